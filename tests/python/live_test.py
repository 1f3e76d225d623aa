"""A running daemon as a Python program meets it, on loopback and in a partition of its own."""

import faulthandler
import time

import numpy as np
import pytest

import clearance
from clearance import CommandStatus

LIMIT_S = 30.0  # only a broken program takes longer
ARM = ["shoulder", "elbow"]


def eventually(report_of, is_so):
    """The first report for which it is so."""
    end = time.monotonic() + LIMIT_S
    while time.monotonic() < end:
        report = report_of()
        if report is not None and is_so(report):
            return report
    raise AssertionError(f"not within {LIMIT_S} s: {report}")


@pytest.fixture
def daemon(run_daemon, planar_file):
    return run_daemon(planar_file)


def test_a_robot_and_an_object_are_told_and_their_distances_come_back(daemon):
    connection = daemon.connection()
    with clearance.Reports(connection) as reports, clearance.JointWriter(
        "python joints", ARM, connection
    ) as arm, clearance.PoseWriter("python poses", ["ball"], connection) as ball:
        assert arm.wait_heard(LIMIT_S) and ball.wait_heard(LIMIT_S)

        def sent_and_heard():
            arm.write([0.0, np.pi / 2], [0.0, 0.0])
            ball.write([[1.0, 1.0, 1.0, 0, 0, 0, 1]], [[0] * 6])
            return reports.next(0.05)

        report = eventually(sent_and_heard, lambda r: r.unknown == 0 and None not in r.pair_names)
        # The tip is at (1, 1, 0): spheres of 0.1 and 0.25 m, and a wall at x = 3.
        closed_forms = {
            ("lower", "ball"): 0.65,
            ("wall", "lower"): 1.9,
            ("wall", "upper"): 1.9,
            ("ball", "wall"): 1.75,
        }
        assert len(report.pairs) == len(report.pair_names) == 4
        for pair, truth in closed_forms.items():
            row = report[pair]
            assert row["lower"] <= truth + 1e-9 and row["upper"] >= truth - 1e-9
            assert row["pair"] == report[pair[::-1]]["pair"]
        assert set(report.minimum_names) == {"lower", "ball"} and report.minimum_known
        assert report.minimum["distance"] == pytest.approx(0.65, abs=1e-9)
        np.testing.assert_allclose(report[("lower", "ball")]["witness_a"][:2], [1, 1], atol=1e-9)
        assert report.fresh and report.age_s < 1 and report.cycle > 0 and report.revision != 0
        assert report.pairs_total == 4 and reports.refusal == ""
        # A daemon that was held up for its lease counts again with its next tick.
        eventually(lambda: reports.daemons, lambda daemons: daemons == 1)
        with pytest.raises(KeyError):
            report[("lower", "nothing")]
        before = report.cycle
        later = eventually(lambda: reports.newest(0.05), lambda r: r.cycle > before)
        assert later.revision == report.revision and not later.other_daemon


def test_gradients_and_zones_and_health_come_beside_the_reports(run_daemon, planar_file):
    daemon = run_daemon(planar_file, "--gradients")
    connection = daemon.connection()
    with clearance.Reports(connection, gradients=True, separation=True) as reports, clearance.JointWriter(
        "python joints", ARM, connection
    ) as arm, clearance.PoseWriter("python poses", ["ball"], connection) as ball:
        assert arm.wait_heard(LIMIT_S) and ball.wait_heard(LIMIT_S)
        q1, q2 = 0.3, 0.9

        def sent_and_heard():
            arm.write([q1, q2], [0.0, 0.0])
            ball.write([[1.0, 1.0, 5.0, 0, 0, 0, 1]], [[0] * 6])
            return reports.next(0.05)

        report = eventually(
            sent_and_heard, lambda r: r.unknown == 0 and r.gradients is not None and None not in r.pair_names
        )
        assert report.joints == ARM and report.zone_names == ["stop"]
        assert report.gradients.shape == (len(report.pairs), 2) and report.drifts.shape == (4,)
        rows = {frozenset(names): row for names, row in zip(report.pair_names, report.gradients)}
        # The wall is at x = 3, the tip at x = cos(q1) + cos(q1 + q2), the elbow at cos(q1).
        elbow, tip = np.sin(q1), np.sin(q1 + q2)
        truths = {("lower", "wall"): [elbow + tip, tip], ("upper", "wall"): [elbow, 0.0]}
        for pair, truth in truths.items():
            # A pair whose bounds were carried in this tick has no gradient.
            np.testing.assert_allclose(rows[frozenset(pair)], truth, atol=1e-9)
        assert np.isnan(rows[frozenset(("ball", "wall"))]).all()  # no joint moves it
        assert report.separated_zones is None and report.separated_pairs is None

        def told():
            sent_and_heard()
            return reports.zones.get("stop")

        stop = eventually(told, lambda zone: not zone["active"])
        assert stop["cause"] == 0 and stop["clearance"] > 0.25 and stop["cycle"] > 0

        def near():
            arm.write([0.0, 0.0], [0.0, 0.0])
            reports.next(0.05)
            return reports.zones["stop"]

        # The tip is at x = 2 and the wall 0.9 m from it, so a nearer wall makes the zone active.
        with clearance.Commands("python tests", connection) as commands:
            assert commands.send("- place: {object: wall, pose: {xyz: [2.25, 0, 0]}}", LIMIT_S).done
        stop = eventually(near, lambda zone: zone["active"] and zone["cause"] == 1)
        assert stop["clearance"] < 0.2

        def healthy():
            sent_and_heard()
            return reports.health

        health = eventually(healthy, lambda h: any(s["source"] == "python joints" for s in h["sources"]))
        assert health["cycle"] > 0 and health["recording"] == "" and health["tick_p50_us"] > 0
        assert {joint["name"] for joint in health["joints"]} == set(ARM)
        assert "ball" in {one["name"] for one in health["inputs"]}


PERSON_AND_ROBOT = """name: hall
units: {length: m, angle: deg}
rate_hz: 200
defaults: {age_limit_ms: 10000}
objects:
  - {name: person, sphere: {radius: 0.2}}
  - {name: robot, sphere: {radius: 0.1}}
pairs: [{between: [person, robot]}]
zones:
  - name: people
    between: [person, robot]
    enter_below: 0.3
    leave_above: 0.4
    separation: {human: person, reaction_time_ms: 100, stopping_time_ms: 250,
                 stopping_distance: 0.125, stopping_speed: 1, intrusion_distance: 0.1}
"""


def test_separations_belong_to_the_tick_of_their_report(run_daemon, tmp_path):
    (tmp_path / "hall.yaml").write_text(PERSON_AND_ROBOT)
    connection = run_daemon(tmp_path / "hall.yaml").connection()
    with clearance.Reports(connection, separation=True) as reports, clearance.PoseWriter(
        "python poses", ["person", "robot"], connection
    ) as poses:
        assert poses.wait_heard(LIMIT_S)

        def sent_and_heard():
            poses.write([[2, 0, 0, 0, 0, 0, 1], [0, 0, 0, 0, 0, 0, 1]], [[0] * 6] * 2)
            return reports.next(0.05)

        report = eventually(
            sent_and_heard,
            lambda r: r.separated_zones is not None and r.separated_zones[0]["validity"] == 2,
        )
        [zone], [pair] = report.separated_zones, report.separated_pairs
        assert zone["scaling"] == 1.0 and report.zone_names == ["people"]
        # 2 m from centre to centre less both radii. S_p: C, and 1.6 m/s for the reaction time and the
        # age of the person's pose.
        assert pair["clearance"] == pytest.approx(1.7, abs=1e-9)
        age_s = 1e-9 * pair["age_human_ns"]
        assert pair["protective_distance"] == pytest.approx(0.1 + 1.6 * (0.1 + age_s), abs=1e-9)
        assert pair["remaining"] == pytest.approx(pair["clearance"] - pair["protective_distance"], abs=1e-9)


def test_stops_belong_to_the_tick_of_their_report(run_daemon, planar_file):
    stopping = planar_file.read_text().replace("urdf: planar.urdf", "urdf: planar.urdf, stopping: {reaction_ms: 50, time_ms: 200}")
    planar_file.write_text(stopping.replace("max_speed: 100", "max_speed: 1"))
    connection = run_daemon(planar_file).connection()
    with clearance.Reports(connection, separation=True) as reports, clearance.JointWriter(
        "python joints", ARM, connection
    ) as arm, clearance.PoseWriter("python poses", ["ball"], connection) as ball:
        assert arm.wait_heard(LIMIT_S) and ball.wait_heard(LIMIT_S)
        report = eventually(lambda: reports.next(0.05), lambda r: r.stops is not None)
        assert report.stops[0]["validity"] == 0 and report.stops[0]["scaling"] == 0.0

        def sent_and_heard():
            arm.write([0.0, np.pi / 2], [0.0, 0.0])
            ball.write([[1.0, 1.0, 1.0, 0, 0, 0, 1]], [[0] * 6])
            return reports.next(0.05)

        report = eventually(sent_and_heard, lambda r: r.stops is not None and r.stops[0]["validity"] == 2)
        [stop] = report.stops
        assert stop["robot"] == 0 and stop["scaling"] == 1.0 and stop["share"] == 1.0
        # The arm stands, and the ball comes nearer by 1 m/s until it would stand.
        row = report[("lower", "ball")]
        assert 0 < row["stop_lower"] < row["lower"]
        assert np.isnan(report[("ball", "wall")]["stop_lower"])


def test_commands_change_the_scene_and_refusals_say_why(daemon):
    connection = daemon.connection()
    with clearance.Commands("python tests", connection) as commands, clearance.Reports(
        connection
    ) as reports:
        moved = "- place: {object: wall, pose: {xyz: [5.1, 0, 0]}}"
        assert commands.send(moved, LIMIT_S, dry_run=True).status is CommandStatus.DONE
        done = commands.send(moved, LIMIT_S)
        assert done.done and done.revision != 0 and done.in_force_from > 0
        eventually(lambda: reports.next(0.1), lambda r: r.revision == done.revision)
        refused = commands.send("- remove_object: {object: ball}", LIMIT_S)
        assert refused.status is CommandStatus.REFUSED and refused.reason and not refused.done
        stale = commands.send(moved, LIMIT_S, revision=1)
        assert stale.status is CommandStatus.OTHER_REVISION
        with pytest.raises(ValueError, match="plce"):
            commands.send("- plce: {object: wall}", LIMIT_S)
        with pytest.raises(ValueError):
            commands.send("- place: {object: wall}", -1)


def test_an_unknown_object_of_poses_is_named(daemon):
    with clearance.PoseWriter("python", ["nothing"], daemon.connection()) as writer:
        assert writer.wait_heard(LIMIT_S)
        end = time.monotonic() + LIMIT_S
        with pytest.raises(KeyError, match="nothing"):
            while time.monotonic() < end:
                writer.write([[0, 0, 0, 0, 0, 0, 1]])


def test_a_writer_has_each_joint_and_each_object_once(daemon):
    with pytest.raises(ValueError, match="the object 'ball' twice"):
        clearance.PoseWriter("python", ["ball", "ball"], daemon.connection())
    with pytest.raises(ValueError, match="the joint 'a' twice"):
        clearance.JointWriter("python", ["a", "b", "a"], daemon.connection())


def test_a_daemon_that_ends_is_noticed(daemon):
    with clearance.Reports(daemon.connection()) as reports:
        eventually(lambda: reports.next(0.1), lambda _: not reports.fail_safe)
        assert reports.reason == clearance.ReportError.GOOD and not reports.is_held
        daemon.end()
        end = time.monotonic() + LIMIT_S
        while not reports.has_ended and time.monotonic() < end:
            reports.next(0.05)
        assert reports.has_ended and reports.fail_safe
        assert reports.reason != clearance.ReportError.GOOD and not reports.is_held


def test_two_partners_are_one_stream_that_says_when_one_is_missing(run_daemon, planar_file):
    left = run_daemon(planar_file, "--partner", "left")
    right = run_daemon(planar_file, "--partner", "right", partition=left.partition)
    with clearance.Reports(left.connection()) as reports:
        eventually(lambda: reports.next(0.1), lambda r: r.partner == "agrees")
        times = [reports.next(1.0).now_ns for _ in range(50)]
        assert times == sorted(set(times)), "a report comes once, and none after a newer one"
        right.process.kill()
        report = eventually(lambda: reports.next(0.1), lambda r: r.partner == "missing")
        assert report.pair_names


@pytest.fixture
def limited():
    """Ends the program where a call does not come back, which no signal of Python could end."""
    faulthandler.dump_traceback_later(2 * LIMIT_S, exit=True)
    yield
    faulthandler.cancel_dump_traceback_later()


# The leader alone sends gradients, and the reports of both partners are merged.
def test_gradients_of_partners_come_with_the_reports_of_both(run_daemon, planar_file, limited):
    left = run_daemon(planar_file, "--gradients", "--partner", "left")
    run_daemon(planar_file, "--gradients", "--partner", "right", partition=left.partition)
    connection = left.connection()
    with clearance.Reports(connection, gradients=True) as reports, clearance.JointWriter(
        "python joints", ARM, connection
    ) as arm:
        assert arm.wait_heard(LIMIT_S)
        q1, q2 = 0.3, 0.9
        of = set()

        def sent_and_heard():
            arm.write([q1, q2], [0.0, 0.0])
            began = time.monotonic()
            report = reports.next(0.1)
            assert time.monotonic() - began < 5.0
            return report

        def is_told_for_both(report):
            if report.partner != "agrees" or report.gradients is None or None in report.pair_names:
                return False
            rows = {frozenset(names): row for names, row in zip(report.pair_names, report.gradients)}
            row = rows[frozenset(("upper", "wall"))]
            if not np.isnan(row).any():
                np.testing.assert_allclose(row, [np.sin(q1), 0.0], atol=1e-9)
                of.add(report.daemon)
            return len(of) == 2

        eventually(sent_and_heard, is_told_for_both)
