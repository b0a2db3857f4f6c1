#!/usr/bin/env python3
# What the program consists of beside its own sources: the libraries it is linked with, by the Debian packages they are
# from, and the npm packages bundled into report pages, with versions and licences, as a bill of materials (CycloneDX 1.5,
# JSON). The same build gives the same file.
# usage: scripts/sbom.py PROGRAM > bom.json
import json
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
# Header-only: compiled in, so no loader knows them.
HEADER_PACKAGES = ["libeigen3-dev", "libcli11-dev", "nlohmann-json3-dev", "libboost-dev"]
BUNDLERS = ["esbuild"]  # make the bundle, and are not in it


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def linked_files(program):
    """The shared libraries that the loader takes for a program."""
    return sorted({os.path.realpath(path) for path in re.findall(r"(/\S+) \(0x", output("ldd", program))})


def package_of(path):
    """The Debian package a file is from; None where there is none."""
    for name in (path, path.removeprefix("/usr")):  # merged /usr: the package may know it as /lib
        found = subprocess.run(["dpkg-query", "-S", name], capture_output=True, text=True)
        if found.returncode == 0:
            return found.stdout.split(": ")[0].split(",")[0]
    return None


def debian_licences(package):
    """The short names in the machine-readable copyright file; none where it has another form."""
    try:
        with open(f"/usr/share/doc/{package.split(':')[0]}/copyright", encoding="utf-8", errors="replace") as file:
            text = file.read()
    except OSError:
        return []
    return sorted({name.strip() for name in re.findall(r"^License:\s*(\S.*)$", text, re.MULTILINE)})


def debian_component(package):
    values = output("dpkg-query", "-W", "-f=${Package}\t${Version}\t${Architecture}\t${source:Package}\n", package)
    name, version, architecture, source = values.splitlines()[0].split("\t")
    return {
        "type": "library",
        "name": name,
        "version": version,
        "purl": f"pkg:deb/debian/{name}@{version.replace('+', '%2B').replace(':', '%3A')}?arch={architecture}",
        "licenses": [{"license": {"name": licence}} for licence in debian_licences(package)],
        "properties": [{"name": "source-package", "value": source}],
    }


def npm_components(folder):
    """Of the lock file, without what is for building and testing only."""
    with open(os.path.join(folder, "package-lock.json"), encoding="utf-8") as file:
        packages = json.load(file)["packages"]
    components = []
    for path, package in sorted(packages.items()):
        if path == "" or package.get("dev") or package.get("optional"):
            continue
        name = path.rpartition("node_modules/")[2]
        purl_name = name.replace("@", "%40")
        components.append(
            {
                "type": "library",
                "name": name,
                "version": package["version"],
                "scope": "excluded" if name in BUNDLERS else "required",
                "purl": f"pkg:npm/{purl_name}@{package['version']}",
                "licenses": [{"license": {"name": package["license"]}}] if "license" in package else [],
            }
        )
    return components


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: scripts/sbom.py PROGRAM > bom.json")
    program = sys.argv[1]
    files = linked_files(program)
    packages = {path: package_of(path) for path in files}
    names = sorted({package for package in packages.values() if package})
    headers = [name for name in HEADER_PACKAGES if os.path.exists(f"/usr/share/doc/{name}")]
    components = [debian_component(name) for name in names + headers]
    components += [
        {"type": "library", "name": os.path.basename(path), "version": "unknown"}
        for path, package in packages.items()
        if not package
    ]
    bom = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": {
            "component": {
                "type": "application",
                "name": "dynamic-icp",
                "version": output(program, "--version").split()[-1],
                "licenses": [{"license": {"id": "MIT"}}],
            }
        },
        "components": components + npm_components(os.path.join(HERE, "..", "viewer")),
    }
    json.dump(bom, sys.stdout, indent=1)
    print()


if __name__ == "__main__":
    main()
