#!/usr/bin/env python3
"""Lists of components (SPDX 2.3) and licences for the packages that deploy/packages makes.

    deploy/sbom.py --version 0.1.0 --out FOLDER --web web [--linked tools=LIST] server=PROGRAM,… station=… tools=… web=

Writes FOLDER/NAME/sbom.spdx.json and FOLDER/NAME/copyright for each NAME. Components are the Debian packages of the shared
libraries that a program or shared object loads (ldd, dpkg), those whose headers are compiled in, those that LIST names because they
are linked in, and the npm packages that the pages hold. The time is SOURCE_DATE_EPOCH.
"""
import argparse
import hashlib
import json
import os
import re
import subprocess
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEADERS = ("libeigen3-dev", "nlohmann-json3-dev", "libcli11-dev", "libboost-dev", "libutfcpp-dev")


def said(*words):
    return subprocess.run(words, capture_output=True, text=True, check=True).stdout


def debian_package(name, held):
    """Name, version, licences as its copyright file names them, and the package address of a Debian package; their texts too if
    its code is held in ours."""
    version, architecture = said("dpkg-query", "-W", "-f", "${Version} ${Architecture}", name).split()
    base = name.split(":")[0]
    text = Path(f"/usr/share/doc/{base}/copyright").read_text(errors="replace")
    licences = sorted(set(re.findall(r"^License:\s*(\S.*)$", text, re.M)))
    return {"name": base, "version": version, "licences": licences, "texts": [text.strip()] if held else [],
            "address": f"pkg:deb/debian/{base}@{version}?arch={architecture}"}


def libraries(programs):
    """Names of the Debian packages of all shared libraries that the programs load."""
    found = set()
    for program in programs:
        for path in re.findall(r"=> (/\S+)", said("ldd", program)):
            real = os.path.realpath(path)
            for place in (real, real.removeprefix("/usr"), path):  # dpkg knows a library by the path it was shipped under
                owner = subprocess.run(["dpkg", "-S", place], capture_output=True, text=True)
                if owner.returncode == 0:
                    found.add(owner.stdout.split(": ")[0].split(",")[0])
                    break
            else:
                raise SystemExit(f"sbom: no Debian package holds {real}")
    return sorted(found)


def npm_packages(web):
    """The packages that the pages are built from: those of the lock file that are not for development alone."""
    for place, one in sorted(json.loads((web / "package-lock.json").read_text())["packages"].items()):
        if not place or one.get("dev") or one.get("optional"):
            continue
        name = place.split("node_modules/")[-1]
        files = sorted((web / place).glob("[Ll][Ii][Cc][Ee][Nn][CSces]*")) or [web / place / "README.md"]  # some state it in their README
        texts = [path.read_text(errors="replace").strip() for path in files]
        yield {"name": name, "version": one["version"], "licences": [one.get("license", "")], "declared": one.get("license"), "texts": texts,
               "address": f"pkg:npm/{name.replace('@', '%40')}@{one['version']}"}


def spdx(name, version, parts):
    created = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(os.environ.get("SOURCE_DATE_EPOCH", "0"))))

    def entry(number, part):
        return {"SPDXID": f"SPDXRef-{number}", "name": part["name"], "versionInfo": part["version"],
                "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
                "licenseDeclared": part.get("declared") or "NOASSERTION", "licenseComments": "; ".join(filter(None, part["licences"])),
                "copyrightText": "NOASSERTION",
                "externalRefs": [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": part["address"]}]}

    own = {"name": name, "version": version, "licences": [], "declared": "Apache-2.0", "address": f"pkg:deb/{name}@{version}"}
    packages = [entry(number, part) for number, part in enumerate([own, *parts])]
    names = hashlib.sha256(json.dumps(packages, sort_keys=True).encode()).hexdigest()
    return {"spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"{name}-{version}",
            "documentNamespace": f"https://tractus.example.org/spdx/{name}-{version}-{names[:16]}",
            "creationInfo": {"created": created, "creators": ["Tool: deploy/sbom.py"]}, "packages": packages,
            "relationships": [{"spdxElementId": "SPDXRef-DOCUMENT", "relationshipType": "DESCRIBES", "relatedSpdxElement": "SPDXRef-0"}] + [
                {"spdxElementId": "SPDXRef-0", "relationshipType": "DEPENDS_ON", "relatedSpdxElement": f"SPDXRef-{number + 1}"}
                for number in range(len(parts))]}


def copyright_text(parts):
    out = [(ROOT / "NOTICE").read_text().strip(), "The Apache License, Version 2.0: /usr/share/common-licenses/Apache-2.0"]
    beside = [part["name"] for part in parts if not part["texts"]]
    if beside:
        out.append("Loaded as shared libraries, with their licences in the packages of their own (/usr/share/doc/NAME/copyright):\n\n"
                   + "\n".join(beside))
    for part in parts:
        for text in part["texts"]:
            out.append(f"{part['name']} {part['version']}\n\n{text}")
    return ("\n\n" + "-" * 80 + "\n\n").join(out) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--version", required=True)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--web", type=Path, required=True, help="folder of the pages' sources")
    parser.add_argument("--linked", action="append", default=[], metavar="NAME=LIST",
                        help="file with the Debian packages whose code is linked into component NAME, one a line")
    parser.add_argument("components", nargs="+", metavar="NAME=PROGRAM,…")
    options = parser.parse_args()
    linked = {name: Path(path).read_text().split() for name, path in (one.split("=") for one in options.linked)}
    for component in options.components:
        name, programs = component.split("=")
        programs = [one for one in programs.split(",") if one]
        held = sorted({*HEADERS, *linked.get(name, [])})
        parts = ([debian_package(one, False) for one in libraries(programs)] + [debian_package(one, True) for one in held]
                 if programs else list(npm_packages(options.web)))
        folder = options.out / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "sbom.spdx.json").write_text(json.dumps(spdx(f"tractus-{name}", options.version, parts), indent=1) + "\n")
        (folder / "copyright").write_text(copyright_text(parts))


if __name__ == "__main__":
    main()
