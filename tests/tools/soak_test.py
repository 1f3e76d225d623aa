"""tools/soak: what is planted in a round that runs makes it fail, and the same round without it holds.

usage: soak_test.py FOLDER-OF-BUILD
"""

import importlib.machinery
import importlib.util
import os
import pathlib
import shutil
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv[1]).resolve()
sys.path[:0] = [str(ROOT / "tools/soak_parts"), str(ROOT / "tools/evidence_parts"), str(BUILD / "python")]
LOADER = importlib.machinery.SourceFileLoader("soak", str(ROOT / "tools/soak"))
soak = importlib.util.module_from_spec(importlib.util.spec_from_loader("soak", LOADER))
LOADER.exec_module(soak)

import cells, clients, faults, fmea, judge, run as running

os.environ.pop("CYCLONEDDS_URI", None)
SEED = 3  # of a round of bodies


class Unheard(faults.Fault):
    """A fault that nothing tells, as if the daemon had missed it."""
    of, code = "nothing", "poses-late"

    def begin(self):
        pass


class Shifted(cells.Motion):
    """The truth is 10 mm elsewhere than all that was sent."""

    def pose(self, item, stamp_ns):
        pose, twist = super().pose(item, stamp_ns)
        return [pose[0], pose[1], pose[2] + 0.01, *pose[3:]], twist

    def joints(self, robot, stamp_ns):
        values, rates = super().joints(robot, stamp_ns)
        return [value + 0.005 for value in values], rates


def reasons(kinds, plant=lambda run: None, limit_s=running.LIMIT_S):
    """Why a short round fails that has these faults once; `plant` changes it once all is started."""
    options = soak.parsed(["--build", str(BUILD)])
    was, limit, reader = faults.ALL, running.LIMIT_S, running.Run.read
    faults.ALL, running.LIMIT_S = kinds, limit_s
    running.Run.read = lambda run: (plant(run), reader(run))
    try:
        result = soak.play(options, SEED, 1.0)
    finally:
        faults.ALL, running.LIMIT_S, running.Run.read = was, limit, reader
    shutil.rmtree(result["folder"])
    return result, judge.verdict(result)


class Soak(unittest.TestCase):
    def test_holds_where_nothing_is_planted(self):
        result, found = reasons([faults.LeapingSource])
        self.assertEqual(found, [])
        self.assertGreater(result["judged"], 0)
        self.assertGreater(result["faults"][0]["detected"], 0)

    def test_has_the_times_until_a_line_tells_a_fault_by_its_code_and_kind(self):
        def fault(kind, code, told_s):
            return {"kind": kind, "code": code, "told_s": told_s, "detected": told_s is not None}
        told = [{"faults": [fault("KilledSender", "poses-late", 0.03), fault("StoppedSender", "poses-late", 0.5), fault("KilledSender", "poses-late", 0.05), fault("KilledSender", "poses-late", 0.2)]},
                {"faults": [fault("KilledDaemon", "started", 1.0), fault("LeapingSource", "", 0.1), fault("KilledPartner", "partner-missing", None)]}]
        times = soak.times_of(told)
        self.assertEqual(list(times), ["poses-late"])
        self.assertEqual([tuple(each.values()) for each in times["poses-late"]],
                         [("KilledSender", "tools/soak", 50, 200, 3), ("StoppedSender", "tools/soak", 500, 500, 1)])
        rows = fmea.rows((ROOT / "monitor/FAULTS.md").read_text())
        for kind in faults.ALL:
            for code in {kind.code, *getattr(kind, "codes", ())} - {"", "started"}:
                self.assertTrue(any(fmea.tells(row, code) for row in rows), f"monitor/FAULTS.md has no row for {code}")

    def test_finds_bounds_that_are_false_of_a_truth_elsewhere(self):
        def shift(run):
            run.drawn.motion.__class__ = Shifted
        result, found = reasons([faults.LeapingSource], shift)
        self.assertGreater(result["false_count"], 0)
        self.assertTrue(found and found[0].startswith("false:"), found)

    def test_finds_a_fault_that_nothing_tells(self):
        _, found = reasons([Unheard], limit_s=3.0)
        self.assertEqual([one for one in found if "not detected" in one][:1],
                         ["not detected: Unheard of nothing: shown: True, told by [poses-late]: False"])

    def test_finds_a_zone_that_is_left_while_it_is_violated(self):
        def widen(run):
            for scene in run.judge.scenes.values():
                scene.zones = {name: (1e3, pairs) for name, (_, pairs) in scene.zones.items()}
        _, found = reasons([faults.LeapingSource], widen)
        self.assertTrue(any("is not active" in one for one in found), found)

    def test_finds_what_does_not_come_back_and_what_leaks(self):
        alive = {"kind": "K", "of": "x", "detected": True, "alive_s": 0.1, "lacks": ""}
        holds = {"false": [], "reports": 9, "judged": 9, "failures": [], "faults": [alive],
                 "processes": [{"name": "daemon", "samples": [(9, 50.0)] * 6}]}
        self.assertEqual(judge.verdict(holds), [])
        self.assertTrue(judge.verdict(holds | {"faults": [alive | {"alive_s": None}]}))
        once = [{"name": "daemon", "samples": [(9, 50.0)] * 3 + [(9, 51.0 + judge.MOST_MB)] * 3}]
        self.assertEqual(judge.verdict(holds | {"processes": once}), [])
        for end in ([(9 + judge.MOST_DESCRIPTORS + 1, 50.0)], [(9, 51.0 + judge.MOST_AT_ONCE_MB + judge.MOST_MB)], [(9, 50.0 + step * judge.MOST_MB / 8) for step in range(11)]):
            leaks = [{"name": "daemon", "samples": [(9, 50.0)] * 6 + end}]
            self.assertIn("leak", judge.verdict(holds | {"processes": leaks})[0])
        self.assertTrue(judge.verdict(holds | {"judged": 0}))
        self.assertTrue(judge.verdict(holds | {"failures": ["a daemon ended with status 1"]}))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]])
