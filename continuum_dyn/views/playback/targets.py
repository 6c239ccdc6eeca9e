"""The static equilibrium of each moment's inputs, if the log has it."""

import numpy as np

from continuum_dyn.record import Log

EQUAL = 1e-9
"""Largest relative difference of two inputs that count as equal."""


def resting_rows(log: Log) -> np.ndarray:
    """For each sample of the motion the row of its inputs' equilibrium in the log, or -1. Shape (samples,).

    Equilibria of a static path belong to the samples at their times; the two of other motions each to the
    samples whose inputs equal its own and stay constant. An unstable one belongs to none.
    """
    rest, time = log.equilibria, log.trajectory["time"]
    if not rest:
        return np.full(time.size, -1)
    rows = _last_of_each_number(rest["point"])
    matched = _by_time(rest["time"][rows], time) if rows.size > 2 else _by_inputs(log, rows)
    owned = np.where(matched >= 0, rows[matched], -1)
    unstable = np.isin(owned, np.flatnonzero(rest["stable"] == 0)) if "stable" in rest else False
    return np.where(unstable, -1, owned)


def _last_of_each_number(numbers: np.ndarray) -> np.ndarray:
    """Rows of the equilibria that searches ended in: the last one under each number."""
    return np.flatnonzero(np.append(numbers[1:] != numbers[:-1], True))


def _by_time(known: np.ndarray, time: np.ndarray) -> np.ndarray:
    nearest = np.clip(np.searchsorted(known, time - EQUAL * time[-1]), 0, known.size - 1)
    return np.where(np.abs(known[nearest] - time) <= EQUAL * time[-1], nearest, -1)


def _by_inputs(log: Log, rows: np.ndarray) -> np.ndarray:
    matched = np.full(log.trajectory["time"].size, -1)
    for number, row in enumerate(rows):
        same = np.ones(matched.size, dtype=bool)
        for name in ("tension", "cable_displacement", "load_factor", "base_x", "base_y", "base_theta"):
            same &= _same(log, name, row)
        held = same & (np.append(same[1:], False) | np.insert(same[:-1], 0, same.size == 1))
        matched[held] = number
    return matched


def _same(log: Log, name: str, row: int) -> np.ndarray:
    """Whether each sample's input equals that of an equilibrium; cables have either of two inputs."""
    if name not in log.trajectory:
        return np.ones(log.trajectory["time"].size, dtype=bool)
    samples = log.trajectory[name].reshape(log.trajectory["time"].size, -1)
    there = log.equilibria[name][row].reshape(-1)
    if name in ("tension", "cable_displacement"):
        by_length = np.asarray(log.arm["cable_stiffness"]) > 0.0
        given = by_length if name == "cable_displacement" else ~by_length
        samples, there = samples[:, given], there[given]
    scale = np.abs(samples).max(initial=0.0)
    return (np.abs(samples - there) <= EQUAL * scale).all(axis=1)
