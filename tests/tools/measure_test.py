"""Pages of measured figures: each has its command, and tools/measure --stale names those that are older than their code.

usage: measure_test.py
"""
import importlib.machinery
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import yaml

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
LOADER = importlib.machinery.SourceFileLoader("measure", str(ROOT / "tools/measure"))
measure = importlib.util.module_from_spec(importlib.util.spec_from_loader("measure", LOADER))
LOADER.exec_module(measure)


class ListOfPages(unittest.TestCase):
    def setUp(self):
        self.pages = yaml.safe_load((ROOT / measure.MEASURED / "pages.yaml").read_text())

    def test_it_has_each_measured_page_and_no_other(self):
        self.assertEqual(sorted(self.pages), sorted(page.stem for page in (ROOT / measure.MEASURED).glob("*.md")))

    def test_each_page_depends_on_folders_that_exist_and_is_measured_by_a_script_of_the_tree_or_a_built_program(self):
        for page, entry in self.pages.items():
            for folder in entry["of"]:
                self.assertTrue((ROOT / folder).is_dir(), f"{page}: {folder}")
            for script in re.findall(r"\btools/\S+", entry["by"]):
                self.assertTrue((ROOT / script).is_file(), f"{page}: {script}")
            self.assertTrue(re.match(r"build/bench/bin/|tools/|node build/", entry["by"]), page)


class Stale(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.git("init", "-q")
        self.write("core/distance.cpp", "int a;\n")
        self.write("other/tick.cpp", "int b;\n")
        self.git("add", ".")
        self.measured_at = self.commit()

    def git(self, *words):
        user = ["-c", "user.name=a", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"]
        done = subprocess.run(["git", *user, *words], cwd=self.root, capture_output=True, text=True, check=True)
        return done.stdout.strip()

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text)
        self.git("add", path)

    def commit(self):
        self.git("commit", "-q", "--allow-empty", "-m", "c")
        return self.git("rev-parse", "HEAD")

    def stale_after(self, path, text, commit=None):
        self.write(f"{measure.MEASURED}/speed.md", f"# Speed\n\nMeasured at commit {commit or self.measured_at[:8]}.\n")
        self.write(path, text)
        self.commit()
        return list(measure.stale(self.root, {"speed": {"of": ["core"], "by": "true"}}))

    def test_is_a_page_whose_code_has_changed_since_its_commit(self):
        self.assertEqual(self.stale_after("core/distance.cpp", "int c;\n"), ["speed"])

    def test_is_no_page_after_a_change_of_other_code_or_of_a_text(self):
        self.assertEqual(self.stale_after("other/tick.cpp", "int c;\n"), [])
        self.assertEqual(self.stale_after("core/README.md", "words\n"), [])

    def test_is_a_page_of_a_commit_that_is_not_in_the_history_and_one_that_names_none(self):
        self.assertEqual(self.stale_after("other/tick.cpp", "int c;\n", "0123456789"), ["speed"])
        self.assertEqual(self.stale_after("other/tick.cpp", "int d;\n", "unknown"), ["speed"])


if __name__ == "__main__":
    unittest.main()
