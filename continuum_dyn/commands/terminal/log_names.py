"""Name of a run's log: variants of a scenario do not replace one another's."""

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from statics.errors import InputError, LogError

if TYPE_CHECKING:
    from continuum_dyn.record import StreamedLog

SUFFIX = ".h5"


class HeldLog(NamedTuple):
    """A log that is about to be written, and whether it replaces one of another scenario."""

    log: "StreamedLog"
    replaces: bool


def named_log(folder: Path, name: str) -> Path:
    """Path of the log of that name. Raises ``InputError`` for a name that leads elsewhere."""
    path = Path(name)
    if not name or path.name != name or name.startswith("."):
        raise InputError(f"--name {name!r}: not the name of a file. Its folder is given with --out.")
    return folder / (name if path.suffix == SUFFIX else f"{name}{SUFFIX}")


@contextmanager
def hold_log(path: Path, scenario: str, numbered: bool) -> Iterator[HeldLog]:
    """Hold the log at ``path`` for writing.

    If it may be ``numbered``, and holds another scenario than this text or is being written, the next free
    one is held: NAME_2.h5, NAME_3.h5 and so on. Raises ``LogError`` if another run writes the only one.
    """
    from continuum_dyn.record import StreamedLog
    from continuum_dyn.record.sole_writer import LogBusyError

    others = (path.with_name(f"{path.stem}_{number}{path.suffix}") for number in count(2))
    with ExitStack() as held:
        for candidate in chain([path], others if numbered else ()):
            try:
                log = held.enter_context(StreamedLog(candidate))
            except LogBusyError:
                if not numbered:
                    raise
                continue
            replaces = _scenario_in(candidate) not in (None, scenario)
            if not (numbered and replaces):
                yield HeldLog(log, replaces)
                return
            held.pop_all().close()


def _scenario_in(path: Path) -> str | None:
    """Scenario of the log that is at ``path``, finished or not; None if there is none, empty if unknown."""
    from continuum_dyn.record.log_format import UNFINISHED
    from continuum_dyn.record.opened import Opened
    from continuum_dyn.record.reading import open_log

    for kept in (path, path.with_name(path.name + UNFINISHED)):
        if kept.exists():
            try:
                with open_log(kept) as file:
                    return str(Opened(file).attribute("scenario"))
            except LogError:
                return ""
    return None
