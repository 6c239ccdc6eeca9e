"""Mistakes that show when a scenario is built, in each of its parts: the arm, each cable, each load.

A part is built on the sound parts that it depends on, and left out if one of these has a mistake itself.
"""

import json
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

from continuum_dyn.scenario.scenario import check_pull
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario_files.arm_numbers import arm_numbers
from continuum_dyn.scenario_files.building import (
    build,
    build_arm,
    build_base_motion,
    build_cable,
    build_drive,
    build_factor,
    build_load,
    check_damping,
    given_drive,
)
from continuum_dyn.scenario_files.csv_table import Tables
from continuum_dyn.scenario_files.mistakes.messages import Mistake
from continuum_dyn.scenario_files.tables import (
    CableTable,
    LoadTable,
    MaterialDampingTable,
    ScenarioFile,
    SoundTables,
)
from statics.arm import Arm, Cable, Payload
from statics.effects import DiskLoads
from statics.errors import InputError
from statics.scene import Scene


def mistakes_of_parts(
    content: dict[str, Any], known: Iterable[Mistake], text: str, tables: Tables
) -> list[Mistake]:
    """Mistakes in the parts of a file that are free of the ``known`` ones; ``text`` is the file's."""
    places = {mistake.place[:2] for mistake in known}
    file = SoundTables.model_validate_json(json.dumps(_sound(content, places), default=str))
    return _Parts(file, tables, {place[0] for place in places}).mistakes(text)


def _sound(content: dict[str, Any], places: set[tuple[str, ...]]) -> dict[str, Any]:
    """The content without the tables, effects and members of lists that have mistakes at these places."""
    found: dict[str, Any] = {}
    for name, table in content.items():
        if (name,) in places:
            continue
        if isinstance(table, list):
            found[name] = [None if (name, str(n)) in places else each for n, each in enumerate(table)]
        elif name == "effects":
            found[name] = {key: value for key, value in table.items() if (name, key) not in places}
        elif all(place[0] != name for place in places):
            found[name] = table
    return found


class _Parts:
    """The parts of a file that can be built, and the mistakes in the others; ``wrong`` names their tables."""

    def __init__(self, file: SoundTables, tables: Tables, wrong: set[str]) -> None:
        self.file, self.tables, self.wrong = file, tables, wrong
        self.found: list[Mistake] = []
        self.cables: list[CableTable] = []
        self.on_arm: list[Cable] = []
        self.loads: list[LoadTable] = []
        self.payloads: list[Payload] = []
        self.is_ramp = None if file.study is None else file.study.takes_lists

    def mistakes(self, text: str) -> list[Mistake]:
        """All of them; ``text`` is the file's."""
        arm = self._arm()
        if self.file.base is not None:
            self._attempt("base", build_base_motion, self.file.base, self.tables)
        for number, cable in enumerate(self.file.cables):
            if cable is not None and self._cable(number, cable, arm):
                self.cables.append(cable.model_copy(update={"name": cable.name or f"cable_{number + 1}"}))
        if arm is not None:
            self._attempt("cables", lambda: replace(arm, cables=tuple(self.on_arm)))
        for number, load in enumerate(self.file.loads):
            if load is not None and self._load(number, load, arm):
                self.loads.append(load)
        for number, payload in enumerate(self.file.payloads):
            if payload is not None and arm is not None and self._payload(number, payload, arm):
                self.payloads.append(payload)
        self._effects(arm)
        if not self.wrong & {"arm", "base", "effects", "payloads", "study"}:
            self._together(text)
        return self.found

    def _attempt(self, place: str, make: Callable[..., Any], *arguments: Any, number: int = 0) -> Any:
        """A part, or None after adding its mistake; ``number`` is its place in a list, from 0 on."""
        try:
            return make(*arguments)
        except InputError as error:
            self.found.append(Mistake((place, str(number)), str(error), ":"))
            self.wrong.add(place)
            return None

    def _arm(self) -> Arm | None:
        """The arm without cables and payloads."""
        table = self.file.arm
        numbers = None if table is None else self._attempt("arm", arm_numbers, table)
        return None if numbers is None else self._attempt("arm", build_arm, table, numbers)

    def _cable(self, number: int, table: CableTable, arm: Arm | None) -> bool:
        """Whether a cable is without mistakes in its drive and on the arm."""
        before, cable = len(self.found), build_cable(table, number + 1)

        def check_drive() -> None:
            given_drive(table)
            if self.is_ramp is not None:
                check_pull(cable, build_drive(table, self.tables, self.is_ramp))

        self._attempt("cables", check_drive, number=number)
        if arm is not None and self._attempt("cables", lambda: replace(arm, cables=(cable,)), number=number):
            self.on_arm.append(cable)
        return len(self.found) == before

    def _load(self, number: int, table: LoadTable, arm: Arm | None) -> bool:
        """Whether a load is without mistakes in its factor and on the arm."""
        before = len(self.found)
        if table.factor is not None and self.is_ramp is not None:
            self._attempt("loads", build_factor, table, self.tables, self.is_ramp, number=number)
        if arm is not None:
            self._attempt("loads", DiskLoads((build_load(table),)).columns, arm, number=number)
        return len(self.found) == before

    def _payload(self, number: int, payload: Payload, arm: Arm) -> bool:
        """Whether a payload is on the arm."""
        return bool(self._attempt("payloads", lambda: replace(arm, payloads=(payload,)), number=number))

    def _effects(self, arm: Arm | None) -> None:
        """Check each effect on the arm with its payloads, if these are sound."""
        loaded = None
        if arm is not None and "payloads" not in self.wrong:
            loaded = replace(arm, payloads=tuple(self.payloads))
        for _, effect in self.file.effects or ():
            if isinstance(effect, MaterialDampingTable):
                self._attempt("effects", check_damping, effect)
            elif effect is not None and loaded is not None:
                self._attempt("effects", Scene, loaded, (effect,))

    def _together(self, text: str) -> None:
        """Check the scene of all sound parts with its study alone, with each setting, and with all."""
        parts = {"cables": self.cables, "loads": self.loads, "payloads": self.payloads}
        whole = ScenarioFile.model_construct(**dict(self.file) | parts)
        given_mesh = whole.arm.model_copy(update={"subsegments": None})
        alone = whole.model_copy(update={"arm": given_mesh, "accuracy": None, "solver": Solver()})
        scenarios = [("study", alone)]
        if "accuracy" not in self.wrong:
            accurate = {"arm": whole.arm, "accuracy": whole.accuracy}
            scenarios.append(("accuracy", alone.model_copy(update=accurate)))
        if "solver" not in self.wrong:
            scenarios.append(("solver", alone.model_copy(update={"solver": whole.solver})))
        if not self.wrong & {"accuracy", "solver"}:
            scenarios.append(("solver", whole))
        for place, scenario in scenarios:
            self._attempt(place, build, scenario, "", text, self.tables)
