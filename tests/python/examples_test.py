"""The examples run as their usage says."""

import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree

from conftest import DOMAIN, SOURCE

import clearance

EXAMPLES = SOURCE / "tools/python/examples"


def run(name, *arguments):
    done = subprocess.run(
        [sys.executable, EXAMPLES / name, *map(str, arguments)],
        capture_output=True, text=True, timeout=120,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_ten_thousand_random_configurations_have_their_nearest_pairs(arm_files, arm):
    said = run("random_configurations.py", *arm_files, 10_000)
    counts = dict(re.findall(r"^ +\d+  (.*) - (.*)$", said, re.M))
    assert f"10000 configurations, {len(arm.pairs)} pairs" in said and counts
    assert all(pair in arm.pairs for pair in counts.items())


def test_a_plot_shows_the_least_distance_of_a_recording(planar_file, tmp_path):
    cell = planar_file.parent / "alone.yaml"
    cell.write_text(
        "name: alone\nunits: {length: m, angle: rad}\nrobots: [{name: arm, urdf: planar.urdf}]\n"
        "objects: [{name: wall, fixed: true, box: {size: [1, 1, 1]}, pose: {xyz: [3, 0, 0]}}]\n"
        "pairs: [{between: [arm, wall], publish: true}]\n"
    )
    log = tmp_path / "run.csv"
    rows = [f"{1_000_000_000 + 10_000_000 * i},{0.01 * i},0" for i in range(100)]
    log.write_text("t_ns,shoulder,elbow\n" + "\n".join(rows) + "\n")
    picture = tmp_path / "least.svg"
    said = run("least_distances.py", cell, log, picture)
    # The tip begins at (2, 0, 0), 0.1 m thick, before a wall at x = 2.5.
    assert re.match(r"least distance 0\.4000 m at 0\.0\d\d s", said)
    assert ElementTree.parse(picture).getroot().tag.endswith("svg")


def test_the_live_example_prints_distances(run_daemon, arm_files, arm):
    daemon = run_daemon("--urdf", arm_files[0], "--srdf", arm_files[1], "--age-limit-ms", 10_000)
    # The example joins domain 0: here its first lines run in the test's domain.
    text = (EXAMPLES / "live_distances.py").read_text()
    assert "clearance.Connection(cell, " in text
    text = text.replace("clearance.Connection(cell, ", f"clearance.Connection(cell, domain={DOMAIN}, ")
    connection = daemon.connection()
    with clearance.JointWriter("example", arm.joints, connection) as writer:
        assert writer.wait_heard(30)
        example = subprocess.Popen(
            [sys.executable, "-c", text, *map(str, arm_files), daemon.partition, "300"],
            stdout=subprocess.PIPE, text=True,
        )
        at = 0.5 * arm.joint_limits.clip(-3, 3).sum(axis=1)
        while example.poll() is None:
            writer.write(at)
            try:
                example.wait(0.005)
            except subprocess.TimeoutExpired:
                pass
        lines = example.stdout.read().splitlines()
    assert example.returncode == 0 and lines
    exact = arm.distances([at])
    nearest = exact.upper[0].argmin()
    assert lines[-1].split()[0] == f"{exact.lower[0][nearest]:.4f}"
