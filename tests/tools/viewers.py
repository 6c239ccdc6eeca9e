"""Rerun's viewer without a window, and Chromium without one, driven by tests."""

import base64
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
import pytest
from rerun.experimental import ViewerClient

from continuum_dyn.views.playback.viewer import LOOPBACK, VIEWER, free_ports

VULKAN_DRIVERS = Path("/usr/share/vulkan/icd.d")
NO_NETWORK = "ERR_NAME_NOT_RESOLVED"
"""Rerun's page asks its makers' servers for news, which a computer without a network does not find."""
PATIENCE = 120.0
"""Longest wait for a viewer or a browser, s: two busy cores draw without graphics hardware."""

needs_vulkan = pytest.mark.skipif(
    not list(VULKAN_DRIVERS.glob("lvp*.json")), reason="needs the Debian package mesa-vulkan-drivers"
)
needs_chromium = pytest.mark.skipif(
    shutil.which("chromium") is None, reason="needs the Debian package chromium"
)


def settings(folder: Path) -> dict[str, str]:
    """An environment with its own settings folder: a first session, of which rerun reports nothing home."""
    names = ("XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME")
    return os.environ | {name: str(folder) for name in names}


def until(found: Any, what: str) -> Any:
    """What a function returns once that is not false. Fails where it never is."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        with suppress(ConnectionError, RuntimeError, OSError):
            value = found()
            if value:
                return value
        time.sleep(0.2)
    pytest.fail(f"no {what} within {PATIENCE:g} s")


@contextmanager
def ended_after(process: subprocess.Popen[Any]) -> Iterator[None]:
    """The process and what it started are gone after the block."""
    try:
        yield
    finally:
        with suppress(psutil.NoSuchProcess):
            for each in psutil.Process(process.pid).children(recursive=True):
                with suppress(psutil.NoSuchProcess):
                    each.kill()
        process.kill()
        process.communicate()


@contextmanager
def headless_viewer(recording: Path, folder: Path) -> Iterator[ViewerClient]:
    """The viewer with a recording loaded, and no window."""
    (port,) = free_ports(1)
    command = [*VIEWER, "--port", str(port), "--headless", "--window-size", "1600x1000", str(recording)]
    quiet = subprocess.DEVNULL
    process = subprocess.Popen(command, env=settings(folder), stdout=quiet, stderr=quiet)
    with ended_after(process):

        def loaded() -> ViewerClient | None:
            client = ViewerClient.connect(f"rerun+http://{LOOPBACK}:{port}/proxy")
            state = client.get_state()
            ready = not state.loading and state.views and state.recordings[0].timelines
            return client if ready else None

        yield until(loaded, "answer of the viewer")


@contextmanager
def web_playback(log: Path, folder: Path) -> Iterator[tuple[str, set[str]]]:
    """``play --web`` of a log, ended as by Ctrl-C: the address that it prints, and those it listens on."""
    program = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler);"
        "from continuum_dyn.cli import main; main()"
    )
    command = [sys.executable, "-c", program, "play", "--web", str(log)]
    process = subprocess.Popen(command, env=settings(folder), stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    with ended_after(process):
        address = process.stdout.readline().strip()
        servers = psutil.Process(process.pid).children(recursive=True)
        listening = [c for server in servers for c in server.net_connections() if c.status == "LISTEN"]
        yield address, {connection.laddr.ip for connection in listening}
        process.send_signal(signal.SIGINT)
        assert process.wait(timeout=PATIENCE) == 130


class Chromium:
    """Debian's Chromium on one page, spoken to through pipes by its DevTools protocol."""

    def __init__(self, folder: Path) -> None:
        to_browser, from_browser = os.pipe(), os.pipe()
        shell = f'exec chromium "$@" 3<&{to_browser[0]} 4>&{from_browser[1]}'
        options = [
            *("--headless=new", "--no-sandbox", "--no-first-run", "--remote-debugging-pipe"),
            *("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--window-size=1600,1000"),
            f"--user-data-dir={folder / 'chromium'}",
        ]
        inherited = (to_browser[0], from_browser[1])
        self.process = subprocess.Popen(
            ["bash", "-c", shell, "bash", *options],
            pass_fds=inherited,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for each in inherited:
            os.close(each)
        self.write, self.read = os.fdopen(to_browser[1], "wb", 0), os.fdopen(from_browser[0], "rb", 0)
        self.waiting = b""
        self.number = 0
        self.session: str | None = None
        self.complaints: list[str] = []

    def open(self, address: str) -> None:
        """Go there."""
        target = self.ask("Target.createTarget", url="about:blank")["targetId"]
        self.session = self.ask("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Log", "Runtime"):
            self.ask(f"{domain}.enable")
        self.ask("Page.navigate", url=address)

    def close(self) -> None:
        """Say no more to it, which ends it."""
        self.write.close()
        self.read.close()

    def picture(self) -> bytes:
        """What the page looks like, PNG."""
        return base64.b64decode(self.ask("Page.captureScreenshot")["data"])

    def ask(self, method: str, **parameters: Any) -> dict[str, Any]:
        """The answer to a command, or ``RuntimeError``; what the page complains of meanwhile is noted."""
        self.number += 1
        message: dict[str, Any] = {"id": self.number, "method": method, "params": parameters}
        if self.session is not None:
            message["sessionId"] = self.session
        self.write.write(json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self.number:
                if "error" in answer:
                    raise RuntimeError(answer["error"]["message"])
                return answer["result"]
            self._note(answer)

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self.waiting:
            more = self.read.read(65536)
            assert more, "Chromium has ended"
            self.waiting += more
        message, _, self.waiting = self.waiting.partition(b"\0")
        return json.loads(message)

    def _note(self, event: dict[str, Any]) -> None:
        parameters = event.get("params", {})
        if event.get("method") == "Runtime.exceptionThrown":
            self.complaints.append(json.dumps(parameters["exceptionDetails"])[:500])
        if event.get("method") == "Log.entryAdded" and parameters["entry"]["level"] == "error":
            text = parameters["entry"]["text"]
            if NO_NETWORK not in text:
                self.complaints.append(text)
