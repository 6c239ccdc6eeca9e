"""The text beside a playback: the run's results, how to read the drawing, and its scenario."""

import re
from string import punctuation

import numpy as np

from continuum_dyn.record import Log
from continuum_dyn.views.playback.playback import Playback
from statics.support.plain_text import plain_line

ATTRIBUTES = {
    "static_gap": ("gap to the static equilibrium", "m"),
    "tip_error": ("tip error, estimated", "m"),
    "mesh_error": ("part of it due to the mesh", "m"),
    "method": ("solver", ""),
    "rtol": ("relative tolerance", ""),
    "step": ("step", "s"),
    "solve_time": ("time to solve", "s"),
}


def ending(log: Log) -> str:
    """Title, outcome and message of a run in a line."""
    return ": ".join(filter(None, (log.title, log.outcome.replace("_", " "), log.message)))


def about(playback: Playback) -> str:
    """The text in Markdown."""
    parts = [
        f"# {_escape(playback.name or playback.log.title)}",
        _escape(ending(playback.log)),
        _results(playback),
        _reading(playback),
    ]
    if playback.log.scenario:
        fence = _fence(playback.log.scenario)
        parts.append(f"## Scenario\n\n{fence}toml\n{playback.log.scenario.strip()}\n{fence}")
    return "\n\n".join(parts) + "\n"


def _escape(text: str) -> str:
    """The text in a line of Markdown that shows it as it is."""
    return re.sub(f"([{re.escape(punctuation)}])", r"\\\1", plain_line(text))


def _fence(text: str) -> str:
    """A fence longer than any in the text."""
    return "`" * max(3, 1 + max(map(len, re.findall("`+", text)), default=0))


def _results(playback: Playback) -> str:
    """A table of the run's results."""
    columns = playback.columns
    x, y, theta = (float(columns[f"disk_{name}"][-1, -1]) for name in ("x", "y", "theta"))
    rows = {"tip at the end": f"x {1e3 * x:.4f} mm, y {1e3 * y:.4f} mm, theta {theta:.5f} rad"}
    for name, (words, unit) in ATTRIBUTES.items():
        if name in playback.log.attributes:
            value = playback.log.attributes[name]
            rows[words] = f"{value:.3g} {unit}".strip() if isinstance(value, float) else _escape(str(value))
    if "input_work" in columns:
        rows["power ledger"] = f"closes to {_ledger_gap(playback):.2g} J"
    table = "\n".join(f"| {name} | {value} |" for name, value in rows.items())
    return f"| result | |\n|---|---|\n{table}"


def _ledger_gap(playback: Playback) -> float:
    """Largest energy (J) that the ledger does not account for."""
    columns = playback.columns
    stored = columns["kinetic_energy"] + columns["elastic_energy"] + columns["gravity_energy"]
    return float(np.abs(stored - stored[0] - columns["input_work"] + columns["dissipated_energy"]).max())


def _reading(playback: Playback) -> str:
    """The meaning of the lines."""
    said = ["**Core:** coloured by its curvature, on the scale below the arm."]
    if playback.log.cables:
        said.append("**Cables:** as wide as their tension at the base; dashed while slack.")
    if playback.moves:
        said.append("**Light grey:** the static equilibrium of the moment's inputs, if the log has it.")
    said.append("**Thin line at the tip:** its path.")
    if playback.loads(playback.samples[:1]):
        said.append("**Arrows:** loads on disks.")
    if playback.scenario is None:
        said.append("Loads are not drawn: the log has no readable scenario.")
    return "\n\n".join(said)
