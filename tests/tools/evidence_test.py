"""tools/evidence: what it fails for, with one planted fault each, and what it writes of a run.

usage: evidence_test.py BUILD
"""
import copy, fnmatch, json, pathlib, re, subprocess, sys, tempfile, unittest

import yaml

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop(1)).resolve()
sys.path.insert(0, str(ROOT / "tools/evidence_parts"))
import fmea, matrix, outcome, sbom, surroundings

GOOD = {
    "promises": [{"id": "P1", "text": "Distances of points are right.", "tests": ["Distance.OfPointsIsEuclid"]}],
    "assumptions": [
        {"id": "A1", "text": "Bodies are stated.", "detected_by": "none", "why": "Nothing sees them."},
        {"id": "A2", "text": "Shapes are solid.", "detected_by": "the factories refuse others",
         "tests": ["Shapes.WhatIsNoSolidIsRefusedWithItsReason"]}],
}


class Evidence(unittest.TestCase):
    def judged(self, requirements, run=False):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "requirements.yaml"
            file.write_text(yaml.safe_dump(requirements))
            return matrix.judge(file, BUILD, pathlib.Path(folder) if run else None)

    def test_HasNoFaultWhereEachTestRunsAndPasses(self):
        judged = self.judged(GOOD, run=True)
        self.assertEqual(judged["faults"], [])
        self.assertEqual([test["outcome"] for entry in judged["matrix"] for test in entry["tests"]], ["passed"] * 2)

    def test_FailsForEachFaultOfTheListByName(self):
        def without(kind, place, key):
            wrong = copy.deepcopy(GOOD)
            del wrong[kind][place][key]
            return wrong

        def changed(kind, place, key, value):
            wrong = copy.deepcopy(GOOD)
            wrong[kind][place][key] = value
            return wrong

        for wrong, expected in [
            (without("promises", 0, "tests"), "P1: the promise has no test"),
            (changed("promises", 0, "tests", []), "P1: the promise has no test"),
            (changed("promises", 0, "tests", ["Distance.OfPoints"]), "P1: Distance.OfPoints: there is no such test"),
            (without("assumptions", 0, "detected_by"), "A1: the assumption has no answer"),
            (without("assumptions", 0, "why"), "A1: found 'detected_by: none'; expected a reason"),
            (without("assumptions", 1, "tests"), "A2: something detects a breach, and no test shows it"),
            (changed("assumptions", 1, "id", "A1"), "A1: expected an id of its own"),
            (changed("promises", 0, "test", "x"), "P1: the key 'test' is not known"),
            ({**GOOD, "hopes": []}, "the list has 'hopes'"),
        ]:
            with self.subTest(expected):
                faults = self.judged(wrong)["faults"]
                self.assertTrue(faults and faults[0].startswith(expected), faults)

    def test_CountsWhatFailedOrDidNotRun(self):
        with tempfile.TemporaryDirectory() as folder:
            build = pathlib.Path(folder)
            (build / "bin").mkdir()
            program = build / "bin/some_tests"
            cases = [{"name": "Fails", "result": "COMPLETED", "failures": [{}]}, {"name": "Skips", "result": "SKIPPED"}]
            report = json.dumps({"testsuites": [{"name": "Some", "testsuite": cases}]})
            program.write_text("#!/bin/sh\ncase $1 in --gtest_list_tests) printf 'Some.\\n  Fails\\n  Skips\\n  Ends\\n';;\n"
                               f"*) printf '%s' '{report}' >\"${{2#--gtest_output=json:}}\";; esac\n")
            program.chmod(0o755)
            wanted = build / "requirements.yaml"
            tests = ["Some.Fails", "Some.Skips", "Some.Ends"]
            wanted.write_text(yaml.safe_dump({"promises": [{"id": "P1", "text": "All.", "tests": tests}]}))
            faults = matrix.judge(wanted, build, build)["faults"]
        self.assertEqual(faults, ["P1: Some.Fails: failed", "P1: Some.Skips: skipped", "P1: Some.Ends: not run"])

    def test_TakesInALongRunOfThisCommitAlone(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            file = root / "file"

            def commit(text):
                file.write_text(text)
                for command in (["init", "-q"], ["add", "file"], ["-c", "user.name=a", "-c", "user.email=a@b", "commit", "-qm", text]):
                    outcome.git(root, *command)

            commit("one")
            self.assertEqual(outcome.read(root, "soak"), {"outcome": "not run (tools/soak)", "faults": []})
            began = outcome.tree(root)
            outcome.write(root, "soak", "9 faults", ["a leak"], began, rooms={"core": 1})
            self.assertEqual([outcome.read(root, "soak")[key] for key in ("outcome", "faults", "rooms")], ["9 faults", ["a leak"], {"core": 1}])
            self.assertEqual(outcome.tree_since(root, began), began)
            commit("two")
            self.assertTrue(outcome.tree_since(root, began)["is_changed"])
            outcome.write(root, "soak", "9 faults", ["a leak"], began)
            first = began["commit"][:12]
            self.assertEqual(outcome.read(root, "soak"),
                             {"outcome": f"not run on this commit; on {first} it was: 9 faults", "faults": []})
            file.write_text("three")
            outcome.write(root, "soak", "no fault", [], outcome.tree(root))
            self.assertIn(", changed it was: no fault", outcome.read(root, "soak")["outcome"])

    def test_FailsForProgramsOfAnotherCommitForChangedFilesAndForFaultsOfALongRun(self):
        good = {"commit": "0123456789abcdef", "changed_files": [], "built": "clearance 1, 0123456789ab, GNU, Release",
                "long_runs": {"coverage": {"outcome": "no fault", "faults": []}}}
        self.assertEqual(list(surroundings.faults(good)), [])
        for change, expected in [
            ({"changed_files": [" M core/vec.hpp"]}, "1 files are changed beside the commit"),
            ({"built": "clearance 1, 0123456789ab with changes, GNU"}, "the programs are not built from the commit"),
            ({"built": "clearance 1, ba9876543210, GNU, Release"}, "the programs are not built from the commit"),
            ({"built": ""}, "the programs are not built from the commit"),
            ({"long_runs": {"soak": {"outcome": "one", "faults": ["a leak"]}}}, "soak: a leak"),
        ]:
            with self.subTest(expected):
                self.assertTrue(next(surroundings.faults({**good, **change})).startswith(expected))

    def test_JoinsTimesWithTheRowThatTellsThem(self):
        page = """## Stops
| what is wrong | published meanwhile | what to do | test |
|---|---|---|---|
| a joint is late: `[poses-late]` | nothing | see below | `Stops.Late` |
## Late
| code | the line says | cause | what to do |
|---|---|---|---|
| `[poses-late]` | poses are late | the source stopped | start it again |
| | the same | a rare transform | publish it |
| `[poses-even]` | poses are even | no source | - |
## Refused
| CAUSE | meaning | published meanwhile | what to do |
|---|---|---|---|
| not finite; no pose | nonsense \\| damage | [unknown](#late) | repair it |
## Meanwhile
| of rows in | published meanwhile | seen by | what to do |
|---|---|---|---|
| [late](#late) | wider bounds | health | wait |
| `[poses-odd]`, `[poses-even]` | narrow bounds | the log | - |
## Tests
| section | rows | tests |
|---|---|---|
| [late](#late), [refused](#refused) | poses | `Poses.*` |
"""
        time = {"kind": "Silence", "test": "Lies.Are/Silence", "p50_ticks": 21, "max_ticks": 23, "runs": 5}
        found, lost = fmea.joined(page, {"poses-late": [time], "no pose": [time], "pose": [time]})
        self.assertEqual([len(row["times"]) for row in found], [0, 1, 0, 0, 1])
        self.assertEqual([row["detection"] for row in found], ["see `[poses-late]`"] + ["`[poses-late]`"] * 2 + ["`[poses-even]`", "not finite; no pose"])
        self.assertEqual((found[4]["cause"], found[4]["effect"]), ("nonsense | damage", "unknown"))
        self.assertEqual([row["effect"] for row in found], ["nothing", "wider bounds", "wider bounds", "narrow bounds", "unknown"])
        self.assertEqual([row["test"] for row in found], ["`Stops.Late`"] + ["`Poses.*`"] * 4)
        self.assertEqual(lost, ["monitor/FAULTS.md has no row for 'pose', which Lies.Are/Silence has told"])
        case = {"name": "Are/Silence", "time until detected: poses-late": "21 23 5", "file": "x"}
        self.assertEqual(list(fmea.times_of(case, "Lies")), [("poses-late", time)])

    def test_EachRowOfThePageOfFaultsNamesTestsThatExist(self):
        cases = [name for program in sorted(BUILD.glob("bin/*_tests")) for name in matrix.listed(program)]
        patterns = set()
        for row in fmea.rows((ROOT / "monitor/FAULTS.md").read_text()):
            found = re.findall(r"`([A-Z][\w*]*\.[\w*]+)`", row["test"])
            self.assertTrue(found, f"monitor/FAULTS.md: no test for {row['detection']}: {row['cause']}")
            for kind in ("cause", "effect", "detection", "reaction"):
                self.assertTrue(row[kind], f"monitor/FAULTS.md: no {kind} of {row['detection']}: {row['cause']}")
            patterns.update(found)
        for pattern in sorted(patterns):
            known = any(fnmatch.fnmatch(name, place) for name in cases
                        for place in (pattern, f"*/{pattern}", f"{pattern}/*", f"*/{pattern}/*"))
            is_of_page = pattern.startswith("View.") and not (BUILD / "bin/view_tests").exists()
            self.assertTrue(known or is_of_page, f"monitor/FAULTS.md names {pattern}")

    def test_NamesWhatALibraryIsAndWhereItComesFrom(self):
        listed = {each["name"]: each for each in sbom.document(ROOT, BUILD)["packages"]}
        self.assertEqual(listed["clearance"]["licenseDeclared"], "NOASSERTION")
        for pattern, how in [("libyaml-cpp[0-9]*", "linked dynamically"), ("libeigen3-dev", "headers compiled in")]:
            query = ["dpkg-query", "-W", "-f=${Package} ${Version}", pattern]
            name, version = subprocess.run(query, capture_output=True, text=True, check=True).stdout.split()
            self.assertEqual(listed[name]["versionInfo"], version)
            self.assertIn(how, listed[name]["sourceInfo"])
            self.assertNotIn("nothing that is marked", listed[name]["licenseComments"])

    def test_ThePageOfThreatsNamesTestsThatExist(self):
        page = (ROOT / "monitor/SECURITY.md").read_text()
        programs = sorted(BUILD.glob("bin/*_tests"))
        names = {name for program in programs for name in matrix.listed(program)}
        python = "".join(file.read_text() for file in (ROOT / "tests/python").glob("*_test.py"))
        tests = re.findall(r"`([A-Z]\w+\.[A-Z]\w+|test_\w+)`", page)
        self.assertGreater(len(tests), 30)
        for test in tests:
            if test.startswith("ViewAccess.") and not (BUILD / "bin/view_tests").exists():
                continue  # built where the page's libraries are
            known = f"def {test}(" in python or any(matrix.stands_for(test, name) for name in names)
            self.assertTrue(known, f"monitor/SECURITY.md names {test}")


if __name__ == "__main__":
    unittest.main()
