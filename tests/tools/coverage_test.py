"""tools/coverage: what it reads from llvm-cov's listing, and what it fails for.

usage: coverage_test.py
"""
import importlib.machinery, importlib.util, pathlib, sys, unittest

sys.dont_write_bytecode = True
PATH = pathlib.Path(__file__).resolve().parents[2] / "tools/coverage"
loader = importlib.machinery.SourceFileLoader("coverage", str(PATH))
coverage = importlib.util.module_from_spec(importlib.util.spec_from_loader("coverage", loader))
loader.exec_module(coverage)

# Two instances of a template: each takes one half of `a > 0`, and the second branch is a constant. `b > 0` never decides.
LISTING = """./core/pose.hpp:
    7|      2|  if (a > 0 && b > 0) return 1;
  ------------------
  |  Branch (7:7): [True: 1.2k, False: 0]
  |  Branch (7:16): [True: 1, False: 0]
  |  Branch (8:3): [Folded - Ignored]
  ------------------
  |  Branch (7:7): [True: 0, False: 1]
  |  Branch (7:16): [True: 0, False: 0]
  ------------------
  |---> MC/DC Decision Region (7:7) to (7:21)
  |
  |  Number of Conditions: 3
  |     Condition C1 --> (7:7)
  |     Condition C2 --> (7:16)
  |     Condition C3 --> (7:20)
  |
  |  C1-Pair: covered: (1,2)
  |  C2-Pair: not covered
  |  C3-Pair: constant folded
"""


class Coverage(unittest.TestCase):
    def judged(self, branches=0, mcdc=0, files=("core/*",), exceptions=()):
        settings = {"rooms": [{"room": "core", "files": files, "branches": branches, "mcdc": mcdc}],
                    "exceptions": list(exceptions)}
        return coverage.judge(coverage.read(LISTING), settings)

    def test_CountsInstancesOfATemplateAsOneAndLeavesConstantsOut(self):
        found = coverage.read(LISTING)
        self.assertEqual([place[1:] for place, is_shown in found.branches.items() if not is_shown], [(7, 16, "not taken")])
        self.assertEqual(found.conditions, {("core/pose.hpp", 7, 7, "decides"): True, ("core/pose.hpp", 7, 16, "decides"): False})

    def test_FailsBelowAFigureAndNotAtIt(self):
        self.assertEqual(self.judged(75, 50)[1], [])
        self.assertEqual(self.judged(76, 51)[1], ["core: branches 75.0 %; expected 76 % at least",
                                                  "core: mcdc 50.0 %; expected 51 % at least"])
        self.assertEqual(len(self.judged(files=("cord/*",))[1]), 2)

    def test_LeavesOutWhatAnExceptionNamesAndRefusesOneThatCoversNothing(self):
        line = (coverage.ROOT / "core/pose.hpp").read_text().splitlines()[6].strip()
        rooms, faults, excepted = self.judged(100, 100, exceptions=[{"file": "core/*", "text": line, "reason": ""}])
        self.assertEqual((faults, excepted, rooms["core"]["left"]), ([], 2, []))
        self.assertIn("covers nothing", self.judged(exceptions=[{"file": "core/*", "text": "no such line", "reason": ""}])[1][0])


if __name__ == "__main__":
    unittest.main()
