"""Straight-line programs in sympy: assignments in order, each name set once.

Matrix algebra written with ``Trace.name`` stays short: no expression grows, and names survive into the
generated kernels. ``Trace.tangent`` differentiates such a program line by line.
"""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import sympy as sp


def symbol(name: str) -> sp.Symbol:
    """The real symbol of that name."""
    return sp.Symbol(name, real=True)


def symbol_column(name: str, rows: int) -> sp.Matrix:
    """The symbols ``name_0``, ``name_1``, ..., shape (rows, 1)."""
    return sp.Matrix([symbol(f"{name}_{row}") for row in range(rows)])


def symbol_matrix(name: str, rows: int, columns: int, symmetric: bool = False) -> sp.Matrix:
    """The symbols ``name_00``, ``name_01``, ...; those of the upper triangle if symmetric."""
    matrix = sp.Matrix(rows, columns, lambda r, c: symbol(f"{name}_{r}{c}"))
    return _mirror(matrix) if symmetric else matrix


def column_by_name(name: str, value: sp.Matrix) -> sp.Matrix:
    """The column as ``Trace.name`` left it in an earlier step: names, but numbers and symbols as such."""
    return sp.Matrix([v if v.is_Atom else symbol(f"{name}_{row}") for row, v in enumerate(value)])


def matrix_by_name(name: str, value: sp.Matrix, symmetric: bool) -> sp.Matrix:
    """The matrix as ``Trace.matrix`` left it in an earlier step: names, but numbers and symbols as such."""
    names = symbol_matrix(name, *value.shape)
    entries = [v if v.is_Atom else named for v, named in zip(value, names, strict=True)]
    return _mirror(sp.Matrix(*value.shape, entries)) if symmetric else sp.Matrix(*value.shape, entries)


@cache
def derivative(value: Any, by: sp.Symbol) -> Any:
    """Derivative of an expression by a symbol, sums and products term by term: quicker than sympy's own."""
    value = sp.sympify(value)
    if by not in value.free_symbols:
        return sp.S.Zero
    if value.is_Add:
        return sp.Add(*(derivative(term, by) for term in value.args))
    if value.is_Mul:
        slopes = [derivative(factor, by) for factor in value.args]
        factors = value.args
        return sp.Add(*(sp.Mul(*factors[:k], slope, *factors[k + 1 :]) for k, slope in enumerate(slopes)))
    return value.diff(by)


def jacobian(values: sp.Matrix, by: Sequence[sp.Symbol]) -> sp.Matrix:
    """Derivatives of a column by some symbols, shape (rows, symbols)."""
    return sp.Matrix(len(values), len(by), [derivative(value, s) for value in values for s in by])


def _mirror(value: sp.Matrix) -> sp.Matrix:
    """The symmetric matrix with that upper triangle."""
    return sp.Matrix(*value.shape, lambda r, c: value[min(r, c), max(r, c)])


class Trace:
    """Assignments in order: the symbols set by each, one or more, and the value."""

    def __init__(self) -> None:
        self.lines: list[tuple[tuple[sp.Symbol, ...], Any]] = []

    def name(self, name: str, value: Any) -> Any:
        """Name an expression, or each entry of a matrix, and return the names.

        Entries are ``name_00``, ``name_01``, ..., those of a column ``name_0``, ``name_1``, .... Numbers and
        symbols need no name and are returned as they are.
        """
        if isinstance(value, sp.MatrixBase):
            if value.shape[1] > 1:
                return self.matrix(name, value, symmetric=False)
            return sp.Matrix([self.name(f"{name}_{row}", entry) for row, entry in enumerate(value)])
        value = sp.sympify(value)
        return value if value.is_Atom else self.always_name(name, value)

    def always_name(self, name: str, value: Any) -> sp.Symbol:
        """Name a scalar even if it is a number or a symbol: later steps read it by that name."""
        self.lines.append(((symbol(name),), sp.sympify(value)))
        return symbol(name)

    def matrix(self, name: str, value: sp.Matrix, symmetric: bool) -> sp.Matrix:
        """Name the entries of a matrix; of a symmetric one the upper triangle, mirrored."""
        names = sp.Matrix(
            *value.shape,
            lambda r, c: 0 if symmetric and c < r else self.name(f"{name}_{r}{c}", value[r, c]),
        )
        return _mirror(names) if symmetric else names

    def call(self, function: str, arguments: list[Any], results: list[str]) -> list[sp.Symbol]:
        """Call a function of the generated module by name; return the names of its results."""
        symbols = [symbol(name) for name in results]
        self.lines.append((tuple(symbols), sp.Function(function)(*arguments)))
        return symbols

    def tangent(self, directions: Mapping[sp.Symbol, Any]) -> tuple["Trace", dict[sp.Symbol, Any]]:
        """This program followed by its derivative along ``directions`` (symbol -> its change).

        Returns the longer program and the change of every symbol that changes.
        """
        program, change = Trace(), dict(directions)
        for (target,), value in self.lines:
            program.lines.append(((target,), value))
            slope = program.change_of(value, change)
            if slope != 0:
                change[target] = program.name(f"{target.name}_change", slope)
        return program, change

    @staticmethod
    def change_of(value: Any, change: Mapping[sp.Symbol, Any]) -> Any:
        """First-order change of an expression from the changes of its symbols."""
        value = sp.sympify(value)
        return sp.Add(
            *(derivative(value, s) * change[s] for s in sorted(value.free_symbols, key=str) if s in change)
        )
