"""The nearest pair of a robot in random configurations.

usage: random_configurations.py URDF [SRDF] [COUNT]
example: random_configurations.py arm.urdf arm.srdf 10000
"""

import sys
import time
from collections import Counter

import numpy as np

import clearance

cell = clearance.Cell.from_urdf(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else None)
count = int(sys.argv[3]) if len(sys.argv) > 3 else 10_000
lower, upper = np.clip(cell.joint_limits, -np.pi, np.pi).T
joints = np.random.default_rng(1).uniform(lower, upper, (count, len(cell.joints)))

begin = time.perf_counter()
found = cell.distances(joints)
seconds = time.perf_counter() - begin
nearest = found.upper.argmin(axis=1)
least = found.distance[np.arange(count), nearest]
print(f"{count} configurations, {len(cell.pairs)} pairs: {1e6 * seconds / count:.1f} us each")
print(f"{np.count_nonzero(least <= 0)} in collision; median distance {np.median(least):.4f} m")
for pair, times in Counter(nearest.tolist()).most_common(5):
    print(f"{times:6}  {' - '.join(cell.pairs[pair])}")
