"""A cell in shares as a Python program meets it: a daemon for each share, joined by SharedCell."""

import math
import signal
import time

import numpy as np
import pytest
from conftest import PLANAR_ARM, PLANAR_CELL

import clearance
from clearance import PairStatus, ShareState

LIMIT_S = 30.0  # only a broken program takes longer
LATE_S = 0.5
ARM = ["shoulder", "elbow"]
SHARES = """shares:
  - {name: arm, pairs: [{between: [arm, wall]}]}
  - {name: ball, pairs: [{between: [lower, ball]}, {between: [ball, wall]}]}
"""


class Hall:
    """The daemons of both shares, and what sends the inputs."""

    def __init__(self, run_daemon, file, *more):
        self.run, self.file, self.partition = run_daemon, file, None
        self.daemons = {}
        for share in ("arm", "ball"):
            self.start(share, *more)
        self.connection = self.daemons["arm"].connection()
        self.whole = clearance.SharedCell(self.connection, late_after_s=LATE_S, gradients="--gradients" in more)
        self.arm = clearance.JointWriter("python joints", ARM, self.connection)
        one = self.daemons["ball"].connection(share="ball")  # a share has the names of the whole cell
        self.ball = clearance.PoseWriter("python poses", ["ball"], one)

    def start(self, share, *more):
        daemon = self.run(self.file, "--share", share, *more, partition=self.partition)
        self.daemons[share], self.partition = daemon, daemon.partition
        return daemon

    def next(self):
        self.arm.write([0.0, np.pi / 2], [0.0, 0.0])
        self.ball.write([[1.0, 1.0, 1.0, 0, 0, 0, 1]], [[0] * 6])
        return self.whole.next(0.05)

    def until(self, is_so):
        end = time.monotonic() + LIMIT_S
        report = None
        while time.monotonic() < end:
            report = self.next() or report
            if report is not None and is_so(report):
                return report
        raise AssertionError(f"not within {LIMIT_S} s: {report}, {self.whole.what_is_missing}")

    def until_known(self):
        return self.until(lambda r: self.whole.is_whole and r.unknown == 0 and None not in r.pair_names)


@pytest.fixture
def shared_file(tmp_path):
    (tmp_path / "planar.urdf").write_text(PLANAR_ARM)
    (tmp_path / "planar.yaml").write_text(PLANAR_CELL + SHARES)
    return tmp_path / "planar.yaml"


@pytest.fixture
def hall(run_daemon, shared_file):
    return Hall(run_daemon, shared_file)


def test_all_shares_are_one_report_with_one_minimum_and_one_health(hall):
    report = hall.until_known()
    # The tip is at (1, 1, 0): spheres of 0.1 and 0.25 m, and a wall at x = 3.
    closed_forms = {
        ("lower", "ball"): 0.65,
        ("wall", "lower"): 1.9,
        ("wall", "upper"): 1.9,
        ("ball", "wall"): 1.75,
    }
    assert len(report.pairs) == len(report.pair_names) == report.pairs_total == 4
    for pair, truth in closed_forms.items():
        row = report[pair]
        assert row["lower"] <= truth + 1e-9 and row["upper"] >= truth - 1e-9
    report = hall.until(lambda r: r.minimum_certified)
    assert set(report.minimum_names) == {"lower", "ball"}
    assert report.lower_all == pytest.approx(0.65, abs=1e-9)
    assert report.fresh and report.partner == "alone"
    assert hall.whole.what_is_missing == "" and set(hall.whole.shares) == {"arm", "ball"}
    for share in hall.whole.shares.values():
        assert share["state"] is ShareState.WHOLE and share["revision"] == report.revision
        assert 0 <= share["age_s"] < LATE_S and share["daemon"] != 0 and share["partner"] == "alone"
    assert not hall.whole.zones["stop"]["active"] and hall.whole.zones["stop"]["cause"] == 0
    later = hall.until(lambda r: r.cycle > report.cycle)
    assert later.daemon == report.daemon and hall.whole.missed >= 0
    hall.until(lambda r: hall.whole.health["batches"] > 0)
    health = hall.whole.health
    assert {share["share"]: share["state"] for share in health["shares"]} == {"arm": 0, "ball": 0}
    assert {joint["name"] for joint in health["joints"]} == set(ARM)
    newest = hall.whole.newest(1.0)
    assert newest.cycle > later.cycle


@pytest.mark.parametrize("killed", ["arm", "ball"])
def test_what_hangs_on_a_killed_share_is_unknown_by_name_and_comes_back(hall, killed):
    hall.until_known()
    hall.daemons[killed].kill()
    report = hall.until(lambda r: not hall.whole.is_whole)
    of_ball = {frozenset(("lower", "ball")), frozenset(("ball", "wall"))}
    for names, row in zip(report.pair_names, report.pairs):
        is_lost = (frozenset(names) in of_ball) == (killed == "ball")
        assert (row["status"] == PairStatus.UNKNOWN) == is_lost
        assert (row["lower"] == -math.inf) == is_lost
    assert report.unknown == 2 and report.lower_all == -math.inf and not report.minimum_certified
    report = hall.until(lambda r: hall.whole.shares[killed]["state"] is ShareState.MISSING)
    assert hall.whole.what_is_missing == f"the share '{killed}' is missing"
    states = {share["share"]: share["state"] for share in hall.whole.health["shares"]}
    assert states[killed] == ShareState.MISSING and sorted(states.values()) == [0, 1]
    stop = hall.whole.zones["stop"]
    assert stop["active"] == (killed == "arm") and stop["cause"] == (8 if killed == "arm" else 0)
    hall.start(killed)
    hall.until_known()
    assert hall.whole.what_is_missing == ""


def test_a_share_of_another_revision_is_named(hall, shared_file):
    hall.until_known()
    shared_file.write_text(shared_file.read_text().replace("enter_below: 0.2,", "enter_below: 0.1,"))
    hall.daemons["ball"].process.send_signal(signal.SIGHUP)
    hall.until(lambda r: not hall.whole.is_whole)
    hall.until(lambda r: hall.whole.shares["ball"]["state"] is ShareState.OF_ANOTHER_REVISION)
    assert hall.whole.what_is_missing == "the share 'ball' is of another revision"
    hall.daemons["arm"].process.send_signal(signal.SIGHUP)
    before = hall.whole.shares["arm"]["revision"]
    report = hall.until(lambda r: hall.whole.is_whole)
    assert report.revision != before


def test_a_connection_to_one_share_has_its_reports_alone(hall):
    whole = hall.until_known()
    with clearance.Reports(hall.daemons["arm"].connection(share="arm")) as reports:
        report = reports.next(LIMIT_S)
        assert report.pairs_total == 2 and report.revision == whole.revision
    for wrong in ("", "x" * 33):
        with pytest.raises(ValueError):
            clearance.Connection(share=wrong)


def test_partners_of_a_share_are_merged_and_a_missing_one_is_told(hall):
    hall.until_known()
    hall.daemons["ball"].kill()
    hall.start("ball", "--partner", "left")
    second = hall.run(hall.file, "--share", "ball", "--partner", "right", partition=hall.partition)
    hall.until(lambda r: hall.whole.is_whole and r.partner == "agrees")
    assert hall.whole.shares["ball"]["partner"] == "agrees" and hall.whole.shares["arm"]["partner"] == "alone"
    second.kill()
    hall.until(lambda r: r.partner == "missing")
    assert hall.whole.is_whole


def test_gradients_of_all_shares_are_joined(run_daemon, shared_file):
    hall = Hall(run_daemon, shared_file, "--gradients")

    def has_all(report):
        if not hall.whole.is_whole or report.gradients is None or None in report.pair_names:
            return False
        rows = {frozenset(names): row for names, row in zip(report.pair_names, report.gradients)}
        return all(not np.isnan(rows[frozenset(pair)]).any() for pair in (("lower", "wall"), ("lower", "ball")))

    report = hall.until(has_all)
    assert report.joints == ARM
    rows = {frozenset(names): row for names, row in zip(report.pair_names, report.gradients)}
    # The wall is at x = 3, the tip at x = cos(q1) + cos(q1 + q2), with q1 = 0 and q2 = pi / 2.
    np.testing.assert_allclose(rows[frozenset(("lower", "wall"))], [1.0, 1.0], atol=1e-9)
    # The ball is straight above the tip.
    np.testing.assert_allclose(rows[frozenset(("lower", "ball"))], [0.0, 0.0], atol=1e-9)


@pytest.fixture
def nobody():
    return clearance.Connection(domain=7, partition="python-tests-without-a-daemon")


def test_without_daemons_waits_end_with_nothing(nobody):
    for names in ([], ["arm", "ball"]):
        with clearance.SharedCell(nobody, names=names) as whole:
            assert whole.next(0.05) is None and whole.newest(0) is None
            assert not whole.is_whole and whole.shares == {} and whole.zones == {} and whole.health is None
            assert whole.what_is_missing == "" and whole.missed == 0


class Interrupted(Exception):
    pass


def test_a_signal_ends_every_wait(nobody):
    def raise_it(*_):
        raise Interrupted

    former = signal.signal(signal.SIGALRM, raise_it)
    try:
        for wait in (lambda w: w.next(), lambda w: w.newest(600), list):
            signal.setitimer(signal.ITIMER_REAL, 0.2)
            with pytest.raises(Interrupted):
                wait(clearance.SharedCell(nobody))
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, former)


def test_a_closed_one_says_so(nobody):
    whole = clearance.SharedCell(nobody)
    whole.close()
    whole.close()
    assert whole.closed
    calls = [lambda: whole.next(0), lambda: whole.newest(0), lambda: next(whole)]
    calls += [lambda name=name: getattr(whole, name) for name in ("is_whole", "shares", "zones", "health", "missed")]
    for call in calls:
        with pytest.raises(clearance.ClosedError):
            call()


@pytest.mark.parametrize(
    "arguments, error",
    [
        ({"late_after_s": 0}, ValueError),
        ({"late_after_s": math.nan}, ValueError),
        ({"old_after_s": -1}, ValueError),
        ({"names": ["a", "a"]}, ValueError),
        ({"names": [""]}, ValueError),
        ({"names": ["x" * 33]}, ValueError),
        ({"names": [str(i) for i in range(65)]}, ValueError),
        ({"names": 5}, TypeError),
        ({"late_after_s": "soon"}, TypeError),
    ],
)
def test_a_wrong_argument_is_an_exception(nobody, arguments, error):
    with pytest.raises(error):
        clearance.SharedCell(nobody, **arguments)
