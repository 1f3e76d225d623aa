"""A robot's distances, live. Beside it runs: clearanced --urdf arm.urdf --srdf arm.srdf

usage: live_distances.py URDF [SRDF] [PARTITION] [REPORTS]
example: live_distances.py arm.urdf arm.srdf
"""

import sys

import clearance

urdf, srdf, partition, count = (sys.argv[1:] + [None] * 4)[:4]
cell = clearance.Cell.from_urdf(urdf, srdf or None)
with clearance.Reports(clearance.Connection(cell, partition=partition or "")) as reports:
    for heard, report in enumerate(reports, start=1):
        if report.fresh and report.minimum_known:
            print(f"{report.minimum['lower']:.4f} m", *report.minimum_names)
        if count and heard >= int(count):
            break
