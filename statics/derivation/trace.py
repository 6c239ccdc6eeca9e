"""Straight-line programs in sympy: assignments in order, each name set once.

Matrix algebra written with ``let`` stays as short as it was thought: no expression grows, and names
survive into the generated kernels. ``tangent`` differentiates such a program line by line.
"""

from collections.abc import Mapping
from typing import Any

import sympy as sp


class Trace:
    """Assignments in order; numbers and symbols need none and pass through ``let`` as they are."""

    def __init__(self) -> None:
        self.lines: list[tuple[tuple[sp.Symbol, ...], Any]] = []

    def let(self, name: str, value: Any) -> Any:
        """Name a scalar or every entry of a matrix (``name_00``, ``name_01``, ...); return the names."""
        if isinstance(value, sp.MatrixBase):
            return sp.Matrix(
                *value.shape,
                lambda row, column: self.let(_entry(name, value, row, column), value[row, column]),
            )
        value = sp.sympify(value)
        return value if value.is_Atom else self.name(name, value)

    def name(self, name: str, value: Any) -> sp.Symbol:
        """Name a scalar even if it is a number or a symbol: later programs ask for it by that name."""
        symbol = sp.Symbol(name, real=True)
        self.lines.append(((symbol,), sp.sympify(value)))
        return symbol

    def symmetric(self, name: str, value: sp.Matrix) -> sp.Matrix:
        """Name the upper triangle of a symmetric matrix; the lower one is its mirror."""
        size = value.shape[0]
        upper = {(r, c): self.let(f"{name}_{r}{c}", value[r, c]) for r in range(size) for c in range(r, size)}
        return sp.Matrix(size, size, lambda r, c: upper[min(r, c), max(r, c)])

    def call(self, function: str, arguments: list[Any], results: list[str]) -> list[sp.Symbol]:
        """Call a function of the generated module by name; return the names of its results."""
        symbols = [sp.Symbol(name, real=True) for name in results]
        self.lines.append((tuple(symbols), sp.Function(function)(*arguments)))
        return symbols

    def tangent(self, directions: Mapping[sp.Symbol, Any]) -> tuple["Trace", dict[sp.Symbol, Any]]:
        """This program followed by its derivative along ``directions`` (symbol -> its change).

        Returns the longer program and the change of every symbol that changes.
        """
        program, change = Trace(), dict(directions)
        for (symbol,), value in self.lines:
            program.lines.append(((symbol,), value))
            slope = program.change_of(value, change)
            if slope != 0:
                change[symbol] = program.let(f"{symbol.name}_change", slope)
        return program, change

    @staticmethod
    def change_of(value: Any, change: Mapping[sp.Symbol, Any]) -> Any:
        """First-order change of an expression from the changes of its symbols."""
        value = sp.sympify(value)
        return sp.Add(
            *(value.diff(s) * change[s] for s in sorted(value.free_symbols, key=str) if s in change)
        )


def _entry(name: str, matrix: sp.MatrixBase, row: int, column: int) -> str:
    return f"{name}_{row}{column}" if matrix.shape[1] > 1 else f"{name}_{row}"
