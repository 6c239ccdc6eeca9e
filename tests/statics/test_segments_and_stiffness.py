"""Random arms that must rest alike: any number of segments under a moment, no extension and hardly any."""

from dataclasses import replace
from typing import Any

import numpy as np
from hypothesis import strategies as st
from random_scenes import Case, Draw, at_rest, base, holds_for, holds_in, inextensible, near, within

from statics import Arm, Bending, DiskLoad, DiskLoads, Extension, PerDisk, Scene

FLEXURAL_RIGIDITY = 4.2e-3


def under_a_moment(spacings: list[float], moment: float, curvature: float, **traits: Any) -> Case:
    """An arm of these disks whose tip is turned by a moment; the core is the same all along."""
    arm = Arm.preset(
        "rone2012",
        disks=len(spacings),
        second_moment=FLEXURAL_RIGIDITY / 2.1e11,
        reference_curvature=curvature,
        each=PerDisk(disk_spacing=tuple(spacings)),
        **traits,
    )
    load = DiskLoad(arm.disks, moment=moment)
    scene = Scene(arm, (Bending(), Extension(), DiskLoads((load,))))
    nothing = np.zeros((arm.segments, 2))
    pose: dict[str, float] = dict(zip(("base_x", "base_y", "base_theta"), arm.base_pose, strict=True))
    return Case(scene, pose, nothing, nothing)


@st.composite
def cores(draw: Draw) -> tuple[Case, Case]:
    """One segment, and up to six of other lengths, with the same base, core and moment."""
    spacings = draw(st.lists(near(0.02), min_size=1, max_size=6))
    # up to one and a half turns
    shape = draw(within(10.0 * FLEXURAL_RIGIDITY / sum(spacings))), draw(within(20.0))
    mounted = base(draw, moves=False)
    subsegments = draw(st.integers(1, 3))
    one = under_a_moment([sum(spacings)], *shape, base=mounted)
    return one, under_a_moment(spacings, *shape, base=mounted, subsegments=subsegments)


@holds_for(arms=cores())
def test_one_segment_equals_many_under_a_moment_at_the_tip(arms: tuple[Case, Case]) -> None:
    one, many = map(at_rest, arms)
    assert one.stable
    assert many.stable
    np.testing.assert_allclose(many.curvature, one.curvature[0], rtol=1e-11, atol=1e-11)
    np.testing.assert_allclose(many.tip, one.tip, atol=1e-12)


def extensible(case: Case, area: float) -> Case:
    """The same scene of a core that can extend."""
    arm = replace(case.scene.arm, area=area)
    return replace(case, scene=Scene(arm, (*case.scene.effects, Extension())))


@holds_in(inextensible)
def test_extension_vanishes_as_its_stiffness_grows(case: Case) -> None:
    """As 1 / EA: a thousand times the stiffness leaves a thousandth of the change, but for its square."""
    rigid = at_rest(case)
    elastic = [at_rest(extensible(case, area)) for area in (5e-7, 5e-4)]
    assert rigid.found
    changes = []
    for point in elastic:
        assert point.found
        assert point.elongation is not None
        moved = np.array([point.disk_x - rigid.disk_x, point.disk_y - rigid.disk_y])
        changes.append(np.array([*moved, point.elongation]))
    np.testing.assert_allclose(1e3 * changes[1], changes[0], rtol=1e-2, atol=2e-13 * 1e3)
