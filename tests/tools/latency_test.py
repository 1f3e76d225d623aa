"""tools/latency: what it finds in made-up /sys and /proc, what it concludes from made-up histograms, and a short run.

usage: latency_test.py FOLDER-OF-PROGRAMS
"""

import contextlib
import importlib.machinery
import importlib.util
import io
import json
import math
import pathlib
import random
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
LOADER = importlib.machinery.SourceFileLoader("latency", str(ROOT / "tools" / "latency"))
latency = importlib.util.module_from_spec(importlib.util.spec_from_loader("latency", LOADER))
LOADER.exec_module(latency)

CPU = "sys/devices/system/cpu"
# A machine that is well set up.
GOOD = {
    f"{CPU}/cpu0/cpufreq/scaling_governor": "performance",
    f"{CPU}/cpu0/cpuidle/state0/name": "POLL", f"{CPU}/cpu0/cpuidle/state0/latency": "0",
    f"{CPU}/cpu0/cpuidle/state1/name": "C6", f"{CPU}/cpu0/cpuidle/state1/latency": "133",
    f"{CPU}/cpu0/cpuidle/state1/disable": "1",
    f"{CPU}/isolated": "3", f"{CPU}/smt/active": "0", f"{CPU}/online": "0-3",
    "sys/kernel/realtime": "1",
    "sys/devices/system/clocksource/clocksource0/current_clocksource": "tsc",
    "proc/version": "Linux version 6.1.0-rt #1 SMP PREEMPT_RT",
    "proc/sys/kernel/sched_rt_runtime_us": "-1",
    "proc/self/status": "Name:\tpython\nCapEff:\t0000000000000000",
    "proc/self/limits": "Max realtime priority     90        90\nMax locked memory         unlimited unlimited bytes",
    "proc/loadavg": "0.10 0.20 0.30 1/200 4242",
    "proc/17/comm": "bash",
    "proc/cpuinfo": "processor : 0\nflags\t\t: fpu tsc constant_tsc",
    "proc/stat": "cpu  1 2 3 4 5 6 7 0 0 0",
    "proc/uptime": "1000.0 900.0",
}
# One thing that is wrong each: what is told of it, and a word of its value, its place and its cure.
FAULTS = [
    ("frequency governor", {f"{CPU}/cpu0/cpufreq/scaling_governor": "powersave"}, "powersave", "scaling_governor", "cpupower"),
    ("C-states", {f"{CPU}/cpu0/cpuidle/state1/disable": "0"}, "C6 takes 133 us", "cpuidle", "idle-set"),
    ("kernel", {"sys/kernel/realtime": "0", "proc/version": "Linux #1 SMP PREEMPT_DYNAMIC"}, "PREEMPT_DYNAMIC", "/proc/version",
     "linux-image-rt"),
    ("SCHED_FIFO at priority 80", {"proc/self/limits": "Max realtime priority 0 0\nMax locked memory unlimited unlimited"},
     "refused", "limits", "CAP_SYS_NICE"),
    ("locked memory", {"proc/self/limits": "Max realtime priority 90 90\nMax locked memory 65536 65536"}, "65536", "limits",
     "CAP_IPC_LOCK"),
    ("cores that two processors share", {f"{CPU}/smt/active": "1"}, "SMT", "smt/active", "nosmt"),
    ("other work", {"proc/loadavg": "3.50 1 1 1/2 3"}, "3.50 on 4", "loadavg", "isolate"),
    ("irqbalance", {"proc/17/comm": "irqbalance"}, "moves", "/proc/17/comm", "BANNED"),
    ("clock source", {"sys/devices/system/clocksource/clocksource0/current_clocksource": "hpet"}, "hpet", "clocksource", "tsc"),
    ("virtual machine", {"proc/cpuinfo": "flags : fpu hypervisor", "proc/stat": "cpu 1 2 3 4 5 6 7 2500 0 0"}, "2.50 %",
     "/proc/stat", "bare metal"),
]


def found(files):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in files.items():
            file = pathlib.Path(folder) / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text + "\n")
        return {one.what: one for one in latency.findings(folder)}


def histogram(values_ns):
    values = sorted(values_ns)
    return {"count": len(values), "max_ns": values[-1], "bins": [[ns, values.count(ns)] for ns in sorted(set(values))]}


def run_of(wakeup_ns, tick_ns):
    return {"stages": {"wakeup": histogram([wakeup_ns]), "tick": histogram([tick_ns])}}


class Machine(unittest.TestCase):
    def test_of_a_good_one_nothing_is_wrong(self):
        self.assertEqual({one.level for one in found(GOOD).values()}, {"good"})

    def test_each_fault_is_told_with_its_value_its_place_and_its_cure(self):
        for what, files, *words in FAULTS:
            with self.subTest(what):
                told = found(GOOD | files)
                self.assertEqual([one.what for one in told.values() if one.level != "good"], [what])
                for word, of in zip(words, (told[what].value, told[what].where, told[what].cure)):
                    self.assertIn(word, of)

    def test_what_a_machine_does_not_show_is_not_called_good(self):
        shown = {name: text for name, text in GOOD.items() if "cpufreq" not in name and "cpuidle" not in name}
        told = found(shown)
        self.assertEqual([told[what].level for what in ("frequency governor", "C-states")], ["note", "note"])

    def test_capabilities_stand_for_limits(self):
        told = found(GOOD | {"proc/self/limits": "", "proc/self/status": f"CapEff:\t{1 << 23 | 1 << 14:016x}"})
        self.assertEqual(told["SCHED_FIFO at priority 80"].level, "good")
        self.assertEqual(told["locked memory"].level, "good")


class Percentiles(unittest.TestCase):
    def test_are_those_of_the_sorted_values(self):
        draw = random.Random(62)
        for count in (20, 999, 10_000, 50_000):
            values = [draw.choice((1000, 2000, 4000, 9000)) for _ in range(count)]
            for share in (0.5, 0.9, 0.999):
                expected = sorted(values)[math.ceil(share * count - 1e-6) - 1] / 1000
                told = latency.percentile_us(histogram(values), share)
                self.assertEqual(told, expected if count * (1 - share) >= 10 - 1e-6 else None, (count, share))

    def test_are_left_out_with_the_time_that_they_would_take(self):
        bins = {"count": 9_999_999, "max_ns": 5000, "bins": [[5000, 9_999_999]]}
        self.assertIsNone(latency.percentile_us(bins, 0.999999))
        bins["count"] = bins["bins"][0][1] = 10_000_000
        self.assertEqual(latency.percentile_us(bins, 0.999999), 5.0)
        self.assertEqual(dict(latency.figures(histogram([1000] * 2000), 1000)),
                         {"p50": "1.0", "p99.9": "needs 10 s", "p99.9999": "needs 10000 s", "max": "1.0"})

    def test_of_cyclictest_have_what_is_beyond_its_histogram(self):
        text = "# Histogram\n000004 000010\n000005 000000\n000009 000002\n# Total: 000012\n# Max Latencies: 00777\n" \
               "# Histogram Overflows: 00003\n"
        self.assertEqual(latency.read_cyclictest(text),
                         {"count": 15, "max_ns": 777_000, "bins": [[4000, 10], [9000, 2], [777_000, 3]]})
        self.assertIsNone(latency.read_cyclictest("Unable to change scheduling policy!\n"))


class Verdict(unittest.TestCase):
    def test_a_rate_holds_while_the_margin_is_left(self):
        for worst_us, rate_hz, margin, holds in ((800, 1000, 0.2, True), (801, 1000, 0.2, False), (801, 500, 0.2, True),
                                                 (1000, 1000, 0.0, True), (1500, 1000, 0.0, False)):
            told = latency.verdict(run_of(200_000, worst_us * 1000 - 200_000), rate_hz, margin)
            self.assertEqual(told["holds"], holds, told)
            self.assertAlmostEqual(told["margin"], 1 - worst_us * rate_hz / 1e6, 3)

    def test_the_rate_that_holds_holds_and_the_next_one_does_not(self):
        draw = random.Random(7)
        for _ in range(200):
            run = run_of(draw.randrange(1, 900_000), draw.randrange(1, 3_000_000))
            margin = draw.random() * 0.8
            rate_hz = latency.verdict(run, 1000, margin)["rate_that_holds_hz"]
            if rate_hz > 0:
                self.assertTrue(latency.verdict(run, rate_hz * (1 - 1e-9), margin)["holds"])
            self.assertFalse(latency.verdict(run, rate_hz + 1, margin)["holds"])

    def test_nothing_measured_holds_nothing(self):
        empty = {"count": 0, "max_ns": 0, "bins": []}
        self.assertFalse(latency.verdict({"stages": {"wakeup": empty, "tick": empty}}, 1000, 0.2)["holds"])


class Run(unittest.TestCase):
    """No claim here depends on how fast the machine is."""

    def test_has_every_tick_in_the_histograms_and_says_what_it_found(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as told:
            file = pathlib.Path(folder) / "latency.json"
            status = latency.main(["--seconds", "2", "--bin", PROGRAMS, "--json", str(file)])
            judged = json.loads(file.read_text())
        self.assertEqual(status, 0 if judged["holds"] else 2)
        self.assertEqual(judged["schema"], 1)
        self.assertEqual([one["name"] for one in judged["runs"]], ["idle"])
        self.assertEqual(len(judged["findings"]), len(latency.findings()))
        run = judged["runs"][0]
        self.assertEqual(set(run["stages"]), set(latency.STAGES))
        for stage, of in run["stages"].items():
            self.assertEqual(sum(count for _, count in of["bins"]), of["count"], stage)
            self.assertEqual(of["bins"], sorted(of["bins"]), stage)
            self.assertGreaterEqual(of["bins"][-1][0], of["max_ns"], stage)
        self.assertEqual(run["stages"]["wakeup"]["count"], 2000)
        self.assertEqual(run["stages"]["tick"]["count"], 2000)
        self.assertLessEqual(run["stages"]["tick_to_received"]["count"], 2000)
        self.assertGreater(run["stages"]["tick_to_received"]["count"], 0)
        self.assertEqual(judged["holds"], run["verdict"]["holds"])
        self.assertIn("needs 10000 s", told.getvalue())

    def test_a_missing_program_is_named(self):
        with self.assertRaises(SystemExit) as ended, contextlib.redirect_stderr(io.StringIO()) as told:
            latency.main(["--bin", "/nowhere"])
        self.assertEqual(ended.exception.code, 2)
        self.assertIn("/nowhere", told.getvalue())


if __name__ == "__main__":
    PROGRAMS = sys.argv.pop(1)
    unittest.main()
