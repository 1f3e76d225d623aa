"""The package is installed by CMake, and by pip without a network, and works from there."""

import os
import re
import subprocess
import sys
import zipfile

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


def test_a_wheel_with_its_libraries_needs_the_system_alone(tmp_path):
    run(
        sys.executable, "-m", "pip", "wheel", "--no-index", "--no-deps", "--no-build-isolation",
        "--disable-pip-version-check", "--config-settings", "libraries=inside", "-w", tmp_path, SOURCE / "tools/python",
    )
    [wheel] = tmp_path.glob("clearance-*.whl")
    with zipfile.ZipFile(wheel) as packed:
        packed.extractall(tmp_path / "unpacked")
    [extension] = tmp_path.glob("unpacked/clearance/_clearance*.so")
    listed = re.findall(r"(\S+) => (not found|\S+)", run("ldd", extension))
    inside = {name for name, path in listed if "/clearance/../clearance.libs/" in path}
    outside = {name for name, _ in listed} - inside
    assert len(inside) > 10 and all(re.fullmatch(r"lib(c|m|gcc_s|stdc\+\+)\.so\.\d+", name) for name in outside), listed
    expect_package(tmp_path / "unpacked")
    terms = {file.name for file in tmp_path.glob("unpacked/*.dist-info/licenses/*")}
    # Debian's package of libddsc has another name in each release.
    assert "libgmp10" in terms and any(name.startswith("libddsc") for name in terms) and len(terms) <= len(inside)


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
