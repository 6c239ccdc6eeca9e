"""Profiles that a body can follow: from rest, without a jump or a corner; and their rates."""

import dataclasses
from itertools import pairwise
from math import inf, pi, sin

import numpy as np

from continuum_dyn.scenario.profiles import Piece, Piecewise, Profile, Sine, Table, straight
from statics.errors import InputError

JUMP, TURN = 1e-12, 1e-4
"""Largest jumps of value and slope that count as none, in parts of the largest value and slope.

A phase of 1.5708 is a quarter turn.
"""


@dataclasses.dataclass(frozen=True)
class Rate:
    """The time derivative of a smooth profile, piece by piece; zero at the equilibrium before the start."""

    of: Piecewise
    initial: float = 0.0

    def pieces(self) -> list[Piece]:
        """The derivatives of the profile's pieces."""
        return list(map(derivative, self.of.pieces()))


def derivative(piece: Piece) -> Piece:
    """The piece's time derivative: a wave's is another one, a quarter of a period ahead."""
    start, _, slope, amplitude, frequency, phase = piece
    return start, slope, 0.0, amplitude * frequency, frequency, phase + pi / 2


def pieces_from(profile: Piecewise, start: float, count: int) -> np.ndarray:
    """The profile's piece at time ``start`` (s) and those after it, at most ``count``, shape (pieces, 6)."""
    if isinstance(profile, Rate):
        _, value, slope, amplitude, frequency, phase = range(6)
        found = pieces_from(profile.of, start, count)
        rows = found.copy()
        rows[:, value], rows[:, slope] = found[:, slope], 0.0
        rows[:, amplitude] *= found[:, frequency]
        rows[:, phase] += pi / 2
        return rows
    if isinstance(profile, Table):
        return profile.pieces_from(start, count)
    rows = np.array(profile.pieces(), dtype=float).reshape(-1, 6)
    active = max(int(np.searchsorted(rows[:, 0], start, side="right")) - 1, 0)
    return rows[active : active + count]


def check_smooth(profile: Profile, name: str, unit: str) -> None:
    """Raise ``InputError`` if a body could not follow the profile from rest: at a jump or a corner."""
    run = _from_rest(profile)
    size = max(abs(piece[1]) + abs(piece[3]) for piece in run)
    speed = max(abs(piece[2]) + abs(piece[3] * piece[4]) for piece in run)
    for earlier, later in pairwise(run):
        t = max(0.0, later[0])
        jump = _value(later, t) - _value(earlier, t)
        turn = _value(derivative(later), t) - _value(derivative(earlier), t)
        if abs(jump) > JUMP * size:
            raise InputError(f"{name}: jumps by {jump:g} {unit} at {t:g} s. {_advice(profile)}")
        if abs(turn) > TURN * speed:
            raise InputError(f"{name}: its rate jumps by {turn:g} {unit}/s at {t:g} s. {_advice(profile)}")


def _from_rest(profile: Profile) -> list[Piece]:
    """The rest before time zero, and the profile's pieces from there on; periods repeat the second one."""
    if isinstance(profile, Table):
        profile = dataclasses.replace(profile, periods=min(profile.periods, 2))
    pieces = profile.pieces()
    ends = [*(later[0] for later in pieces[1:]), inf]
    moving = [piece for piece, end in zip(pieces, ends, strict=True) if end > 0.0]
    return [straight(0.0, profile.initial), *moving]


def _value(piece: Piece, t: float) -> float:
    start, value, slope, amplitude, frequency, phase = piece
    return value + slope * (t - start) + amplitude * sin(frequency * (t - start) + phase)


def _advice(profile: Profile) -> str:
    instead = 'profile = "smooth_ramp"'
    if isinstance(profile, Sine):
        instead = "phase = 1.5708, which starts from rest at mean + amplitude"
    return f'That is an impulse, by the profile "{profile.profile}". Try {instead}.'
