"""A robot's distances, live. Beside it runs: clearanced --urdf arm.urdf --srdf arm.srdf

usage: live_distances.py URDF SRDF [PARTITION [REPORTS]]
example: live_distances.py arm.urdf arm.srdf
"""

import itertools
import sys

import clearance

cell = clearance.Cell.from_urdf(sys.argv[1], sys.argv[2])
connection = clearance.Connection(cell, partition="".join(sys.argv[3:4]))
with clearance.Reports(connection) as reports:
    for report in itertools.islice(reports, int(sys.argv[4]) if len(sys.argv) > 4 else None):
        if report.fresh and report.minimum_names:
            print(f"{report.minimum['lower']:.4f} m", *report.minimum_names)
