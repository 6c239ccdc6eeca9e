"""Scenarios that come with the program."""

from functools import cache
from pathlib import Path

from continuum_dyn.scenario_files.text import read_text
from continuum_dyn.scenario_files.toml_text import read_toml
from statics.errors import InputError, did_you_mean

FIRST = "first"
_PACKAGE = Path(__file__).parents[1]

SHORT_NAMES = {
    FIRST: "first_scenario",
    "step": "step_response",
    "ramp": "tension_ramp",
    "friction": "friction_ramp",
    "water": "step_response_in_water",
    "base": "shaken_base",
    "upright": "mounted_upright",
    "payload": "step_response_payload",
    "taper": "tapered_arm",
    "length": "length_driven",
    "follower": "follower_tip",
    "snap": "snap_through",
    "buckling": "self_weight_buckling",
    "core": "heavy_core",
    "accuracy": "step_response_within_1_um",
}
"""Short names of scenarios, beside those of their files."""


@cache
def shipped() -> dict[str, Path]:
    """Files of the scenarios by name: one short name or the file's own for each."""
    installed = _PACKAGE / "scenarios"
    folder = installed if installed.is_dir() else _PACKAGE.parent / "scenarios"  # of a checkout
    short = {file: name for name, file in SHORT_NAMES.items()}
    found = {short.get(file.stem, file.stem): file for file in folder.glob("*.toml")}
    return {FIRST: Path(__file__).with_name(f"{SHORT_NAMES[FIRST]}.toml")} | dict(sorted(found.items()))


def shipped_scenario(name: str) -> Path:
    """The file of the scenario with that name, short or its file's. Raises ``InputError`` for another."""
    known = shipped()
    by_file = {file.stem: file for file in known.values()}
    if name not in known and name not in by_file:
        raise InputError(f"no scenario is named '{name}'.{did_you_mean(name, known)}")
    return known.get(name) or by_file[name]


def title_of(file: Path) -> str:
    """The title that a scenario has in its file."""
    return read_toml(read_text(file))["title"]
