"""Replays as arrays, judged by configurations and closed forms."""

import math

import numpy as np
import pytest

import clearance
from clearance.testing import assert_min_distance

CELL = """name: arm and wall
units: {length: m, angle: rad}
rate_hz: 100
robots: [{name: arm, urdf: planar.urdf}]
objects:
  - {name: wall, fixed: true, box: {size: [0.2, 4, 4]}, pose: {xyz: [3.1, 0, 0]}}
pairs: [{between: [arm, wall], publish: true}]
zones: [{name: stop, between: [lower, wall], enter_below: 1.0, leave_above: 1.05}]
"""
COUNT = 200


@pytest.fixture
def cell(planar_file):
    file = planar_file.parent / "wall.yaml"
    file.write_text(CELL)
    return clearance.Cell(file)


@pytest.fixture
def joints():
    at = np.linspace(0, 2 * np.pi, COUNT)
    return np.stack([0.8 * np.sin(at), 0.5 * np.cos(at)], axis=1)


@pytest.fixture
def recording(tmp_path, joints):
    file = tmp_path / "run.csv"
    rows = [f"{1_000_000_000 + 10_000_000 * i},{a:.17g},{b:.17g}" for i, (a, b) in enumerate(joints)]
    file.write_text("t_ns,shoulder,elbow\n" + "\n".join(rows) + "\n")
    return file


def test_each_tick_has_the_distances_of_its_configuration(cell, joints, recording):
    ticks = clearance.replay(cell, recording, tick_hz=0)
    assert isinstance(ticks, np.recarray) and len(ticks) == COUNT
    exact = cell.distances(joints)
    assert ticks.distance.shape == (COUNT, 2)
    assert np.all(ticks.lower <= exact.upper) and np.all(exact.lower <= ticks.upper)
    assert np.all(ticks.status == 0)
    np.testing.assert_allclose(ticks.time_s, 0.01 * np.arange(COUNT), atol=1e-9)
    np.testing.assert_array_equal(ticks.cycle, 1 + np.arange(COUNT))
    column = next(i for i, pair in enumerate(cell.pairs) if "lower" in pair)
    assert np.all(ticks.minimum_pair == column)
    inside = exact.distance[:, column] < 1.0
    assert inside.any()
    assert np.all(ticks.zone_active[inside, 0]) and not ticks.zone_active.all()


# The shoulder turns at 0.5 rad/s, and goes on for 50 ms and then for at most 200 ms. From 1.062 m, the arm comes to 0.978 m.
def test_a_replay_has_how_each_robot_stops(planar_file, tmp_path):
    file = planar_file.parent / "stops.yaml"
    stopping = "urdf: planar.urdf, stopping: {reaction_ms: 40, path: kept, time_ms: 200}"
    zones = "leave_above: 1.05}, {name: stops, between: [lower, wall], stops: {margin: 1}}]"
    file.write_text(CELL.replace("urdf: planar.urdf", stopping).replace("leave_above: 1.05}]", zones))
    cell = clearance.Cell(file)
    run = tmp_path / "run.csv"
    rows = [f"{1_000_000_000 + 10_000_000 * i},{-1 + 0.005 * i},0.5,0,0" for i in range(120)]
    run.write_text("t_ns,shoulder,shoulder/velocity,elbow,elbow/velocity\n" + "\n".join(rows) + "\n")
    ticks = clearance.replay(cell, run, tick_hz=0)
    assert ticks.stop_scaling.shape == (120, 1) and ticks.stop_lower.shape == ticks.lower.shape
    assert np.all(ticks.stop_validity == 2) and np.all(ticks.stop_lower <= ticks.lower)
    assert ticks.stop_scaling[0, 0] == 1 and ticks.stop_share[0, 0] == 1 and 0.6 < ticks.stop_scaling[-1, 0] < 0.63
    assert set(cell.pairs[ticks.stop_pair[-1, 0]]) == {"lower", "wall"}
    assert np.all((ticks.stop_time >= 0.24) & (ticks.stop_time <= 0.26))
    np.testing.assert_allclose(ticks.stop_clearance[-1, 0], ticks.stop_lower[-1].min() - 1.0, atol=1e-12)


def test_a_window_leaves_the_other_ticks_out(cell, recording):
    ticks = clearance.replay(cell, recording, tick_hz=0, start_s=0.5, end_s=1.0)
    assert 49 <= len(ticks) <= 51


def test_the_records_outlive_everything_else(cell, recording):
    lower = clearance.replay(cell, recording).lower_all
    del cell
    assert np.isfinite(lower).any()


def test_the_helper_passes_what_is_far_enough_and_names_what_is_not(cell, joints, recording):
    least = cell.distances(joints).distance.min()
    # Bounds for the time between two ticks are lower by the curvature of the path.
    check = assert_min_distance(recording, cell, least - 1e-3)
    assert check.ok and check.ticks > 0
    assert math.isclose(check.closest_distance, least, abs_tol=1e-9)
    with pytest.raises(AssertionError, match="lower.*wall|wall.*lower"):
        assert_min_distance(recording, cell, least + 1e-6)


def test_the_helper_fails_for_a_zone_that_was_active(cell, recording):
    with pytest.raises(AssertionError, match="stop"):
        assert_min_distance(recording, cell, 0.0, no_zone=["stop"])


def test_the_helper_fails_if_nothing_was_ever_known(cell, tmp_path):
    file = tmp_path / "half.csv"
    file.write_text("t_ns,shoulder\n1000000000,0.1\n1010000000,0.1\n")
    with pytest.raises((AssertionError, clearance.ReplayError)):
        assert_min_distance(file, cell, 0.0)


def test_the_helper_reads_the_cell_by_its_name(planar_file, recording, cell):
    assert assert_min_distance(str(recording), str(planar_file.parent / "wall.yaml"), 0.1).ok


@pytest.mark.parametrize(
    "arguments, error",
    [
        ({"recording": "/nowhere/run.mcap"}, clearance.ReplayError),
        ({"start_s": math.nan}, ValueError),
        ({"tick_hz": -1.0}, ValueError),
        ({"tick_hz": math.nan}, ValueError),
        ({"joints": {"nothing": 1.0}}, clearance.ReplayError),
        ({"joints": 5}, TypeError),
        ({"recording": 7}, TypeError),
        ({"cell": None}, TypeError),
    ],
)
def test_a_wrong_argument_is_an_exception(cell, recording, arguments, error):
    with pytest.raises(error):
        clearance.replay(**{"cell": cell, "recording": recording, **arguments})


def test_an_expectation_that_is_no_number_is_refused(cell, recording):
    with pytest.raises(ValueError):
        clearance.check_replay(cell, recording, math.nan)
    with pytest.raises((clearance.ReplayError, ValueError)):
        clearance.check_replay(cell, recording, no_zone=["nothing"])
