"""Small motion about a state: its rates, its frequencies, and the modes of an arm at rest."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse.linalg import LinearOperator, eigs

from continuum_dyn.dynamics import Dynamics
from continuum_dyn.profiles import Constant, Span, spans
from continuum_dyn.study import Scenario, dissipated_by
from statics import codegen
from statics.equilibria import Equilibrium, StaticSolver
from statics.errors import InputError
from statics.outcome import Outcome

MOST_COORDINATES = 400
"""Most coordinates of an arm whose modes are asked for: they are all found at once, in some seconds."""
FEW_COORDINATES = 64
"""Coordinates up to which rates are found with kernels that are not compiled, in a second or less."""
MOST_DENSE = 128
"""Most coordinates whose linearized motion is written out as a matrix."""
SMALL = 1e-6
"""Change of a bend angle (rad) by which accelerations are differenced."""
WITHIN = 1e-3
"""Relative error allowed to the iteration for the largest eigenvalue."""


def rates(dynamics: Dynamics, y: np.ndarray, span: Span) -> tuple[float, float]:
    """Smallest and largest absolute eigenvalue (1/s) of the motion linearized at ``y``."""
    size = 2 * dynamics.size
    found = np.abs(np.linalg.eigvals(dynamics.jacobian(span.start, y, span)[:size, :size]))
    return float(found.min()), float(found.max())


def fastest_frequency(dynamics: Dynamics, span: Span, y: np.ndarray) -> float:
    """Largest natural frequency (rad/s) of the undamped motion linearized at a state at rest."""
    size = dynamics.size
    if size <= MOST_DENSE:
        stiffness = dynamics.jacobian(span.start, y, span)[size : 2 * size, :size]
        return float(np.sqrt(np.abs(np.linalg.eigvals(stiffness)).max()))
    scale = SMALL * dynamics.scales()[:size]

    def accelerations(change: np.ndarray) -> np.ndarray:
        """Change of the accelerations, in units of ``scale``, by a change of coordinates in the same."""
        shift = np.zeros_like(y)
        shift[:size] = scale * change.ravel() / np.abs(change).max()
        ahead, behind = (dynamics.rate(span.start, y + sign * shift, span) for sign in (1, -1))
        return (ahead - behind)[size : 2 * size] / (2 * scale) * np.abs(change).max()

    operator = LinearOperator((size, size), matvec=accelerations, dtype=float)
    start = np.random.default_rng(0).standard_normal(size)
    largest = eigs(operator, k=1, v0=start, tol=WITHIN, return_eigenvectors=False)
    return float(np.sqrt(np.abs(largest).max()))


@dataclass(frozen=True)
class Mode:
    """A mode of small motion about an equilibrium.

    It swings as exp(-decay t) cos(...), with one rate in ``decay_rates`` (1/s), or it is overdamped and
    creeps back as two exponentials, with the slow rate and the fast one. ``frequency`` (Hz) is that without
    its damping, so |eigenvalue| / 2 pi, or the geometric mean of the two rates; ``damping_ratio`` is the
    mean decay rate over 2 pi times that, 1 or more where it creeps.

    ``shape`` holds the disks' displacements in x and y and their turn, shape (disks, 3), per metre of the
    largest displacement of any disk: 1, 1 and rad/m; the tip's larger one is positive. ``coordinates`` is
    the same in the segments' coordinates, shape (segments, dofs). Where damping lets the disks move out of
    step, both are the part in step.
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
    def rates(self) -> tuple[float, ...]:
        """Absolute eigenvalues, 1/s: one for the conjugate pair, or the two decay rates."""
        return (2.0 * np.pi * self.frequency,) if self.swings else self.decay_rates

    @property
    def decay_time(self) -> float:
        """Time (s) in which it falls to 1/e, in the end; infinite where nothing damps it."""
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
    """The modes about the equilibrium of the scenario's first tensions, which stay as they are.

    Raises ``InputError`` for a scene without inertia, with nodes that carry no mass or with more than
    ``MOST_COORDINATES`` coordinates, and where no stable equilibrium is found.
    """
    dynamics = Dynamics(scenario.scene)
    _check(dynamics)
    rest = StaticSolver(scenario.scene).solve(scenario.initial_tension)
    if rest.outcome is not Outcome.COMPLETED:
        raise InputError(f"modes are those about a stable equilibrium; found: {rest.outcome}.")
    found = modes(dynamics, dynamics.state(rest.coordinates), _still(scenario.initial_tension))
    return RestModes(scenario, rest, found)


def rates_without(scenario: Scenario, effect: str) -> tuple[float, float] | None:
    """Least and largest rate (1/s) about rest without an effect; None where there is no such rest.

    The kernels run as plain Python: a single matrix is not worth a compilation, unless the arm has many
    more than ``FEW_COORDINATES``.
    """
    try:
        without = scenario.without(effect)
        with np.errstate(all="ignore"):
            rest = StaticSolver(without.scene, codegen.load_interpreted).solve(without.initial_tension)
            if rest.outcome is not Outcome.COMPLETED:
                return None
            dynamics = Dynamics(without.scene, codegen.load_interpreted)
            return rates(dynamics, dynamics.state(rest.coordinates), _still(without.initial_tension))
    except (InputError, ArithmeticError, ValueError):  # Python raises where compiled code goes on with nan
        return None


def _still(inputs: np.ndarray) -> Span:
    """What drives the scene, staying as it is."""
    return spans(tuple(Constant(float(value)) for value in inputs), 1.0)[0]


def modes(dynamics: Dynamics, y: np.ndarray, span: Span) -> tuple[Mode, ...]:
    """All modes of the motion linearized at an equilibrium ``y``, lowest frequency first.

    Eigenvalues and -vectors of the exact Jacobian. Swinging modes are conjugate pairs; of real eigenvalues
    each of the slower half is joined with the one of the faster half whose shape is most like its own.
    """
    size = dynamics.size
    eigenvalues, vectors = np.linalg.eig(dynamics.jacobian(span.start, y, span)[: 2 * size, : 2 * size])
    decay, turning = -np.real(eigenvalues), np.imag(eigenvalues)
    if not dissipated_by(dynamics.scene):
        decay[turning != 0.0] = 0.0  # but for rounding
    shapes = vectors[:size] / dynamics.scales()[:size, None]
    shapes = np.real(shapes * _turn(shapes))
    in_step = shapes * dynamics.scales()[:size, None]
    pairs = [(int(k),) for k in np.flatnonzero(turning > 0.0)]
    pairs += _overdamped(decay, np.flatnonzero(turning == 0.0), shapes)
    inputs = span.inputs(np.array([span.start]))[0]
    found = []
    for pair in pairs:
        vector = in_step[:, pair[0]].reshape(-1, dynamics.dofs)
        moved = dynamics.displacements(y, vector, inputs)
        found.append(_mode([float(decay[k]) for k in pair], float(turning[pair[0]]), vector, moved))
    return tuple(sorted(found, key=lambda mode: mode.frequency))


def _turn(shapes: np.ndarray) -> np.ndarray:
    """Phases by which most of each shape is in step: sums of squares become real and positive."""
    return np.exp(-0.5j * np.angle(np.sum(shapes**2, axis=0)))


def _check(dynamics: Dynamics) -> None:
    if dynamics.scene.arm.massless_nodes:
        raise InputError(
            "modes need mass on every node, and those between disks carry none. Give the arm's core_density."
        )
    if dynamics.size > MOST_COORDINATES:
        raise InputError(
            f"modes of {dynamics.size} coordinates are asked for; allowed: {MOST_COORDINATES}. Give fewer "
            "disks or subsegments: the lowest modes need few."
        )


def _overdamped(decay: np.ndarray, real: np.ndarray, shapes: np.ndarray) -> list[tuple[int, ...]]:
    """Pairs (slow, fast) of the real eigenvalues, by the likeness of their shapes."""
    slow, fast = np.split(real[np.argsort(np.abs(decay[real]))], 2)
    unit = shapes / np.linalg.norm(shapes, axis=0)
    rows, columns = linear_sum_assignment(np.abs(unit[:, slow].T @ unit[:, fast]), maximize=True)
    return [(int(slow[row]), int(fast[column])) for row, column in zip(rows, columns, strict=True)]


def _mode(decay: list[float], turning: float, coordinates: np.ndarray, shape: np.ndarray) -> Mode:
    """A mode from its one or two decay rates (1/s), its angular frequency (rad/s) and its unscaled shape."""
    speed = float(np.hypot(decay[0], turning) if turning else np.sqrt(decay[0] * decay[1]))
    tip = shape[-1, :2]
    per = np.copysign(np.hypot(shape[:, 0], shape[:, 1]).max(), tip[np.argmax(np.abs(tip))])
    ratio = float(np.mean(decay)) / speed
    return Mode(speed / (2.0 * np.pi), ratio, tuple(decay), shape / per, coordinates / per)
