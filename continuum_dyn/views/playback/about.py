"""What is said of a run beside the pictures: its results, how to read what is drawn, and its scenario."""

import numpy as np

from continuum_dyn.record import Log
from continuum_dyn.views.playback.loads import acting_loads
from continuum_dyn.views.playback.story import Story

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


def about(story: Story) -> str:
    """Markdown."""
    parts = [f"# {story.name or story.log.title}", ending(story.log), _results(story), _reading(story)]
    if story.log.scenario:
        parts.append(f"## Scenario\n\n```toml\n{story.log.scenario.strip()}\n```")
    return "\n\n".join(parts) + "\n"


def _results(story: Story) -> str:
    """A table of what the run came to."""
    columns = story.columns
    x, y, theta = (float(columns[f"disk_{name}"][-1, -1]) for name in ("x", "y", "theta"))
    rows = {"tip at the end": f"x {1e3 * x:.4f} mm, y {1e3 * y:.4f} mm, theta {theta:.5f} rad"}
    for name, (words, unit) in ATTRIBUTES.items():
        if name in story.log.attributes:
            value = story.log.attributes[name]
            rows[words] = f"{value:.3g} {unit}".strip() if isinstance(value, float) else str(value)
    if "input_work" in columns:
        rows["power ledger"] = f"closes to {_ledger_gap(story):.2g} J"
    table = "\n".join(f"| {name} | {value} |" for name, value in rows.items())
    return f"| result | |\n|---|---|\n{table}"


def _ledger_gap(story: Story) -> float:
    """Largest energy (J) that the ledger does not account for."""
    columns = story.columns
    stored = columns["kinetic_energy"] + columns["elastic_energy"] + columns["gravity_energy"]
    return float(np.abs(stored - stored[0] - columns["input_work"] + columns["dissipated_energy"]).max())


def _reading(story: Story) -> str:
    """What the lines are."""
    said = ["**Core:** coloured by its curvature, on the scale below the arm."]
    if story.log.cables:
        said.append("**Cables:** as wide as their tension at the base; dashed while slack.")
    if story.moves:
        said.append("**Light grey:** the static equilibrium of the moment's inputs, if the log has it.")
    said.append("**Thin line at the tip:** its way.")
    if acting_loads(story, story.samples[:1]):
        said.append("**Arrows:** loads on disks.")
    if story.scenario is None:
        said.append("The log carries no scenario that could be read: loads are not drawn.")
    return "\n\n".join(said)
