"""Generated kernels: readable, keyed by structure and sources, never recompiled for a number."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import moving, rone2012

from continuum_dyn import Scenario, implicit_kernel, motion_kernel, simulate
from continuum_dyn.scenario.profiles import Constant
from continuum_dyn.scenario.studies import MotionStudy
from statics import Scene, codegen, equilibrium
from statics.derivation.at_rest import RECIPE


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A kernel folder of the test's own, and nothing loaded yet."""
    folder = tmp_path / "kernels"
    monkeypatch.setenv("CONTINUUM_DYN_CACHE", str(folder))
    monkeypatch.setattr(codegen, "_loaded", {})
    return folder


def test_changed_numbers_compile_nothing() -> None:
    run = Scenario(moving(rone2012()), (Constant(1.0),), MotionStudy(0.001, samples=2))
    simulate(run)
    kernel = codegen.load(run.scene.at_rest, RECIPE)
    implicit, observing = (codegen.load(run.scene, kind.RECIPE) for kind in (implicit_kernel, motion_kernel))
    functions = (kernel.find_equilibrium, implicit.advance, implicit.interpolate, observing.observe)
    before = [len(function.signatures) for function in functions]
    assert min(before) > 0
    for disks, stiffness in ((4, 2.0), (1, 1.0), (30, 0.5)):
        simulate(replace(run, scene=moving(rone2012(disks=disks, stiffness=stiffness, gravity=(1.0, -3.0)))))
    assert codegen.load(run.scene.at_rest, RECIPE) is kernel
    assert [len(function.signatures) for function in functions] == before


def test_key_follows_structure_not_numbers(tmp_path: Path) -> None:
    scene = rone2012()
    key = codegen.kernel_key(scene, RECIPE)
    assert codegen.kernel_key(rone2012(disks=9, stiffness=0.1), RECIPE) == key
    fewer = Scene(scene.arm, scene.effects[1:])
    assert codegen.kernel_key(fewer, RECIPE) != key
    source = tmp_path / "physics.py"
    source.write_text("1")
    first = codegen.kernel_key(scene, replace(RECIPE, sources=(source,)))
    source.write_text("2")
    assert codegen.kernel_key(scene, replace(RECIPE, sources=(source,))) != first


def test_kernel_is_written_once_and_opens_with_what_made_it(own_cache: Path, paper_arm: Scene) -> None:
    codegen.load(paper_arm, RECIPE)
    (path,) = own_cache.glob("*.py")
    text, written = path.read_text(), path.stat().st_mtime_ns
    for words in (
        "Effects: bending, cables, extension, gravity",
        "SEGMENT_COLUMNS",
        "def pose_step(",
        "Generated",
    ):
        assert words in text
    codegen._loaded.clear()
    codegen.load(rone2012(disks=9, stiffness=0.1), RECIPE)
    assert path.stat().st_mtime_ns == written
    assert own_cache.stat().st_mode & 0o777 == 0o700


def test_size_of_the_generated_source_does_not_depend_on_the_number_of_disks() -> None:
    texts = {REST.write(rone2012(disks=disks).structure) for disks in (1, 4, 1024)}
    assert len(texts) == 1


def test_interpreted_kernel_needs_no_compiler(paper_arm: Scene) -> None:
    kernel: Any = codegen.load_interpreted(paper_arm, RECIPE)
    segments = paper_arm.table("segment", kernel.SEGMENT_COLUMNS)
    disks = paper_arm.table("disk", kernel.DISK_COLUMNS)
    q = np.zeros((4, 2))
    ended, _ = kernel.find_equilibrium(q, np.array([1.0]), segments, disks, 0.02, 50)
    assert ended == 0
    np.testing.assert_allclose(q[:, 0], equilibrium(paper_arm, 1.0).bend_angle, rtol=1e-12)
