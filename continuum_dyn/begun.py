"""A motion that was broken off, taken up where it was."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from continuum_dyn.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval, inputs_at
from continuum_dyn.scenario.solver import Solver


@dataclass(frozen=True)
class Begun:
    """What is known of it: the solver's settings, what it counted, and its samples, one at least.

    ``columns`` hold them by glossary name: ``time`` (samples,), coordinates and rates (samples, segments),
    ``input_work``, ``dissipated_energy``, ``elastic_energy`` and ``step_size`` (samples,). The last sample
    may lie between the times that samples were asked for.
    """

    solver: Solver
    counters: Mapping[str, int]
    columns: Mapping[str, np.ndarray]

    def states(self, dynamics: Dynamics, stretches: list[Interval]) -> tuple[np.ndarray, np.ndarray]:
        """States (samples, size) and inputs (samples, inputs) of the samples.

        Where a cable's displacement jumps just after the last of them, what the jump puts into its stretch
        is added to the input work.
        """
        given = self.columns
        inputs = inputs_at(stretches, given["time"])
        pairs = (("bend_angle", "elongation"), ("bend_angle_rate", "elongation_rate"))
        q, u = (np.stack([given[name] for name in names[: dynamics.dofs]], axis=-1) for names in pairs)
        size = (len(q), dynamics.size)
        integrals = [given["input_work"], given["dissipated_energy"]]
        states = np.column_stack([q.reshape(size), u.reshape(size), *integrals])
        seen = dynamics.observe(states, inputs)
        states[:, -2] -= seen.transport_energy
        if dynamics.scene.driven_by_length:
            states[-1, -2] += seen.ledger["elastic_energy"][-1] - given["elastic_energy"][-1]
        return states, inputs
