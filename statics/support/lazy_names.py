"""Names of a package that are loaded on first use, so that a command's help loads no solver."""

import ast
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, TypeGuard


def loaded_when_asked_for(file: str) -> Callable[[str], Any]:
    """``__getattr__`` of a package, for the names that its ``file`` imports if ``TYPE_CHECKING``."""
    (block,) = (node for node in ast.parse(Path(file).read_text(encoding="utf-8")).body if _is_lazy(node))
    imports = [node for node in block.body if isinstance(node, ast.ImportFrom)]
    homes = {alias.name: node.module or "" for node in imports for alias in node.names}

    def named(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {Path(file).parent.name!r} has no attribute {name!r}")
        return getattr(import_module(homes[name]), name)

    return named


def _is_lazy(node: ast.stmt) -> TypeGuard[ast.If]:
    return isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING"
