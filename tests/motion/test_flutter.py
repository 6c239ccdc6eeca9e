"""Stability where no energy tells: Beck's column, and the verdict on a scenario."""

from pathlib import Path
from signal import SIGINT, raise_signal

import numpy as np
import pytest
from conftest import JET, at_rest, cantilever, edited
from interrupting import at_call
from typer.testing import CliRunner

from continuum_dyn import simulate
from continuum_dyn.cli import app
from continuum_dyn.integrators import Monitor
from continuum_dyn.modes import Mode, modes, modes_at_rest, still
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.record import read_log, write_log
from continuum_dyn.scenario.intervals import cut_into_intervals
from continuum_dyn.scenario.profiles import Constant
from continuum_dyn.scenario.solver import Solver
from continuum_dyn.simulation.integration import inspector, integrate
from continuum_dyn.stability import Growth, growth_about
from statics import DiskLoad, Outcome

# ---- Beck's column ----

BECK = 20.05
"""Flutter load over E J / L^2 of a uniform cantilever under a tangential force at its tip (Beck 1952)."""


def growth(disks: int, push: float, damping: float = 0.0) -> Growth | None:
    """What grows about the straight column that a follower force pushes."""
    scene = cantilever(disks, DiskLoad(disks, (-push, 0.0), follower=True), damping=damping)
    rest = at_rest(scene)
    assert np.abs(rest.bend_angle).max() == 0.0
    return growth_about(Dynamics(scene), rest)


def flutter_load(disks: int, damping: float = 0.0) -> float:
    low, high = 5.0, 25.0
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if growth(disks, middle, damping) is None else (low, middle)
    return low


def test_column_under_a_follower_force_flutters_at_becks_load() -> None:
    coarse, fine = flutter_load(8), flutter_load(16)
    assert (coarse - BECK) / (fine - BECK) == pytest.approx(4.0, rel=0.1)  # second order
    assert (4 * fine - coarse) / 3 == pytest.approx(BECK, abs=0.01)
    found = growth(16, 1.02 * fine)
    assert found is not None
    assert found.modes == 1
    assert found.frequency == pytest.approx(11.0 / (2 * np.pi), rel=0.02)  # Omega = 11.0: Beck 1952


def test_follower_force_does_not_buckle_a_column_and_a_dead_one_does() -> None:
    for push in (0.5, 0.99 * np.pi**2 / 4, 1.5 * np.pi**2 / 4, np.pi**2, 18.0):
        assert growth(12, push) is None
    dead = cantilever(12, DiskLoad(12, (-1.05 * np.pi**2 / 4, 1e-6)))
    assert abs(at_rest(dead).tip[1]) > 0.1


def test_little_damping_in_the_core_lowers_the_flutter_load() -> None:
    """To 10.94 as Kelvin-Voigt damping tends to zero (Bolotin and Zhinzher 1969)."""
    assert flutter_load(16, damping=1e-4) == pytest.approx(10.94, rel=0.01)


def test_stability_without_damping_is_told_by_divergence_too() -> None:
    """A dead force, taken as if nothing were known of its potential: half way between stable and not."""
    for push, grows in ((0.97, False), (1.03, True)):
        load = DiskLoad(16, (-push * np.pi**2 / 4, 0.0))
        scene = cantilever(16, load, DiskLoad(1, follower=True))
        found = growth_about(Dynamics(scene), at_rest(scene))
        assert (found is not None) == grows
        assert found is None or (found.frequency == 0.0 and str(found).startswith("divergence"))


def undamped_modes(push: float, *, follower: bool) -> tuple[Mode, ...]:
    """About the straight column of 8 disks under a force along it."""
    scene = cantilever(8, DiskLoad(8, (-push, 0.0), follower=follower), DiskLoad(1, follower=True))
    dynamics = Dynamics(scene)
    return modes(dynamics, dynamics.state(np.zeros((8, 1))), still(np.empty(0)))


def test_undamped_flutter_is_two_modes_of_one_frequency_one_of_which_grows() -> None:
    found, expected = undamped_modes(22.0, follower=True), growth(8, 22.0)
    assert expected is not None
    grows, dies = found[:2]
    assert (grows.kind, dies.kind) == ("flutters", "swings")
    assert grows.frequency == pytest.approx(dies.frequency, rel=1e-9)
    assert grows.damping_ratio == pytest.approx(-dies.damping_ratio, rel=1e-9)
    assert grows.decay_rates[0] == pytest.approx(-expected.rate, rel=1e-9)
    assert len(found) == 8
    assert all(mode.damping_ratio == 0.0 for mode in found[2:])


def test_undamped_divergence_is_one_mode_of_two_opposite_rates() -> None:
    """Beyond the dead force's first two buckling loads: pi^2 / 4 and 9 pi^2 / 4."""
    found = undamped_modes(30.0, follower=False)
    diverging = [mode for mode in found if mode.grows]
    assert [mode.kind for mode in diverging] == ["diverges", "diverges"]
    for mode in diverging:
        growing, dying = mode.decay_rates
        assert growing == -dying < 0.0
        assert mode.frequency == pytest.approx(dying / (2 * np.pi), rel=1e-12)
    assert all(mode.kind == "swings" for mode in found if mode not in diverging)


# ---- scenarios: from the file to the verdict ----

ALONG = ("force = [0.0, 2.0]", "force = [-9.0, 0.0]")
EQUILIBRIUM = ('kind = "step_response"\nduration = 1.0\nsamples = 1001', 'kind = "equilibrium"')
CONSTANT = ('factor = { profile = "step", before = 0.0, after = 1.0 }', "factor = 1.0")


def test_equilibrium_that_flutters_is_unstable_and_says_how(tmp_path: Path) -> None:
    run = simulate(edited(JET, tmp_path, ALONG, EQUILIBRIUM, CONSTANT))
    assert run.outcome is Outcome.UNSTABLE_EQUILIBRIUM
    assert run.equilibria[0].unstable_directions == 1
    assert not run.equilibria[0].stable
    assert run.message.endswith("flutter at 42.7 Hz that grows at 18.6 1/s")


def test_interrupted_while_stability_is_judged_it_keeps_the_equilibrium(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its kernels may have to be derived first, which takes a while."""
    at_call("continuum_dyn.simulation.at_rest:judge", 1, lambda: raise_signal(SIGINT), monkeypatch.setattr)
    run = simulate(edited(JET, tmp_path, ALONG, EQUILIBRIUM, CONSTANT))
    assert (run.outcome, len(run.equilibria)) == (Outcome.INTERRUPTED, 1)
    assert run.message == "interrupted after 1 of 1 points, stability unknown"


def test_without_inertia_stability_is_not_judged_and_is_told_so(tmp_path: Path) -> None:
    motion = "inertia = {}\nrotary_inertia = {}\nmaterial_damping = { retardation_time = 1.2e-3 }\n"
    run = simulate(edited(JET, tmp_path, ALONG, EQUILIBRIUM, CONSTANT, (motion, "")))
    assert run.outcome is Outcome.COMPLETED
    assert run.equilibria[0].stable is None
    assert run.message.startswith("stability is not checked: follower loads have no potential")
    assert "Add inertia = {} to [effects]" in run.message
    write_log(run, tmp_path / "jet.h5")
    assert "stable" not in read_log(tmp_path / "jet.h5").equilibria


@pytest.mark.slow
def test_flutter_grows_in_the_motion_at_the_rate_and_frequency_of_its_mode(tmp_path: Path) -> None:
    found = modes_at_rest(edited(JET, tmp_path, ALONG, CONSTANT))
    (mode,) = (mode for mode in found.modes if mode.grows)
    assert mode.kind == "flutters"
    dynamics, periods = Dynamics(found.scenario.scene), 8
    samples = np.linspace(0.0, periods / mode.frequency, 200 * periods + 1)
    start = dynamics.state(found.rest.coordinates + 1e-7 * mode.coordinates)
    still = cut_into_intervals((Constant(1.0),), float(samples[-1]))
    monitor = Monitor(inspect=inspector(dynamics))
    moved = integrate(dynamics, still, samples, start, Solver("chain", rtol=1e-12, atol=1e-15), monitor)
    y = moved.disk_y[:, -1] - found.rest.tip[1]
    before = np.flatnonzero(np.diff(np.sign(y)) != 0)
    crossings = samples[before] - y[before] * np.diff(samples)[before] / (y[before + 1] - y[before])
    half_period = (crossings[-1] - crossings[1]) / (len(crossings) - 2)
    assert 0.5 / half_period == pytest.approx(mode.frequency * np.sqrt(1 - mode.damping_ratio**2), rel=1e-3)
    peaks = [np.abs(part).max() for part in np.split(y, before + 1)[2:-1]]
    rate = np.log(peaks[-1] / peaks[0]) / ((len(peaks) - 1) * half_period)
    assert rate == pytest.approx(-mode.decay_rates[0], rel=0.01)


def test_command_shows_modes_that_grow(tmp_path: Path) -> None:
    edited(JET, tmp_path, ALONG, CONSTANT)
    arguments = ["modes", str(tmp_path / JET.name), "--out", str(tmp_path)]
    result = CliRunner(env={"COLUMNS": "80"}).invoke(app, arguments)
    assert result.exit_code == 0, result.output
    assert "flutters" in result.stdout
    assert "grows e-fold in" in result.stdout
    assert max(map(len, result.stdout.splitlines()[:-1])) <= 80
