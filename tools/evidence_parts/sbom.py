"""The libraries in the programs of a build, as SPDX 2.3: from the linker's and the compiler's lists, by dpkg.

Licences are what Debian's copyright files name. They are comments, since their names are not always those of SPDX.
"""
import hashlib, json, os, pathlib, re, subprocess


def lines(*command, **more):
    return subprocess.run(command, capture_output=True, text=True, check=False, **more).stdout.splitlines()


def packages_of(files):
    """The Debian packages of these files."""
    found, files = set(), sorted({str(pathlib.Path(file).resolve()) for file in files} | {str(file) for file in files})
    for first in range(0, len(files), 500):
        for line in lines("dpkg", "-S", *files[first:first + 500]):
            found.update(name.strip() for name in line.split(": ")[0].split(",") if not line.startswith("diversion"))
    return found


def linked(build):
    """Shared libraries, by the loader's list of each program that is installed."""
    files = set()
    for program in sorted(build.glob("bin/clearance*")):
        files.update(re.findall(r"=> (/\S+)", "\n".join(lines("ldd", str(program)))))
    return packages_of(files)


def compiled_in(build):
    """Headers, by what the build has read for anything but tests."""
    files, counts = set(), False
    for line in lines("ninja", "-t", "deps", cwd=build):
        if line and not line.startswith(" "):
            counts = not line.startswith("tests/")
        elif counts and line.startswith("    /usr/"):
            files.add(line.strip())
    return packages_of(files)


def licences(name):
    file = pathlib.Path("/usr/share/doc") / name.split(":")[0] / "copyright"
    text = file.read_text(errors="replace") if file.exists() else ""
    return sorted(set(re.findall(r"^License:[ \t]*(\S.*?)[ \t]*$", text, re.MULTILINE)))


def package(name, how):
    shown = lines("dpkg-query", "-W", "-f=${Version}\\n${source:Package}\\n${source:Version}\\n${Architecture}\\n", name)
    version, source, source_version, architecture = shown[:4]
    plain, named = name.split(":")[0], licences(name)
    return {
        "SPDXID": f"SPDXRef-deb-{re.sub(r'[^A-Za-z0-9.]', '-', plain)}", "name": plain, "versionInfo": version,
        "supplier": "Organization: Debian", "downloadLocation": "NOASSERTION", "filesAnalyzed": False,
        "sourceInfo": f"Debian source {source} {source_version}; {how}", "licenseConcluded": "NOASSERTION",
        "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
        "licenseComments": "Debian's copyright file names: " + ("; ".join(named) if named else "nothing that is marked"),
        "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                          "referenceLocator": f"pkg:deb/debian/{plain}@{version}?arch={architecture}"}]}


def of_npm(root):
    for name, version in json.loads((root / "tools/view/npm/package.json").read_text())["dependencies"].items():
        yield {"SPDXID": f"SPDXRef-npm-{re.sub(r'[^A-Za-z0-9.]', '-', name)}", "name": name, "versionInfo": version,
               "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
               "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION",
               "sourceInfo": "in the page of clearance-view, if it was built",
               "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl",
                                 "referenceLocator": f"pkg:npm/{name}@{version}"}]}


def document(root, build):
    """The same build gives the same bytes: the time is that of the commit."""
    found = lines("git", "log", "-1", "--format=%H%n%cd", "--date=format-local:%Y-%m-%dT%H:%M:%SZ", cwd=root,
                  env={**os.environ, "TZ": "UTC"})
    commit, created = found[:2] if len(found) > 1 else ("not known", "1970-01-01T00:00:00Z")  # sources without a history
    version = re.search(r"project\(\w+ VERSION (\S+)", (root / "CMakeLists.txt").read_text())
    own = {"SPDXID": "SPDXRef-Clearance", "name": "clearance", "versionInfo": version.group(1) if version else commit,
           "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
           "licenseDeclared": "NOASSERTION", "copyrightText": "NOASSERTION", "sourceInfo": f"commit {commit}"}
    shared = linked(build)
    packages = [package(name, "linked dynamically") for name in sorted(shared)]
    packages += [package(name, "headers compiled in") for name in sorted(compiled_in(build) - shared)]
    packages += of_npm(root)
    names = hashlib.sha256(json.dumps(packages, sort_keys=True).encode()).hexdigest()
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": "clearance",
            "documentNamespace": f"https://clearance.invalid/spdx/{commit}/{names[:16]}",
            "creationInfo": {"created": created, "creators": ["Tool: tools/evidence"]},
            "packages": [own, *packages],
            "relationships": [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES",
                               "relatedSpdxElement": own["SPDXID"]}] +
                             [{"spdxElementId": own["SPDXID"], "relationshipType": "DEPENDS_ON",
                               "relatedSpdxElement": each["SPDXID"]} for each in packages]}
