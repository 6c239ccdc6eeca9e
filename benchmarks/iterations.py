"""Newton iterations of an implicit stage, pass by pass, for one arm or for several in lanes."""

import time
from collections.abc import Callable

import numpy as np

from continuum_dyn.simulation import Motion
from statics.kernels.calling import run
from statics.kernels.compiled import compiled
from statics.kernels.lowering import lower
from statics.kernels.machine_code import MachineCode, compile_text
from statics.kernels.slots import DAMPING_WEIGHT, SCALARS, SLOTS, STIFFNESS_WEIGHT

REPEATS = 15


@compiled
def repeat_motion(
    address: int,
    times: int,
    n: int,
    scalars: np.ndarray,
    q: np.ndarray,
    u: np.ndarray,
    w: np.ndarray,
    inputs: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
) -> None:
    """Repeat the outward pass."""
    for _ in range(times):
        run(address, n, scalars, q, u, w, inputs, segments, disks, chain)


@compiled
def repeat_residual(
    address: int,
    times: int,
    n: int,
    scalars: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
) -> None:
    """Repeat the residual pass."""
    for _ in range(times):
        run(address, n, scalars, disks, chain, residual)


@compiled
def repeat_elimination(
    address: int,
    times: int,
    n: int,
    scalars: np.ndarray,
    segments: np.ndarray,
    disks: np.ndarray,
    chain: np.ndarray,
    residual: np.ndarray,
    descent: np.ndarray,
) -> None:
    """Repeat the elimination."""
    for _ in range(times):
        run(address, n, scalars, segments, disks, chain, residual, descent, descent)


@compiled
def repeat_substitution(
    address: int,
    times: int,
    n: int,
    scalars: np.ndarray,
    chain: np.ndarray,
    descent: np.ndarray,
    change: np.ndarray,
) -> None:
    """Repeat the substitution."""
    for _ in range(times):
        run(address, n, scalars, chain, descent, change)


def nanoseconds(work: Callable[[], None]) -> float:
    """Shortest time of some repeats."""
    times = []
    work()
    for _ in range(REPEATS):
        started = time.perf_counter()
        work()
        times.append(time.perf_counter() - started)
    return 1e9 * min(times)


class Iteration:
    """The passes of one Newton iteration on an arm that moves, or on so many equal arms in lanes."""

    def __init__(self, motion: Motion, lanes: int = 1) -> None:
        kernel, segments, disks = motion.dynamics.motion
        self.n, self.lanes = len(segments), lanes
        shape = (self.n, motion.dynamics.dofs)
        q = motion.start[: motion.dynamics.size].reshape(shape).copy()
        q[:, 0] += 1.0 / self.n
        self.q, self.u, self.w = (
            self._spread(values) for values in (q, np.full(shape, 0.1), np.zeros(shape))
        )
        self.segments, self.disks, self.tension = map(self._spread, (segments, disks, np.array([1.0])))
        self.chain = self._spread(np.empty((self.n, kernel.widths["chain"])))
        self.residual, self.descent, self.change = (self._spread(np.empty(shape)) for _ in range(3))
        scalars = np.zeros(SCALARS)
        scalars[DAMPING_WEIGHT], scalars[STIFFNESS_WEIGHT] = 1e-3, 1e-6
        self.scalars = self._spread(scalars)
        if lanes == 1:
            self.addresses = kernel.addresses
        else:
            text = lower(kernel.tree, kernel.signatures, kernel.widths, SLOTS, lanes)
            self.code = MachineCode(compile_text(text))
            self.addresses = {name: self.code.address(name) for name in kernel.signatures}

    def _spread(self, values: np.ndarray) -> np.ndarray:
        """The values in every lane, which is the last axis."""
        return values if self.lanes == 1 else np.repeat(values[..., None], self.lanes, axis=-1)

    def passes(self, times: int) -> dict[str, Callable[[], None]]:
        """Every pass so many times in a row, by its name."""
        given = {name: (address, times, self.n, self.scalars) for name, address in self.addresses.items()}
        tables, moving = (self.segments, self.disks, self.chain), (self.q, self.u, self.w, self.tension)
        return {
            "motion": lambda: repeat_motion(*given["motion"], *moving, *tables),
            "residual": lambda: repeat_residual(*given["residual"], *tables[1:], self.residual),
            "eliminate": lambda: repeat_elimination(
                *given["eliminate"], *tables, self.residual, self.descent
            ),
            "substitute": lambda: repeat_substitution(
                *given["substitute"], self.chain, self.descent, self.change
            ),
        }

    def spent(self, times: int) -> dict[str, float]:
        """Nanoseconds of every pass to a segment of one arm, by its name."""
        work = times * self.n * self.lanes
        return {name: nanoseconds(repeated) / work for name, repeated in self.passes(times).items()}
