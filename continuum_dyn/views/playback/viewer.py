"""Rerun's viewer for recordings: in a window of its own, or in a browser on this computer."""

import os
import socket
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic, sleep
from urllib.parse import quote

from continuum_dyn.record import Log
from continuum_dyn.views.playback.recording import save
from statics.errors import LogError

LOOPBACK = "127.0.0.1"
VIEWER = (
    *(sys.executable, "-c", "import sys; from rerun_cli.__main__ import main; sys.exit(main())"),
    *("--bind", LOOPBACK),
)
"""The viewer of this Python environment, for this computer only. ``-m rerun_cli`` loses its exit status."""

QUIET = {"CI": "1", "TELEMETRY_ENABLED": "false"}
"""Environment in which rerun sends no statistics of its use: it has no other switch but one for good."""

INSTEAD = "To view it in a browser, add --web; to save a recording for another computer, add --save FILE.rrd"
"""Advice where no window can be opened."""
START_TIME = 20.0
"""Longest time for a server to answer, s."""


def environment() -> dict[str, str]:
    """Environment of rerun's viewer: this program's, in which it sends no statistics."""
    inherited = {name: value for name, value in os.environ.items() if name != "FORCE_RERUN_ANALYTICS"}
    return inherited | QUIET


def show(logs: Sequence[Log]) -> None:
    """Open logs in rerun's viewer, and return when its window is closed.

    Raises ``LogError`` if the viewer cannot run here.
    """
    with _save_temporarily(logs) as path:
        # On the default port, a viewer that already runs would take the file over.
        with _start(["--port", "auto", str(path)]) as viewer:
            _, words = viewer.communicate()
        if viewer.returncode:
            raise LogError(f"{_why_no_window(words, viewer.returncode)} {INSTEAD}")


def _why_no_window(words: str, status: int) -> str:
    if any(name in words for name in ("WAYLAND_DISPLAY", "DISPLAY", "EventLoop")):
        return "no display is available for the rerun viewer."
    return f"the rerun viewer cannot start: {_last_line(words, status).rstrip('.')}."


def serve(logs: Sequence[Log], tell: Callable[[str], None]) -> None:
    """Serve logs to browsers on this computer until Ctrl-C; ``tell`` receives the address to open.

    Raises ``LogError`` if the server cannot run here.
    """
    data, page = free_ports(2)
    with _save_temporarily(logs) as path:
        ports = ["--port", str(data), "--web-viewer-port", str(page)]
        with _start(["--serve-web", *ports, str(path)]) as server:
            _wait_for(page, server)
            tell(address(data, page))
            try:
                _, words = server.communicate()
            except KeyboardInterrupt:
                return
        if server.returncode:
            raise LogError(f"the rerun server ended: {_last_line(words, server.returncode)}")


def address(data: int, page: int) -> str:
    """The address of the viewer on port ``page`` with the recording served on port ``data``."""
    source = quote(f"rerun+http://{LOOPBACK}:{data}/proxy", safe="")
    return f"http://{LOOPBACK}:{page}/?url={source}&theme=light"


def free_ports(count: int) -> list[int]:
    """``count`` ports that nothing listens on."""
    sockets = [socket.create_server((LOOPBACK, 0)) for _ in range(count)]
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


@contextmanager
def _save_temporarily(logs: Sequence[Log]) -> Iterator[Path]:
    """Save a recording of the logs while it is shown."""
    with TemporaryDirectory(prefix="continuum-dyn-", ignore_cleanup_errors=True) as folder:
        path = Path(folder) / f"{logs[0].path.stem}.rrd"
        save(logs, path)
        yield path


@contextmanager
def _start(arguments: Sequence[str]) -> Iterator[subprocess.Popen[str]]:
    """Start the viewer; it and its own processes end with the block at the latest."""
    import psutil

    try:
        viewer = subprocess.Popen([*VIEWER, *arguments], stderr=subprocess.PIPE, text=True, env=environment())
    except OSError as error:
        raise LogError(f"cannot start the rerun viewer: {error}.") from error
    try:
        yield viewer
    finally:
        with suppress(psutil.NoSuchProcess):
            for process in (*psutil.Process(viewer.pid).children(recursive=True), viewer):
                with suppress(psutil.NoSuchProcess):
                    process.terminate()
        viewer.wait()


def _wait_for(port: int, server: subprocess.Popen[str]) -> None:
    """Wait until a server answers on the port. Raises ``LogError`` if none does."""
    until = monotonic() + START_TIME
    while server.poll() is None and monotonic() < until:
        with suppress(OSError), socket.create_connection((LOOPBACK, port), timeout=1.0):
            return
        sleep(0.05)
    if server.poll() is None:
        raise LogError(f"the rerun server did not answer within {START_TIME:g} s.")


def _last_line(words: str, status: int) -> str:
    return (words.strip().splitlines() or [f"exit status {status}"])[-1]
