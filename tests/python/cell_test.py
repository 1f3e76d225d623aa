"""Cells and their distances in given configurations, against kinematics by hand."""

import math
import signal
import threading

import numpy as np
import pytest

import clearance
from clearance import PairStatus

LIMITS = 3.0


def tips(joints):
    """Centres of the planar arm's two spheres."""
    q1, q2 = joints[:, 0], joints[:, 0] + joints[:, 1]
    elbow = np.stack([np.cos(q1), np.sin(q1), 0 * q1], axis=1)
    return elbow, elbow + np.stack([np.cos(q2), np.sin(q2), 0 * q2], axis=1)


def to_wall(centres):
    """From spheres of 0.1 m to the box [3, 3.2] x [-2, 2] x [-2, 2]."""
    low, high = np.array([3, -2, -2]), np.array([3.2, 2, 2])
    return np.linalg.norm(centres - np.clip(centres, low, high), axis=1) - 0.1


def random_joints(count, seed=1):
    return np.random.default_rng(seed).uniform(-LIMITS, LIMITS, (count, 2))


def test_bounds_hold_the_closed_form_in_random_configurations(planar):
    joints = random_joints(500)
    ball = np.array([1.5, 0.5, 1.0])
    found = planar.distances(joints, {"ball": [*ball, 0, 0, 0, 1]})
    elbow, tip = tips(joints)
    truth = {
        ("lower", "wall"): to_wall(tip),
        ("upper", "wall"): to_wall(elbow),
        ("lower", "ball"): np.linalg.norm(tip - ball, axis=1) - 0.35,
        ("ball", "wall"): np.full(500, 1.25),
    }
    assert len(found) == 500 and found.distance.shape == (500, 4)
    for column, pair in enumerate(planar.pairs):
        exact = truth[pair] if pair in truth else truth[pair[::-1]]
        assert np.all(found.lower[:, column] <= exact + 1e-12)
        assert np.all(found.upper[:, column] >= exact - 1e-12)
        assert np.all(found.upper[:, column] - found.lower[:, column] < 1e-9)
        between = found.point_b[:, column] - found.point_a[:, column]
        np.testing.assert_allclose(
            between, found.distance[:, column, None] * found.normal[:, column], atol=1e-8
        )


def test_gradients_are_the_differences_of_distances(planar):
    joints = random_joints(60, seed=2)
    ball = {"ball": [1.5, 0.5, 1.0, 0, 0, 0, 1]}
    gradient = planar.distances(joints, ball, gradients=True).gradient
    assert gradient.shape == (60, 4, 2)
    step = 1e-6
    for joint in range(2):
        moved = [planar.distances(joints + sign * step * np.eye(2)[joint], ball) for sign in (1, -1)]
        difference = (moved[0].distance - moved[1].distance) / (2 * step)
        np.testing.assert_allclose(gradient[:, :, joint], difference, atol=1e-5)


def test_pairs_of_an_object_without_a_pose_are_unknown(planar):
    found = planar.distances(random_joints(3), gradients=True)
    for column, pair in enumerate(planar.pairs):
        unknown = "ball" in pair
        assert np.all(np.isneginf(found.lower[:, column]) == unknown)
        assert np.all(np.isposinf(found.upper[:, column]) == unknown)
        assert np.all(np.isnan(found.distance[:, column]) == unknown)
        assert np.all(np.isnan(found.gradient[:, column]) == unknown)
        assert np.all((found.status[:, column] == PairStatus.UNKNOWN) == unknown)


def test_a_pose_of_one_call_is_forgotten_in_the_next(planar):
    planar.distances([[0, 0]], {"ball": [0, 0, 5, 0, 0, 0, 1]})
    assert np.isneginf(planar.distances([[0, 0]]).lower).any()


def test_the_same_call_gives_the_same_bits_whatever_came_before(arm):
    joints = np.random.default_rng(5).uniform(-1, 0, (50, len(arm.joints)))
    joints = np.clip(joints, *arm.joint_limits.T)
    first = arm.distances(joints)
    arm.distances(joints[::-1])
    again = arm.distances(joints)
    for name in ("distance", "lower", "upper", "point_a", "point_b", "normal"):
        assert getattr(first, name).tobytes() == getattr(again, name).tobytes()


def test_each_configuration_alone_agrees_with_the_series(arm):
    joints = np.random.default_rng(6).uniform(*np.clip(arm.joint_limits, -3, 3).T, (20, len(arm.joints)))
    series = arm.distances(joints)
    for row in range(20):
        alone = arm.distances(joints[row : row + 1])
        assert np.all(alone.lower <= series.upper[row]) and np.all(series.lower[row] <= alone.upper)


def test_points_are_left_out_on_request(arm):
    found = arm.distances(np.zeros((2, len(arm.joints))).clip(*arm.joint_limits.T), points=False)
    for name in ("point_a", "point_b", "normal", "gradient"):
        with pytest.raises(AttributeError, match="points=True"):
            getattr(found, name)
    assert found.part_a.shape == found.distance.shape


def test_no_configurations_are_no_error(arm):
    assert arm.distances(np.zeros((0, len(arm.joints)))).distance.shape == (0, len(arm.pairs))


@pytest.mark.parametrize(
    "joints, poses, error",
    [
        ([[0, 0, 0]], {}, ValueError),
        ([0, 0], {}, ValueError),
        ([["a", "b"]], {}, TypeError),
        (None, {}, TypeError),
        ([[0, math.nan]], {}, ValueError),
        ([[0, math.inf]], {}, ValueError),
        ([[0, 0], [0, 4]], {}, ValueError),
        ([[0, 0]], {"nothing": [0] * 6 + [1]}, KeyError),
        ([[0, 0]], {"wall": [0] * 6 + [1]}, ValueError),
        ([[0, 0]], {"lower": [0] * 6 + [1]}, ValueError),
        ([[0, 0]], {"ball": [0] * 7}, ValueError),
        ([[0, 0]], {"ball": "here"}, TypeError),
        ([[0, 0]], {3: [0] * 6 + [1]}, TypeError),
        ([[0, 0]], 5, TypeError),
    ],
)
def test_a_wrong_argument_is_an_exception(planar, joints, poses, error):
    with pytest.raises(error):
        planar.distances(joints, poses)
    assert np.isfinite(planar.distances([[0, 0]]).lower).any()  # and the cell works as before


def test_a_pose_of_a_sensor_is_refused(arm_files):
    cell = clearance.Cell(arm_files[0].parents[1] / "camera.yaml")
    with pytest.raises(ValueError, match="'camera' is a sensor"):
        cell.distances(np.zeros((1, len(cell.joints))), {"camera": [0, 0, 1, 0, 0, 0, 1]})


def test_a_position_out_of_limits_is_named(planar):
    with pytest.raises(ValueError, match=r"joints\[1, 1\].*elbow"):
        planar.distances([[0, 0], [0, 9]])


def test_threads_share_a_cell(arm):
    joints = np.random.default_rng(8).uniform(*np.clip(arm.joint_limits, -3, 3).T, (300, len(arm.joints)))
    expected = arm.distances(joints).lower.tobytes()
    found = []
    threads = [
        threading.Thread(target=lambda: found.append(arm.distances(joints).lower.tobytes()))
        for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 4


def test_a_batch_refuses_a_second_thread_or_serves_one_after_the_other():
    ball = clearance.point(radius=0.1)
    batch = clearance.DistanceBatch([ball] * 300, [(i, j) for i in range(300) for j in range(i)])
    poses = np.random.default_rng(1).uniform(-9, 9, (300, 7))
    poses[:, 3:] = [0, 0, 0, 1]
    truth = batch.evaluate(poses)["distance"]
    wrong = []

    def ask():
        for _ in range(20):
            try:
                found = batch.evaluate(poses)["distance"]
                if not np.allclose(found, truth):
                    wrong.append(found)
            except RuntimeError as error:
                if "thread" not in str(error):
                    wrong.append(error)

    threads = [threading.Thread(target=ask) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


class Interrupted(Exception):
    pass


@pytest.fixture
def interrupt():
    """Sends a signal in 0.2 s whose handler raises, as Ctrl-C does."""

    def raise_it(*_):
        raise Interrupted

    former = signal.signal(signal.SIGALRM, raise_it)
    yield lambda: signal.setitimer(signal.ITIMER_REAL, 0.2)
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, former)


def test_a_signal_ends_a_long_series(arm, interrupt):
    joints = np.zeros((400_000, len(arm.joints))).clip(*arm.joint_limits.T)
    with pytest.raises(Interrupted):
        interrupt()
        for _ in range(1000):
            arm.distances(joints, points=False)


def test_a_signal_ends_the_reading_of_meshes(tmp_path, interrupt):
    # A bumpy ball, many times in other sizes, which all have to be split into convex parts.
    angles = np.linspace(0, np.pi, 40), np.linspace(0, 2 * np.pi, 80, endpoint=False)
    polar, round_ = (a.ravel() for a in np.meshgrid(*angles, indexing="ij"))
    bumps = 1 + 0.3 * np.sin(5 * round_) * np.sin(polar) * np.cos(4 * polar)
    points = np.stack([np.sin(polar) * np.cos(round_), np.sin(polar) * np.sin(round_), np.cos(polar)], 1)
    points *= bumps[:, None]
    faces = []
    for i in range(39):
        for j in range(80):
            k = (j + 1) % 80
            faces.append([1 + 80 * i + j, 81 + 80 * i + j, 81 + 80 * i + k, 1 + 80 * i + k])
    objects = ""
    for number in range(30):
        with open(tmp_path / f"{number}.obj", "w", encoding="utf-8") as file:
            file.writelines("v {} {} {}\n".format(*p) for p in points * (1 + 0.1 * number))
            file.writelines("f {} {} {}\nf {} {} {}\n".format(*f[:3], f[0], *f[2:]) for f in faces)
        objects += f"  - {{name: o{number}, mesh: {{file: {number}.obj}}}}\n"
    text = "name: x\nunits: {length: m, angle: deg}\nobjects:\n" + objects
    text += "  - {name: floor, fixed: true, half_space: {normal: [0, 0, 1], offset: 0}}\n"
    text += "pairs:\n" + "".join(f"  - {{between: [o{n}, floor]}}\n" for n in range(30))
    with pytest.raises(Interrupted):
        interrupt()
        clearance.Cell.from_yaml(text, tmp_path / "x.yaml")


def test_every_mistake_of_a_cell_is_listed(tmp_path):
    with pytest.raises(clearance.CellError) as raised:
        clearance.Cell.from_yaml("name: x\nobjcts: []\nrate_hz: fast\n", tmp_path / "x.yaml")
    assert len(raised.value.errors) >= 2
    assert all("x.yaml:" in text for text in raised.value.errors)


@pytest.mark.parametrize(
    "call",
    [
        lambda: clearance.Cell("/nowhere/cell.yaml"),
        lambda: clearance.Cell.from_urdf("/nowhere/arm.urdf"),
        lambda: clearance.Cell.from_yaml(""),
    ],
)
def test_a_cell_that_cannot_be_read_is_a_cell_error(call):
    with pytest.raises(clearance.CellError):
        call()


@pytest.mark.parametrize("call", [lambda: clearance.Cell(3), lambda: clearance.Cell.from_yaml(None)])
def test_a_cell_of_no_text_is_a_type_error(call):
    with pytest.raises(TypeError):
        call()


def test_a_cell_tells_its_names(planar):
    assert planar.name == "planar" and planar.joints == ["shoulder", "elbow"]
    assert planar.zones == ["stop"] and set(planar.objects) >= {"wall", "ball", "upper", "lower"}
    np.testing.assert_array_equal(planar.joint_limits, [[-3, 3], [-3, 3]])
    assert planar.pairs == planar.published_pairs and len(planar.pairs) == 4
    assert planar.rate_hz == 200 and planar.interface is None and planar.revision != 0


BALL = {"ball": [1.5, 0.5, 1.0, 0, 0, 0, 1]}


def test_chosen_pairs_are_the_columns_of_all(planar):
    joints = random_joints(200, seed=5)
    every = planar.distances(joints, BALL, gradients=True)
    chosen = [planar.pairs[3], planar.pairs[1][::-1]]
    found = planar.distances(joints, BALL, gradients=True, pairs=chosen)
    assert found.distance.shape == (200, 2)
    for array in ("distance", "lower", "upper", "status", "part_a", "point_a", "normal", "gradient"):
        np.testing.assert_array_equal(getattr(found, array), getattr(every, array)[:, [3, 1]])


@pytest.mark.parametrize("below", [-0.05, 0.0, 0.02, 0.5, 1.2, 3.0])
def test_a_limit_is_decided_as_by_all_distances(planar, below):
    joints = random_joints(500, seed=6)
    every = planar.distances(joints, BALL)
    found = planar.distances(joints, BALL, below=below)
    is_below = np.any(every.upper < below, axis=1)
    is_free = np.all(every.lower >= below, axis=1)
    assert np.all((is_below | is_free))
    np.testing.assert_array_equal(found.verdict == clearance.Verdict.BELOW, is_below)
    np.testing.assert_array_equal(found.verdict == clearance.Verdict.FREE, is_free)
    assert np.all(found.lower <= every.upper) and np.all(found.upper >= every.lower)
    free = found.verdict == clearance.Verdict.FREE
    assert np.all(found.lower[free] >= below)


def test_an_unknown_pair_leaves_a_limit_undecided(planar):
    joints = [[0.0, 0.0]]
    assert planar.distances(joints, below=0.1).verdict[0] == clearance.Verdict.UNDECIDED
    wall = [pair for pair in planar.pairs if "ball" not in pair]
    assert planar.distances(joints, below=0.1, pairs=wall).verdict[0] == clearance.Verdict.FREE


def test_threads_give_the_same_bits(planar):
    joints = random_joints(1000, seed=7)
    one = planar.distances(joints, BALL)
    for threads in (0, 2, 5):
        many = planar.distances(joints, BALL, threads=threads)
        for array in ("distance", "lower", "upper", "point_a", "normal"):
            np.testing.assert_array_equal(getattr(many, array), getattr(one, array))
    joints[[700, 300, 900], 1] = 99.0
    with pytest.raises(ValueError, match=r"joints\[300, 1\]"):
        planar.distances(joints, threads=3)


def test_wrong_pairs_limits_and_threads_are_named(planar):
    joints = [[0.0, 0.0]]
    with pytest.raises(KeyError, match="nor a group 'moon'"):
        planar.distances(joints, pairs=[("wall", "moon")])
    with pytest.raises(ValueError, match="below: found nan"):
        planar.distances(joints, below=math.nan)
    with pytest.raises(ValueError, match="threads: found -1"):
        planar.distances(joints, threads=-1)
    with pytest.raises(AttributeError, match="below="):
        planar.distances(joints).verdict
    assert planar.distances(joints, pairs=[]).distance.shape == (1, 0)
