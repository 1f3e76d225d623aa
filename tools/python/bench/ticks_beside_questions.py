"""The tick of a running daemon with and without questions about motions, in turns.

usage: PYTHONPATH=BUILD/python python3 tools/python/bench/ticks_beside_questions.py BUILD/bin CELL [ROUNDS [SECONDS [OPTION OF clearanced]...]]

Each round runs the daemon and a simulated robot twice: once alone, once while a client asks one question after another.
The order changes from round to round. Figures are those that the daemon says at its end.
"""

import os
import re
import statistics
import subprocess
import sys
import time

import numpy as np

import clearance

CLIENT = "measure"
ROWS = 16


def motion(cell, generator):
    """A chunk of actions: ROWS waypoints in 0.5 s for all joints, near the middle of their ranges."""
    limits = np.clip(cell.joint_limits, -1.0, 1.0)
    middle, half = limits.mean(axis=1), 0.5 * (limits[:, 1] - limits[:, 0])
    begin, end = (middle + half * generator.uniform(-0.5, 0.5, len(middle)) for _ in range(2))
    share = np.linspace(0.0, 1.0, ROWS)[:, None]
    return cell.joints, 0.5 * share[:, 0], begin + share * (end - begin)


def run(programs, file, cell, seconds, asks, options):
    partition = f"measure-{os.getpid()}-{time.monotonic_ns()}"
    network = ["--partition", partition]
    daemon = subprocess.Popen(
        [f"{programs}/clearanced", file, "--questions", CLIENT, *network, *options],
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
    )
    robot = subprocess.Popen(
        [f"{programs}/clearance-robot", file, *network], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    generator, answers, refused, times = np.random.default_rng(1), 0, 0, []
    connection = clearance.Connection(partition=partition)
    with clearance.Questions(CLIENT, connection) as questions:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if not asks:
                time.sleep(0.1)
                continue
            begin = time.monotonic()
            asked = clearance.Question(*motion(cell, generator), margins=[0.0, 0.02], others="still")
            answer = questions.ask(asked, 30.0)
            times.append(time.monotonic() - begin)
            answers += answer.answered
            refused += not answer.answered
    robot.terminate()
    daemon.terminate()
    summary = daemon.communicate()[0]
    robot.wait()
    found = re.search(r"^tick +p50 ([\d.]+) us .*?p99\.9 ([\d.]+) us", summary, re.M)
    assert found, summary
    return float(found[1]), float(found[2]), answers, refused, times


def main(programs, file, rounds=4, seconds=20, *options):
    cell = clearance.Cell(file)
    found = {False: [], True: []}
    for number in range(int(rounds)):
        for asks in (False, True) if number % 2 == 0 else (True, False):
            p50, p999, answers, refused, times = run(programs, file, cell, float(seconds), asks, options)
            found[asks].append((p50, p999))
            text = f"; {answers} answers, {refused} refused" if asks else ""
            if times:
                text += f", p50 {1e3 * statistics.median(times):.2f} ms, max {1e3 * max(times):.2f} ms"
            print(f"{'with   ' if asks else 'without'} p50 {p50:6.1f} us  p99.9 {p999:7.1f} us{text}", flush=True)
    for at, name in ((0, "p50"), (1, "p99.9")):
        ratios = [w[at] / o[at] for w, o in zip(found[True], found[False])]
        print(f"{name}: with / without, median of {len(ratios)}: {statistics.median(ratios):.3f}")


if __name__ == "__main__":
    main(*sys.argv[1:])
