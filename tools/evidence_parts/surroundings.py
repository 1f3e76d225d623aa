"""What a run of tests stands on: the commit, the machine, the build, and what was not run."""
import datetime, json, os, pathlib, platform, re, subprocess


def output(*command, cwd=None):
    return subprocess.run(command, capture_output=True, text=True, cwd=cwd, check=False).stdout.strip()


def setting(build, name):
    found = re.search(rf"^{name}:[A-Z]+=(.*)$", (build / "CMakeCache.txt").read_text(), re.MULTILINE)
    return found.group(1) if found else "not stated"


def outcome(root, name):
    """What tools/analyse or tools/coverage found, if it ran on this commit."""
    file = root / "build" / name / "outcome.json"
    if not file.exists():
        return {"outcome": "not run"}
    found = json.loads(file.read_text())
    return found if found["commit"] == output("git", "rev-parse", "HEAD", cwd=root) else {
        "outcome": f"not run on this commit; on {found['commit'][:12]} it was: {found['outcome']}"}


def of(root, build):
    processor = re.search(r"model name\s*: (.*)", pathlib.Path("/proc/cpuinfo").read_text())
    release = re.search(r'PRETTY_NAME="(.*)"', pathlib.Path("/etc/os-release").read_text())
    return {
        "statement": "Clearance is not certified. This page shows what was run, and nothing beyond it.",
        "commit": output("git", "rev-parse", "HEAD", cwd=root),
        "changed_files": output("git", "status", "--porcelain", cwd=root).splitlines(),
        "time": datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds"),
        "machine": {"processor": processor.group(1) if processor else platform.processor(),
                    "processors": os.cpu_count(), "kernel": platform.release(),
                    "system": release.group(1) if release else "not known"},
        "build": {"type": setting(build, "CMAKE_BUILD_TYPE"), "flags": setting(build, "CMAKE_CXX_FLAGS"),
                  "sanitize": setting(build, "CLEARANCE_SANITIZE"),
                  "compiler": output(setting(build, "CMAKE_CXX_COMPILER"), "--version").splitlines()[:1]},
        "static_analysis": outcome(root, "analysis"),
        "coverage": outcome(root, "coverage"),
        "not_run": ["tests that the matrix does not name (tools/check runs all)",
                    "sanitizers and campaigns (tools/check --all)", "slips (tests/mutants/run)"],
    }
