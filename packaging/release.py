"""Checks that everything that names a version names the same one, and that of a tag: `python3 packaging/release.py v0.4.0`.

A name that begins with no v and a digit, such as that of a branch, is no version: then only the files are compared.
"""

import re
import sys
import tomllib
from pathlib import Path
from xml.etree import ElementTree

ROOT = Path(__file__).resolve().parent.parent


def versions():
    """Version by file."""
    first = lambda path, pattern: re.search(pattern, (ROOT / path).read_text(), re.MULTILINE).group(1)
    return {
        "Cargo.toml": tomllib.loads((ROOT / "Cargo.toml").read_text())["package"]["version"],
        "python/pyproject.toml": tomllib.loads((ROOT / "python" / "pyproject.toml").read_text())["project"]["version"],
        "python/src/wheelrail/__init__.py": first("python/src/wheelrail/__init__.py", r'^__version__ = "(.+)"'),
        "modelDescription.xml": ElementTree.parse(ROOT / "modelDescription.xml").getroot().get("version"),
        "CITATION.cff": first("CITATION.cff", r"^version: \"?([^\"\n]+)"),
    }


def main(arguments):
    """Prints the version, or ends with what differs."""
    if len(arguments) != 1:
        sys.exit(__doc__)
    (tag,) = arguments
    found = versions()
    if re.match(r"v\d", tag):
        found["the tag"] = tag[1:]
    if len(set(found.values())) > 1:
        sys.exit("error: versions differ: " + ", ".join(f"{name} {version}" for name, version in found.items()))
    print(found["Cargo.toml"])


if __name__ == "__main__":
    main(sys.argv[1:])
