"""Text from elsewhere is shown as it is, on any terminal, in plots and in recordings."""

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import h5py
import pytest
from conftest import SCENARIOS
from matplotlib.figure import Figure
from typer.testing import CliRunner

from continuum_dyn.cli import app
from continuum_dyn.record import read_log
from continuum_dyn.record.datasets import VERSIONS
from continuum_dyn.views.figures import log_plots
from continuum_dyn.views.figures.heading import set_heading
from continuum_dyn.views.playback.about import about
from continuum_dyn.views.playback.playback import playback_of
from continuum_dyn.views.playback.recording import save
from statics.support.plain_text import plain, plain_line

TITLE = "deflection [/mm] [red]x[/red] :smile: a $x^$ b `c` <d> \u00b5"
CABLE = "c$ [/x] :on:"
HOSTILE = "\x1b]0;title\x07\x1b[31mred[/foo]\n\udcff \u202e"
FULL = Path("/dev/full")
needs_full = pytest.mark.skipif(not FULL.exists(), reason="there is no full device here")


def program(*arguments: Any, **options: Any) -> subprocess.CompletedProcess[bytes]:
    environment = os.environ | {"NO_COLOR": "1", "COLUMNS": "120"} | options.pop("env", {})
    command = [sys.executable, "-m", "continuum_dyn", *arguments]
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | options
    return subprocess.run(command, env=environment, check=False, **options)


@pytest.fixture(scope="module")
def scenario(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A ramp in a folder whose name looks like the end of some markup."""
    folder = tmp_path_factory.mktemp("text") / "[" / "x]"
    folder.mkdir(parents=True)
    text = (SCENARIOS / "tension_ramp.toml").read_text()
    text = text.replace('"upper"', f'"{CABLE}"').replace(
        'title = "Tension ramp, 0 to 2 N"', f'title = "{TITLE}"'
    )
    assert TITLE in text
    (folder / "ramp.toml").write_text(text, encoding="utf-8")
    return folder / "ramp.toml"


@pytest.fixture(scope="module")
def log(scenario: Path) -> Path:
    result = CliRunner().invoke(
        app, ["run", str(scenario), "--out", str(scenario.parent)], env={"COLUMNS": "300"}
    )
    assert result.exit_code == 0, result.exception
    for text in (TITLE, f"{CABLE} (N)", str(scenario.with_suffix(".h5"))):
        assert text in result.stdout
    return scenario.with_suffix(".h5")


@pytest.fixture(scope="module")
def hostile(log: Path) -> Path:
    """A log whose texts would steer a terminal, and are not UTF-8."""
    path = log.with_name("hostile.h5")
    path.write_bytes(log.read_bytes())
    with h5py.File(path, "r+", libver=VERSIONS) as file:
        for name in ("title", "message", "versions"):
            file.attrs.create(name, HOSTILE.encode(errors="surrogateescape"), dtype=h5py.string_dtype())
        for group in ("arm", "equilibria"):
            file[group]["cable"][0] = HOSTILE.replace("\udcff", "")
    return path


def test_characters_that_cannot_be_shown_are_replaced() -> None:
    assert plain("a\tb\n\x1b[1m\udcff") == "a\tb\n\ufffd[1m\ufffd"
    assert plain_line(" a\n b\x07") == "a b\ufffd"
    assert plain(TITLE) == plain_line(TITLE) == TITLE


def test_logs_of_any_texts_are_shown(log: Path, hostile: Path, tmp_path: Path) -> None:
    runner = CliRunner(env={"COLUMNS": "300"})
    for path in (log, hostile):
        for arguments in (["info"], ["validate"], ["plot", "--out", str(tmp_path / "plot.png")]):
            result = runner.invoke(app, [arguments[0], str(path), *arguments[1:]])
            assert result.exit_code == 0 or arguments == ["validate"], result.output
            assert "\x1b" not in result.output
        result = runner.invoke(app, ["play", str(path), "--save", str(tmp_path / "x.rrd")])
        assert result.exit_code == 0, result.exception
    assert TITLE in runner.invoke(app, ["info", str(log)]).stdout


def test_no_formula_begins_in_a_heading(log: Path, tmp_path: Path) -> None:
    figure = Figure()
    set_heading(figure, "a $x^$ b")
    assert figure.get_suptitle() == "a $x^$ b"
    figure.savefig(tmp_path / "heading.png")
    assert log_plots.picture(read_log(log)).get_suptitle() == TITLE


def test_text_beside_a_playback_shows_a_title_as_it_is(log: Path, tmp_path: Path) -> None:
    playback = playback_of(read_log(log))
    assert playback is not None
    first = about(playback).splitlines()[0]
    assert r"\[\/mm\]" in first
    assert first.replace("\\", "") == f"# {TITLE}"
    save([playback.log], tmp_path / "x.rrd")


def test_output_in_ascii_replaces_what_it_does_not_have(log: Path, scenario: Path) -> None:
    for environment in (
        {"PYTHONIOENCODING": "ascii"},
        {"LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"},
    ):
        result = program("info", log, env=environment)
        assert result.returncode == 0, result.stderr
        assert TITLE.replace("\u00b5", "?").encode() in result.stdout
    given_back = program("info", log, "--scenario", env={"PYTHONIOENCODING": "ascii"})
    assert given_back.stdout == scenario.read_bytes()


@pytest.mark.slow
@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="names are UTF-8 elsewhere")
def test_files_of_names_that_are_not_utf_8(tmp_path: Path, scenario: Path) -> None:
    folder = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff"))
    folder.mkdir()
    given = Path(os.fsdecode(os.fsencode(folder) + b"/n\xfe.toml"))
    given.write_bytes(scenario.read_bytes().replace(b"title", b"# title"))
    for arguments in (
        ("run", given, "--out", folder),
        ("run", given.with_suffix(".h5"), "--out", folder),
        ("info", given.with_suffix(".h5")),
        ("plot", given.with_suffix(".h5"), "--out", folder / "x.png"),
        ("run", given, "--set", "arm.disks=5", "--name", given.stem, "--out", folder),
    ):
        result = program(*arguments)
        assert result.returncode == 0, result.stderr
    assert len(list(folder.iterdir())) == 6


@pytest.mark.slow
def test_any_backend_of_matplotlib_may_be_named(log: Path, tmp_path: Path) -> None:
    result = program("plot", log, "--out", tmp_path / "x.png", env={"MPLBACKEND": "none of them"})
    assert result.returncode == 0, result.stderr


@needs_full
@pytest.mark.parametrize(
    "arguments", [["info"], ["info", "--scenario"], ["--help"], ["--version"], ["run", "--json"]]
)
def test_full_output_is_an_error(arguments: list[str], log: Path, tmp_path: Path) -> None:
    if arguments[0] == "run":
        arguments = ["run", "--json", "--out", str(tmp_path), str(log)]
    elif arguments[0] == "info":
        arguments = [*arguments, str(log)]
    with FULL.open("w") as full:
        result = program(*arguments, stdout=full)
    assert result.returncode == 2
    assert result.stderr.decode().startswith("error: cannot write to standard output: No space left")
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.skipif(os.name != "posix", reason="closes a descriptor")
def test_closed_output_is_an_error(log: Path) -> None:
    result = program("info", log, stdout=None, preexec_fn=lambda: os.close(1))
    assert (result.returncode, result.stderr.count(b"\n")) == (2, 1)
    assert b"standard output is closed" in result.stderr
    result = program("info", "none.h5", stderr=None, preexec_fn=lambda: os.close(2))
    assert (result.returncode, result.stdout) == (2, b"")
