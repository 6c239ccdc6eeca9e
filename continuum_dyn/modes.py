"""Small motion about a state: its rates, its frequencies, and the modes of an arm at rest."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval, cut_into_intervals
from continuum_dyn.scenario.profiles import Constant
from continuum_dyn.scenario.scenario import Scenario
from statics.equilibria import Equilibrium, StaticSolver
from statics.errors import InputError
from statics.outcome import Outcome
from statics.scene import Scene

MOST_COORDINATES = 400
"""Largest number of coordinates for modes: all are computed together, in some seconds."""
FEW_COORDINATES = 64
"""Coordinates up to which rates are found for a table, where each effect left out is another structure."""
MOST_DENSE = 128
"""Largest number of coordinates whose linearized motion is written out as a matrix."""
SMALL = 1e-6
"""Change of a bend angle (rad) by which accelerations are differenced."""
NEUTRAL = 1e-7
"""Largest growth over a rate's size that is rounding."""
FARTHEST = 1e13
"""Largest over smallest absolute eigenvalue, above which rounding of the largest drowns the smallest."""
WITHIN = 1e-3
"""Relative error allowed to the iteration for the largest eigenvalue."""


def rates(dynamics: Dynamics, y: np.ndarray, interval: Interval) -> tuple[float, float]:
    """Smallest and largest absolute eigenvalue (1/s) of the motion linearized at ``y``."""
    size = 2 * dynamics.size
    found = np.abs(np.linalg.eigvals(linearized(dynamics, y, interval)[:size, :size]))
    return float(found.min()), float(found.max())


def linearized(dynamics: Dynamics, y: np.ndarray, interval: Interval) -> np.ndarray:
    """d(rate)/dy. Raises ``InputError`` if it is beyond floating point."""
    matrix = dynamics.jacobian(interval.start, y, interval)
    if not np.isfinite(matrix).all():
        raise InputError(
            "the equations of motion overflow at the start: numbers of the scene are too far apart. "
            "Look for a unit that is not SI."
        )
    return matrix


def fastest_frequency(dynamics: Dynamics, interval: Interval, y: np.ndarray) -> float:
    """Largest natural frequency (rad/s) of the undamped motion linearized at a state at rest."""
    size = dynamics.size
    if size <= MOST_DENSE:
        stiffness = linearized(dynamics, y, interval)[size : 2 * size, :size]
        return float(np.sqrt(np.abs(np.linalg.eigvals(stiffness)).max()))
    from scipy.sparse.linalg import LinearOperator, eigs  # slow to load, and only large arms need it

    scale = SMALL * dynamics.scales()[:size]

    def accelerations(change: np.ndarray) -> np.ndarray:
        """Change of the accelerations, in units of ``scale``, by a change of coordinates in the same."""
        shift = np.zeros_like(y)
        shift[:size] = scale * change.ravel() / np.abs(change).max()
        ahead, behind = (dynamics.rate(interval.start, y + sign * shift, interval) for sign in (1, -1))
        return (ahead - behind)[size : 2 * size] / (2 * scale) * np.abs(change).max()

    operator = LinearOperator((size, size), matvec=accelerations, dtype=float)
    start = np.random.default_rng(0).standard_normal(size)
    largest = eigs(operator, k=1, v0=start, tol=WITHIN, return_eigenvectors=False)
    return float(np.sqrt(np.abs(largest).max()))


@dataclass(frozen=True)
class Mode:
    """A mode of small motion about an equilibrium.

    It oscillates as exp(-decay t) cos(...), with one rate in ``decay_rates`` (1/s), or it is overdamped and
    creeps back as two exponentials, with the slow rate and the fast one. A negative rate is one of growth,
    under loads without a potential: an oscillating mode then flutters, an overdamped one diverges.
    ``frequency`` (Hz) is that without its damping, so |eigenvalue| / 2 pi, or the geometric mean of the two
    rates' sizes; ``damping_ratio`` is the mean decay rate over 2 pi times that.

    ``shape`` holds the disks' displacements in x and y and their turn, shape (disks, 3), per metre of the
    largest displacement of any disk: 1, 1 and rad/m; the tip's larger one is positive. ``coordinates`` is
    the same in the segments' coordinates, shape (segments, dofs). If damping lets the disks move out of
    phase, both are the part in phase.
    """

    frequency: float
    damping_ratio: float
    decay_rates: tuple[float, ...]
    shape: np.ndarray
    coordinates: np.ndarray

    @property
    def swings(self) -> bool:
        """Whether it passes through the equilibrium again and again."""
        return len(self.decay_rates) == 1

    @property
    def grows(self) -> bool:
        """Whether it flutters or diverges."""
        return self.decay_rates[0] < 0.0

    @property
    def kind(self) -> str:
        """Kind of motion: "swings", "creeps" (back), "flutters" or "diverges"."""
        if self.grows:
            return "flutters" if self.swings else "diverges"
        return "swings" if self.swings else "creeps"

    @property
    def rates(self) -> tuple[float, ...]:
        """Absolute eigenvalues, 1/s: one for the conjugate pair, or one for each of two exponentials."""
        return (2.0 * np.pi * self.frequency,) if self.swings else tuple(map(abs, self.decay_rates))

    @property
    def decay_time(self) -> float:
        """Time (s) in which it falls to 1/e, in the end; infinite if undamped, negative if it grows."""
        return 1.0 / self.decay_rates[0] if self.decay_rates[0] else np.inf


@dataclass(frozen=True)
class RestModes:
    """The equilibrium that a scenario starts from, and all modes about it, lowest frequency first."""

    scenario: Scenario
    rest: Equilibrium
    modes: tuple[Mode, ...]

    @property
    def rates(self) -> tuple[float, float]:
        """Least and largest absolute eigenvalue, 1/s."""
        found = [rate for mode in self.modes for rate in mode.rates]
        return min(found), max(found)


def modes_at_rest(scenario: Scenario) -> RestModes:
    """The modes about the equilibrium of the scenario's first tensions, which are held constant.

    Raises ``InputError`` for a scene without inertia, with nodes that carry no mass or with more than
    ``MOST_COORDINATES`` coordinates, and if no equilibrium is found, or one that is unstable by its
    energy.
    """
    check(scenario.scene)
    dynamics = Dynamics(scenario.scene)
    rest = StaticSolver(scenario.scene).solve(scenario.initial_inputs)
    if rest.outcome is not Outcome.COMPLETED:
        raise InputError(f"modes are those about a stable equilibrium; found: {rest.outcome}.")
    found = modes(dynamics, dynamics.state(rest.coordinates), still(scenario.initial_inputs))
    return RestModes(scenario, rest, found)


def rates_without(scenario: Scenario, effect: str) -> tuple[float, float] | None:
    """Least and largest rate (1/s) about rest without an effect; None if there is no such rest."""
    try:
        without = scenario.without(effect)
        with np.errstate(all="ignore"):
            rest = StaticSolver(without.scene).solve(without.initial_inputs)
            if rest.outcome is not Outcome.COMPLETED:
                return None
            dynamics = Dynamics(without.scene)
            return rates(dynamics, dynamics.state(rest.coordinates), still(without.initial_inputs))
    except (InputError, ArithmeticError, ValueError):  # numbers without a rest may overflow
        return None


def still(inputs: np.ndarray) -> Interval:
    """An interval of constant inputs."""
    return cut_into_intervals(tuple(Constant(float(value)) for value in inputs), 1.0).first


class _Motion(NamedTuple):
    """The rates of decay (1/s) of a mode, its angular frequency (rad/s), and its part in phase."""

    decay: tuple[float, ...]
    turning: float
    coordinates: np.ndarray


def modes(dynamics: Dynamics, y: np.ndarray, interval: Interval) -> tuple[Mode, ...]:
    """All modes of the motion linearized at an equilibrium ``y``, lowest frequency first.

    Raises ``InputError`` if rounding of the fastest motion hides the slowest.
    """
    size, scales = dynamics.size, dynamics.scales()[: dynamics.size]
    jacobian = linearized(dynamics, y, interval)[: 2 * size, : 2 * size]
    free = not jacobian[size:, size:].any()
    motions = _free(jacobian[size:, :size], scales) if free else _damped(jacobian, scales)
    inputs = interval.inputs(np.array([interval.start]))[0]
    found = [_mode(dynamics, y, inputs, motion) for motion in motions]
    return tuple(sorted(found, key=lambda mode: (mode.frequency, mode.decay_rates[0])))


def _free(accelerations: np.ndarray, scales: np.ndarray) -> list[_Motion]:
    """Modes of an undamped scene, from d(acceleration)/dq: its eigenvalues are squares of rates.

    A negative one oscillates, a positive one diverges. A pair of conjugate ones, which only loads without a
    potential can cause, flutters: it oscillates twice, once growing and once dying away.
    """
    squares, vectors = np.linalg.eig(accelerations)
    _check_spread(np.sqrt(np.abs(squares)), np.sqrt(FARTHEST))
    motions = []
    for square, shape in zip(squares, _in_step(vectors, scales).T, strict=True):
        rate = np.sqrt(complex(square))
        growth = 0.0 if rate.real < NEUTRAL * abs(rate) else float(rate.real)
        decay = (-growth, growth) if square.imag == 0.0 else (-growth if square.imag > 0.0 else growth,)
        motions.append(_Motion(decay if growth else (0.0,), float(abs(rate.imag)), shape))
    return motions


def _damped(jacobian: np.ndarray, scales: np.ndarray) -> list[_Motion]:
    """Modes from the exact Jacobian by (q, u).

    Oscillating ones are conjugate pairs; of real eigenvalues each of the slower half, or of those that grow,
    is paired with the one of the other half whose shape is most similar.
    """
    eigenvalues, vectors = np.linalg.eig(jacobian)
    _check_spread(np.abs(eigenvalues), FARTHEST)
    decay, turning = -np.real(eigenvalues), np.imag(eigenvalues)
    shapes = _in_step(vectors[: scales.size], scales)
    pairs = [(int(k),) for k in np.flatnonzero(turning > 0.0)]
    pairs += _overdamped(decay, np.flatnonzero(turning == 0.0), shapes / scales[:, None])
    return [
        _Motion(tuple(float(decay[k]) for k in pair), float(turning[pair[0]]), shapes[:, pair[0]])
        for pair in pairs
    ]


def _check_spread(rates: np.ndarray, farthest: float) -> None:
    """Raise ``InputError`` for rates (1/s) of which some are zero, or rounding of the largest."""
    slowest, fastest = float(rates.min()), float(rates.max())
    if not slowest * farthest > fastest:
        raise InputError(
            f"modes are lost in rounding: rates of the linearized motion go from {slowest:.3g} to "
            f"{fastest:.3g} 1/s; their largest ratio is {farthest:.2g}. Give the lightest nodes more "
            "mass (disk_mass, core_density) or inertia, or leave out the damping that makes them so fast."
        )


def _in_step(vectors: np.ndarray, scales: np.ndarray) -> np.ndarray:
    """Shapes rotated in phase so that most of each is in phase, and the real part of them."""
    shapes = vectors / scales[:, None]
    turn = np.exp(-0.5j * np.angle(np.sum(shapes**2, axis=0)))
    return np.real(shapes * turn) * scales[:, None]


def check(scene: Scene) -> None:
    """Raise ``InputError`` for a scene whose modes cannot be found."""
    if not scene.has("inertia"):
        raise InputError("modes need the effect 'inertia'. Add inertia = {} to [effects].")
    if scene.arm.massless_nodes:
        raise InputError(
            "modes need mass at every node, and some have none. Give the arm's core_density, or disk_mass."
        )
    size = scene.arm.segments * len(scene.coordinates)
    if size > MOST_COORDINATES:
        raise InputError(
            f"{size} coordinates are too many for modes. Allowed: {MOST_COORDINATES}. Give fewer disks or "
            "subsegments: the lowest modes need few."
        )


def _overdamped(decay: np.ndarray, real: np.ndarray, shapes: np.ndarray) -> list[tuple[int, ...]]:
    """Pairs (slow, fast) of the real eigenvalues, by the similarity of their shapes."""
    from scipy.optimize import linear_sum_assignment  # slow to load, and motions look at rates alone

    slow, fast = np.split(real[np.argsort(decay[real])], 2)
    unit = shapes / np.linalg.norm(shapes, axis=0)
    rows, columns = linear_sum_assignment(np.abs(unit[:, slow].T @ unit[:, fast]), maximize=True)
    return [(int(slow[row]), int(fast[column])) for row, column in zip(rows, columns, strict=True)]


def _mode(dynamics: Dynamics, y: np.ndarray, inputs: np.ndarray, motion: _Motion) -> Mode:
    decay, turning = motion.decay, motion.turning
    speed = float(np.hypot(decay[0], turning) if turning else np.sqrt(abs(decay[0] * decay[1])))
    coordinates = motion.coordinates.reshape(-1, dynamics.dofs)
    shape = dynamics.displacements(y, coordinates, inputs)
    tip = shape[-1, :2]
    per = np.copysign(np.hypot(shape[:, 0], shape[:, 1]).max(), tip[np.argmax(np.abs(tip))])
    ratio = float(np.mean(decay)) / speed
    return Mode(speed / (2.0 * np.pi), ratio, decay, shape / per, coordinates / per)
