"""The matrix of promises and assumptions, from the outcome of the tests that they name."""
import json, re, subprocess

import yaml

import fmea

FIELDS = {"promises": {"id", "text", "tests"}, "assumptions": {"id", "text", "detected_by", "why", "tests"}}


def listed(program):
    """The full names of all cases of a test program."""
    text = subprocess.run([program, "--gtest_list_tests"], check=True, capture_output=True, text=True).stdout
    suite, names = "", []
    for line in text.splitlines():
        if not line.startswith(" "):
            suite = line.split()[0] if line.strip() else ""
        elif suite.endswith("."):
            names.append(suite + line.split()[0])
    return names


def stands_for(test, name):
    """True if a case is `test`, or one of its instances."""
    suite, _, case = test.partition(".")
    return re.fullmatch(rf"([^/.]+/)?{re.escape(suite)}(/[^/.]+)?\.{re.escape(case)}(/.+)?", name) is not None


def mistakes(requirements):
    """What the list itself lacks."""
    seen = set()
    for kind, fields in FIELDS.items():
        for entry in requirements.get(kind) or []:
            of = entry.get("id", f"an entry of {kind}")
            for unknown in sorted(set(entry) - fields):
                yield f"{of}: the key '{unknown}' is not known; expected one of {', '.join(sorted(fields))}"
            if "id" not in entry or "text" not in entry or entry["id"] in seen:
                yield f"{of}: expected an id of its own, and a text"
            seen.add(entry.get("id"))
            answer = entry.get("detected_by")
            if kind == "promises" and not entry.get("tests"):
                yield f"{of}: the promise has no test"
            if kind == "assumptions" and not answer:
                yield f"{of}: the assumption has no answer; expected 'detected_by: none' or what detects a breach"
            if kind == "assumptions" and answer == "none" and not entry.get("why"):
                yield f"{of}: found 'detected_by: none'; expected a reason under 'why'"
            if kind == "assumptions" and answer and answer != "none" and not entry.get("tests"):
                yield f"{of}: something detects a breach, and no test shows it"
    for kind in sorted(set(requirements) - set(FIELDS)):
        yield f"the list has '{kind}'; expected 'promises' and 'assumptions'"


def outcomes_of(program, names, out):
    """Runs these cases. The command; by name passed, failed or skipped; and the times that they have recorded. A case
    that did not run is missing."""
    file = out / f"{program.name}.json"
    file.unlink(missing_ok=True)
    command = [str(program), "--gtest_filter=" + ":".join(names), f"--gtest_output=json:{file}", "--gtest_brief=1"]
    with open(out / f"{program.name}.log", "w") as log:
        subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=False)
    outcomes, times = {}, []
    if not file.exists():  # it ended by a signal
        return command, outcomes, times
    for suite in json.loads(file.read_text())["testsuites"]:
        for case in suite["testsuite"]:
            state = "skipped" if case["result"] != "COMPLETED" else "failed" if case.get("failures") else "passed"
            outcomes[f"{suite['name']}.{case['name']}"] = state
            times += fmea.times_of(case, suite["name"])
    return command, outcomes, times


def judge(requirements, build, out):
    """The matrix, the commands, and all faults. Without `out` no test is run."""
    wanted = yaml.safe_load(requirements.read_text())
    faults = list(mistakes(wanted))
    programs = sorted(build.glob("bin/*_tests"))
    names = {program: listed(program) for program in programs}
    tests = sorted({test for kind in FIELDS for entry in wanted.get(kind) or [] for test in entry.get("tests") or []})
    cases = {test: [(program, name) for program in programs for name in names[program] if stands_for(test, name)]
             for test in tests}
    outcomes, commands, times = {}, [], {}
    if out is not None:
        for program in programs:
            of_program = sorted({name for all_of in cases.values() for where, name in all_of if where == program})
            if of_program:
                print(f"evidence: {len(of_program)} cases of {program.name}", flush=True)
                command, states, recorded = outcomes_of(program, of_program, out)
                outcomes.update(states)
                commands.append(" ".join(command))
                for name, time in recorded:
                    times.setdefault(name, []).append(time)

    def outcome(test):
        if not cases[test]:
            return "there is no such test"
        if out is None:
            return "not run"
        states = {outcomes.get(name, "not run") for _, name in cases[test]}
        return next((bad for bad in ("failed", "not run", "skipped") if bad in states), "passed")

    matrix = []
    for kind in FIELDS:
        for entry in wanted.get(kind) or []:
            results = [{"name": test, "cases": len(cases[test]), "outcome": outcome(test)}
                       for test in entry.get("tests") or []]
            matrix.append({**entry, "kind": kind[:-1], "tests": results})
            good = {"passed"} if out is not None else {"passed", "not run"}
            faults += [f"{entry.get('id')}: {result['name']}: {result['outcome']}"
                       for result in results if result["outcome"] not in good]
    return {"matrix": matrix, "faults": faults, "commands": commands, "times": times}
