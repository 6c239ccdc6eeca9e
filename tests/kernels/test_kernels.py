"""Generated kernels: readable, keyed by structure and sources, never recompiled for a number."""

import os
import sys
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from shutil import copytree
from typing import Any

import numpy as np
import pytest
from conftest import moving, rone2012

from continuum_dyn import Scenario, simulate
from continuum_dyn.integrators import runge_kutta
from continuum_dyn.passes import observation
from continuum_dyn.passes.motion_passes import MOTION
from continuum_dyn.scenario.profiles import Constant
from continuum_dyn.scenario.studies import MotionStudy
from statics import Scene, StaticSolver, equilibrium
from statics.kernels import loading
from statics.kernels.loading import kernel_key, load, load_interpreted
from statics.passes import newton, search
from statics.passes.rest_passes import REST


@pytest.fixture
def own_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A kernel folder of the test's own, and nothing loaded yet."""
    folder = tmp_path / "kernels"
    monkeypatch.setenv("CONTINUUM_DYN_CACHE", str(folder))
    monkeypatch.setattr(loading, "_loaded", {})
    return folder


def rewrite(path: Path, text: str) -> None:
    """Change a file, a second after it was last changed."""
    then = path.stat().st_mtime_ns if path.exists() else 0
    path.write_text(text)
    os.utime(path, ns=(then + 10**9, then + 10**9))


def test_changed_numbers_compile_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    run = Scenario(moving(rone2012()), (Constant(1.0),), MotionStudy(0.001, samples=2))
    simulate(run)
    structure = run.scene.structure
    at_rest, in_motion = load(run.scene.at_rest.structure, REST), load(structure, MOTION)
    modules = (newton, search, runge_kutta, observation)
    functions: list[Any] = [
        each for module in modules for each in vars(module).values() if hasattr(each, "codes")
    ]
    before = [len(function.codes) for function in functions]
    entered: list[Any] = [
        newton.find_stable,
        runge_kutta.advance,
        runge_kutta.interpolate,
        observation.observe,
    ]
    assert all(len(function.codes) > 0 for function in entered)
    monkeypatch.setattr(loading, "_compiled", None)
    for disks, stiffness in ((4, 2.0), (1, 1.0), (30, 0.5)):
        simulate(replace(run, scene=moving(rone2012(disks=disks, stiffness=stiffness, gravity=(1.0, -3.0)))))
    assert load(run.scene.at_rest.structure, REST) is at_rest
    assert load(structure, MOTION) is in_motion
    assert [len(function.codes) for function in functions] == before


def test_key_follows_structure_not_numbers() -> None:
    scene = rone2012()
    key = kernel_key(scene.structure, REST)
    assert kernel_key(rone2012(disks=9, stiffness=0.1).structure, REST) == key
    assert kernel_key(Scene(scene.arm, scene.effects[1:]).structure, REST) != key
    assert kernel_key(scene.structure, MOTION) != key


def test_key_follows_where_the_cores_own_mass_stands() -> None:
    structure = rone2012().structure
    keys = {
        kernel_key(replace(structure, core_fractions=fractions), REST)
        for fractions in ((), (0.5,), (0.25, 0.75), (0.2, 0.8))
    }
    assert len(keys) == 4


def test_key_follows_the_file_of_an_effect(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(tmp_path))
    file = tmp_path / "effect_whose_file_changes.py"
    rewrite(file, "from statics import Bending\n\n\nclass Own(Bending):\n    name = 'own'\n")
    own = import_module(file.stem).Own
    structure = replace(rone2012().structure, effects=(own,))
    first = kernel_key(structure, REST)
    assert kernel_key(structure, REST) == first
    rewrite(file, file.read_text() + "\n")
    assert kernel_key(structure, REST) != first
    del sys.modules[file.stem]


@pytest.mark.parametrize("family", [REST, MOTION], ids=lambda family: family.name)
def test_key_follows_every_source_of_the_derivation(
    family: loading.Family, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    structure = rone2012().structure
    folder = tmp_path / "derivation"
    copytree(loading._SHARED, folder)
    assert set(loading._SHARED.rglob("*.py")) <= set(family.sources)
    monkeypatch.setattr(loading, "_SHARED", folder)
    found = {kernel_key(structure, family)}
    files = sorted(folder.rglob("*.py"))
    for file in files:
        rewrite(file, file.read_text() + "\n")
        found.add(kernel_key(structure, family))
    assert len(found) == 1 + len(files)


def test_kernel_is_written_once_and_opens_with_what_made_it(own_cache: Path, paper_arm: Scene) -> None:
    load(paper_arm.structure, REST)
    (path,) = own_cache.glob("*.py")
    text, written = path.read_text(), path.stat().st_mtime_ns
    for words in (
        "Effects: bending, cables, extension, gravity",
        "SEGMENT_COLUMNS",
        "def pose_step(",
        "Generated",
    ):
        assert words in text
    loading._loaded.clear()
    load(rone2012(disks=9, stiffness=0.1).structure, REST)
    assert path.stat().st_mtime_ns == written
    assert own_cache.stat().st_mode & 0o777 == 0o700


def test_size_of_the_generated_source_does_not_depend_on_the_number_of_disks() -> None:
    texts = {REST.write(rone2012(disks=disks).structure) for disks in (1, 4, 1024)}
    assert len(texts) == 1


def test_interpreted_kernel_needs_no_compiler(paper_arm: Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    expected = equilibrium(paper_arm, 1.0)
    monkeypatch.setattr(loading, "_compiled", None)
    monkeypatch.setattr(loading, "lower", None)
    found = StaticSolver(paper_arm, load_interpreted).solve(np.array([1.0]))
    assert found.found
    np.testing.assert_allclose(found.bend_angle, expected.bend_angle, rtol=1e-12)
