"""Text of a scenario without what later versions may know otherwise: materials and damping ratios."""

from typing import Any

from continuum_dyn.effects import MaterialDamping
from continuum_dyn.scenario_files.arm_numbers import replace_materials
from continuum_dyn.scenario_files.toml_text import read_toml, toml_text
from statics.scene import Scene

LOOKED_UP = ("core_material", "disk_material")


def self_contained(text: str, scene: Scene) -> str:
    """The text with the numbers that materials and a damping ratio lead to, or as it is without these.

    What it said before stands above it, in comments.
    """
    content = read_toml(text)
    arm, damping = content["arm"], content["effects"].get("material_damping", {})
    described: dict[str, Any] = {}
    if any(name in arm for name in LOOKED_UP):
        described["arm"] = arm
        content["arm"] = replace_materials(arm)
    if "damping_ratio" in damping:
        described["effects"] = {"material_damping": damping}
        known = next(effect for effect in scene.effects if isinstance(effect, MaterialDamping))
        content["effects"] |= {"material_damping": {"retardation_time": known.retardation_time}}
    if not described:
        return text
    comments = "".join(f"# {line}\n" for line in toml_text(described).splitlines() if line)
    return f"# Written with the numbers that followed from\n{comments}\n{toml_text(content)}"
