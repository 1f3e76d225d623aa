"""Questions about motions: closed forms of a planar arm, the same answer from a running daemon, and refusals."""

import math
import threading
import time

import numpy as np
import pytest

import clearance
from clearance import Question, QuestionStatus, Verdict

LIMIT_S = 60
# The tip is a sphere of 0.1 m at 2 m from the shoulder, and the wall begins at x = 3 m.
SWING = dict(joints=["shoulder"], times=[0.0, 2.0], positions=[[-1.0], [0.5]])
REST = dict(held={"elbow": 0.0}, poses={"ball": [0, 9, 9, 0, 0, 0, 1]}, others="still")


def test_a_swing_has_its_least_distance_between_its_waypoints(planar):
    answer = planar.ask(Question(**SWING, **REST, margins=[0.0, 0.8, 0.95], tolerance=1e-9))
    assert answer.answered and answer.status is QuestionStatus.ANSWERED
    assert answer.lower <= 0.9 + 1e-12 and answer.upper >= 0.9 - 1e-12
    assert answer.upper - answer.lower <= 1e-9
    assert answer.time == pytest.approx(4 / 3, abs=1e-3)
    assert set(answer.pair) == {"wall", "lower"}
    assert answer.points.shape == (2, 3)
    assert np.linalg.norm(answer.points[0] - answer.points[1]) == pytest.approx(0.9, abs=1e-6)
    assert [margin.verdict for margin in answer.margins] == [Verdict.FREE, Verdict.FREE, Verdict.BELOW]
    assert answer.is_free() and answer.is_free(0.8)
    assert not answer.is_free(0.95) and not answer.is_free(0.5), "0.5 was not asked for"
    # The distance is 3 - 2 cos(a) - 0.1, and a = -1 + 0.75 t.
    truth = (1 - math.acos((3 - 0.1 - 0.95) / 2)) / 0.75
    below = answer.margins[2]
    assert below.above_until <= truth + 1e-9 and below.below_at >= truth - 1e-9
    assert below.below_at == pytest.approx(truth, abs=1e-5) and set(below.pair) == {"wall", "lower"}
    assert answer.margins[0].pair is None and math.isnan(answer.margins[0].below_at)
    assert answer.within_work_limit and answer.queries > 0


def test_margins_of_pairs_are_not_those_of_all(planar):
    margins = [0.8, ("wall", "lower", 0.95), ("wall", "upper", 0.95)]
    answer = planar.ask(Question(**SWING, **REST, margins=margins))
    assert [margin.between for margin in answer.margins] == [None, ("wall", "lower"), ("wall", "upper")]
    assert answer.is_free(0.8) and answer.is_free(0.95, ("wall", "upper"))
    assert not answer.is_free(0.95, ("wall", "lower")) and not answer.is_free(0.95)
    for wrong in ([("wall",)], [("wall", "lower", "upper", 0.1)], ["wall"]):
        with pytest.raises((TypeError, ValueError, RuntimeError)):
            Question(**SWING, **REST, margins=wrong)
    with pytest.raises(ValueError, match="lowr"):
        planar.ask(Question(**SWING, **REST, margins=[("wall", "lowr", 0.1)]))


def test_a_sensor_of_a_cell_that_is_not_run_may_be_left_out(planar_file):
    sensor = "sensors: [{name: eye, depth_image: /depth, depth_error: {constant: 0.01}, range: [0.3, 4]}]\n"
    text = planar_file.read_text().replace("pairs:\n", sensor + "pairs:\n  - {between: [arm, eye]}\n")
    planar_file.write_text(text)
    cell = clearance.Cell(planar_file)
    with pytest.raises(ValueError, match="\"eye\": it has no frame, .* 'without' leaves it out"):
        cell.ask(Question(**SWING, **REST))
    answer = cell.ask(Question(**SWING, **REST, without=["eye"]))
    assert answer.without == ["eye"]
    assert answer.upper == pytest.approx(0.9, abs=1e-3) and set(answer.pair) == {"wall", "lower"}
    with pytest.raises(ValueError, match="leaves out"):
        cell.ask(Question(**SWING, **REST, without=["eye"], margins=[("lower", "eye", 0.1)]))


def test_the_function_and_the_method_give_the_same_bits_in_every_thread(planar):
    question = Question(**SWING, **REST)
    first = planar.ask(question)
    found = []

    def ask():
        found.extend(clearance.ask(planar, question) for _ in range(5))

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 20
    assert {(a.lower, a.upper, a.time) for a in found} == {(first.lower, first.upper, first.time)}


def test_cubic_motions_leave_the_chord(planar):
    rest = Question(["shoulder"], [0, 1], [[0.5], [0.5]], **REST)
    swung = Question(["shoulder"], [0, 1], [[0.5], [0.5]], [[-4.0], [4.0]], **REST)
    assert planar.ask(swung).lower < planar.ask(rest).lower - 0.1


def test_an_object_comes_nearer_by_its_largest_speed_unless_it_is_still(planar):
    at = dict(held={"elbow": 0.0}, poses={"ball": [2.0, 5.0, 0, 0, 0, 0, 1]})
    rest = dict(joints=["shoulder"], times=[0.0, 0.01], positions=[[0.0], [0.0]])
    still = planar.ask(Question(**rest, **at, others="still"))
    moving = planar.ask(Question(**rest, **at))
    assert still.lower == pytest.approx(0.9, abs=1e-3), "the wall is nearer than the ball"
    assert moving.lower == pytest.approx(0.9, abs=1e-3), "0.01 s x 100 m/s leave 3.65 m"
    slow = planar.ask(Question(joints=["shoulder"], times=[0.0, 0.045], positions=[[0.0], [0.0]], **at))
    assert slow.lower == pytest.approx(5.0 - 0.35 - 4.5, abs=2e-3)


# The motion ends at 0.5 rad/s. The shoulder goes on for 0.2 s, and the ball comes nearer until then.
def test_a_stoppable_motion_counts_stops_from_any_instant(planar, planar_file):
    motion = dict(joints=["shoulder"], times=[0.0, 1.0], positions=[[-1.0], [-0.5]], **REST)
    with pytest.raises(ValueError, match='robot "arm" states no stopping'):
        planar.ask(Question(**motion, stoppable=True))
    stops = "stopping: {reaction_ms: 40, path: kept, time_ms: 160}"
    planar_file.write_text(planar_file.read_text().replace("planar.urdf}", f"planar.urdf, {stops}}}"))
    cell = clearance.Cell(planar_file)
    asked = cell.ask(Question(**motion, margins=[1.1], tolerance=1e-9))
    assert asked.upper == pytest.approx(2.9 - 2 * math.cos(0.5), abs=1e-8) and asked.is_free(1.1)
    stoppable = cell.ask(Question(**motion, margins=[1.1], tolerance=1e-9, stoppable=True, time_scaling=True))
    assert stoppable.upper == pytest.approx(2.9 - 2 * math.cos(0.5 - 0.5 * 0.2), abs=1e-8)
    assert stoppable.margins[0].verdict is Verdict.BELOW
    limit = stoppable.time_limit
    assert limit.is_limited and limit.zone == "" and 0 < limit.factor < limit.factor_above < 1
    slower = dict(motion, times=[0.0, 1.0 / limit.factor])
    assert cell.ask(Question(**slower, margins=[1.1], stoppable=True)).is_free(1.1)


def test_an_age_widens_and_a_meant_contact_keeps_the_margin(planar):
    at = dict(held={"elbow": 0.0}, poses={"ball": [2.0, 5.0, 0, 0, 0, 0, 1]})
    rest = dict(joints=["shoulder"], times=[0.0, 0.005], positions=[[0.0], [0.0]])
    aged = planar.ask(Question(**rest, **at, ages={"ball": 0.04}))
    assert aged.lower == pytest.approx(5.0 - 0.35 - 4.5, abs=2e-3)
    contact = ("lower", "wall", 0.01)
    meant = planar.ask(Question(**SWING, **REST, margins=[0.95], contacts=[contact]))
    assert meant.margins[0].verdict is Verdict.FREE and meant.upper == pytest.approx(0.9, abs=1e-3)
    # The least distance is reached after 4/3 s.
    ended = planar.ask(Question(**SWING, **REST, margins=[0.95], contacts=[(*contact, 1.3, None)]))
    assert ended.margins[0].verdict is Verdict.BELOW


@pytest.mark.parametrize(
    "change, match",
    [
        (dict(joints=["knee"]), "knee"),
        (dict(held={}), "elbow"),
        (dict(poses={}), "ball"),
        (dict(times=[1.0, 1.0]), ""),
        (dict(positions=[[0.0], [math.nan]]), ""),
        (dict(margins=[-1.0]), "margin"),
        (dict(tolerance=0.0), "tolerance"),
    ],
)
def test_what_does_not_fit_the_cell_is_refused_with_the_reason(planar, change, match):
    with pytest.raises(ValueError, match=match):
        planar.ask(Question(**{**SWING, **REST, **change}))


PERSON_AND_POST = """
name: absent
units: {length: m, angle: rad}
ros2: {world_frame: map}
robots:
  - {name: anna, person: {stature: 1.75, error: 0}, absent: true}
  - {name: bert, person: {stature: 1.75, error: 0}}
objects: [{name: post, fixed: true, sphere: {radius: 0.1}}]
pairs: [{between: [anna, bert]}, {between: [anna, post]}, {between: [bert, post]}]
"""


@pytest.fixture
def two_people(tmp_path):
    file = tmp_path / "cell.yaml"
    file.write_text(PERSON_AND_POST)
    return clearance.Cell(file)


def position_of(joint, rot_w=1.0):
    return rot_w if joint.endswith("rot_w") else 9.0 if joint.endswith("trans_x") else 0.0


def test_an_absent_robot_needs_no_positions(two_people):
    bert = {joint: position_of(joint) for joint in two_people.joints if "bert" in joint}
    moved = "r_knee_y_bert" if "r_knee_y_bert" in bert else next(j for j in bert if "base" not in j)
    del bert[moved]
    answer = two_people.ask(Question([moved], [0, 1], [[0.0], [0.1]], held=bert, others="still"))
    assert answer.pair is not None and "anna" not in "".join(answer.pair) and answer.lower > 5
    rows = np.array([[position_of(j) if "bert" in j else math.nan for j in two_people.joints]])
    found = two_people.distances(rows, below=5.0)
    absent = np.array(["anna" in "".join(pair) for pair in two_people.pairs])
    assert np.all((found.status[0] == clearance.PairStatus.ABSENT) == absent)
    assert found.verdict[0] == Verdict.FREE
    rows[0, next(i for i, j in enumerate(two_people.joints) if "anna" in j)] = 0.0
    with pytest.raises(ValueError, match="anna"):
        two_people.distances(rows)


@pytest.mark.parametrize("length", [0.0, 1e-200, 0.5, 2.0])
def test_a_quaternion_has_the_length_one(two_people, length):
    row = [position_of(j, length) if "bert" in j else math.nan for j in two_people.joints]
    with pytest.raises(ValueError, match="quaternion.*bert"):
        two_people.distances([row])


@pytest.mark.parametrize(
    "change, error, match",
    [
        (dict(positions=[[0.0]]), ValueError, "positions"),
        (dict(velocities=[0.0, 0.0]), ValueError, "velocities"),
        (dict(times="now"), TypeError, "times"),
        (dict(poses={"ball": [0, 0, 0]}), ValueError, "ball"),
        (dict(poses={"ball": [0, 0, 0, 0, 0, 0, 2]}), ValueError, "ball"),
        (dict(others="fly"), ValueError, "fly"),
        (dict(beside=[(["elbow"], [0.0])]), ValueError, "beside"),
        (dict(moving={"ball": ([0.0],)}), ValueError, "moving"),
        (dict(payloads={"part": ("lower",)}), ValueError, "payloads"),
        (dict(held={"elbow": "x"}), TypeError, ""),
        (dict(ages={"wall": 1.0}), ValueError, "wall"),
        (dict(turn_speeds={"wall": 1.0}), ValueError, "wall"),
        (dict(contacts=[("lower", "wall")]), ValueError, "contacts"),
    ],
)
def test_wrong_shapes_are_refused_at_once(change, error, match):
    with pytest.raises(error, match=match):
        Question(**{**SWING, **REST, **change})


@pytest.fixture
def daemon(run_daemon, planar_file):
    return run_daemon(planar_file, "--questions", "python tests")


def test_a_daemon_answers_for_where_everything_is_now(daemon, planar):
    connection = daemon.connection()
    joints = clearance.JointWriter("python joints", ["shoulder", "elbow"], connection)
    poses = clearance.PoseWriter("python poses", ["ball"], connection)
    question = Question(**SWING, margins=[0.8], others="still")
    with joints, poses, clearance.Questions("python tests", connection) as questions:
        empty = questions.ask(question, LIMIT_S)
        assert empty.status is QuestionStatus.NO_INPUT and not empty.answered
        assert empty.lower == -math.inf and empty.upper == math.inf and not empty.is_free(0.8)
        assert "shoulder" not in empty.reason and "elbow" in empty.reason
        assert joints.wait_heard(LIMIT_S) and poses.wait_heard(LIMIT_S) and questions.is_heard
        end = time.monotonic() + LIMIT_S
        while True:
            joints.write([-1.25, 0.0])
            poses.write([[0, 9, 9, 0, 0, 0, 1]])
            answer = questions.ask(question, LIMIT_S)
            if answer.answered or time.monotonic() > end:
                break
        here = planar.ask(Question(**SWING, **REST, margins=[0.8]))
        assert (answer.lower, answer.upper, answer.time) == (here.lower, here.upper, here.time)
        assert answer.is_free(0.8) and answer.revision == planar.revision and answer.cycle > 0
        of_zone = questions.ask(Question(**SWING, margins=[("stop", 0.8), ("lower", "wall", 0.95)], others="still"), LIMIT_S)
        assert of_zone.is_free(0.8, "stop") and not of_zone.is_free(0.8) and not of_zone.is_free(0.95, ("lower", "wall"))
        assert answer.start_joint == "shoulder" and answer.start_deviation == 0.25
        part = ("lower", [0.1, 0, 0, 0, 0, 0, 1], [], clearance.box([0.3, 0.01, 0.01]))
        carried = questions.ask(Question(**SWING, payloads={"part": part}, others="still"), LIMIT_S)
        there = planar.ask(Question(**SWING, **REST, payloads={"part": part}))
        assert (carried.lower, carried.upper) == (there.lower, there.upper)
        assert "part" in carried.pair and carried.upper < answer.upper
        stated = Question(**SWING, margins=[0.95], others="still", contacts=[("lower", "wall", 0.01)])
        assert questions.ask(stated, LIMIT_S).is_free(0.95)
        refused = questions.ask(Question(**{**SWING, "joints": ["knee"]}), LIMIT_S)
        assert refused.status is QuestionStatus.REFUSED and "knee" in refused.reason
        stale = questions.ask(question, LIMIT_S, revision=1)
        assert stale.status is QuestionStatus.OTHER_REVISION


def test_without_a_daemon_the_wait_ends_with_the_reason():
    connection = clearance.Connection(partition="python-nobody-answers")
    with clearance.Questions("python tests", connection) as questions:
        assert not questions.is_heard
        with pytest.raises(TimeoutError, match="no daemon"):
            questions.ask(Question(**SWING), 0.1)
    with pytest.raises(clearance.ClosedError):
        questions.ask(Question(**SWING), 0.1)
