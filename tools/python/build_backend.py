"""Makes a wheel (PEP 517) of the extension that CMake builds and installs.

CLEARANCE_BUILD in the environment names a build folder to take the extension from. Without it, the
project is built in build/python, which takes some minutes the first time. The setting libraries=inside
puts the shared libraries into the wheel that its users may not have (tools/package --wheel).
"""

import base64
import hashlib
import os
import pathlib
import re
import shutil
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


def metadata(folder):
    requirement = (folder / "python/requires").read_text()  # tools/python/CMakeLists.txt writes it
    return (
        f"Metadata-Version: 2.1\nName: clearance\nVersion: {version()}\n"
        "Summary: Certified distances of robots, live and offline\n"
        f"Requires-Python: >=3.10\nRequires-Dist: {requirement}\n"
    )


def wheel():
    return f"Wheel-Version: 1.0\nGenerator: clearance\nRoot-Is-Purelib: false\nTag: {tag()}\n"


# Of every Linux that has NumPy: glibc's, and those of the compiler.
SYSTEM = re.compile(r"(ld-linux.*|libc|libm|libdl|libpthread|librt|libgcc_s|libstdc\+\+)\.so\.\d+")


def output_of(*command):
    return subprocess.run(list(map(str, command)), stdout=subprocess.PIPE, text=True, check=True).stdout


def put_libraries_inside(extension, libraries):
    """Copies what the extension needs, but for the system's, into the folder beside it; both then name the copies.

    A copy's name has a digest of its content, so that a program may have another copy beside it.
    """
    needed = dict(re.findall(r"(\S+) => (/\S+)", output_of("ldd", extension)))
    needed = {name: pathlib.Path(path) for name, path in needed.items() if not SYSTEM.fullmatch(name)}
    digests = {name: hashlib.sha256(path.read_bytes()).hexdigest()[:8] for name, path in needed.items()}
    inside = {name: name.replace(".so", f"-{digests[name]}.so", 1) for name in needed}
    renames = [word for pair in inside.items() for word in ("--replace-needed", *pair)]
    libraries.mkdir()
    # Debian 12's patchelf changes one kind of entry a call; of several, it loses some.
    for name, path in needed.items():
        copy = shutil.copyfile(path.resolve(), libraries / inside[name])
        for change in (["--set-soname", inside[name]], ["--set-rpath", "$ORIGIN"], renames):
            run("patchelf", *change, copy)
    for change in (["--set-rpath", f"$ORIGIN/../{libraries.name}"], renames):
        run("patchelf", *change, extension)
    return needed.values()


def terms_of(libraries):
    """Of each Debian package that these libraries are of, the file with its terms."""
    owners = {output_of("dpkg-query", "--search", f"*/{path.resolve().name}").split(":")[0] for path in libraries}
    return {owner: pathlib.Path(f"/usr/share/doc/{owner}/copyright").read_bytes() for owner in sorted(owners)}


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = build()
    name = f"clearance-{version()}"
    files = {}
    with tempfile.TemporaryDirectory() as prefix:
        run("cmake", "--install", folder / "tools/python", "--component", "python", "--prefix", prefix, "--strip")
        extensions = list(pathlib.Path(prefix).rglob("_clearance*.so"))
        if not extensions or not extensions[0].name.endswith(sysconfig.get_config_var("EXT_SUFFIX")):
            raise SystemExit(
                f"clearance: {folder} holds no extension for Python {sys.version.split()[0]}; "
                "expected a build with tools/setup --python and -DPython3_EXECUTABLE of this Python"
            )
        package = extensions[0].parent
        libraries = package.parent / "clearance.libs"
        if (config_settings or {}).get("libraries") == "inside":
            copied = put_libraries_inside(extensions[0], libraries)
            for owner, terms in terms_of(copied).items():
                files[f"{name}.dist-info/licenses/{owner}"] = terms
        for file in sorted(package.iterdir()) + sorted(libraries.glob("*")):
            files[f"{file.parent.name}/{file.name}"] = file.read_bytes()
    files[f"{name}.dist-info/METADATA"] = metadata(folder).encode()
    files[f"{name}.dist-info/WHEEL"] = wheel().encode()
    record = ""
    for path, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{path},sha256={digest},{len(content)}\n"
    files[f"{name}.dist-info/RECORD"] = f"{record}{name}.dist-info/RECORD,,\n".encode()
    file_name = f"{name}-{tag()}.whl"
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / file_name, "w") as out:
        for path, content in files.items():
            out.writestr(zipfile.ZipInfo(path), content, zipfile.ZIP_DEFLATED)  # without a time: the same bytes
    return file_name
