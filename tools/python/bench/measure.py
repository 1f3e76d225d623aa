"""What Python adds to the C++ API: each time in turns with the same loop in C++.

A live report is measured only with a daemon's program: it ticks, reports wait, and their taking is timed.

usage: measure.py BUILD [ROUNDS]
example: PYTHONPATH=build/release/python python3 tools/python/bench/measure.py build/release
"""

import math
import pathlib
import subprocess
import sys
import time
import uuid

import numpy as np

import clearance

BUILD = pathlib.Path(sys.argv[1])
ROUNDS = int(sys.argv[2]) if len(sys.argv) > 2 else 7
CELLS = pathlib.Path(__file__).resolve().parents[3] / "config/cells"
ARM = [CELLS / "seven_joint_arm/arm.urdf", CELLS / "seven_joint_arm/arm.srdf"]
COUNT = 10_000


def time_of_query():
    count, cube, state = 200_000, clearance.box([0.5, 0.5, 0.5]), clearance.TrackingState()
    pose = clearance.Pose([2, 0.3, 0.4], [0.1, 0.2, 0.3, math.sqrt(0.86)])
    relative, distance = clearance.RelativePose(clearance.Pose(), pose), clearance.distance
    begin = time.perf_counter()
    for _ in range(count):
        distance(cube, cube, relative, state)
    return 1e9 * (time.perf_counter() - begin) / count


def time_of_configuration(cell, joints):
    begin = time.perf_counter()
    found = cell.distances(joints)
    seconds = time.perf_counter() - begin
    assert np.isfinite(found.lower).all()
    return 1e6 * seconds / COUNT


def times_of_reports(cell_file):
    """us for each waiting report of two_arms (123 pairs), taken as arrays."""
    network = {"domain": 97, "partition": uuid.uuid4().hex}
    options = [f"--{key}={value}" for key, value in network.items()]
    daemon = subprocess.Popen(
        [BUILD / "bin/clearanced", cell_file, *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    times = []
    try:
        with clearance.Reports(clearance.Connection(**network), depth=512) as reports:
            assert reports.next(30) is not None
            for _ in range(ROUNDS):
                time.sleep(0.3)
                reports.next(1)
                for _ in range(200):
                    begin = time.perf_counter()
                    report = reports.next(0)
                    end = time.perf_counter()
                    if report is not None:
                        times.append(1e6 * (end - begin))
            print(f"live report of {len(report.pairs)} pairs: ", end="")
    finally:
        daemon.terminate()
        daemon.wait()
    return np.percentile(times, [1, 50, 99])


cell = clearance.Cell.from_urdf(*ARM)
lower, upper = cell.joint_limits.clip(-3.14, 3.14).T
joints = np.random.default_rng(1).uniform(lower, upper, (COUNT, len(cell.joints)))
queries, configurations = [], []
for _ in range(ROUNDS):
    said = subprocess.check_output([BUILD / "bin/clearance_python_loop", *ARM, str(COUNT)], text=True)
    query, configuration = map(float, said.split())
    queries.append((query, time_of_query()))
    configurations.append((configuration, time_of_configuration(cell, joints)))
query, configuration = np.min(queries, axis=0), np.min(configurations, axis=0)
print(f"distance(): {query[0]:.0f} ns in C++, {query[1] - query[0]:.0f} ns more in Python")
print(
    f"distances() of {COUNT} configurations, {len(cell.pairs)} pairs: {configuration[0]:.2f} us each in C++, "
    f"{configuration[1] / configuration[0]:.2f} times that in Python"
)
print("{:.1f} us at best, {:.1f} median, {:.1f} p99".format(*times_of_reports(CELLS / "two_arms.yaml")))
