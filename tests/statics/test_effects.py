"""Over the registry: every effect names what it is made of, and leaves no trace where it is left out."""

from dataclasses import replace

import numpy as np
import pytest
from conftest import UPPER
from one_of_each import ONE_OF_EACH
from passes_by_hand import Passes
from whole_arm import random_state

from continuum_dyn.effects import (
    EFFECTS,
    LinearDrag,
    MassDamping,
    MaterialDamping,
    QuadraticDrag,
)
from continuum_dyn.equations.virtual_power import derive_dynamics, partial_velocity
from continuum_dyn.passes.motion_passes import MOTION
from statics import (
    Arm,
    DiskLoad,
    DiskLoads,
    Extension,
    Gravity,
    InputError,
    Scene,
)
from statics.arm import CableKind
from statics.derivation.segment import DiskSymbols, SegmentSymbols
from statics.derivation.virtual_work import collect, partial_displacement
from statics.effects import Effect
from statics.kernels.loading import load_interpreted
from statics.passes.rest_passes import REST
from statics.quantities import QUANTITIES

ARM = Arm.preset("rone2012", cables=(replace(UPPER, friction=0.2),))
WITHOUT_EFFECT: tuple[Effect, ...] = (
    Gravity((0.0, 0.0)),
    DiskLoads(loads=(DiskLoad(4),)),
    MaterialDamping(0.0),
    MassDamping(0.0),
    LinearDrag(0.0),
    QuadraticDrag(0.0),
)
"""Those that parameters of zero leave without effect."""
TRACES = {
    "bending": ("reference_curvature",),
    "extension": ("elongation", "axial_stiffness"),
    "gravity": ("gravity_x", "gravity_y"),
    "cables": ("tension_1", "hole_offset_1", "cable_passes_1"),
    "cable_friction": ("friction_1", "tension_lost_1", "math.tanh"),
    "loads": ("load_force_x", "load_force_y", "load_moment"),
    "inertia": ("far_acceleration_0*node_mass",),
    "rotary_inertia": ("far_angular_acceleration*node_inertia",),
    "material_damping": ("retardation_time",),
    "mass_damping": ("mass_damping_rate",),
    "linear_drag": ("'drag_per_speed'", "'rotary_drag_per_speed'"),
    "quadratic_drag": ("drag_per_speed_squared", "e-120"),
}
"""Names that an effect, and nothing else, brings into a generated kernel."""


DAMPING = [
    name
    for name, effect in EFFECTS.items()
    if effect.account == "dissipated_power" and not effect.acts_at_rest
]
"""What dissipates in each place by itself; friction does so along a whole cable."""


def everything_but(name: str) -> Scene:
    return Scene(ARM, ONE_OF_EACH).without(name)


def test_one_of_each_is_every_registered_effect() -> None:
    assert {effect.name for effect in ONE_OF_EACH} == set(EFFECTS) == set(TRACES)


@pytest.mark.parametrize("effect", ONE_OF_EACH, ids=lambda effect: effect.name)
def test_effect_names_its_quantities_and_its_source(effect: Effect) -> None:
    assert effect.source
    assert set(effect.quantities) <= set(QUANTITIES)
    assert {name.removesuffix("_1") for name in effect.columns(ARM)} == set(effect.quantities)
    assert set(effect.coordinates) <= set(QUANTITIES)
    assert type(effect).__doc__


@pytest.mark.parametrize("name", EFFECTS)
def test_effect_left_out_leaves_no_trace_in_the_generated_source(name: str) -> None:
    source = load_interpreted(everything_but(name).structure, MOTION).text
    found = [trace for trace in TRACES[name] if trace in source]
    assert not found


def acts_on_disks(effect: Effect) -> bool:
    return effect.site in ("disk", "mass")


def symbols_of(effect: Effect) -> SegmentSymbols | DiskSymbols:
    """What the effect's pairs are written in; a span is one segment here."""
    if acts_on_disks(effect):
        return DiskSymbols(payloads=1)
    return SegmentSymbols(("bend_angle", "elongation"), (CableKind(rubs=True),))


def test_effects_that_are_there_leave_their_traces() -> None:
    source = load_interpreted(Scene(ARM, ONE_OF_EACH).structure, MOTION).text
    assert not [trace for traces in TRACES.values() for trace in traces if trace not in source]


def balance_of(scene: Scene) -> np.ndarray:
    """What one state that moves lacks for balance, and its powers."""
    passes, (q, u) = Passes(scene, MOTION, load_interpreted), random_state(scene, seed=1)
    powers = passes.motion(q, u, 100.0 * u, np.array([1.3]))
    return np.append(passes.residual(), [*powers.values()])


@pytest.mark.slow
@pytest.mark.parametrize("effect", WITHOUT_EFFECT, ids=lambda effect: effect.name)
def test_effect_with_parameters_of_zero_is_no_effect(effect: Effect) -> None:
    without = everything_but(effect.name)
    found = balance_of(Scene(ARM, (*without.effects, effect)))
    np.testing.assert_allclose(found, balance_of(without), rtol=1e-11)


def test_statics_knows_nothing_of_motion() -> None:
    source = REST.write(Scene(ARM, ONE_OF_EACH).at_rest.structure)
    assert not [word for word in ("_rate", "velocity", "far_acceleration", "node_inertia") if word in source]


@pytest.mark.parametrize("effect", ONE_OF_EACH, ids=lambda effect: effect.name)
def test_partial_velocities_are_partial_displacements(effect: Effect) -> None:
    """Kane 1985, sec. 2.14: for r(q), dr'/du_i = dr/dq_i, so at rest virtual power is virtual work."""
    at = symbols_of(effect)
    for _, displacement in collect([effect], (effect.site,), at)[0][1]:
        for i, coordinate in enumerate(at.coordinates):
            moving = partial_velocity(displacement, at.coordinates, at.rates, i)
            assert moving == partial_displacement(displacement, coordinate)


@pytest.mark.parametrize("effect", ONE_OF_EACH, ids=lambda effect: effect.name)
def test_only_effects_in_motion_depend_on_rates_or_accelerations(effect: Effect) -> None:
    at = symbols_of(effect)
    changing = {str(s) for s in (*at.rates, *at.accelerations)}
    pairs = collect([effect], (effect.site,), at)[0][1]
    symbols = {str(s) for pair in pairs for s in _free_symbols(pair.load)}
    assert bool(symbols & changing) == (not effect.acts_at_rest)


def _free_symbols(load: object) -> set[object]:
    parts = load if isinstance(load, tuple) else (load,)
    return set().union(*(getattr(part, "free_symbols", set()) for part in parts))


@pytest.mark.parametrize("name", DAMPING)
def test_what_dissipates_takes_energy_in_any_motion_and_has_a_symmetric_damping_matrix(name: str) -> None:
    effect = next(effect for effect in ONE_OF_EACH if effect.name == name)
    forces = derive_dynamics(Scene(ARM, {effect, Extension()}).structure)
    on_disks, on_segments = (forces.disk, forces.on_disk), (forces.segment, forces.on_segment)
    at, part = on_disks if acts_on_disks(effect) else on_segments
    random = np.random.default_rng(2)
    assert part.damping == part.damping.T
    for size in (1e-100, 1e-3, 1.0, 1e3):
        moving = dict(zip(at.rates, map(float, size * random.uniform(-1, 1, len(at.rates))), strict=True))
        power = part.powers["dissipated_power"].subs(moving)
        damping = part.damping.subs(moving)
        parameters = dict.fromkeys(power.free_symbols | damping.free_symbols, 2.0)
        assert power.subs(parameters) >= 0
        assert np.linalg.eigvalsh(np.array(damping.subs(parameters), dtype=float)).min() >= 0


def test_effects_in_any_order_are_the_same_scene() -> None:
    assert Scene(ARM, ONE_OF_EACH).effects == Scene(ARM, reversed(ONE_OF_EACH)).effects


def test_effect_given_twice_is_refused() -> None:
    with pytest.raises(InputError, match="'gravity' is given 2 times"):
        Scene(ARM, (Gravity(), Gravity((0.0, 0.0))))


def test_effect_without_the_number_that_it_needs_is_refused_by_name() -> None:
    with pytest.raises(InputError, match="'gravity' needs the arm's disk_mass"):
        Scene(Arm(4, 0.02), (Gravity(),))


def test_load_beyond_the_arm_is_refused() -> None:
    with pytest.raises(InputError, match="disk 5"):
        Scene(ARM, (DiskLoads(loads=(DiskLoad(5),)),))
