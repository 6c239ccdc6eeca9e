"""The package as others get it: built, installed without the repository, and run."""

import json
import os
import subprocess
import sys
import tarfile
import venv
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).parents[2]

pytestmark = pytest.mark.slow


def run(*words: str | Path, cwd: Path) -> str:
    """What a program prints; without the paths that would lead it to the repository."""
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    result = subprocess.run(words, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the source distribution, and the wheel that is built from it alone."""
    pytest.importorskip("hatchling", reason="hatchling is not installed: pip install hatchling")
    folder = tmp_path_factory.mktemp("dist")
    build = (sys.executable, "-m", "hatchling", "build", "--directory", folder)
    subprocess.run([*build, "--target", "sdist"], cwd=REPOSITORY, check=True, capture_output=True)
    (archive,) = folder.glob("*.tar.gz")
    with tarfile.open(archive) as files:
        files.extractall(folder, filter="data")
    source = folder / archive.name.removesuffix(".tar.gz")
    subprocess.run([*build, "--target", "wheel"], cwd=source, check=True, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def wheel(built: Path) -> Path:
    (found,) = built.glob("*.whl")
    return found


@pytest.fixture(scope="module")
def programs(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where the programs are of an environment that has the wheel, and what the wheel depends on."""
    folder = tmp_path_factory.mktemp("environment")
    venv.create(folder)
    (packages,) = folder.glob("lib/python*/site-packages")
    dependencies = [path for path in sys.path if path.endswith("site-packages")]
    (packages / "dependencies.pth").write_text("\n".join(dependencies))
    pip = (sys.executable, "-m", "pip", "--python", folder / "bin" / "python")
    run(*pip, "install", "--no-deps", "--no-index", "--quiet", wheel, cwd=folder)
    return folder / "bin"


@pytest.mark.skipif(not (REPOSITORY / ".git").exists(), reason="this is no checkout of the repository")
def test_source_distribution_holds_what_the_repository_holds(built: Path) -> None:
    (archive,) = built.glob("*.tar.gz")
    with tarfile.open(archive) as files:
        held = {name.partition("/")[2] for name in files.getnames()}
    tracked = run("git", "ls-files", "--cached", "--others", "--exclude-standard", cwd=REPOSITORY)
    assert held == {*tracked.splitlines(), "PKG-INFO"}


def test_wheel_holds_the_packages_with_their_data_and_nothing_else(wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.partition("/")[0] for name in names} == {
        *("continuum_dyn", "statics"),
        f"{'-'.join(wheel.name.split('-')[:2])}.dist-info",
    }
    for package in ("statics", "continuum_dyn"):
        assert f"{package}/py.typed" in names
    assert {
        "continuum_dyn/scenario_files/first_scenario.toml",
        "continuum_dyn/scenario_files/examples.toml",
    } <= {*names}
    scenarios = REPOSITORY / "scenarios"
    held = {name.removeprefix("continuum_dyn/scenarios/") for name in names if "/scenarios/" in name}
    assert held == {file.relative_to(scenarios).as_posix() for file in scenarios.rglob("*") if file.is_file()}
    assert any(name.endswith("licenses/LICENSE") for name in names)


def test_what_is_heavy_is_required_by_extras_alone(wheel: Path) -> None:
    (metadata,) = (name for name in zipfile.ZipFile(wheel).namelist() if name.endswith("METADATA"))
    lines = zipfile.ZipFile(wheel).read(metadata).decode().splitlines()
    required = [line for line in lines if line.startswith("Requires-Dist: ")]
    for package, extra in (("rerun-sdk", "rerun"), ("matplotlib", "plots")):
        lines_of_it = [line for line in required if package in line]
        assert any(line.endswith(f"; extra == '{extra}'") for line in lines_of_it)
        assert all("; extra == " in line for line in lines_of_it)
    assert "License-Expression: BSD-3-Clause" in lines


def test_installed_without_the_repository_it_runs_the_scenario_that_it_writes(
    programs: Path, tmp_path: Path
) -> None:
    place = run(programs / "python", "-c", "import statics; print(statics.__file__)", cwd=tmp_path)
    assert Path(place).is_relative_to(programs.parent)
    program = programs / "continuum-dyn"
    run(program, "init", "arm.toml", cwd=tmp_path)
    assert "slow_ramp.csv" in run(program, "init", "slow.toml", "--from", "slow_ramp", cwd=tmp_path)
    record = json.loads(run(program, "run", "arm.toml", "--json", cwd=tmp_path))
    assert record["outcome"] == "settled"
    assert record["static_gap"] < 1e-6
    assert (tmp_path / record["log"]).exists()
    assert json.loads(run(program, "schema", cwd=tmp_path))["title"] == "continuum-dyn scenario"
