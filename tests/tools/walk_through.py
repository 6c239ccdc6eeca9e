"""Walk-throughs of docs/how_to: what a page says to write or to change, done to a copy of the program."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

REPOSITORY = Path(__file__).parents[2]
PACKAGES = "statics", "continuum_dyn"


def page(name: str) -> str:
    return (REPOSITORY / "docs" / "how_to" / name).read_text(encoding="utf-8")


def copy_of_program(root: Path) -> Path:
    for package in PACKAGES:
        shutil.copytree(REPOSITORY / package, root / package, ignore=shutil.ignore_patterns("__pycache__"))
    return root


class Block(NamedTuple):
    """A block of a page: a whole file, or a ``diff`` of lines to change in one."""

    path: str
    kind: str
    text: str


def perform(block: Block, root: Path) -> None:
    """Write the block's file, or change in it the lines that the block shows, which stand there once."""
    file = root / block.path
    if block.kind != "diff":
        assert not file.exists(), f"{block.path} is to be new"
        file.parent.mkdir(exist_ok=True)
        file.write_text(block.text, encoding="utf-8")
        return
    lines = block.text.splitlines(keepends=True)
    before = "".join(line[1:] for line in lines if line[0] in " -")
    after = "".join(line[1:] for line in lines if line[0] in " +")
    text = file.read_text(encoding="utf-8")
    assert text.count(before) == 1, f"{block.path} does not have, once: {before}"
    file.write_text(text.replace(before, after), encoding="utf-8")


def run(program: Path, *arguments: str, **environment: str) -> str:
    """What Python prints in the copy."""
    done = subprocess.run(
        [sys.executable, *arguments],
        cwd=program,
        env=os.environ | {"PYTHONPATH": str(program)} | environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


COMMAND_LINE = "-c", "from continuum_dyn.cli import main; main()"


def said(text: str, pattern: str) -> str:
    """What a page says where the pattern's group stands; wherever its lines break."""
    found = re.search(pattern, " ".join(text.split()))
    assert found, f"the page does not say: {pattern}"
    return found.group(1)
