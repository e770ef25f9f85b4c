"""Bill of materials of the library: every crate that Cargo links, as CycloneDX 1.6 in JSON, for scanners of vulnerabilities and licences.

    python3 packaging/sbom.py --out FILE [--target TRIPLE ...]    for this machine without --target

`make fmu` writes target/wheelrail.cdx.json with it and packs it into the FMU. Versions and checksums are those of Cargo.lock.
Crates of tests, of builds and of macros are no part of the library, and none of the bill. The same crates give the same bytes.
"""

import argparse
import json
import os
import re
import subprocess
import uuid
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CARGO = os.environ.get("CARGO", "cargo")


def host():
    """Triple of this machine, as the compiler names it."""
    lines = subprocess.run([os.environ.get("RUSTC", "rustc"), "-vV"], check=True, stdout=subprocess.PIPE, text=True).stdout
    return next(line.split()[1] for line in lines.splitlines() if line.startswith("host:"))


def linked(target):
    """Crates that are linked for a platform, the product first, each with the names of those that it needs: by their package URL, or
    by `workspace:` for those of this repository."""
    library = ["--package", "wheelrail", "--edges", "normal,no-proc-macro"]
    command = [CARGO, "tree", "--locked", *library, "--target", target]
    lines = subprocess.run(
        [*command, "--prefix", "depth", "--format", "\t{p}\t{l}\t{r}\t"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True
    ).stdout
    crates, above = {}, []
    for line in filter(None, lines.splitlines()):
        depth, package, licence, repository, _ = line.split("\t")
        name, version, *place = package.split()
        key = f"{'workspace:' if place else 'pkg:cargo/'}{name}@{version.removeprefix('v')}"
        # A crate whose branch stands further up is marked and has no branch again.
        crates.setdefault(key, {"licence": licence, "repository": repository, "needs": set()})
        above[int(depth) :] = [key]
        if len(above) > 1:
            crates[above[-2]]["needs"].add(key)
    return crates


def component(key, crate, checksums):
    """Entry of one crate."""
    name, version = re.split("[:/]", key)[-1].split("@")
    entry = {
        "type": "library",
        "bom-ref": key,
        "name": name,
        "version": version,
        "licenses": [{"expression": crate["licence"].replace("/", " OR ")}],
    }
    if key.startswith("pkg:"):
        entry |= {"hashes": [{"alg": "SHA-256", "content": checksums[name, version]}], "purl": key}
    if crate["repository"]:
        entry["externalReferences"] = [{"type": "vcs", "url": crate["repository"]}]
    return entry


def bill(targets):
    """The bill of some platforms together."""
    crates = {}
    for target in targets:
        for key, crate in linked(target).items():
            crates.setdefault(key, crate)["needs"] |= crate["needs"]
    root, *others = crates
    lock = (ROOT / "Cargo.lock").read_text()
    locked = re.findall(r'^name = "(.+)"\nversion = "(.+)"\nsource = .+\nchecksum = "([0-9a-f]{64})"$', lock, re.MULTILINE)
    checksums = {(name, version): checksum for name, version, checksum in locked}
    contents = {
        "metadata": {
            "component": component(root, crates[root], checksums),
            "properties": [{"name": "wheelrail:target", "value": target} for target in sorted(targets)],
        },
        "components": [component(key, crates[key], checksums) for key in sorted(others)],
        "dependencies": [{"ref": key, "dependsOn": sorted(crates[key]["needs"])} for key in sorted(crates)],
    }
    serial = uuid.uuid5(uuid.NAMESPACE_OID, json.dumps(contents, sort_keys=True))
    head = {"bomFormat": "CycloneDX", "specVersion": "1.6", "serialNumber": f"urn:uuid:{serial}", "version": 1}
    return head | contents


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--target", action="append", metavar="TRIPLE", help="a platform of the libraries; may be repeated")
    arguments = parser.parse_args()
    made = bill(arguments.target or [host()])
    arguments.out.parent.mkdir(parents=True, exist_ok=True)
    arguments.out.write_text(json.dumps(made, indent=1, ensure_ascii=False) + "\n")
    print(f"{arguments.out}: {len(made['components'])} crates")


if __name__ == "__main__":
    main()
