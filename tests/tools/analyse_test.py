"""tools/analyse: what it fails for, in a tree with a planted fault for each tool.

usage: analyse_test.py
"""
import contextlib, importlib.machinery, importlib.util, io, pathlib, shutil, sys, tempfile, unittest
from unittest import mock

sys.dont_write_bytecode = True
PATH = pathlib.Path(__file__).resolve().parents[2] / "tools/analyse"
loader = importlib.machinery.SourceFileLoader("analyse", str(PATH))
analyse = importlib.util.module_from_spec(importlib.util.spec_from_loader("analyse", loader))
loader.exec_module(analyse)
MISSING = [program for program in ("clang++-19", "clang-tidy-19", "cppcheck", "ninja") if not shutil.which(program)]

FILES = {
    analyse.LOCKS: (analyse.ROOT / analyse.LOCKS).read_text(),
    "core/body.cpp": "int twice(int a) { if (a > 0); return 2 * a; }\n",
    "core/excused.cpp": "int half(int a) { if (a > 0); return a / 2; }\n",
    "config/index.cpp": "int last() { int all[3] = {1, 2, 3}; return all[3]; }\n",
    "monitor/counter.hpp": """#include "monitor/interface/mutex.hpp"
struct Counter {
  void add() { clearance::Lock lock(mutex); next(); lock.unlock(); lock.lock(); next(); }
  void next() REQUIRES(mutex) { ++count; }
  int read() const { return count; }
  void step() { next(); }
  auto later() { const clearance::Lock lock(mutex); return [this] { return count; }; }
  void close() { clearance::Lock lock(mutex); lock.unlock(); count = 0; }
  mutable clearance::Mutex mutex;
  GUARDED_BY(mutex) int count = 0;
};
""",
    "monitor/counter.cpp": '#include "monitor/counter.hpp"\n',
    "monitor/unreadable.cpp": '#include "monitor/counter.hpp"\n#include "monitor/missing.hpp"\n',
    "tools/lockless.cpp": '#include "tools/missing.hpp"\n',
    "tests/analysis.yaml": """
clang_tidy:
  rooms:
    - {units: ["core/*"], checks: [bugprone-suspicious-semicolon]}
    - {units: ["core/*", "config/*"], checks: [modernize-avoid-c-arrays]}
  left_out: []
cppcheck: {enable: warning}
deviations:
  - {file: core/excused.cpp, check: bugprone-suspicious-semicolon}
  - {file: core/idle.cpp, check: bugprone-suspicious-semicolon}
""",
}
LOCKING = [
    "monitor/counter.hpp:5: reading variable 'count' requires holding mutex 'mutex' [-Wthread-safety-analysis]",
    "monitor/counter.hpp:6: calling function 'next' requires holding mutex 'mutex' exclusively [-Wthread-safety-analysis]",
    "monitor/counter.hpp:7: reading variable 'count' requires holding mutex 'mutex' [-Wthread-safety-analysis]",
    "monitor/counter.hpp:8: writing variable 'count' requires holding mutex 'mutex' exclusively [-Wthread-safety-analysis]",
    "monitor/unreadable.cpp:1: 'monitor/missing.hpp' file not found [clang-diagnostic-error]"]


@unittest.skipIf(MISSING, f"needs {', '.join(MISSING)} (tools/setup --analyse)")
class Analyse(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name).resolve()
        rules = f"rule cxx\n  command = c++ -std=c++20 -I{self.root} -o $out -c $in\nrule link\n  command = c++ -o $out $in\n"
        sources = [file for file in FILES if file.endswith(".cpp")]
        build = "".join(f"build {file}.o: cxx {self.root / file}\n" for file in sources) + "build program: link monitor/counter.cpp.o\n"
        for file, text in {**FILES, "build/release/build.ninja": rules + build}.items():
            (self.root / file).parent.mkdir(parents=True, exist_ok=True)
            (self.root / file).write_text(text)
        (self.root / "build/release/monitor").mkdir()
        (self.root / "build/release/monitor/counter.cpp.o").write_bytes(b"\xff")

    def run_of(self, *arguments):
        out, command = io.StringIO(), ["analyse", "--build", str(self.root / "build/release"), *arguments]
        with contextlib.redirect_stdout(out), mock.patch.object(sys, "argv", command), \
                mock.patch.multiple(analyse, ROOT=self.root, OUT=self.root / "build/analysis"):
            status = analyse.main()
        return status, out.getvalue().splitlines()

    def test_NamesEachFindingAndEachDeviationThatCoversNothing(self):
        status, lines = self.run_of()
        self.assertEqual(lines[:-1], [
            "config/index.cpp:1: Array 'all[3]' accessed at index 3, which is out of bounds. [cppcheck-arrayIndexOutOfBounds]",
            "config/index.cpp:1: do not declare C-style arrays, use std::array<> instead [modernize-avoid-c-arrays]",
            "core/body.cpp:1: potentially unintended semicolon [bugprone-suspicious-semicolon]",
            *LOCKING,
            "tests/analysis.yaml: the deviation bugprone-suspicious-semicolon of core/idle.cpp covers nothing: remove it"])
        self.assertRegex(lines[-1], "analyse: 9 findings, 1 covered by 1 deviations, in 3 units of clang-tidy and 2 with locks")
        self.assertEqual(status, 1)

    def test_ReadsOnlyTheUnitsThatAreNamed(self):
        status, lines = self.run_of("monitor/counter.cpp")
        self.assertEqual((status, lines[:-1]), (1, LOCKING[:-1]))
        self.assertEqual(self.run_of("core/excused.cpp")[0], 0)


if __name__ == "__main__":
    unittest.main(verbosity=2)
