#!/usr/bin/env python3
"""Writes docs/LICENSE-THIRD-PARTY: crates that are linked into the library, with their licence texts (each text once)."""

import json
import subprocess
from pathlib import Path

ROOT = Path(__file__).parent.parent
TARGET = "x86_64-unknown-linux-gnu"
RULE = "=" * 100


def linked():
    """Packages that the library links, from cargo's own resolution: not those of tests, builds and macros only."""
    command = ["cargo", "metadata", "--format-version=1", "--locked", f"--filter-platform={TARGET}"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout)
    packages = {package["id"]: package for package in metadata["packages"]}
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    found, pending = set(), [metadata["resolve"]["root"]]
    while pending:
        for dependency in nodes[pending.pop()]["deps"]:
            normal = any(kind["kind"] is None for kind in dependency["dep_kinds"])
            macro = any("proc-macro" in target["kind"] for target in packages[dependency["pkg"]]["targets"])
            if normal and not macro and dependency["pkg"] not in found:
                found.add(dependency["pkg"])
                pending.append(dependency["pkg"])
    others = [packages[package] for package in found if packages[package]["source"]]  # without members of the workspace
    return sorted(others, key=lambda package: (package["name"], package["version"]))


def texts(package):
    """Licence files of a package."""
    folder = Path(package["manifest_path"]).parent
    wanted = ("licen", "copying", "notice", "unlicense")
    files = sorted(file for file in folder.iterdir() if file.is_file() and file.name.lower().startswith(wanted))
    return [file.read_text(errors="replace").strip() for file in files]


def main():
    # Texts that differ in line breaks only are one text.
    owners, first = {}, {}
    lines = ["Crates linked into the wheelrail library.", ""]
    for package in linked():
        name = f"{package['name']} {package['version']}"
        lines.append(f"{name}: {package['license']} ({package['repository']})")
        for text in texts(package):
            words = " ".join(text.split())
            owners.setdefault(words, []).append(name)
            first.setdefault(words, text)
    for words, names in owners.items():
        lines += ["", RULE, ", ".join(names), RULE, "", first[words]]
    (ROOT / "docs" / "LICENSE-THIRD-PARTY").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
