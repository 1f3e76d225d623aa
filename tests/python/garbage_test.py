"""Whatever the arguments are, the answer is a value or an exception, and never the end of the interpreter."""

import copy
import inspect
import itertools
import math
import pickle
import random

import numpy as np
import pytest

import clearance

GARBAGE = [
    None,
    True,
    0,
    -1,
    2**70,
    math.nan,
    math.inf,
    -1e308,
    5e-324,
    "",
    "text\0with a null",
    "\udcff",
    b"bytes",
    [],
    {},
    [1, 2, 3],
    [math.nan] * 3,
    [0, 0, 0, 0, 0, 0, 1],
    [[0, 0, 0, 0, 0, 0, 1.0]] * 2,
    [[1, 2], [3]],
    np.zeros((0, 3)),
    np.zeros((3, 0)),
    np.zeros((2, 7)),
    np.eye(4),
    np.ones(3, dtype=complex),
    np.array(["a", "b", "c"]),
    np.zeros((4, 4, 4, 4)),
    np.random.default_rng(1).normal(size=(20, 3))[::-2],
    np.broadcast_to(1e200, (12, 3)),
    object(),
    int,
    clearance.point(radius=1.0),
    clearance.box([1, 1, 1]),
    clearance.Pose(),
    clearance.TrackingState(),
]
# The warnings are NumPy's, about such arguments.
pytestmark = pytest.mark.filterwarnings("ignore")
# These wait for a daemon, or join DDS anew with each call.
LIVE = {"Reports", "SharedCell", "JointWriter", "PoseWriter", "Commands", "Connection"}
CALLABLE = sorted(set(clearance.__all__) - LIVE)


def try_it(call, *arguments, **keywords):
    try:
        return call(*arguments, **keywords)
    except Exception as error:
        assert not isinstance(error, (SystemError, RecursionError)), (call, arguments, error)
        return None


@pytest.mark.parametrize("name", CALLABLE)
def test_calls_with_garbage_give_values_or_exceptions(name):
    thing = getattr(clearance, name)
    rng = random.Random(name)
    try_it(thing)
    for one in GARBAGE:
        try_it(thing, one)
    for _ in range(400):
        try_it(thing, *rng.choices(GARBAGE, k=rng.randint(2, 6)))


@pytest.mark.parametrize("name", [n for n in clearance.__all__ if inspect.isclass(getattr(clearance, n))])
def test_no_object_is_made_without_its_initialisation(name):
    made = getattr(clearance, name)
    if issubclass(made, (BaseException, int)):
        return
    for attempt in (
        lambda: made.__new__(made),
        lambda: object.__new__(made),
        lambda: type("Derived", (made,), {"__init__": lambda self: None})(),
    ):
        with pytest.raises(TypeError):
            attempt()


def test_objects_are_not_copied_or_pickled_half():
    for thing in (clearance.box([1, 1, 1]), clearance.Pose(), clearance.TrackingState()):
        pickled = [lambda x, p=p: pickle.dumps(x, p) for p in range(pickle.HIGHEST_PROTOCOL + 1)]
        reduced = [lambda x, p=p: x.__reduce_ex__(p) for p in range(-1, pickle.HIGHEST_PROTOCOL + 2)]
        for attempt in (copy.copy, copy.deepcopy, lambda x: x.__reduce__(), *pickled, *reduced):
            with pytest.raises(TypeError):
                attempt(thing)


# Python's own pickling calls the class that all of them have in common.
def test_no_object_is_made_of_the_common_base():
    base = clearance.Pose.__mro__[-2]
    for attempt in (base, lambda: base(clearance.Pose()), type("Derived", (base,), {})):
        with pytest.raises(TypeError):
            attempt()


# Includes those of `object`.
def members_of(thing):
    return [n for n in dir(thing) if n != "__init__" and not n.startswith(("__sub", "__init_sub"))]


def test_methods_and_members_with_garbage_give_values_or_exceptions(planar, arm_files):
    cell = planar
    ball = clearance.point(radius=0.1)
    things = [
        cell,
        cell.distances([[0, 0]]),
        clearance.DistanceBatch([ball, ball], [(0, 1)]),
        clearance.distance(ball, ball, [1, 0, 0, 0, 0, 0, 1]),
        ball,
        clearance.Pose(),
        clearance.RelativePose(clearance.Pose(), clearance.Pose()),
        clearance.TrackingState(),
    ]
    rng = random.Random(2)
    for thing in things:
        for member in members_of(thing):
            value = try_it(getattr, thing, member)
            if not callable(value) or inspect.isclass(value):
                continue
            try_it(value)
            for one in GARBAGE:
                try_it(value, one)
            for _ in range(60):
                try_it(value, *rng.choices(GARBAGE, k=rng.randint(2, 4)))
            for key in ("poses", "points", "gradients", "joints"):
                try_it(value, **{key: rng.choice(GARBAGE)})


def test_distances_of_every_pair_of_shapes_at_hostile_poses_have_ordered_bounds():
    shapes = [
        clearance.point(),
        clearance.point(radius=1e12),
        clearance.segment([0, 0, 0], [1e-9, 0, 0], radius=1e-3),
        clearance.box([1e-9, 1, 1e9]),
        clearance.ellipsoid([1e-3, 1, 1e3]),
        clearance.cone(1, 1e-6),
        clearance.polyhedron_from_halfspaces([[0, 0, 1, 0]]),
        clearance.polyhedron_from_halfspaces([[1, 0, 0, 1], [-1, 1e-3, 0, 1]]),
    ]
    half = math.sqrt(0.5)
    poses = [[x, 0, z, *q] for x in (0, 1e-300, 1e11) for z in (0, -1e-9) for q in ((0, 0, 0, 1), (half, 0, 0, half))]
    for a, b in itertools.product(shapes, shapes):
        for pose in poses:
            found = try_it(clearance.distance, a, b, pose)
            if found is not None:
                assert found.lower <= found.upper
