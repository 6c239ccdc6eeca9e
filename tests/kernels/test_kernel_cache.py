"""The folder of the kernels, damaged, shared, full or foreign: right results or a clear error."""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random

import pytest
import tiny_kernel
from conftest import SCENARIOS, at_rest
from typer.testing import CliRunner

from continuum_dyn import load_scenario
from continuum_dyn.cli import app
from statics.errors import KernelCacheError
from statics.kernels import loading
from statics.kernels.kept_files import no_cache, read_sealed, write_sealed

pytestmark = pytest.mark.skipif(os.name != "posix", reason="owners, modes and mounts are those of POSIX")

UNACTUATED = SCENARIOS / "unactuated.toml"
CLI = "from continuum_dyn.cli import main; main()"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A kernel folder of the test's own, not there yet; nothing is loaded."""
    folder = tmp_path / "kernels"
    monkeypatch.setenv("CONTINUUM_DYN_CACHE", str(folder))
    monkeypatch.setattr(loading, "_loaded", {})
    return folder


def answer(factor: float) -> float:
    """As by a process that has loaded nothing yet; right is twice the factor, plus 1."""
    loading._loaded.clear()
    return tiny_kernel.answer(factor)


def kept(folder: Path) -> list[str]:
    """The names of what is kept, all of it whole."""
    assert all(read_sealed(path) is not None for path in folder.iterdir())
    return sorted(path.name for path in folder.iterdir())


def with_a_bit_changed(whole: bytes) -> bytes:
    place = Random(0).randrange(whole.index(b"\n") + 1, len(whole))
    return whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :]


@pytest.mark.parametrize(
    "damaged",
    [with_a_bit_changed, lambda whole: whole[: len(whole) // 2], lambda _: b"", lambda _: b"\xff\x00" * 5000],
    ids=["edited", "truncated", "empty", "other bytes"],
)
def test_damaged_files_are_made_again(folder: Path, damaged: Callable[[bytes], bytes]) -> None:
    assert answer(3.0) == 7.0
    before = kept(folder)
    assert len(before) == 3  # the text, its machine code, and that of a function
    for path in folder.iterdir():
        path.write_bytes(damaged(path.read_bytes()))
    assert answer(3.0) == 7.0
    assert kept(folder) == before


@pytest.mark.parametrize(("one", "other"), [("times_3*.py", "times_5*.py"), ("times_3*[!y]", "times_5*[!y]")])
def test_code_that_was_renamed_to_other_code_is_not_taken_for_it(folder: Path, one: str, other: str) -> None:
    """Neither a kernel's text nor its machine code."""
    assert (answer(3.0), answer(5.0)) == (7.0, 11.0)
    pairs = list(zip(folder.glob(one), folder.glob(other), strict=True))
    assert len(pairs) == 1
    for first, second in pairs:
        its, others = first.read_bytes(), second.read_bytes()
        first.write_bytes(others)
        second.write_bytes(its)
    assert (answer(3.0), answer(5.0)) == (7.0, 11.0)


@pytest.mark.parametrize("as_link", [False, True])
def test_a_file_that_others_may_write_to_is_not_loaded(folder: Path, tmp_path: Path, as_link: bool) -> None:
    """Not even where its seal is right; here it holds the text of another kernel."""
    answer(3.0)
    (path,) = folder.glob("*.py")
    write_sealed(path, tiny_kernel.family(5.0).write(tiny_kernel.STRUCTURE).encode())
    assert answer(3.0) == 11.0  # so it is loaded where it is the user's own
    path.chmod(0o666)
    if as_link:
        path.rename(tmp_path / path.name)
        path.symlink_to(tmp_path / path.name)
    assert answer(3.0) == 7.0
    assert not path.is_symlink()
    assert path.stat().st_mode & 0o777 == 0o600


def test_machine_code_that_others_may_write_to_is_not_loaded(folder: Path) -> None:
    """Not even where its seal is right; here it holds the code of another kernel."""
    assert (answer(3.0), answer(5.0)) == (7.0, 11.0)
    one, other = (path for path in sorted(folder.glob("times_*")) if path.suffix != ".py")
    code = read_sealed(other)
    assert code is not None
    write_sealed(one, code)
    assert answer(3.0) == 11.0  # so it is loaded where it is the user's own
    for path in folder.iterdir():
        path.chmod(0o666)
    assert (answer(3.0), answer(5.0)) == (7.0, 11.0)
    assert {path.stat().st_mode & 0o777 for path in folder.iterdir()} == {0o600}


@pytest.mark.parametrize("as_link", [False, True])
def test_a_folder_that_others_may_write_to_is_refused(folder: Path, tmp_path: Path, as_link: bool) -> None:
    where = tmp_path / "elsewhere" if as_link else folder
    where.mkdir()
    where.chmod(0o770)
    if as_link:
        folder.symlink_to(where)
    with pytest.raises(KernelCacheError, match=f"chmod 700 {folder}.*CONTINUUM_DYN_CACHE.*--no-cache"):
        answer(3.0)
    assert not list(where.iterdir())


def test_a_folder_of_another_user_is_refused(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder.mkdir()
    me = os.getuid()
    monkeypatch.setattr(os, "getuid", lambda: me + 1)
    with pytest.raises(KernelCacheError, match=r"belongs to another user.*CONTINUUM_DYN_CACHE") as refused:
        answer(3.0)
    assert "chmod" not in str(refused.value)


def test_a_folder_that_cannot_be_made_is_refused(folder: Path) -> None:
    folder.symlink_to(folder.parent / "nowhere")
    with pytest.raises(KernelCacheError, match="CONTINUUM_DYN_CACHE"):
        answer(3.0)


@contextmanager
def small_disk(folder: Path, room: str) -> Iterator[None]:
    """A disk of its own for the folder, with room for so much."""
    folder.mkdir(mode=0o700)
    command = ["mount", "-t", "tmpfs", "-o", f"size={room},mode=700", "tmpfs", str(folder)]
    mounted = subprocess.run(command, capture_output=True, text=True, check=False)
    if mounted.returncode:
        pytest.skip(f"only who may mount a disk can fill one here: {mounted.stderr.strip()}")
    try:
        yield
    finally:
        subprocess.run(["umount", str(folder)], check=True)


@pytest.mark.parametrize(("taken", "files"), [(64, 0), (60, 1), (56, 2)])
def test_a_full_disk_is_told_and_leaves_nothing_broken(folder: Path, taken: int, files: int) -> None:
    """Full before the text is written, or its machine code, or that of the function that calls it."""
    with small_disk(folder, "64k"):
        (folder / "ballast").write_bytes(bytes(1024 * taken))
        with pytest.raises(KernelCacheError, match=r"No space left.*CONTINUUM_DYN_CACHE"):
            answer(3.0)
        (folder / "ballast").unlink()
        assert len(kept(folder)) == files
        assert answer(3.0) == 7.0
        assert len(kept(folder)) == 3


def test_a_read_only_folder_gives_what_it_holds_and_tells_what_it_cannot_take(folder: Path) -> None:
    with small_disk(folder, "1m"):
        assert answer(3.0) == 7.0
        before = kept(folder)
        subprocess.run(["mount", "-o", "remount,ro", str(folder)], check=True)
        assert answer(3.0) == 7.0
        with pytest.raises(KernelCacheError, match=r"Read-only.*CONTINUUM_DYN_CACHE"):
            answer(5.0)
        assert kept(folder) == before


def test_two_processes_at_once_fill_an_empty_folder(folder: Path) -> None:
    program = [sys.executable, tiny_kernel.__file__, "3", "5"]
    pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.PIPE)
    running = [subprocess.Popen(program, **pipes, text=True) for _ in range(2)]
    for process in running:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
    assert [process.communicate("go\n", timeout=120) for process in running] == [("7.0\n11.0\n", "")] * 2
    assert len(kept(folder)) == 5  # two texts, their machine code, and that of a function


def run_unactuated(out: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """The command line with ``--no-cache``."""
    return subprocess.run(
        [sys.executable, "-c", CLI, "--no-cache", "run", str(UNACTUATED), "--json", "--out", str(out)],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
def test_without_cache_the_folder_is_not_even_looked_at(tmp_path: Path, folder: Path) -> None:
    with no_cache():
        expected = at_rest(load_scenario(UNACTUATED).scene).tip
    folder.mkdir()
    folder.chmod(0o777)
    (tmp_path / "temporary").mkdir()
    result = run_unactuated(tmp_path, TMPDIR=str(tmp_path / "temporary"))
    assert result.returncode == 0, result.stderr
    assert json.loads(result.stdout)["tip"] == pytest.approx(expected, rel=1e-12)
    assert not list(folder.iterdir())
    assert not list((tmp_path / "temporary").iterdir())


def test_without_cache_and_without_a_temporary_folder_it_is_told_what_to_do(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "nowhere"))
    result = CliRunner().invoke(app, ["--no-cache", "run", str(UNACTUATED)])
    assert result.exit_code == 2
    assert "TMPDIR" in result.stderr
