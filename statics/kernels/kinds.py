"""Kinds of the values that compiled functions work on, and the cells that these are made of."""

from dataclasses import dataclass

FLOAT, INT, BOOL = "double", "i64", "i1"
SCALAR_KINDS = {bool: BOOL, int: INT, float: FLOAT}
"""LLVM's types of numbers, by the annotations that name them."""
NAMES = {FLOAT: "a float", INT: "an integer", BOOL: "a bool", None: "nothing"}


@dataclass(frozen=True)
class ArrayKind:
    """Kind of an array of floats: its number of axes."""

    axes: int


@dataclass(frozen=True)
class TupleKind:
    """Kind of a tuple: those of its parts, and their names if it has such."""

    parts: "tuple[Kind, ...]"
    names: tuple[str, ...] = ()


Kind = str | ArrayKind | TupleKind


def cells(kind: Kind | None) -> list[str]:
    """LLVM types of the parts of a value: an array consists of its address and its shape."""
    match kind:
        case None:
            return []
        case ArrayKind(axes):
            return ["ptr", *[INT] * axes]
        case TupleKind(parts):
            return [cell for part in parts for cell in cells(part)]
    return [kind]


def named(kind: Kind | None) -> str:
    """Words for a kind."""
    match kind:
        case ArrayKind(axes):
            return f"an array with {axes} axes"
        case TupleKind(parts):
            return f"a tuple ({', '.join(map(named, parts))})"
    return NAMES[kind]


@dataclass(frozen=True)
class Value:
    """A value in the making: its kind, and LLVM's names of its cells."""

    kind: Kind
    cells: tuple[str, ...]

    @property
    def typed(self) -> list[tuple[str, str]]:
        """Every cell with its type."""
        return list(zip(cells(self.kind), self.cells, strict=True))

    @property
    def text(self) -> str:
        """The cells as parameters or arguments of a function."""
        return ", ".join(map(" ".join, self.typed))

    @property
    def parts(self) -> "list[Value]":
        """The parts of a tuple; of anything else none."""
        left, found = list(self.cells), []
        for kind in self.kind.parts if isinstance(self.kind, TupleKind) else ():
            count = len(cells(kind))
            found.append(Value(kind, tuple(left[:count])))
            del left[:count]
        return found

    @property
    def literal(self) -> int | None:
        """The integer that stands in the text, None if this is none."""
        known = self.kind == INT and self.cells[0].lstrip("-").isdigit()
        return int(self.cells[0]) if known else None
