"""Plots the least distance of a recording: a bag of ROS 2, a recording of ours or joints as CSV.

The picture is made by matplotlib if it is installed; otherwise it is an SVG of one curve.

usage: least_distances.py CELL RECORDING PICTURE
example: least_distances.py cell.yaml run.mcap distances.svg
"""

import sys

import numpy as np

import clearance


def plot(time, least, picture):
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(8, 4))
    axes.plot(time, least)
    axes.set(xlabel="time (s)", ylabel="least distance, certified (m)")
    figure.savefig(picture)


def draw(time, least, picture):
    width, height, left, top = 800, 400, 70, 20
    low, high = min(0.0, least.min()), max(least.max(), 1e-3)
    x = left + (width - left - top) * time / max(time[-1], 1e-9)
    y = top + (height - 3 * top) * (high - least) / (high - low)
    curve = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
    bottom = height - 2 * top
    labels = [(left, height - top, "0 s"), (width - 3 * top, height - top, f"{time[-1]:.1f} s")]
    labels += [(5, top + 5, f"{high:.3f} m"), (5, bottom, f"{low:.3f} m")]
    with open(picture, "w", encoding="utf-8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}">\n')
        file.write('<rect width="100%" height="100%" fill="white"/>\n')
        file.write(f'<polyline points="{curve}" fill="none" stroke="#1f5fa8" stroke-width="1.5"/>\n')
        for at_x, at_y, text in labels:
            file.write(f'<text x="{at_x}" y="{at_y}" font-family="sans-serif">{text}</text>\n')
        file.write("</svg>\n")


cell_file, recording, picture = sys.argv[1:]
ticks = clearance.replay(clearance.Cell(cell_file), recording)
known = ticks[np.isfinite(ticks.lower_all)]
if len(known) == 0:
    sys.exit(f"{recording}: no tick knows all pairs")
try:
    plot(known.time_s, known.lower_all, picture)
except ImportError:
    draw(known.time_s, known.lower_all, picture)
worst = known[known.lower_all.argmin()]
names = " - ".join(clearance.Cell(cell_file).pairs[worst.minimum_pair])
print(f"least distance {worst.lower_all:.4f} m at {worst.time_s:.3f} s, {names}: {picture}")
