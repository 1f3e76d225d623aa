"""Distances of two bodies against closed forms, and arguments that are refused."""

import math

import numpy as np
import pytest

import clearance
from clearance import DistanceStatus, Pose, TrackingState

ROUNDING = 1e-12


def within(found, truth):
    return found.lower <= truth + ROUNDING and truth - ROUNDING <= found.upper


def rotation_of(q):
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def random_pose(rng):
    q = rng.normal(size=4)
    return np.concatenate([rng.uniform(-3, 3, 3), q / np.linalg.norm(q)])


CLOSED_FORMS = [
    # body, half height along z: the distance from a point at (0, 0, 5) above it
    (lambda: clearance.point(radius=0.5), 0.5),
    (lambda: clearance.box([1, 2, 3]), 3.0),
    (lambda: clearance.box([1, 2, 3], radius=0.25), 3.25),
    (lambda: clearance.segment([0, 0, -1], [0, 0, 1], radius=0.5), 1.5),
    (lambda: clearance.ellipsoid([1, 2, 3]), 3.0),
    (lambda: clearance.cylinder(2, 1.5), 1.5),
    (lambda: clearance.cylinder(2, 1.5, radius=0.1), 1.6),
    (lambda: clearance.cone(1, 2), 2.0),
    (lambda: clearance.truncated_cone(1, 0.5, 2), 2.0),
    (lambda: clearance.prism([[0, 1], [-1, -1], [1, -1]], -1, 2), 2.0),
    (lambda: clearance.polyhedron_from_halfspaces([[0, 0, 2, 2]]), 1.0),
    (lambda: clearance.rounded_by(0.5, clearance.box([1, 1, 1])), 1.5),
    (
        lambda: clearance.polyhedron_from_vertices(
            [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
        ),
        1.0,
    ),
]


@pytest.mark.parametrize("make, top", CLOSED_FORMS)
def test_each_shape_is_as_far_below_a_point_as_its_closed_form_says(make, top):
    found = clearance.distance(make(), clearance.point(), [0, 0, 5, 0, 0, 0, 1])
    assert within(found, 5 - top)
    assert found.upper - found.lower < 1e-9
    assert found.status == DistanceStatus.CONVERGED
    np.testing.assert_allclose(found.point_on_a[2], top, atol=1e-9)
    np.testing.assert_allclose(found.point_on_b, [0, 0, 5], atol=1e-9)
    np.testing.assert_allclose(found.normal, [0, 0, 1], atol=1e-6)


def test_a_point_and_a_turned_box_agree_with_clamping_the_point_to_the_box():
    rng = np.random.default_rng(7)
    half = np.array([0.3, 0.5, 0.7])
    box, point = clearance.box(half), clearance.point()
    state = TrackingState()
    for _ in range(300):
        pose, at = random_pose(rng), rng.uniform(-4, 4, 3)
        local = rotation_of(pose[3:]).T @ (at - pose[:3])
        truth = np.linalg.norm(local - np.clip(local, -half, half))
        relative = clearance.RelativePose(pose, [*at, 0, 0, 0, 1])
        found = clearance.distance(box, point, relative, state)
        if truth > 0:
            assert within(found, truth)
        else:
            assert within(found, -np.min(half - np.abs(local)))


def test_overlapping_boxes_have_the_smallest_overlap_as_depth():
    box = clearance.box([1, 1, 1])
    found = clearance.distance(box, box, [1.7, 0.4, 0.2, 0, 0, 0, 1])
    assert within(found, -0.3)
    assert found.status is DistanceStatus.OVERLAPPING
    without = clearance.distance(box, box, [1.7, 0.4, 0.2, 0, 0, 0, 1], depth=False)
    assert without.status is DistanceStatus.DEPTH_NOT_ASKED


def test_the_three_spellings_of_a_pose_give_the_same_bits():
    box = clearance.box([1, 1, 1])
    pose = Pose([3, 0, 0], [0, 0, math.sqrt(0.5), math.sqrt(0.5)])
    matrix = np.array([[0, -1, 0, 3], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    spellings = [
        pose,
        np.concatenate([pose.position, pose.orientation]),
        clearance.RelativePose(Pose(), pose),
        matrix,
    ]
    answers = [clearance.distance(box, box, one) for one in spellings]
    assert {(a.lower, a.upper) for a in answers[:3]} == {(answers[0].lower, answers[0].upper)}
    assert within(answers[3], 1.0)


def test_poses_compose_as_their_matrices_do():
    rng = np.random.default_rng(3)
    a, b = random_pose(rng), random_pose(rng)
    at = rng.normal(size=3)
    inner = rotation_of(b[3:]) @ at + b[:3]
    expected = rotation_of(a[3:]) @ inner + a[:3]
    np.testing.assert_allclose((Pose.of(a) @ Pose.of(b)).apply(at), expected, atol=1e-12)


def test_a_batch_gives_the_bits_of_single_tracked_queries():
    rng = np.random.default_rng(11)
    bodies = [clearance.box(rng.uniform(0.1, 0.5, 3)) for _ in range(6)]
    bodies.append(clearance.segment([0, 0, 0], [0, 0, 1], radius=0.1))
    pairs = [(i, j) for i in range(7) for j in range(i)]
    batch = clearance.DistanceBatch(bodies, pairs)
    states = [TrackingState() for _ in pairs]
    poses = np.array([random_pose(rng) for _ in bodies])
    assert len(batch) == len(pairs)
    for _ in range(50):
        poses[:, :3] += rng.normal(scale=0.002, size=(7, 3))
        rows = batch.evaluate(poses)
        for row, (i, j), state in zip(rows, pairs, states):
            relative = clearance.RelativePose(poses[i], poses[j])
            one = clearance.distance(bodies[i], bodies[j], relative, state)
            assert (row["lower"], row["upper"], row["distance"]) == (one.lower, one.upper, one.distance)
            assert row["point_on_b"].tobytes() == one.point_on_b.tobytes()
            assert row["status"] == one.status


def test_results_of_a_batch_stay_when_the_batch_is_asked_again_or_gone():
    ball = clearance.point(radius=0.5)
    batch = clearance.DistanceBatch([ball, ball], [(0, 1)])
    at = np.array([[0, 0, 0, 0, 0, 0, 1.0], [3, 0, 0, 0, 0, 0, 1]])
    first = batch.evaluate(at)
    at[1, 0] = 5
    second = batch.evaluate(at)
    del batch, ball
    np.testing.assert_allclose([first["distance"][0], second["distance"][0]], [2, 4], atol=1e-12)


def test_arrays_of_any_layout_mean_their_numbers():
    points = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    reference = clearance.polyhedron_from_vertices(points).vertices
    for same in (points.astype(np.float32), np.asfortranarray(points), points[::-1][::-1], points.tolist()):
        np.testing.assert_array_equal(clearance.polyhedron_from_vertices(same).vertices, reference)


BALL = clearance.point(radius=1.0)
AT = [5, 0, 0, 0, 0, 0, 1.0]
NAN = math.nan


@pytest.mark.parametrize(
    "call, error",
    [
        (lambda: clearance.box([1, 1]), ValueError),
        (lambda: clearance.box([1, 1, NAN]), clearance.ShapeError),
        (lambda: clearance.box([1, 1, -1]), clearance.ShapeError),
        (lambda: clearance.box("abc"), TypeError),
        (lambda: clearance.box(None), TypeError),
        (lambda: clearance.box([1, 1, 1], radius=-1), clearance.ShapeError),
        (lambda: clearance.box([1, 1, 1], radius=NAN), clearance.ShapeError),
        (lambda: clearance.polyhedron_from_vertices(np.zeros((0, 3))), clearance.ShapeError),
        (lambda: clearance.polyhedron_from_vertices([[0, 0, 0]] * 9), clearance.ShapeError),
        (lambda: clearance.polyhedron_from_halfspaces([[1, 0, 0, -1], [-1, 0, 0, -1]]), clearance.ShapeError),
        (lambda: clearance.segment([0, 0, 0], [0, 0, 0]), clearance.ShapeError),
        (lambda: clearance.prism([[0, 0, 0]], 0, 1), ValueError),
        (lambda: Pose([0, 0, 0], [0, 0, 0, 2]), ValueError),
        (lambda: Pose([0, 0, NAN]), ValueError),
        (lambda: Pose([0, 0, 1e13]), ValueError),
        (lambda: Pose.of(np.eye(4) * 2), ValueError),
        (lambda: Pose.of(np.diag([1, 1, -1, 1])), ValueError),
        (lambda: clearance.RelativePose([1e12, 0, 0, 0, 0, 0, 1], [-1e12, 0, 0, 0, 0, 0, 1]), ValueError),
        (lambda: clearance.distance(BALL, BALL, [1, 2, 3]), ValueError),
        (lambda: clearance.distance(BALL, BALL, [NAN] * 7), ValueError),
        (lambda: clearance.distance(BALL, BALL, object()), TypeError),
        (lambda: clearance.distance(BALL, BALL, None), TypeError),
        (lambda: clearance.distance(BALL, 3, AT), TypeError),
        (lambda: clearance.distance(None, BALL, AT), TypeError),
        (lambda: clearance.distance(BALL, BALL, AT, 5), TypeError),
        (lambda: clearance.distance(BALL, BALL), TypeError),
        (lambda: clearance.distance(BALL, BALL, AT, None, True), TypeError),
        (lambda: clearance.distance(BALL, BALL, AT, pose=AT), TypeError),
        (lambda: clearance.distance(BALL, BALL, AT, speed=3), TypeError),
        (lambda: clearance.Body(), TypeError),
        (lambda: clearance.Distance(), TypeError),
        (lambda: clearance.DistanceBatch([BALL], [(0, 1)]), ValueError),
        (lambda: clearance.DistanceBatch([BALL], [(0, -1)]), ValueError),
        (lambda: clearance.DistanceBatch([BALL], [(0, 0.5)]), ValueError),
        (lambda: clearance.DistanceBatch([BALL, None], [(0, 1)]), TypeError),
        (lambda: clearance.DistanceBatch([BALL, 3], [(0, 1)]), TypeError),
        (lambda: clearance.DistanceBatch([BALL, BALL], [(0, 1)]).evaluate([AT]), ValueError),
        (lambda: clearance.DistanceBatch([BALL, BALL], [(0, 1)]).evaluate([AT, [NAN] * 7]), ValueError),
    ],
)
def test_a_wrong_argument_is_an_exception(call, error):
    with pytest.raises(error) as raised:
        call()
    assert str(raised.value)


def test_keywords_mean_the_same_as_places():
    by_name = clearance.distance(pose=AT, b=BALL, a=BALL, state=None, depth=True)
    assert by_name.distance == clearance.distance(BALL, BALL, AT).distance == 3.0


def test_a_body_tells_its_numbers():
    box = clearance.box([1, 2, 3])
    assert box.vertices.shape == (8, 3) and box.facets.shape == (6, 4)
    np.testing.assert_allclose(sorted(box.facets[:, 3]), [1, 1, 2, 2, 3, 3])
    assert not box.curved and box.bounded
    assert clearance.ellipsoid([1, 1, 2]).curved
    assert not clearance.polyhedron_from_halfspaces([[0, 0, 1, 0]]).bounded
