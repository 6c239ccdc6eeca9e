"""The structure of a scene: all that its equations are derived from, and so the key of its kernels.

Numbers are no part of it: a changed stiffness never causes a new derivation, a changed equation always does.
"""

import hashlib
import inspect
import sys
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from pathlib import Path
from typing import Any

from statics.arm import CableKind
from statics.effects.effect import Effect
from statics.errors import InputError


@dataclass(frozen=True)
class Structure:
    """Everything that changes the equations of a scene; the only input of the derivation.

    ``effects`` are the classes of the scene's effects; ``coordinates`` and ``inputs`` the names of a
    segment's coordinates and of the numbers that drive the scene; ``payloads`` the largest number of them on
    one disk; ``core_fractions`` where along a segment the core's own mass stands, none without such mass.
    """

    effects: tuple[type[Effect], ...]
    coordinates: tuple[str, ...]
    inputs: tuple[str, ...]
    cable_kinds: tuple[CableKind, ...] = ()
    holes_differ: bool = False
    has_subsegments: bool = False
    payloads: int = 0
    followers_among_driven: tuple[bool, ...] = ()
    has_followers: bool = False
    core_fractions: tuple[float, ...] = ()
    base_moves: bool = False

    @property
    def forms(self) -> list[Effect]:
        """The effects without their numbers: they refuse to read a field, by an ``InputError``."""
        return [form_of(effect) for effect in self.effects]

    @property
    def names(self) -> list[str]:
        """Names of the effects."""
        return [effect.name for effect in self.effects]

    @property
    def has_follower_loads(self) -> bool:
        """Whether some load turns with its disk."""
        return self.has_followers or any(self.followers_among_driven)

    def has(self, name: str) -> bool:
        """Whether the scene has the effect of that name."""
        return name in self.names

    @property
    def text(self) -> str:
        """The structure in full, for a hash: an effect by its name and by a hash of its source."""
        own = {field.name: getattr(self, field.name) for field in fields(self)}
        own["effects"] = [
            (effect.name, effect.__qualname__, source_digest(effect)) for effect in self.effects
        ]
        return repr(own)


@cache
def form_of(effect: type[Effect]) -> Effect:
    """An effect of that class without numbers, of which only ``pairs`` is called.

    A field that ``pairs`` reads would become a number in a kernel that is kept for every number.
    """
    as_dataclass: Any = effect
    names = {field.name for field in fields(as_dataclass)} if is_dataclass(effect) else set[str]()

    def refuse(self: Any, name: str) -> Any:
        if name in names:
            raise InputError(
                f"effect '{effect.name}' reads its field '{name}' in pairs(), where numbers are not known. "
                f"Return it from columns(), and write at.{name} in pairs()."
            )
        return object.__getattribute__(self, name)

    form: Any = type(effect.__name__, (effect,), {"__getattribute__": refuse})
    return object.__new__(form)


def source_digest(effect: type[Effect]) -> str:
    """Hash of the file of an effect's class, or of the class itself if it was typed into a session."""
    file = getattr(sys.modules[effect.__module__], "__file__", None)
    if file is None:
        return hashlib.sha256(inspect.getsource(effect).encode()).hexdigest()
    return file_digest(Path(file), Path(file).stat().st_mtime_ns)


@cache
def file_digest(file: Path, _changed: int) -> str:
    """Hash of a file's content, read once as long as it does not change."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
