"""The tutorials: their commands are run one after another, as a reader pastes them, and print what the pages show.

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


if __name__ == "__main__":
    unittest.main()
