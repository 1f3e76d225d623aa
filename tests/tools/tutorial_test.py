"""The tutorials: their commands are run one after another, as a reader pastes them, and print what the pages show.

The pages about ROS 2 show commands and parts of cells in their sentences, too. Each is run or read by itself.

usage: tutorial_test.py BUILD
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
NUMBER = re.compile(r"-?\d+(\.\d+)?")


def text_of(page):
    return (ROOT / "tools" / page).read_text(encoding="utf-8")


def blocks(page):
    """The page's blocks of code, each as (language, text)."""
    return re.findall(r"^```(\w*)\n(.*?)^```$", text_of(page), re.DOTALL | re.MULTILINE)


def for_this_machine(page, text):
    """The block of code in a partition of its own."""
    own = f"tutorial-{os.getpid()}"
    if page == "FIRST_DAY.md":  # it names none
        return re.sub(r"\b(clearanced|clearance-robot|clearance-watch) (?!--check)", rf"\1 --partition {own} ", text)
    return text.replace("partition: tutorial", f"partition: {own}").replace("--partition tutorial", f"--partition {own}")


def pattern(line):
    """The line with any numbers in the place of its own."""
    at, parts = 0, []
    for number in NUMBER.finditer(line):
        parts += [re.escape(line[at:number.start()]), NUMBER.pattern]
        at = number.end()
    return re.compile("".join(parts) + re.escape(line[at:]))


class Tutorial(unittest.TestCase):
    def test_its_commands_run_and_print_what_it_shows(self):
        self.assertEqual(self.follow("TUTORIAL.md"), (5, 7))

    def test_the_first_day_does_as_well(self):
        self.assertEqual(self.follow("FIRST_DAY.md", "first"), (4, 2))

    def test_the_one_of_stops_does_as_well(self):
        self.assertEqual(self.follow("STOPS_TUTORIAL.md"), (5, 8))

    def test_the_page_of_questions_asks_what_it_shows(self):
        self.assertEqual(self.follow("../idl/QUESTIONS.md"), (1, 2))

    def follow(self, page, subfolder="tutorial"):
        """Runs the page's commands; returns how many blocks have run, and how many lines were compared."""
        with tempfile.TemporaryDirectory() as home:
            share = pathlib.Path(home) / "clearance/share/clearance"
            share.mkdir(parents=True)
            (share / "cells").symlink_to(ROOT / "config/cells")
            environment = {**{name: value for name, value in os.environ.items() if name != "ROS_DOMAIN_ID"}, "HOME": home, "PATH": f"{BUILD}/bin:/usr/bin:/bin", "PYTHONPATH": f"{BUILD}/python"}
            folder, output, ran, compared, recording = home, "", 0, 0, ""

            def run(text):
                return subprocess.run(["bash", "-euo", "pipefail", "-c", for_this_machine(page, text)], cwd=folder, env=environment,
                                      capture_output=True, text=True, timeout=120)

            for language, text in blocks(page):
                if language == "sh":
                    done = run(text)
                    if "--record" in text:
                        recording = text
                    # A busy machine delays joint states by more than the age limit, or ticks, and then the recording does not pass.
                    for _ in range(3 if "replay check" in text else 0):
                        if done.returncode != 1 or not re.search("stale|between this tick and the last", done.stdout + done.stderr):
                            break
                        (folder / "run.mcap").unlink()
                        self.assertEqual(run(recording).returncode, 0)
                        done = run(text)
                    folder = pathlib.Path(home) / subfolder
                    log = folder / "daemon.log"
                    output = done.stdout + done.stderr
                    self.assertEqual(done.returncode, 0, text + output + (log.read_text() if log.exists() else ""))
                    ran += 1
                elif language == "" and ran and "[" not in text and ">=" not in text:
                    for line in text.splitlines():
                        self.assertRegex(output, pattern(line))
                        compared += 1
            return ran, compared

    def test_the_thresholds_that_it_works_out_are_those_of_its_formula(self):
        text = text_of("TUTORIAL.md")
        v, a, delay = 0.5, 5.0, 0.010 + 0.001 + 0.019
        stop = v * delay + v * v / (2 * a)
        slow = stop + v * v / a
        for figure in (f"0.5 * {delay:.3f} + {v * v / (2 * a):.3f} = {stop:.3f} m", f"{stop:.3f} + {v * v / a:.2f} = {slow:.3f} m"):
            self.assertIn(figure, text)


ROS_PAGES = ("../idl/ROS.md", "../idl/SIMULATED_TIME.md", "ros2/README.md")
ARM = ROOT / "config/cells/seven_joint_arm/arm"
# Keys that make a cell of the parts on the pages.
CELL = {
    "name": "page",
    "units": "{length: m, angle: rad}",
    "rate_hz": "50",
    "robots": f"[{{name: arm, urdf: {ARM}.urdf, srdf: {ARM}.srdf}}]",
    "pairs": "[{between: [arm, arm]}]",
}
# Commands that need a ROS 2, and those that only copy. A new one is either ours, and run here, or belongs into this list.
NOT_RUN = {
    "cp -r ~/clearance/share/clearance/ros2/* ~/workspace/src/",
    "cd ~/workspace && colcon build && . install/setup.sh",
    "colcon build --base-paths src/clearance/tools/ros2",
    "colcon build --packages-skip clearance_moveit",
    "colcon list",
    "ros2 bag play",
    "ros2 bag play BAG",
    "ros2 bag play BAG --clock",
    "ros2 bag record",
    "ros2 bag record -a",
    "ros2 launch",
    "ros2 launch clearance_ros clearance.launch.py cell:=cell.yaml rviz:=true",
    "ros2 node list",
    "ros2 topic echo",
    "ros2 topic echo /clearance/zones",
    "ros2 topic info",
    "ros2 topic list",
    "tools/check --ros2",  # tools/RosPackages
}
NOT_OURS = {"--base-paths", "--clock", "--show-args", "--skip-keys"}  # options


def shown(page):
    """All that a page shows as code: the lines of its blocks without their comments, and what stands in its sentences."""
    in_blocks = [line.partition("  #")[0].strip() for language, text in blocks(page) if language != "yaml" for line in text.splitlines()]
    sentences = re.sub(r"^```.*?^```$", "", text_of(page), flags=re.DOTALL | re.MULTILINE)
    return in_blocks + [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", sentences)]


class RosPages(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        joints = [*(f"joint{i}" for i in range(1, 8)), "finger"]
        rows = [["t_ns", *joints], *([str(i * 10_000_000), *["0.01"] * len(joints)] for i in range(3))]
        (pathlib.Path(self.folder.name) / "BAG").write_text("".join(",".join(row) + "\n" for row in rows))

    def write_cell(self, part=""):
        if "tracked_bodies" in part:  # is refused without a person
            part += "\nrobots: [{name: arm, person: {stature: 1.75, error: 0.1}}]"
        keys = re.findall(r"^(\w+):", part, re.MULTILINE)
        rest = "".join(f"{key}: {value}\n" for key, value in CELL.items() if key not in keys)
        (pathlib.Path(self.folder.name) / "CELL").write_text(rest + part + "\n")

    def run_here(self, words):
        done = subprocess.run([f"{BUILD}/bin/{words[0]}", *words[1:]], cwd=self.folder.name, capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, 0, f"{words}\n{done.stdout}{done.stderr}")
        return done.stdout

    def test_each_command_of_ours_runs_and_each_other_one_is_listed(self):
        commands = {code for page in ROS_PAGES for code in shown(page) if re.match(r"(clearanced|clearance-\w+|ros2|colcon|rosdep|cp|cd|tools/\w+) ", code)}
        ours = {code for code in commands if code.startswith("clearance")}
        self.assertEqual(commands - ours, NOT_RUN)
        self.write_cell()
        for words in map(str.split, sorted(ours)):
            words += [] if "CELL" in words or "BAG" in words else [{"clearanced": "CELL", "clearance-replay": "BAG"}[words[0]]]
            self.run_here(words + (["--check"] if words[0] == "clearanced" else ["--cell", "CELL"]))
        self.assertEqual(len(ours), 4)

    def test_each_option_is_one_of_ours_or_listed(self):
        told = "".join(self.run_here([*program, "--help"]) for program in (["clearanced"], ["clearance-replay", "check"]))
        options = {code.split()[0] for page in ROS_PAGES for code in shown(page) if code.startswith("--")}
        self.assertEqual({each for each in options if not re.search(rf"(^|[ ,]){each}\b", told, re.MULTILINE)}, NOT_OURS)

    def test_each_part_of_a_cell_is_read(self):
        parts = {code for page in ROS_PAGES for code in shown(page) if re.match(r"\w+: [{[]", code)}
        parts |= {text for page in ROS_PAGES for language, text in blocks(page) if language == "yaml"}
        for part in sorted(parts):
            self.write_cell(part)
            self.run_here(["clearanced", "CELL", "--check"])
        self.assertEqual(len(parts), 6)


if __name__ == "__main__":
    unittest.main()
