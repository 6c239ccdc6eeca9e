"""README.md and the pages of docs/ are worked through as a reader would: what they show runs, and says that.

A page is followed from its top, in a folder of its own that holds the scenarios and one Python session.

- ``console``: lines that begin with "$ " are commands. The lines below one are of what it prints, in that
  order; "..." stands for anything. A command succeeds, unless "$ echo $?" below it shows another exit status.
- ``python``: run. A block ``text`` right below it is what it prints, in the same way.
- ``toml`` that begins with "# NAME.toml": a file that is written. Other blocks are only shown: among them the
  few commands that serve until Ctrl-C, or take minutes and have tests of their own.

``make`` is only asked what it would do, since it installs; the checks before anything lands run it. ``play``
writes a file and opens no window.
"""

import contextlib
import io
import re
import shlex
import shutil
import subprocess
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from typer.testing import CliRunner

from continuum_dyn.cli import app

REPOSITORY = Path(__file__).parents[2]
DOCS = REPOSITORY / "docs"
PAGES = [REPOSITORY / "README.md", *sorted(DOCS.rglob("*.md"))]
PERFORMED_ELSEWHERE = {"docs/how_to/own_effect.md"}
"""Pages with a test of their own: tests/program/test_own_effect_page.py."""
SLOW = {
    "README.md",
    "docs/how_to/accuracy.md",
    "docs/how_to/hard_cases.md",
    "docs/how_to/logs.md",
    "docs/how_to/own_arm.md",
    "docs/how_to/scenario.md",
    "docs/how_to/settling.md",
    "docs/how_to/tension_ramp.md",
    "docs/tutorial.md",
}
"""Pages that take more than a second or two, most of it for what they compile."""
LANGUAGES = {"console", "python", "toml", "text", "diff", "csv"}
BLOCK = re.compile(r"^```(\S*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
RUNNER = CliRunner(env={"COLUMNS": "80", "NO_COLOR": "1"})


class Block(NamedTuple):
    """A fenced block: its language, its text, and the text of the ``text`` block right below it, if any."""

    language: str
    text: str
    shown: str


def name_of(page: Path) -> str:
    return page.relative_to(REPOSITORY).as_posix()


def blocks(page: Path) -> list[Block]:
    text = page.read_text(encoding="utf-8")
    found = list(BLOCK.finditer(text))
    below = {match.start(): match for match in found}
    made = []
    for match in found:
        after = re.compile(r"\n*").match(text, match.end())
        follower = below.get(after.end()) if after else None
        shown = follower[2] if follower and follower[1] == "text" else ""
        made.append(Block(match[1], match[2], shown))
    return made


def worked_through(page: Path) -> bool:
    """Whether a page has anything to run."""
    return name_of(page) not in PERFORMED_ELSEWHERE and any(
        block.language in ("console", "python") for block in blocks(page)
    )


def check_shown(printed: str, shown: str, what: str) -> None:
    """Every line shown stands in what was printed, in that order; runs of blanks count as one."""
    lines = iter(" ".join(line.split()) for line in printed.splitlines())
    for line in filter(None, (" ".join(line.split()) for line in shown.splitlines())):
        if line != "...":
            pattern = ".*".join(map(re.escape, line.split("...")))
            assert any(re.fullmatch(pattern, candidate) for candidate in lines), (
                f"{what}: does not print, or not in this order: {line}\nIt prints:\n{printed}"
            )


class Reader:
    """Who follows one page: a shell in a folder, and a Python session."""

    def __init__(self) -> None:
        self.session: dict[str, Any] = {"__name__": "page"}
        self.status = 0

    def follow(self, block: Block) -> None:
        """Do what a block says."""
        if block.language == "console":
            self.type(block.text)
        elif block.language == "python":
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed):
                exec(compile(block.text, "page", "exec"), self.session)
            check_shown(printed.getvalue(), block.shown, block.text)
        elif block.language == "toml" and (name := re.match(r"# ([\w.-]+\.toml)\b", block.text)):
            Path(name[1]).write_text(block.text, encoding="utf-8")

    def type(self, text: str) -> None:
        """Enter the commands of a console block, and compare what they print."""
        entries = re.split(r"^\$ ", text, flags=re.MULTILINE)
        assert not entries[0].strip(), f"a console block begins with a command: {text}"
        for number, entry in enumerate(entries[1:], start=1):
            command, _, shown = entry.partition("\n")
            asked = entries[number + 1 :] and entries[number + 1].startswith("echo $?")
            check_shown(self.run(command), shown, command)
            assert self.status == 0 or asked, f"{command}: exit status {self.status}"

    def run(self, command: str) -> str:
        """What the command prints."""
        if command == "echo $?":
            last, self.status = self.status, 0
            return f"{last}"
        command, _, target = command.partition(" > ")
        words = shlex.split(command, comments=True)
        program, arguments = words[0], [name for word in words[1:] for name in expanded(word)]
        if arguments[:1] == ["play"] and "--save" not in arguments:
            arguments += ["--save", "played.rrd"]
        assert program in ("continuum-dyn", "make", "cat", "ls"), f"cannot be tried: {command}"
        if program != "continuum-dyn":
            return self.start(program, arguments)
        result = RUNNER.invoke(app, arguments)
        if result.exception is not None and not isinstance(result.exception, SystemExit):
            raise result.exception
        self.status = result.exit_code
        if target:
            Path(target).write_text(result.stdout, encoding="utf-8")
        return result.output

    def start(self, program: str, arguments: list[str]) -> str:
        """What another program prints."""
        dry = ["--dry-run", "--directory", str(REPOSITORY)] if program == "make" else []
        done = subprocess.run([program, *dry, *arguments], capture_output=True, text=True, check=False)
        self.status = done.returncode
        return done.stdout + done.stderr


def expanded(word: str) -> list[str]:
    """The files that a word with a star stands for, as the shell has it."""
    return sorted(map(str, Path().glob(word))) if "*" in word else [word]


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, id=name_of(page), marks=pytest.mark.slow if name_of(page) in SLOW else ())
        for page in PAGES
        if worked_through(page)
    ],
)
def test_page_runs_and_prints_what_it_shows(
    page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shutil.copytree(REPOSITORY / "scenarios", tmp_path / "scenarios")
    monkeypatch.chdir(tmp_path)
    reader = Reader()
    for block in blocks(page):
        reader.follow(block)


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_blocks_say_what_they_are(page: Path) -> None:
    """So that no command hides in a block of another kind."""
    fences = re.findall(r"^```([\w{}-]*)", page.read_text(encoding="utf-8"), flags=re.MULTILINE)[::2]
    assert [kind for kind in fences if not (kind in LANGUAGES or kind.startswith("{"))] == []


def links(page: Path) -> list[str]:
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    return [link for link in re.findall(r"\]\(([^)\s]+)\)", text) if "://" not in link and link[0] != "#"]


@pytest.mark.parametrize("page", [*PAGES, REPOSITORY / "CONTRIBUTING.md"], ids=name_of)
def test_links_lead_somewhere(page: Path) -> None:
    assert [link for link in links(page) if not (page.parent / link.partition("#")[0]).exists()] == []
