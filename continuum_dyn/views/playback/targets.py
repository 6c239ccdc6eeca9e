"""The static equilibrium of the inputs that act at a moment, as far as the log has it."""

import numpy as np

from continuum_dyn.record import Log

SAME = 1e-9
"""Relative difference below which two inputs are one."""


def resting_rows(log: Log) -> np.ndarray:
    """For each sample of the motion the row of its inputs' equilibrium in the log, or -1. Shape (samples,).

    Those of a static path belong to the samples of their times; of the two that other motions have, each to
    the samples whose inputs are its own and stay so. One that is known to be unstable belongs to none.
    """
    rest, time = log.equilibria, log.trajectory["time"]
    if not rest:
        return np.full(time.size, -1)
    rows = _found(rest["point"])
    matched = _by_time(rest["time"][rows], time) if rows.size > 2 else _by_inputs(log, rows)
    owned = np.where(matched >= 0, rows[matched], -1)
    unstable = np.isin(owned, np.flatnonzero(rest["stable"] == 0)) if "stable" in rest else False
    return np.where(unstable, -1, owned)


def _found(numbers: np.ndarray) -> np.ndarray:
    """Rows of the equilibria that searches ended in: the last one under each number."""
    return np.flatnonzero(np.append(numbers[1:] != numbers[:-1], True))


def _by_time(known: np.ndarray, time: np.ndarray) -> np.ndarray:
    nearest = np.clip(np.searchsorted(known, time - SAME * time[-1]), 0, known.size - 1)
    return np.where(np.abs(known[nearest] - time) <= SAME * time[-1], nearest, -1)


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
    """Where an input is that of an equilibrium; of a cable that is its tension or its displacement."""
    if name not in log.trajectory:
        return np.ones(log.trajectory["time"].size, dtype=bool)
    samples = log.trajectory[name].reshape(log.trajectory["time"].size, -1)
    there = log.equilibria[name][row].reshape(-1)
    if name in ("tension", "cable_displacement"):
        by_length = np.asarray(log.arm["cable_stiffness"]) > 0.0
        given = by_length if name == "cable_displacement" else ~by_length
        samples, there = samples[:, given], there[given]
    scale = np.abs(samples).max(initial=0.0)
    return (np.abs(samples - there) <= SAME * scale).all(axis=1)
