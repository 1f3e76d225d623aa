"""What a run of tests stands on: the commit, the machine, the build, and what was not run."""
import datetime, os, pathlib, platform, re, subprocess

import outcome


def output(*command, cwd=None):
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, check=False).stdout.strip()


def setting(build, name):
    found = re.search(rf"^{name}:[A-Z]+=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE)
    return found.group(1) if found else "not stated"


def of(root, build):
    processor = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    release = re.search(r'PRETTY_NAME="(.*)"', pathlib.Path("/etc/os-release").read_text())
    return {
        "statement": "Clearance is not certified. This page shows what was run, and nothing beyond it.",
        "commit": outcome.git(root, "rev-parse", "HEAD"),
        "changed_files": outcome.git(root, "status", "--porcelain").splitlines(),
        "built": output(build / "bin/clearanced", "--version"),
        "time": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "machine": {"processor": processor.group(1) if processor else platform.processor(),
                    "processors": os.cpu_count(), "kernel": platform.release(),
                    "system": release.group(1) if release else "not known"},
        "build": {"type": setting(build, "CMAKE_BUILD_TYPE"), "flags": setting(build, "CMAKE_CXX_FLAGS"),
                  "sanitize": setting(build, "CLEARANCE_SANITIZE"),
                  "compiler": output(setting(build, "CMAKE_CXX_COMPILER"), "--version").splitlines()[:1]},
        "random_cases": "all" if "CLEARANCE_ALL_REPEATS" in os.environ else
                        "a share, as in tools/check (with CLEARANCE_ALL_REPEATS=1: all)",
        "long_runs": {name: outcome.read(root, name) for name in outcome.LONG_RUNS},
        "not_run": ["tests that the matrix does not name (tools/check --more runs all)",
                    "sanitizers, fuzzers and campaigns (tools/check --all)"],
    }


def faults(found):
    """What keeps the page from being evidence of its commit, and what its long runs have found."""
    if found["changed_files"]:
        yield f"{len(found['changed_files'])} files are changed beside the commit"
    if f", {found['commit'][:12]}," not in found["built"]:
        yield f"the programs are not built from the commit: {found['built']}"
    for name, run in found["long_runs"].items():
        yield from (f"{name}: {fault}" for fault in run["faults"])
