"""The package is installed by CMake, and by pip without a network, and works from there."""

import os
import subprocess
import sys

from conftest import SOURCE

PROGRAM = """
import clearance, clearance.testing
ball = clearance.point(radius=0.5)
print(clearance.__file__)
print(clearance.distance(ball, ball, [3, 0, 0, 0, 0, 0, 1]).distance)
"""


def run(*command, **environment):
    given = {k: v for k, v in os.environ.items() if k != "PYTHONPATH"}
    done = subprocess.run(
        list(map(str, command)), capture_output=True, text=True, env={**given, **environment}
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def expect_package(folder):
    file, distance = run(sys.executable, "-c", PROGRAM, PYTHONPATH=str(folder)).split()
    assert file == str(folder / "clearance/__init__.py") and float(distance) == 2.0
    assert (folder / "clearance/py.typed").exists() and (folder / "clearance/_clearance.pyi").exists()
    assert not any(file.is_symlink() for file in (folder / "clearance").iterdir())


def test_cmake_installs_the_package_as_a_component(tmp_path):
    build = os.environ["CLEARANCE_BUILD"]
    run("cmake", "--install", build, "--component", "python", "--prefix", tmp_path)
    [package] = tmp_path.rglob("site-packages")
    expect_package(package)
    examples = tmp_path / "share/clearance/python"
    assert {file.name for file in examples.iterdir()} == {
        file.name for file in (SOURCE / "tools/python/examples").glob("*.py")
    }


def test_pip_installs_the_package_without_a_network(tmp_path):
    run(
        sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--disable-pip-version-check",
        "--target", tmp_path, SOURCE / "tools/python",
    )
    expect_package(tmp_path)
    listed = run(sys.executable, "-m", "pip", "list", "--path", tmp_path)
    assert "clearance" in listed


def test_pip_names_a_build_folder_that_is_none(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "pip", "install", "--no-index", "--no-deps", "--target", str(tmp_path),
         str(SOURCE / "tools/python")],
        capture_output=True, text=True, env={**os.environ, "CLEARANCE_BUILD": str(tmp_path)},
    )
    assert done.returncode != 0 and "is no folder of a build" in done.stdout + done.stderr


def test_without_numpy_the_import_says_how_to_install_it():
    program = "import sys; sys.modules['numpy'] = None; import clearance"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode != 0 and "sudo apt install python3-numpy" in done.stderr
