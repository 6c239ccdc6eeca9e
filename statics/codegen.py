"""Generated kernels: written once for each structure of a scene, kept in the user's cache, loaded.

Structure is what changes the equations: the effects, the coordinates of a segment, the kinds of the cables,
the loads that change or that turn with their disk, whether there is a base and whether it moves, the most
payloads on one disk, whether a span has several segments, whether the holes of a cable differ, whether the
core has mass. Numbers are not, so a changed number never recompiles; a changed source file always does. A
warm start finds its kernel by a hash and imports neither sympy nor the derivation.
"""

import hashlib
import inspect
import platform
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any

from statics.effects import Effect
from statics.kernel_files import kernel_folder, read_sealed, write_sealed
from statics.scene import Scene
from statics.stages import stage

_HERE = Path(__file__).parent
DERIVATION = tuple(
    _HERE / f"{stem}.py"
    for stem in (
        "sigma",
        "segment",
        "trace",
        "virtual_work",
        "cable_tension",
        "reach",
        "recursion",
        "cable_steps",
        "compose",
        "codegen",
        "chain",
    )
)
"""The sources that every kernel is made from."""

_loaded: dict[Path, ModuleType] = {}


@dataclass(frozen=True)
class Recipe:
    """How a kind of kernel is made: ``write(scene)`` returns its text; ``sources`` are what it depends on."""

    kind: str
    write: Callable[[Scene], str]
    sources: tuple[Path, ...]


Loader = Callable[[Scene, Recipe], Any]
"""``load`` or ``load_interpreted``."""


def load(scene: Scene, recipe: Recipe) -> Any:
    """The compiled kernel module for the scene's structure.

    Raises ``KernelCacheError`` if the cache folder cannot be used safely.
    """
    path = _path(scene, recipe)
    if path not in _loaded:
        _loaded[path] = _module(path, _kept_text(scene, recipe, path))
    return _loaded[path]


def load_interpreted(scene: Scene, recipe: Recipe) -> Any:
    """The same functions as plain Python: for tests, for a debugger, and for what is asked only once."""
    text = _kept_text(scene, recipe, _path(scene, recipe))
    text = text.replace("from numba import njit\n", "njit = lambda **_: lambda function: function\n")
    module = ModuleType(f"interpreted_{recipe.kind}")
    exec(compile(text, module.__name__, "exec"), module.__dict__)
    return module


def _path(scene: Scene, recipe: Recipe) -> Path:
    return kernel_folder() / f"{recipe.kind}_{kernel_key(scene, recipe)}.py"


def kernel_key(scene: Scene, recipe: Recipe) -> str:
    """Hash of the scene's structure, of the sources behind it, and of the versions that shape the code."""
    effects = [effect.name for effect in scene.effects]
    forms = (scene.cable_kinds, scene.inputs, scene.payloads)
    forms += (scene.spans, scene.holes_differ, scene.core_has_mass)
    loads = (scene.followers_among_driven, scene.has_followers)
    structure = (recipe.kind, scene.coordinates, forms, loads, effects)
    sources = [_digest(file, file.stat().st_mtime_ns) for file in recipe.sources]
    sources += [_effect_digest(effect) for effect in scene.effects]
    return hashlib.sha256(repr((structure, _versions(), sources)).encode()).hexdigest()[:24]


def _effect_digest(effect: Effect) -> str:
    """That of the effect's file, or of its class where that was typed into a session."""
    file = getattr(sys.modules[type(effect).__module__], "__file__", None)
    if file is None:
        return inspect.getsource(type(effect))
    return _digest(Path(file), Path(file).stat().st_mtime_ns)


@cache
def _digest(file: Path, _changed: int) -> str:
    return hashlib.sha256(file.read_bytes()).hexdigest()


@cache
def _versions() -> list[str]:
    return [platform.python_version(), *(version(name) for name in ("numba", "numpy", "sympy"))]


def _kept_text(scene: Scene, recipe: Recipe, path: Path) -> str:
    """The kernel's text from its file; made, or made again if it is not what was once written."""
    kept = read_sealed(path)
    if kept is None:
        with stage(f"derived {recipe.kind}, {path.name}"):
            kept = recipe.write(scene).encode()
        write_sealed(path, kept)
    return kept.decode()


def _module(path: Path, text: str) -> ModuleType:
    """The kernel made from the text that was checked, not from what its file may hold by now."""
    from statics.compiled_code import keep_compiled

    module = ModuleType(path.stem)
    module.__file__ = str(path)
    sys.modules[path.stem] = module  # where numba looks for a function's globals
    exec(compile(text, path, "exec"), module.__dict__)
    keep_compiled(module, path, hashlib.sha256(text.encode()).hexdigest())
    return module
