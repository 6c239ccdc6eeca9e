"""Continuation of an interrupted motion from its last sample."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from continuum_dyn.integrators import Monitor
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Timeline
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.integration import integrate
from continuum_dyn.simulation.motion import Motion
from continuum_dyn.simulation.samples import Samples
from continuum_dyn.simulation.trajectory import Trajectory


@dataclass(frozen=True)
class Resumption:
    """State from which an interrupted motion resumes: solver settings, counters and samples, at least one.

    ``columns`` hold the samples by glossary name: ``time`` (samples,), coordinates and rates (samples,
    segments), ``input_work``, ``dissipated_energy``, ``elastic_energy`` and ``step_size`` (samples,). The
    last sample may lie between the times that were requested.
    """

    solver: Solver
    counters: Mapping[str, int]
    columns: Mapping[str, np.ndarray]

    def states(self, dynamics: Dynamics, timeline: Timeline) -> tuple[np.ndarray, np.ndarray]:
        """States (samples, size) and inputs (samples, inputs) of the samples.

        If a cable's displacement jumps just after the last of them, the energy that the jump adds to its
        stretch is added to the input work.
        """
        given = self.columns
        inputs = timeline.inputs(given["time"])
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

    def integrate(self, motion: Motion, monitor: Monitor, gathered: Samples) -> Trajectory:
        """The whole motion, integrated from the last sample on; sampled as one that was not interrupted."""
        times, dynamics = self.columns["time"], motion.dynamics
        states, inputs = self.states(dynamics, motion.timeline)
        kept = np.isin(times, motion.samples)
        gathered.add(times[kept], states[kept], inputs[kept], self.columns["step_size"][kept])
        rest = motion.timeline.after(float(times[-1]))
        if rest.start >= rest.end:
            return gathered.trajectory(dict(self.counters))
        trajectory = integrate(dynamics, rest, motion.samples, states[-1], self.solver, monitor, gathered)
        counters = {name: n + self.counters.get(name, 0) for name, n in trajectory.counters.items()}
        return replace(trajectory, counters=counters)
