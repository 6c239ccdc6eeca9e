"""Generated kernels: written once for each structure of a scene, kept in the user's cache, loaded.

Structure is what changes the equations: the effects, the coordinates of a segment, the kinds of the cables,
the loads that change or that turn with their disk, whether there is a base and whether it moves, the most
payloads on one disk, whether a span has several segments, whether the holes of a cable differ, whether the
core has mass. Numbers are not, so a changed number never recompiles; a changed source file always does. A
warm start finds its kernel by a hash and imports neither sympy nor the derivation.
"""

import hashlib
import importlib.util
import inspect
import os
import platform
import stat
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any

from platformdirs import user_cache_path

from statics.effects import Effect
from statics.errors import KernelCacheError
from statics.scene import Scene

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

_loaded: dict[str, ModuleType] = {}


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
    key = kernel_key(scene, recipe)
    if key not in _loaded:
        _loaded[key] = _import(f"{recipe.kind}_{key}", _kept_text(scene, recipe, key))
    return _loaded[key]


def load_interpreted(scene: Scene, recipe: Recipe) -> Any:
    """The same functions as plain Python: for tests, for a debugger, and for what is asked only once."""
    text = _kept_text(scene, recipe, kernel_key(scene, recipe)).read_text(encoding="utf-8")
    text = text.replace("from numba import njit\n", "njit = lambda **_: lambda function: function\n")
    module = ModuleType(f"interpreted_{recipe.kind}")
    exec(compile(text, module.__name__, "exec"), module.__dict__)
    return module


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


def kernel_folder() -> Path:
    """Folder of the generated kernels: ``CONTINUUM_DYN_CACHE``, or the user's own cache folder.

    Raises ``KernelCacheError`` where others could write to it: kernels are code.
    """
    named = os.environ.get("CONTINUUM_DYN_CACHE")
    folder = Path(named) if named else user_cache_path("continuum-dyn") / "kernels"
    try:
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        status = folder.stat()
    except OSError as error:
        raise KernelCacheError(
            f"cannot make the folder for generated kernels, {folder}: {error.strerror}. "
            "Name another with the environment variable CONTINUUM_DYN_CACHE."
        ) from error
    if os.name == "posix" and (
        status.st_uid != os.getuid() or status.st_mode & (stat.S_IWGRP | stat.S_IWOTH)
    ):
        raise KernelCacheError(
            f"the folder for generated kernels, {folder}, may be written to by others, and kernels are code. "
            f"Try: chmod 700 {folder}, or name another with the environment variable CONTINUUM_DYN_CACHE."
        )
    return folder


def _kept_text(scene: Scene, recipe: Recipe, key: str) -> Path:
    """The kernel's file; made, or made again if it is not what was once written."""
    path = kernel_folder() / f"{recipe.kind}_{key}.py"
    if not _is_whole(path):
        _write_atomically(path, _sealed(recipe.write(scene)))
    return path


def _sealed(text: str) -> str:
    return f"# sha256 of what follows: {hashlib.sha256(text.encode()).hexdigest()}\n{text}"


def _is_whole(path: Path) -> bool:
    try:
        sealed = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError):
        return False
    return sealed == _sealed(sealed.partition("\n")[2])


def _write_atomically(path: Path, text: str) -> None:
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, suffix=".tmp")
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        Path(name).replace(path)
    except OSError as error:
        raise KernelCacheError(f"cannot write the generated kernel {path}: {error.strerror}.") from error


def _import(name: str, path: Path) -> ModuleType:
    specification = importlib.util.spec_from_file_location(name, path)
    if specification is None or specification.loader is None:
        raise KernelCacheError(f"cannot import the generated kernel {path}.")
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    specification.loader.exec_module(module)
    return module
