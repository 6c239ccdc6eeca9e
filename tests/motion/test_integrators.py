"""The chain's own integrator: its stated order, its errors in metres, and what SciPy may expect of it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from conftest import SCENARIOS, motion, moving, rone2012
from scipy.integrate import solve_ivp

from continuum_dyn import Scenario, Trajectory, load_scenario, simulate
from continuum_dyn.effects import Inertia, MaterialDamping, RotaryInertia
from continuum_dyn.integrators import choose
from continuum_dyn.integrators.runge_kutta import start_records, step_once
from continuum_dyn.integrators.scipy_solvers import ChainSolver
from continuum_dyn.integrators.tableau import ESDIRK5, SDIRK4, Tableau, dopri8
from continuum_dyn.passes.dynamics import Dynamics
from continuum_dyn.scenario.intervals import Interval, cut_into_intervals
from continuum_dyn.scenario.profiles import Sine, Step
from continuum_dyn.scenario.solver import Method, Solver
from continuum_dyn.scenario.studies import MotionStudy
from statics import Scene, equilibrium
from statics.kernels.slots import SCALARS


@pytest.fixture(scope="module")
def step_response() -> Scenario:
    return load_scenario(SCENARIOS / "step_response.toml")


def tip_error(found: Trajectory, reference: Trajectory) -> float:
    """Largest distance of the tips over all samples, m."""
    apart = [getattr(found, name)[:, -1] - getattr(reference, name)[:, -1] for name in ("disk_x", "disk_y")]
    return float(np.hypot(*apart).max())


def order_conditions(a: np.ndarray, b: np.ndarray) -> dict[int, list[float]]:
    """What Butcher's conditions up to order 5 leave over. Hairer, Norsett and Wanner 1993, table II.2.2."""
    c = a.sum(axis=1)
    return {
        1: [b.sum() - 1],
        2: [b @ c - 1 / 2],
        3: [b @ c**2 - 1 / 3, b @ a @ c - 1 / 6],
        4: [b @ c**3 - 1 / 4, (b * c) @ a @ c - 1 / 8, b @ a @ c**2 - 1 / 12, b @ a @ a @ c - 1 / 24],
        5: [
            b @ c**4 - 1 / 5,
            (b * c**2) @ a @ c - 1 / 10,
            b @ (a @ c) ** 2 - 1 / 20,
            (b * c) @ a @ c**2 - 1 / 15,
            b @ a @ c**3 - 1 / 20,
            (b * c) @ a @ a @ c - 1 / 30,
            b @ a @ (c * (a @ c)) - 1 / 40,
            b @ a @ a @ c**2 - 1 / 60,
            b @ a @ a @ a @ c - 1 / 120,
        ],
    }


def at_infinity(tableau: Tableau, b: np.ndarray) -> float:
    """Absolute stability function at z = -1e6."""
    ones, z = np.ones(len(b)), -1e6
    return float(abs(1 + z * b @ np.linalg.solve(np.eye(len(b)) - z * tableau.a, ones)))


def test_tableau_has_its_order_and_is_stiffly_accurate_and_l_stable() -> None:
    b, embedded = ESDIRK5.a[-1], ESDIRK5.a[-1] - ESDIRK5.error_weights
    left_over, embedded_left_over = order_conditions(ESDIRK5.a, b), order_conditions(ESDIRK5.a, embedded)
    assert max(abs(x) for order in left_over for x in left_over[order]) < 1e-14
    assert max(abs(x) for order in range(1, 5) for x in embedded_left_over[order]) < 1e-14
    assert max(abs(x) for x in embedded_left_over[5]) > 1e-5
    np.testing.assert_allclose(ESDIRK5.a @ ESDIRK5.c, ESDIRK5.c**2 / 2, atol=1e-15)  # stage order 2
    assert ESDIRK5.c[-1] == pytest.approx(1.0)
    assert at_infinity(ESDIRK5, b) < 1e-4
    z = 1j * np.logspace(-2, 4, 300)
    grown = [abs(1 + s * b @ np.linalg.solve(np.eye(len(b)) - s * ESDIRK5.a, np.ones(len(b)))) for s in z]
    assert max(grown) < 1 + 1e-12


def fixed_steps(
    dynamics: Dynamics, interval: Interval, y: np.ndarray, count: int, tableau: Tableau
) -> np.ndarray:
    """The state at the span's end after ``count`` equal steps."""
    kernel, segments, disks = dynamics.motion
    arm = (interval.pieces, segments, disks)
    shape = (count + 1, dynamics.scene.arm.disks, dynamics.dofs)
    records = (np.empty(shape[0]), np.empty((shape[0], y.size)), np.empty(shape), np.empty((shape[0], 3, 2)))
    method = (tableau.a, tableau.c, tableau.error_weights, tableau.predictor, 0.0, np.inf)
    n, dofs = shape[1:]
    stages = tuple(np.empty((len(tableau.c), n, dofs)) for _ in range(3))
    workspace = np.empty((n, kernel.widths["chain"])), np.empty((6, n, dofs)), np.empty(SCALARS)
    start_records(kernel.passes, interval.start, y, arm, records)
    times, states, accelerations, _ = records
    h = (interval.end - interval.start) / count
    for row in range(count):
        stages[2][0] = accelerations[row]
        arguments = (1e-11, arm, stages, workspace, states[row + 1])
        step_once(kernel.passes, times[row], h, states[row], 0.1, method, *arguments)
        times[row + 1], accelerations[row + 1] = times[row] + h, stages[2][-1]
    return states[-1, : 2 * dynamics.size]


@pytest.mark.parametrize(
    ("tableau", "order", "counts"),
    [
        (ESDIRK5, 5, (28, 40, 56, 80, 112)),
        (SDIRK4, 4, (28, 40, 56, 80, 112)),
        (dopri8(), 8, (24, 28, 34, 40, 48)),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_steps_of_fixed_size_have_the_stated_order(
    tableau: Tableau, order: int, counts: tuple[int, ...]
) -> None:
    plain = rone2012(disks=2)
    effects = [effect for effect in plain.effects if effect.name != "extension"]
    hardly_damped = MaterialDamping(retardation_time=1e-9)  # more would be stiff, and stiffness costs order
    scene = Scene(plain.arm, (*effects, Inertia(), RotaryInertia(), hardly_damped))
    dynamics, (interval,) = Dynamics(scene), cut_into_intervals((Sine(1.0, 0.9, 9.0),), 0.04)
    y = dynamics.state(equilibrium(scene, 0.3).coordinates)
    reference = fixed_steps(dynamics, interval, y, 1280, ESDIRK5)
    scale = dynamics.scales()[: 2 * dynamics.size]
    errors = [
        np.abs((fixed_steps(dynamics, interval, y, n, tableau) - reference) / scale).max() for n in counts
    ]
    assert np.polyfit(np.log(counts), np.log(errors), 1)[0] == pytest.approx(-order, abs=0.4)


@pytest.mark.slow
def test_tip_error_follows_the_tolerance(step_response: Scenario) -> None:
    brief = replace(step_response, study=MotionStudy(0.1, samples=101))
    reference = motion(replace(brief, solver=Solver("Radau", rtol=1e-11, atol=1e-14)))
    errors = {}
    for rtol in (1e-5, 1e-6, 1e-7, 1e-8, 1e-9):
        found = motion(replace(brief, solver=Solver("chain", rtol=rtol, atol=1e-14)))
        errors[rtol] = tip_error(found, reference) / (rtol * 0.08)
    assert max(errors.values()) < 300
    assert min(errors.values()) > 0.1


@pytest.mark.slow
def test_two_methods_agree_on_a_reference_to_a_tenth_of_a_nanometre(step_response: Scenario) -> None:
    chain = motion(replace(step_response, solver=Solver("chain", rtol=1e-12, atol=1e-14)))
    radau = motion(replace(step_response, solver=Solver("Radau", rtol=1e-12, atol=1e-15)))
    assert tip_error(chain, radau) < 1e-10


def test_power_ledger_of_the_chain_closes_with_its_tolerance(step_response: Scenario) -> None:
    gaps = []
    for rtol in (1e-6, 1e-8, 1e-10):
        trajectory = motion(replace(step_response, solver=Solver("chain", rtol=rtol, atol=1e-14)))
        gaps.append(np.abs(trajectory.ledger_gap).max() / trajectory.ledger["input_work"].max())
    assert np.all(np.array(gaps) < [2.5e-4, 1e-5, 3e-7])


def test_number_of_steps_does_not_depend_on_the_number_of_segments() -> None:
    steps = [motion(release(disks)).counters["steps"] for disks in (4, 16, 64, 256)]
    assert max(steps) < 1.3 * min(steps)


def release(disks: int, method: Method = "chain") -> Scenario:
    step = (Step(before=0.0, after=1.0),)
    return Scenario(moving(rone2012(disks=disks)), step, MotionStudy(0.2, samples=201), Solver(method))


def test_work_is_counted_in_segment_evaluations(step_response: Scenario) -> None:
    counters = motion(step_response).counters
    assert counters["segment_evaluations"] == 4 * counters["newton_iterations"]
    stages = len(ESDIRK5.c) - 1
    assert stages * counters["steps"] <= counters["newton_iterations"] < 2 * stages * counters["steps"]
    assert counters["rejections"] < 0.2 * counters["steps"]
    assert counters["steps"] < 150


def by_solve_ivp(scenario: Scenario, **options: Any) -> Any:
    dynamics, (interval,) = Dynamics(scenario.scene), cut_into_intervals(scenario.profiles, 0.2)
    y = dynamics.state(equilibrium(scenario.scene, scenario.initial_inputs).coordinates)
    asked = {"dynamics": dynamics, "intervals": [interval], "tolerance": 1e-8, "first_step": 1e-4}
    return solve_ivp(
        lambda t, y: dynamics.rate(t, y, interval), (0.0, 0.2), y, ChainSolver, **asked, **options
    )


@pytest.mark.parametrize("disks", [4, 30])
def test_chain_solver_is_one_of_scipys(disks: int) -> None:
    """Dense output passes through the steps, and sampling does not change them."""
    scenario = release(disks)
    plain = by_solve_ivp(scenario, dense_output=True)
    assert plain.success
    np.testing.assert_allclose(plain.sol(plain.t), plain.y, rtol=1e-12, atol=1e-15)
    at = np.linspace(0.0, 0.2, 57)
    sampled = by_solve_ivp(scenario, t_eval=at)
    assert sampled.nfev == plain.nfev
    np.testing.assert_array_equal(sampled.t, at)
    np.testing.assert_allclose(sampled.y, plain.sol(at), rtol=1e-12, atol=1e-15)


def test_dense_output_is_of_at_least_third_order(step_response: Scenario) -> None:
    """Between the ends of its steps the interpolant stays as close to the motion as at them."""
    fine = motion(replace(step_response, solver=Solver("chain", rtol=1e-11, atol=1e-14)))
    for rtol in (1e-6, 1e-8):
        found = motion(replace(step_response, solver=Solver("chain", rtol=rtol, atol=1e-14)))
        assert found.counters["steps"] < found.time.size / 5
        assert tip_error(found, fine) < 300 * rtol * 0.08
        rates = np.abs(found.bend_angle_rate - fine.bend_angle_rate).max()
        assert rates < 3e5 * rtol


def test_jump_at_the_start_is_resolved_though_the_axial_modes_are_fast(step_response: Scenario) -> None:
    brief = replace(step_response, study=MotionStudy(2e-5, samples=41))
    chain = motion(replace(brief, solver=Solver("chain", rtol=1e-9, atol=1e-14)))
    radau = motion(replace(brief, solver=Solver("Radau", rtol=1e-11, atol=1e-15)))
    assert chain.elongation is not None
    assert radau.elongation is not None
    np.testing.assert_allclose(chain.elongation, radau.elongation, atol=2e-3 * np.ptp(radau.elongation))


def chosen(scene: Scene, duration: float = 1.0, exact: bool = False) -> str:
    dynamics = Dynamics(scene)
    start = dynamics.state(equilibrium(scene, 0.0).coordinates)
    return choose(
        dynamics, start, cut_into_intervals((Step(0.0, 1.0),), duration).first, duration, exact
    ).method


def without_extension(disks: int) -> Scene:
    scene = moving(rone2012(disks=disks))
    return Scene(scene.arm, (effect for effect in scene.effects if effect.name != "extension"))


def test_auto_goes_by_the_motions_own_modes() -> None:
    damped, free = moving(rone2012()), moving(rone2012(), damping=False)
    undamped = Scene(free.arm, (*free.effects, MaterialDamping(retardation_time=0.0)))
    assert chosen(damped) == "chain"
    assert [chosen(without_extension(disks)) for disks in (1, 3, 4)] == ["explicit", "chain", "chain"]
    assert [chosen(scene) for scene in (free, undamped)] == ["explicit", "explicit"]
    assert [chosen(free, 1e4), chosen(free, 1e4, exact=True)] == ["midpoint", "explicit"]


@pytest.mark.slow
def test_undamped_motion_keeps_its_energy_under_auto() -> None:
    free = moving(rone2012(), damping=False)
    released = Scenario(free, (Step(before=2.0, after=0.0),), MotionStudy(0.01, samples=11))
    for rtol, kept in ((1e-7, 1e-4), (1e-10, 1e-6)):
        run = simulate(replace(released, solver=Solver("auto", rtol)))
        assert run.solver is not None
        assert run.trajectory is not None
        assert run.solver.method == "explicit"
        assert np.abs(run.trajectory.ledger_gap).max() < kept * run.trajectory.ledger["kinetic_energy"].max()


def test_explicit_method_agrees_with_the_implicit_one_where_both_can() -> None:
    scenario = Scenario(without_extension(2), (Step(0.0, 1.0),), MotionStudy(0.3, samples=301))
    found = motion(replace(scenario, solver=Solver("explicit", rtol=1e-9, atol=1e-12)))
    reference = motion(replace(scenario, solver=Solver("chain", rtol=1e-12, atol=1e-14)))
    assert tip_error(found, reference) < 1e-9


def test_explicit_steps_at_the_edge_of_stability_do_not_shiver(step_response: Scenario) -> None:
    """Errors within the tolerance, but of the axial modes' rates, dissipated more than the motion had."""
    brief = replace(step_response, study=MotionStudy(2e-3, samples=11), solver=Solver("explicit"))
    run = simulate(brief)
    assert run.trajectory is not None
    assert np.abs(run.trajectory.ledger_gap).max() < 1e-5 * run.trajectory.largest_energy
