"""What ``run --live`` costs: a run's processor time with a process that follows its log, over that without.

The follower reads, draws and sends as it does for rerun's window, into a file instead: what the window itself
takes depends on the computer's graphics. Its own processor time, most of it to start, is told beside it.
"""

import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

import psutil

from continuum_dyn import Scenario, load_scenario, simulate
from continuum_dyn.record import StreamedLog
from continuum_dyn.scenario.profiles import Sine
from continuum_dyn.scenario.studies import MotionStudy

SCENARIO = Path(__file__).parents[1] / "scenarios" / "step_response.toml"
DURATION, SAMPLES_PER_SECOND = 1500.0, 100
REPEATS = 3
FOLLOWER = """
import os, sys
from pathlib import Path
import rerun as rr
from continuum_dyn.views.playback.live import Follower, follow
log, since, parent = Path(sys.argv[1]), float(sys.argv[2]), os.getppid()
recording = rr.RecordingStream("benchmark")
recording.save(log.with_suffix(".rrd"))
follow(log, since, Follower(recording), lambda: os.getppid() == parent)
"""


def scenario() -> Scenario:
    """The arm of the step response, pulled up and down all the time, for long enough to be looked at."""
    study = MotionStudy(DURATION, samples=int(DURATION * SAMPLES_PER_SECOND) + 1)
    return replace(load_scenario(SCENARIO), tension=(Sine(1.0, 0.9, 3.0),), study=study)


def solved(asked: Scenario, log: Path, followed: bool) -> tuple[float, float]:
    """Processor seconds that the run took, and those that the follower had taken by then."""
    command = [sys.executable, "-c", FOLLOWER, str(log), repr(time.time())]
    follower = subprocess.Popen(command) if followed else None
    started = time.process_time()
    with StreamedLog(log) as streamed:
        run = simulate(asked, sink=streamed)
        took = time.process_time() - started
        spent = sum(psutil.Process(follower.pid).cpu_times()[:2]) if follower else 0.0
        streamed.finish(run)
    if follower:
        follower.wait()
    return took, spent


def main() -> None:
    """Print the ratio of medians, and the follower's share of a processor."""
    asked = scenario()
    with TemporaryDirectory() as folder:
        log = Path(folder) / "log.h5"
        solved(asked, log, followed=False)
        pairs = [
            (solved(asked, log, followed=False), solved(asked, log, followed=True)) for _ in range(REPEATS)
        ]
    alone = median(took for (took, _), _ in pairs)
    together = median(took for _, (took, _) in pairs)
    spent = median(spent for _, (_, spent) in pairs)
    print(f"processor time of the run: alone {alone:.2f} s, followed {together:.2f} s")
    print(f"ratio {together / alone:.3f}")
    print(f"follower: {spent:.2f} s in another process")


if __name__ == "__main__":
    main()
