"""What a playback draws, from logs made by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from logs_by_hand import LENGTH, equilibria, motion_log
from playback_entities import entities_of

from continuum_dyn.record import Log
from continuum_dyn.views.playback import heat_map
from continuum_dyn.views.playback.about import about
from continuum_dyn.views.playback.arm import TAUT_WIDTH, moving_parts
from continuum_dyn.views.playback.colors import diverging
from continuum_dyn.views.playback.drawing import Arrows, Drawn, Lines
from continuum_dyn.views.playback.measures import measures_of
from continuum_dyn.views.playback.playback import Playback, names_of, playback_of
from continuum_dyn.views.playback.plots import plots_of
from continuum_dyn.views.playback.recording import record_logs
from continuum_dyn.views.playback.targets import resting_rows
from statics.errors import InputError


def playback_from(log: Log) -> Playback:
    playback = playback_of(log)
    assert playback is not None
    return playback


def drawn(log: Log) -> dict[str, Drawn]:
    playback = playback_from(log)
    return moving_parts(playback, np.arange(len(playback.times)), measures_of([playback]))


def lines(log: Log, entity: str) -> Lines:
    found = drawn(log)[entity]
    assert isinstance(found, Lines)
    return found


# ---- colours ----


def test_curvature_is_blue_one_way_red_the_other_and_white_where_there_is_none() -> None:
    blue, white, red = diverging(np.array([-3.0, 0.0, 3.0]), 3.0).astype(int)
    assert white.tolist() == [0xF7] * 3
    assert blue[2] > 2 * blue[0]
    assert red[0] > 2 * red[2]


def test_each_segment_has_the_colour_of_its_curvature() -> None:
    log = motion_log(2, curvature=np.array([[-4.0, 0.0], [4.0, 2.0]]))
    color = np.asarray(lines(log, "arm/backbone").color)
    expected = diverging(np.array([-4.0, 0.0, 4.0, 2.0]), 4.0)
    assert [(c >> 24 & 255, c >> 16 & 255, c >> 8 & 255) for c in color.tolist()] == [
        tuple(rgb) for rgb in expected.tolist()
    ]


def test_picture_has_time_to_the_right_and_segments_upwards() -> None:
    playback = playback_from(motion_log(2, curvature=np.array([[1.0, 0.0], [0.0, -1.0]])))
    picture = heat_map.picture(playback, measures_of([playback]))
    first, last = diverging(np.array([1.0, 0.0]), 1.0), diverging(np.array([0.0, -1.0]), 1.0)
    assert picture.shape == (heat_map.HEIGHT, heat_map.WIDTH, 3)
    np.testing.assert_array_equal(picture[[-1, 0], 0], first[[0, 1]])
    np.testing.assert_array_equal(picture[[-1, 0], -1], last[[0, 1]])


# ---- cables ----


def test_cable_is_as_wide_as_its_tension_and_dashed_while_it_has_none() -> None:
    log = motion_log(4, tension=np.array([[2.0], [1.0], [0.0], [0.5]]))
    taut, slack = lines(log, "arm/cables/upper"), lines(log, "arm/cables/upper/slack")
    least, most = TAUT_WIDTH
    np.testing.assert_allclose(taut.width, least + (most - least) * np.array([1.0, 0.5, 0.25]))
    assert taut.counts is not None
    assert slack.counts is not None
    assert taut.counts.tolist() == [1, 1, 0, 1]
    assert (slack.counts > 1).tolist() == [False, False, True, False]
    np.testing.assert_allclose(slack.strips[..., 1], 0.008)
    assert 0.3 < np.diff(slack.strips[..., 0]).sum() / LENGTH < 0.7


def test_cable_that_is_never_slack_has_no_dashes() -> None:
    assert "arm/cables/upper/slack" not in drawn(motion_log())


# ---- loads ----

FORCE = "\n[[loads]]\ndisk = 2\nforce = [0.3, 0.4]\n"


def test_dead_force_is_an_arrow_at_its_disk() -> None:
    arrow = drawn(motion_log(3, loads=FORCE))["arm/loads/1/force"]
    assert isinstance(arrow, Arrows)
    np.testing.assert_allclose(arrow.place, [[LENGTH, 0.0]] * 3)
    np.testing.assert_allclose(arrow.vector, [[0.15 * LENGTH, 0.2 * LENGTH]] * 3)


def test_follower_turns_with_its_disk() -> None:
    theta = np.array([[0.0, 0.0], [0.0, np.pi / 2]])
    arrow = drawn(motion_log(2, loads=FORCE + "follower = true\n", disk_theta=theta))["arm/loads/1/force"]
    assert isinstance(arrow, Arrows)
    np.testing.assert_allclose(arrow.vector, LENGTH * np.array([[0.15, 0.2], [-0.2, 0.15]]), atol=1e-12)


def test_driven_load_is_as_large_as_its_factor() -> None:
    factor = '\nfactor = { profile = "ramp", before = 1.0, after = -0.5, start = 0.0, end = 1.0 }\n'
    both = FORCE + FORCE.strip() + factor + "moment = 0.01\n"
    log = motion_log(2, loads=both, load_factor=np.array([[1.0], [-0.5]]))
    arrow = drawn(log)["arm/loads/2/force"]
    assert isinstance(arrow, Arrows)
    np.testing.assert_allclose(arrow.vector, LENGTH * np.array([[0.15, 0.2], [-0.075, -0.1]]))
    assert lines(log, "arm/loads/2/size").labels == ["0.5 N, 0.01 N m", "0.25 N, -0.005 N m"]


def test_round_arrow_turns_the_way_of_its_moment() -> None:
    for moment in (0.02, -0.02):
        arc = lines(motion_log(1, loads=f"\n[[loads]]\ndisk = 2\nmoment = {moment}\n"), "arm/loads/1/moment")
        x, y = (arc.strips[0, :24] - [LENGTH, 0.0]).T
        turned = np.unwrap(np.arctan2(y, x))
        np.testing.assert_allclose(turned[-1] - turned[0], np.sign(moment) * 1.5 * np.pi)


def test_log_without_a_scenario_says_that_loads_are_not_drawn() -> None:
    log = replace(motion_log(loads=FORCE), scenario="")
    assert not any("loads" in entity for entity in drawn(log))
    assert "Loads are not drawn" in about(playback_from(log))


# ---- equilibria of the moment ----


def test_equilibria_of_a_path_belong_to_the_samples_of_their_times() -> None:
    log = motion_log(5)
    times = log.trajectory["time"]
    found = equilibria(np.array([1, 2, 2, 4, 5]), times[[0, 1, 1, 3, 4]], np.ones(5))
    found["stable"][4] = False
    # Row 1 was left for row 2, point 3 was not found, and the last one is unstable.
    assert resting_rows(replace(log, equilibria=found)).tolist() == [0, 2, -1, 3, -1]


def test_equilibria_of_the_ends_belong_to_samples_whose_tension_stays_theirs() -> None:
    tension = np.array([0.0, 0.0, 0.0, 1.0, 2.0, 1.0, 1.0])[:, None]
    log = motion_log(7, tension=tension)
    log = replace(log, equilibria=equilibria(np.array([1, 2]), np.array([0.0, 1.0]), np.array([0.0, 1.0])))
    assert resting_rows(log).tolist() == [0, 0, 0, -1, -1, 1, 1]


def test_equilibrium_of_a_cable_driven_by_its_length_is_known_by_its_displacement() -> None:
    log = motion_log(3, tension=np.array([[5.0], [6.0], [7.0]]))
    found = equilibria(np.array([1, 2]), np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    log = replace(log, equilibria=found, arm={**log.arm, "cable_stiffness": np.array([2e4])})
    assert resting_rows(log).tolist() == [1, 1, 1]


def test_ghost_is_where_the_equilibrium_of_the_moment_is() -> None:
    log = motion_log(4, tension=np.array([[0.0], [0.0], [1.0], [1.0]]))
    log = replace(log, equilibria=equilibria(np.array([1, 2]), np.array([0.0, 1.0]), np.array([0.0, 1.0])))
    ghost = lines(log, "arm/equilibrium")
    np.testing.assert_allclose(ghost.strips[:, -1, 0], LENGTH + np.array([0.0, 0.0, 1e-3, 1e-3]))


def test_tip_is_plotted_with_its_target_and_the_band_that_counts_as_settled() -> None:
    log = motion_log(4, tension=np.array([[0.0], [0.5], [1.0], [1.0]]))
    log = replace(log, equilibria=equilibria(np.array([1, 2]), np.array([0.0, 1.0]), np.array([0.0, 1.0])))
    tip, target, low, high = plots_of(playback_from(log))["tip_x"].series
    np.testing.assert_array_equal(tip.values, 1e3 * LENGTH)  # mm
    np.testing.assert_allclose(target.values, [np.nan, np.nan, 1e3 * LENGTH + 1.0, 1e3 * LENGTH + 1.0])
    np.testing.assert_allclose(high.values - low.values, [np.nan, np.nan, 2.0 * LENGTH, 2.0 * LENGTH])


# ---- several runs ----


def test_runs_are_named_by_as_much_of_their_path_as_it_takes() -> None:
    at = [motion_log(path=path) for path in ("/logs/a.h5", "/logs/b.h5", "/other/a.h5")]
    assert names_of(at[:1]) == [""]
    assert names_of(at[:2]) == ["a", "b"]
    assert names_of(at) == ["logs a", "logs b", "other a"]
    assert names_of([at[0], at[0]]) == ["1 a", "2 a"]


def test_runs_share_a_view_and_a_time_in_colours_and_names_of_their_own(tmp_path: Path) -> None:
    short, long = motion_log(5, path="short.h5"), motion_log(9, path="long.h5", duration=2.0)
    (tmp_path / "both.rrd").write_bytes(record_logs([short, long]))
    entities = entities_of(tmp_path / "both.rrd")
    for log, name in ((short, "short"), (long, "long")):
        plot = entities[f"/series/tension/{name}"]
        times = np.array(plot["sim_time"], dtype="timedelta64[ns]").astype(float) * 1e-9
        np.testing.assert_allclose(times, log.trajectory["time"], atol=1e-6)
        assert plot["SeriesLines:names"] == [[f"{name}: upper"]]
    for entity, column in (
        ("/arm/{}/rim", "LineStrips2D:colors"),
        ("/series/tip_y/{}", "SeriesLines:colors"),
    ):
        first, second = (entities[entity.format(name)][column][0][0] for name in ("short", "long"))
        assert first != second


def test_results_and_scenario_are_told_in_words() -> None:
    log = replace(motion_log(), attributes={"static_gap": 2e-8, "solve_time": 0.003})
    words = about(playback_from(log))
    assert "| tip at the end | x 40.0000 mm, y 0.0000 mm, theta 0.00000 rad |" in words
    assert "| gap to the static equilibrium | 2e-08 m |" in words
    assert log.scenario.strip() in words


def test_motion_and_equilibria_have_no_time_in_common() -> None:
    log = motion_log()
    resting = equilibria(np.array([1, 2]), np.zeros(2), np.ones(2)) | {"disk_theta": np.zeros((2, 2))}
    still = replace(log, path=Path("ramp.h5"), trajectory={}, equilibria=resting)
    with pytest.raises(InputError, match=r"run\.h5 is a motion and ramp\.h5 a sequence of equilibria"):
        record_logs([log, still])
