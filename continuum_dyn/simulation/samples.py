"""Samples of a motion, from the solver to the trajectory, passed in blocks to a listener."""

import time
from collections.abc import Callable

import numpy as np

from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.simulation.trajectory import Trajectory, join, observe_trajectory

INTERVAL = 1.0
"""Shortest time between two blocks, s: rare enough to cost little, however many samples a run has."""

Listener = Callable[[Trajectory], None]
"""Receives one block of samples after another."""


class Samples:
    """Gathers states in order of time. Blocks, and the trajectory, end before a number that is not finite."""

    def __init__(self, dynamics: Dynamics, listener: Listener | None = None) -> None:
        self.dynamics, self.listener = dynamics, listener
        self.latest = -np.inf
        self.overflow: float | None = None
        self._pending: list[tuple[np.ndarray, ...]] = []
        self._blocks: list[Trajectory] = []
        self._passed = time.monotonic()

    def add(self, at: np.ndarray, states: np.ndarray, inputs: np.ndarray, step_size: np.ndarray) -> None:
        """Append samples at times (s); shapes (samples,), (samples, size), (samples, inputs), (samples,)."""
        if at.size:
            self._pending.append((at, states, inputs, step_size))
            self.latest = float(at[-1])
        if self.listener is not None and time.monotonic() - self._passed > INTERVAL:
            block = self._observe()
            if block is not None:
                self.listener(block)
            self._passed = time.monotonic()

    def trajectory(self, counters: dict[str, int]) -> Trajectory:
        """All samples; ``overflow`` is then the time (s) of the first one left out as not finite, if any."""
        self._observe()
        return join(self._blocks, counters)

    def _observe(self) -> Trajectory | None:
        """The samples added since the last call, if any."""
        if not self._pending or self.overflow is not None:
            return None
        times, states, inputs, steps = (np.concatenate(column) for column in zip(*self._pending, strict=True))
        self._pending.clear()
        block = observe_trajectory(self.dynamics, times, states, inputs, steps, {}).finite()
        if block.time.size < times.size:
            self.overflow = float(times[block.time.size])
        self._blocks.append(block)
        return block
