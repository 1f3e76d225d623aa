"""The lines of tools/python/README.md run where the page says, and are Python everywhere."""

import re

from conftest import SOURCE

TEXT = (SOURCE / "tools/python/README.md").read_text()


def blocks_of(chapter):
    text = TEXT.split(f"## {chapter}\n")[1].split("\n## ")[0]
    return re.findall(r"```python\n(.*?)```", text, re.S)


def test_the_lines_about_bodies_and_robots_run(monkeypatch, arm_files):
    monkeypatch.chdir(arm_files[0].parent)
    for chapter in ("Distances of bodies", "Distances of a robot"):
        [block] = blocks_of(chapter)
        exec(compile(block, chapter, "exec"), {})


def test_the_other_lines_are_python():
    for chapter in ("Motions before they are made", "Recordings", "Live", "A cell in shares"):
        [block] = blocks_of(chapter)
        compile(block, chapter, "exec")
