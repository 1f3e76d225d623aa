"""The stub says what the module has, and mypy finds no fault in the package and in its examples."""

import ast
import inspect
import pathlib
import subprocess
import sys

import clearance
from clearance import _clearance, testing

ROOM = pathlib.Path(testing.__file__).resolve().parent.parent


def members_of_stub():
    tree = ast.parse((ROOM / "clearance/_clearance.pyi").read_text())
    classes, functions = {}, set()
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            named = {n.name for n in node.body if isinstance(n, ast.FunctionDef)}
            named |= {n.target.id for n in node.body if isinstance(n, ast.AnnAssign)}
            named |= {t.id for n in node.body if isinstance(n, ast.Assign) for t in n.targets}
            classes[node.name] = (named, [b.id for b in node.bases if isinstance(b, ast.Name)])
        elif isinstance(node, ast.FunctionDef):
            functions.add(node.name)

    def members(name):
        named, bases = classes[name]
        return named.union(*(members(base) for base in bases if base.startswith("_")))

    return {name: members(name) for name in public(classes)}, functions


def public(names):
    return {name for name in names if not name.startswith("_")}


def test_the_stub_has_the_names_of_the_module():
    classes, functions = members_of_stub()
    assert set(classes) | functions == public(vars(_clearance)) == set(clearance.__all__)


def test_the_stub_has_the_members_of_each_class():
    for name, members in members_of_stub()[0].items():
        real = vars(getattr(_clearance, name))
        if name.endswith("Error"):
            continue
        assert public(members) == public(real), name


def test_every_name_has_a_docstring():
    for name in clearance.__all__:
        thing = getattr(clearance, name)
        assert inspect.getdoc(thing), name
        if not inspect.isclass(thing) or name.endswith(("Error", "Status", "Path")):
            continue
        for member in public(vars(thing)):
            assert inspect.getdoc(getattr(thing, member)), f"{name}.{member}"


def test_mypy_is_strict_with_the_package_and_its_examples(tmp_path):
    mypy = [sys.executable, "-m", "mypy", "--cache-dir", str(tmp_path)]
    mypy += ["--config-file", str(ROOM / "mypy.ini")]
    examples = sorted((ROOM / "examples").glob("*.py"))
    calls = [["--strict", "-p", "clearance"]]
    calls += [["--check-untyped-defs", str(example)] for example in examples]
    for call in calls:
        checked = subprocess.run(mypy + call, capture_output=True, text=True, cwd=ROOM)
        assert checked.returncode == 0, checked.stdout + checked.stderr
