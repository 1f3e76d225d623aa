"""The lines of tools/python/README.md run where the page says, and are Python everywhere."""

import itertools
import re

import clearance
from conftest import DOMAIN, SOURCE

TEXT = (SOURCE / "tools/python/README.md").read_text()


def blocks_of(chapter):
    text = TEXT.split(f"## {chapter}\n")[1].split("\n## ")[0]
    return re.findall(r"```python\n(.*?)```", text, re.S)


def test_the_lines_about_bodies_and_robots_run(monkeypatch, arm_files):
    monkeypatch.chdir(arm_files[0].parent)
    for chapter in ("Distances of bodies", "Distances of a robot"):
        [block] = blocks_of(chapter)
        exec(compile(block, chapter, "exec"), {})


# Wall and ball are out of the arm's reach. A factor of a motion that need not be stoppable may be larger than 1.
def test_the_lines_about_stops_run(monkeypatch, planar_file):
    stops = "stopping: {reaction_ms: 40, time_ms: 160}"
    text = planar_file.read_text().replace("planar.urdf}", f"planar.urdf, {stops}}}").replace("max_speed: 100", "max_speed: 0.1")
    (planar_file.parent / "stopping.yaml").write_text(text)
    monkeypatch.chdir(planar_file.parent)
    names = {"clearance": clearance}
    exec(compile(blocks_of("Motions before they are made")[1], "stops", "exec"), names)
    assert names["answer"].is_free(0.02) and names["answer"].time_limit.factor == 1


# Five times, since names and reports come on two topics, in any order.
def test_the_lines_about_reports_run_with_the_first_report(monkeypatch, run_daemon, planar_file):
    cell = planar_file.read_text().replace("wall", "table").replace("lower", "hand")
    planar_file.write_text(cell)
    urdf = planar_file.parent / "planar.urdf"
    urdf.write_text(urdf.read_text().replace("lower", "hand").replace('<limit hand=', '<limit lower='))
    daemon = run_daemon(planar_file)
    monkeypatch.setenv("ROS_DOMAIN_ID", str(DOMAIN))
    [block] = blocks_of("Live")
    block = block.replace('"lab"', repr(daemon.partition)).replace("in reports:", "in itertools.islice(reports, 3):")
    for _ in range(5):
        names = {"clearance": clearance, "itertools": itertools}
        exec(compile(block, "Live", "exec"), names)
        assert names["report"].pairs_total == 4 and names["hand"]["lower"] == -float("inf")


def test_the_other_lines_are_python():
    for chapter in ("Motions before they are made", "Recordings", "A cell in shares"):
        block = blocks_of(chapter)[0]
        compile(block, chapter, "exec")
