"""How the cost of a motion grows with the number of segments, with and without extension.

The step response of the paper's arm, its length and mass cut into n segments, by the chain's own method at
10 um of tip error or better. Reported: steps, time per segment and step, real-time factor; asserted: the
ratios between numbers of segments. What a call costs without any motion (0.3 ms) is measured by one over a
nanosecond and is not part of the time per step.
"""

from dataclasses import replace
from pathlib import Path

from continuum_dyn import Scenario, load_scenario
from continuum_dyn.experiments.cost import least_seconds
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.scenario.studies import MotionStudy
from continuum_dyn.simulation import Motion
from continuum_dyn.simulation.accuracy import tip_distance
from statics import Scene

SCENARIO = Path(__file__).parents[1] / "scenarios" / "step_response.toml"
DISKS = (16, 64, 256, 1024)
DURATION, NOTHING = 1.0, 1e-9
SOLVER = Solver("chain", rtol=1e-6, atol=1e-9)
REFERENCE = Solver("chain", rtol=1e-10, atol=1e-13)
STEPS_WITHIN, COST_WITHIN = 1.3, 1.5
"""Largest allowed ratios, over the numbers of segments, of the steps and of the time per segment and step."""
WITHOUT_EXTENSION = 1.2
"""Least factor by which the motion without extension is faster, from 64 segments on."""
ERROR = 1e-5


def cut(scenario: Scenario, disks: int, extension: bool) -> Scenario:
    """The same arm in that many segments, 31 samples."""
    scene, arm = scenario.scene, scenario.scene.arm
    assert arm.disk_mass is not None
    assert arm.disk_inertia is not None
    parts = disks / arm.disks
    finer = replace(
        arm,
        disks=disks,
        disk_spacing=arm.disk_spacing / parts,
        disk_mass=arm.disk_mass / parts,
        disk_inertia=arm.disk_inertia / parts,
        cables=tuple(replace(cable, anchor=None) for cable in arm.cables),
    )
    effects = (effect for effect in scene.effects if extension or effect.name != "extension")
    return replace(scenario, scene=Scene(finer, effects), study=MotionStudy(DURATION, samples=31))


def main() -> None:
    """Print the table and check the ratios."""
    scenario = load_scenario(SCENARIO)
    print("extension  segments  steps  tip error  time     per segment and step  times real time")
    rows: dict[tuple[bool, int], tuple[int, float, float]] = {}
    for extension in (True, False):
        for disks in DISKS:
            case = cut(scenario, disks, extension)
            motion, still = Motion(case), Motion(replace(case, study=MotionStudy(NOTHING, samples=31)))
            motion.warm_up(SOLVER)
            found, reference = motion.complete(SOLVER), motion.complete(REFERENCE)
            assert found is not None
            assert reference is not None
            error, steps = tip_distance(found, reference), found.counters["steps"]
            seconds, call = least_seconds(motion, SOLVER), least_seconds(still, SOLVER)
            each = (seconds - call) / steps / disks
            rows[extension, disks] = (steps, each, seconds)
            name = "with" if extension else "without"
            print(
                f"{name:9s}  {disks:8d}  {steps:5d}  {error:.1e} m  {seconds * 1e3:6.1f} ms"
                f"  {each * 1e6:17.2f} us  {DURATION / seconds:15.1f}"
            )
            assert error < ERROR
        taken = [rows[extension, disks][0] for disks in DISKS]
        prices = [rows[extension, disks][1] for disks in DISKS]
        assert max(taken) < STEPS_WITHIN * min(taken)
        assert max(prices) < COST_WITHIN * min(prices)
    for disks in DISKS:
        ratio = rows[True, disks][2] / rows[False, disks][2]
        print(f"{disks} segments: {ratio:.2f} times as fast without extension")
        assert ratio > (WITHOUT_EXTENSION if disks >= 64 else 1.0)
    assert rows[True, 1024][2] < DURATION


if __name__ == "__main__":
    main()
