"""Random scenarios as users write them: any structure, any numbers, any study; small, so that runs are brief.

A scenario follows from a seed and its number alone; ``python tests/tools/random_structures.py SEED NUMBER``
prints one. As many as ``ALIKE`` in a row share their structure, whose kernels take seconds to compile.
"""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import pi
from random import Random
from typing import Any, NamedTuple

from scenario_mutants import Tables, written

ALIKE = 20
"""Number of scenarios of one structure."""
STIFF, EXPLICIT = ("Radau", "BDF", "LSODA"), ("RK23", "RK45", "DOP853")
METALS, PLASTICS = ("steel", "stainless_steel", "nitinol"), ("peek", "pla", "pa12")
BUDGET = {"max_steps": 4000, "max_seconds": 2.0}


class RandomScenario(NamedTuple):
    """The text of a scenario and the CSV files beside it, by name."""

    text: str
    tables: Mapping[str, str]


@dataclass(frozen=True)
class CableTraits:
    """Everything about a cable that changes the equations."""

    driven_by_length: bool
    rubs: bool
    holes_differ: bool


@dataclass(frozen=True)
class LoadTraits:
    """Everything about a load that changes the equations."""

    driven: bool
    follower: bool


@dataclass(frozen=True)
class Traits:
    """Everything about a scenario that changes the equations; ``base`` is "", "fixed" or "moves"."""

    effects: tuple[str, ...]
    cables: tuple[CableTraits, ...]
    loads: tuple[LoadTraits, ...]
    payloads: int
    has_subsegments: bool
    core_has_mass: bool
    base: str

    @property
    def moves(self) -> bool:
        """Whether there can be a motion."""
        return "inertia" in self.effects

    @property
    def rubs(self) -> bool:
        """Whether some cable rubs."""
        return any(cable.rubs for cable in self.cables)

    @property
    def has_potential(self) -> bool:
        """Whether no load turns with its disk."""
        return not any(load.follower for load in self.loads)

    @property
    def is_damped(self) -> bool:
        """Whether something takes energy from the motion."""
        return self.rubs or any(name.endswith(("damping", "drag")) for name in self.effects)


def scenario(seed: int, number: int) -> RandomScenario:
    """The scenario of that number."""
    structure, numbers = Random(f"{seed} structure {number // ALIKE}"), Random(f"{seed} {number}")
    draw = _Draw(numbers, _traits(structure))
    return RandomScenario(written(draw.content(f"Random {seed} {number}")), draw.tables)


def _traits(rng: Random) -> Traits:
    moves = rng.random() < 0.8
    often = {"extension": 0.6, "gravity": 0.7}
    if moves:
        dampings = {"material_damping": 0.8, "mass_damping": 0.2, "linear_drag": 0.2, "quadratic_drag": 0.2}
        often |= {"inertia": 1.0, "rotary_inertia": 0.7} | (dampings if rng.random() < 0.85 else {})
    effects = ("bending", *(name for name, part in often.items() if rng.random() < part))
    base = rng.choices(("", "fixed", "moves" if moves else "fixed"), (6, 2, 2))[0]
    by_length, rubbing = rng.choice((0.0, 0.0, 0.5, 1.0)), rng.choice((0.0, 0.0, 0.0, 0.6))
    cables = tuple(
        CableTraits(rng.random() < by_length, rng.random() < rubbing, rng.random() < 0.2)
        for _ in range(rng.choices(range(5), (1, 3, 3, 2, 1))[0])
    )
    followers = rng.choice((0.0, 0.0, 0.5))
    loads = tuple(
        LoadTraits(rng.random() < 0.4, rng.random() < followers)
        for _ in range(rng.choices(range(3), (5, 3, 1))[0])
    )
    has_subsegments = rng.random() < 0.3
    moves_massless_nodes = base != "moves" and "material_damping" in effects
    needs_mass = moves and has_subsegments and not moves_massless_nodes
    return Traits(
        effects,
        cables,
        loads,
        payloads=rng.choices(range(3), (6, 3, 1))[0],
        has_subsegments=has_subsegments,
        core_has_mass=needs_mass or rng.random() < 0.3,
        base=base,
    )


class _Draw:
    """Draws the numbers of one scenario of given traits; keeps the tables of its profiles."""

    def __init__(self, rng: Random, traits: Traits) -> None:
        self.rng, self.traits = rng, traits
        self.tables: dict[str, str] = {}
        self.disks = rng.randint(1, 5)
        self.kind = rng.choice(("motion", "step_response")) if traits.moves else ""
        if traits.base != "moves" and (not traits.moves or rng.random() < 0.25):
            self.kind = rng.choice(("equilibrium", "ramp"))
        self.duration = self.near(0.1, 3.0)
        self.points = rng.randint(1, 9)

    @property
    def moves(self) -> bool:
        """Whether its study is one of motion."""
        return self.kind in ("motion", "step_response")

    # ---- numbers ----

    def chance(self, part: float) -> bool:
        return self.rng.random() < part

    def near(self, value: float, most: float = 2.0) -> float:
        """A number within a factor of ``most``."""
        return float(f"{value * most ** self.rng.uniform(-1.0, 1.0):.4g}")

    def within(self, limit: float) -> float:
        """A number of either sign, at times zero."""
        return 0.0 if self.chance(0.1) else float(f"{self.rng.uniform(-limit, limit):.4g}")

    def each(self, draw: Callable[[], float]) -> float | list[float]:
        """One number, or a list of one for each disk."""
        return [draw() for _ in range(self.disks)] if self.chance(0.25) else draw()

    # ---- the tables of the file ----

    def content(self, title: str) -> Tables:
        traits = self.traits
        found = {"title": title, "arm": self.arm(), "effects": {n: self.effect(n) for n in traits.effects}}
        found["cables"] = [self.cable(number, cable) for number, cable in enumerate(traits.cables, start=1)]
        found["loads"] = [self.load(number, load) for number, load in enumerate(traits.loads, start=1)]
        found["payloads"] = self.payloads()
        if traits.base:
            found["base"] = self.base()
        found["study"] = self.study()
        found["solver"] = self.solver()
        chosen = self.moves and found["solver"]["method"] != "midpoint" and "rtol" not in found["solver"]
        if chosen and self.chance(0.07):
            found["accuracy"] = {"tip": self.near(3e-5, 5.0)}
        return found

    def arm(self) -> Tables:
        found = {"disks": self.disks} | self.spacing()
        has_preset = self.chance(0.4)
        if has_preset:
            found["preset"] = "rone2012"
        else:
            found |= self.core()
        found |= self.round_disks() if self.chance(0.15) else self.plain_disks(has_preset)
        if self.chance(0.2):
            found["reference_curvature"] = self.each(lambda: self.within(8.0))
        if self.traits.has_subsegments:
            found["subsegments"] = self.rng.randint(2, 3)
        if self.traits.core_has_mass and "core_material" not in found:
            found["core_density"] = self.near(7.8e3)
        return found

    def spacing(self) -> Tables:
        if self.chance(0.15):
            return {"length": self.near(0.02 * self.disks, 1.5)}
        return {"disk_spacing": self.each(lambda: self.near(0.02, 1.5))}

    def core(self) -> Tables:
        """A rod or, rarely, a tube; a material only where the core has mass, because it sets that too."""
        found: Tables = {}
        if self.traits.core_has_mass and self.chance(0.3):
            found["core_material"] = self.rng.choice(METALS)
        else:
            found["youngs_modulus"] = self.each(lambda: self.near(2.1e11))
        if self.chance(0.15):
            found["core_outer_radius"] = self.each(lambda: self.near(6e-4, 1.3))
            found["core_inner_radius"] = self.each(lambda: self.near(3e-4, 1.3))
        else:
            found["core_radius"] = self.each(lambda: self.near(4e-4, 1.5))
        return found

    def plain_disks(self, has_preset: bool) -> Tables:
        found: Tables = {} if has_preset else {"disk_inertia": self.each(lambda: self.near(2e-8, 3.0))}
        return found | {"disk_mass": self.each(lambda: self.near(7.8e-4, 3.0))}

    def round_disks(self) -> Tables:
        """Disks, or rings, by their measures and what they weigh."""
        found: Tables = {"disk_radius": self.each(lambda: self.near(9.5e-3, 1.5))}
        found["disk_thickness"] = self.each(lambda: self.near(3e-3, 1.5))
        if self.chance(0.3):
            found["disk_inner_radius"] = self.near(1e-3, 3.0)
        weights: dict[str, Callable[[], Any]] = {
            "disk_material": lambda: self.rng.choice(PLASTICS),
            "disk_density": lambda: self.each(lambda: self.near(1.2e3, 1.5)),
            "disk_mass": lambda: self.each(lambda: self.near(7.8e-4, 3.0)),
        }
        name = self.rng.choice(list(weights))
        return found | {name: weights[name]()}

    def effect(self, name: str) -> Tables:
        drawn: dict[str, Callable[[], Tables]] = {
            "gravity": lambda: {"acceleration": [self.within(15.0), self.within(15.0)]},
            "material_damping": self.material_damping,
            "mass_damping": lambda: {"mass_damping_rate": self.near(3.0, 5.0)},
            "linear_drag": lambda: {"drag_per_speed": self.near(0.01, 5.0)},
            "quadratic_drag": lambda: {"drag_per_speed_squared": self.near(0.1, 5.0)},
        }
        return drawn.get(name, dict)()

    def material_damping(self) -> Tables:
        if self.chance(0.15):
            return {"damping_ratio": self.near(0.1, 5.0)}
        return {"retardation_time": self.near(1e-3, 5.0)}

    def cable(self, number: int, traits: CableTraits) -> Tables:
        sign = self.rng.choice((1, -1))
        found: Tables = {"name": f"cable {number}", "hole_offset": sign * self.near(0.007, 1.5)}
        last = self.disks
        if self.chance(0.3):
            last = found["anchor"] = self.rng.randint(1, self.disks)
        if last > 1 and self.chance(0.15):
            found["start"] = self.rng.randint(1, last - 1)
        if traits.holes_differ:
            found["hole_offset"] = [sign * self.near(0.007, 1.5) for _ in range(last + 1)]
        if traits.driven_by_length:
            found["cable_stiffness"] = self.near(1000.0, 5.0)
            found["cable_displacement"] = self.drive(f"{number}", "cable_displacement", -1e-3, 2e-3)
        else:
            found["tension"] = self.drive(f"{number}", "tension", 0.0, 3.0)
        if traits.rubs:
            found["friction"] = self.near(0.1, 5.0)
            if self.chance(0.5):
                found["slip_speed"] = self.near(1e-3, 10.0)
        return found

    def load(self, number: int, traits: LoadTraits) -> Tables:
        force, moment = [self.within(0.2), self.within(0.2)], self.within(0.005)
        found: Tables = {"disk": self.rng.randint(1, self.disks), "force": force, "moment": moment}
        found["follower"] = traits.follower
        if traits.driven:
            found["factor"] = self.drive(f"load_{number}", "factor", -1.0, 1.5)
        return found

    def payloads(self) -> list[Tables]:
        disk = self.rng.randint(1, self.disks)
        return [
            {
                "disk": disk,
                "mass": self.near(2e-3),
                "inertia": self.near(1e-6),
                "offset": [self.within(0.01), self.within(0.01)],
            }
            for _ in range(self.traits.payloads)
        ]

    def base(self) -> Tables:
        limits = {"x": 0.02, "y": 0.02, "angle": 0.5}
        found: Tables = {name: self.within(limit) for name, limit in limits.items()}
        if self.traits.base == "moves":
            for name in self.rng.sample(list(limits), self.rng.randint(1, 3)):
                profile = self.rng.choice((self.sine, self.smooth_ramp))
                found[name] = profile(-limits[name], limits[name])
                found[name] |= {"phase": pi / 2} if profile == self.sine else {}  # starts from rest
        return found

    # ---- what drives it ----

    def drive(self, table: str, quantity: str, low: float, high: float) -> Any:
        """A number, a list for a ramp, or a profile, between these values."""
        if self.kind == "equilibrium" or self.chance(0.2):
            return self.between(low, high)
        if self.kind == "ramp":
            values = [self.between(low, high) for _ in range(self.points)]
            return sorted(values) if self.chance(0.5) else values
        drawn = self.rng.choice((self.step, self.ramp, self.smooth_ramp, self.sine, None))
        return self.table(table, quantity, low, high) if drawn is None else drawn(low, high)

    def between(self, low: float, high: float) -> float:
        return float(f"{self.rng.uniform(low, high):.4g}")

    def times(self) -> tuple[float, float]:
        first, last = sorted(self.rng.uniform(0.0, 1.2) for _ in range(2))
        start = 0.0 if self.chance(0.3) else float(f"{first * self.duration:.4g}")
        return start, float(f"{start + (last - first + 0.05) * self.duration:.4g}")

    def step(self, low: float, high: float) -> Tables:
        before, after = self.between(low, high), self.between(low, high)
        return {"profile": "step", "before": before, "after": after, "at": self.times()[0]}

    def ramp(self, low: float, high: float) -> Tables:
        start, end = self.times()
        before, after = self.between(low, high), self.between(low, high)
        return {"profile": "ramp", "before": before, "after": after, "start": start, "end": end}

    def smooth_ramp(self, low: float, high: float) -> Tables:
        return self.ramp(low, high) | {"profile": "smooth_ramp"}

    def sine(self, low: float, high: float) -> Tables:
        mean, room = (low + high) / 2, 0.99 * (high - low) / 2
        found = {
            "profile": "sine",
            "mean": mean,
            "amplitude": self.within(room),
            "frequency": self.near(8.0, 4.0),
        }
        return found | ({"phase": self.within(3.0)} if self.chance(0.3) else {})

    def table(self, name: str, quantity: str, low: float, high: float) -> Tables:
        rows, time = [f"time,{quantity}"], 0.0
        for _ in range(self.rng.randint(1, 6)):
            rows.append(f"{time:.6g},{self.between(low, high):.4g}")
            time += self.near(0.2 * self.duration, 3.0)
        self.tables[f"{name}.csv"] = "\n".join(rows)
        return {"profile": "table", "file": f"{name}.csv"}

    # ---- what is asked ----

    def study(self) -> Tables:
        found: Tables = {"kind": self.kind}
        if self.kind == "ramp":
            follows = self.traits.has_potential and not self.traits.rubs and self.chance(0.4)
            found["path"] = "arc_length" if follows else "stable"
        elif self.kind != "equilibrium":
            found |= {"duration": self.duration, "samples": self.rng.randint(2, 60)}
            found["static_path"] = self.chance(0.1)
        return found

    def solver(self) -> Tables:
        found: Tables = dict(BUDGET)
        if self.moves:
            known = ["auto", "auto", "chain"]
            if self.traits.core_has_mass or not self.traits.has_subsegments:
                known += ["auto", "explicit", self.rng.choice(STIFF + EXPLICIT)]
            if self.traits.has_potential and not self.traits.is_damped:
                known.append("midpoint")
            found["method"] = self.rng.choice(known)
            if found["method"] != "midpoint" and self.chance(0.4):
                rtol = self.near(1e-6, 30.0)
                found |= {"rtol": rtol, "atol": float(f"{1e-3 * rtol:.4g}")}
        return found


if __name__ == "__main__":
    drawn = scenario(int(sys.argv[1]), int(sys.argv[2]))
    print(drawn.text)
    for name, text in drawn.tables.items():
        print(f"# {name}\n{text}")
