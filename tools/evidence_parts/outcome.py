"""Outcomes of long runs in build/NAME/outcome.json: each names the commit and what was changed beside it."""
import json, subprocess

# Long runs by name, each with the program that makes it.
LONG_RUNS = {"analysis": "tools/analyse", "coverage": "tools/coverage", "mutants": "tests/mutants/run", "soak": "tools/soak",
             "reproducible": "tests/tools/packages/reproducible"}


def git(root, *command):
    return subprocess.run(["git", *command], cwd=root, capture_output=True, text=True, check=False).stdout.strip()


def tree(root):
    """The commit that is checked out, and whether files differ from it. A long run asks for it when it begins."""
    return {"commit": git(root, "rev-parse", "HEAD"),
            "is_changed": git(root, "status", "--porcelain", "--untracked-files=no") != ""}


def tree_since(root, began):
    """The tree() of a run that has read sources since it began: changed, if they are others by now."""
    return {**began, "is_changed": began["is_changed"] or tree(root) != began}


def write(root, name, outcome, faults, began, **more):
    """`outcome`: a line for a person. `faults`: what speaks against the commit, a line each. `began`: tree() at the beginning."""
    file = root / "build" / name / "outcome.json"
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(json.dumps({**began, "outcome": outcome, "faults": faults, **more}, indent=1) + "\n")


def read(root, name):
    """What write() has left, if it is of this commit. Otherwise it has neither faults nor figures."""
    file = root / "build" / name / "outcome.json"
    if not file.exists():
        return {"outcome": f"not run ({LONG_RUNS[name]})", "faults": []}
    found = json.loads(file.read_text())
    if found["commit"] == tree(root)["commit"] and not found["is_changed"]:
        return found
    where = found["commit"][:12] + (", changed" if found["is_changed"] else "")
    return {"outcome": f"not run on this commit; on {where} it was: {found['outcome']}", "faults": []}
