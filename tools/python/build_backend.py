"""Makes a wheel (PEP 517) of the extension that CMake builds and installs.

CLEARANCE_BUILD in the environment names a build folder to take the extension from. Without it, the
project is built in build/python, which takes some minutes the first time.
"""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile

ROOM = pathlib.Path(__file__).resolve().parent
PROJECT = ROOM.parents[1]


def get_requires_for_build_wheel(config_settings=None):
    return []


def build_sdist(sdist_directory, config_settings=None):
    raise SystemExit("clearance: there is no source package; install tools/python of a source tree")


def version():
    found = re.search(r"project\(clearance VERSION ([0-9.]+)", (PROJECT / "CMakeLists.txt").read_text())
    return found.group(1)


def run(*command):
    if subprocess.run(list(map(str, command)), stdout=sys.stderr).returncode != 0:
        raise SystemExit(f"clearance: '{' '.join(map(str, command))}' failed; its output is above")


def build():
    """The folder of a build with the extension."""
    given = os.environ.get("CLEARANCE_BUILD")
    folder = pathlib.Path(given) if given else PROJECT / "build/python"
    if given and not (folder / "CMakeCache.txt").exists():
        raise SystemExit(f"clearance: CLEARANCE_BUILD={given} is no folder of a build by CMake")
    if not given:
        options = ["-DCMAKE_BUILD_TYPE=Release", "-DCLEARANCE_PYTHON=ON"]
        options += ["-DCLEARANCE_TESTS=OFF"]
        run("cmake", "-S", PROJECT, "-B", folder, f"-DPython3_EXECUTABLE={sys.executable}", *options)
    run("cmake", "--build", folder, "--target", "clearance_python", "--parallel", os.cpu_count() or 1)
    return folder


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"{python}-{python}-{platform}"


def metadata():
    return (
        f"Metadata-Version: 2.1\nName: clearance\nVersion: {version()}\n"
        "Summary: Certified distances of robots, live and offline\n"
        "Requires-Python: >=3.9\nRequires-Dist: numpy\n"
    )


def wheel():
    return f"Wheel-Version: 1.0\nGenerator: clearance\nRoot-Is-Purelib: false\nTag: {tag()}\n"


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    folder = pathlib.Path(metadata_directory) / f"clearance-{version()}.dist-info"
    folder.mkdir()
    (folder / "METADATA").write_text(metadata())
    (folder / "WHEEL").write_text(wheel())
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = build()
    name = f"clearance-{version()}"
    with tempfile.TemporaryDirectory() as prefix:
        run("cmake", "--install", folder / "tools/python", "--component", "python", "--prefix", prefix)
        extensions = list(pathlib.Path(prefix).rglob("_clearance*.so"))
        if not extensions or not extensions[0].name.endswith(sysconfig.get_config_var("EXT_SUFFIX")):
            raise SystemExit(
                f"clearance: {folder} holds no extension for Python {sys.version.split()[0]}; "
                "expected a build with tools/setup --python and -DPython3_EXECUTABLE of this Python"
            )
        package = extensions[0].parent
        files = {f"clearance/{file.name}": file.read_bytes() for file in sorted(package.iterdir())}
    files[f"{name}.dist-info/METADATA"] = metadata().encode()
    files[f"{name}.dist-info/WHEEL"] = wheel().encode()
    record = ""
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{path},sha256={digest},{len(content)}\n"
    files[f"{name}.dist-info/RECORD"] = f"{record}{name}.dist-info/RECORD,,\n".encode()
    file_name = f"{name}-{tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / file_name, "w", zipfile.ZIP_DEFLATED) as out:
        for path, content in files.items():
            out.writestr(path, content)
    return file_name
