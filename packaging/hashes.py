"""Writes the hashes of pinned Python packages into the requirement files.

    python3 packaging/hashes.py [FILE...]    requirements/*.txt without arguments; needs the program uv

Run it after the version of a pin has changed: pip, which is asked for hashes, refuses a package whose file has none of the
hashes that stand below its pin. All files of a version are listed, so that the pins hold for every platform and Python. Comments
and the order of pins stay as they are.
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COMMAND = ("uv", "pip", "compile", "--quiet", "--no-deps", "--universal", "--python-version", "3.11.9")
FORM = ("--generate-hashes", "--no-header", "--no-annotate")


def logical_lines(text):
    """Lines of a requirement file, each with those that continue it."""
    return re.sub(r"\\\n\s*", "", text).splitlines()


def pin(line):
    """A line without its hashes; empty for a comment."""
    return "" if line.startswith("#") else re.split(r"\s+--hash=", line)[0].strip()


def name(pinned):
    """Name of a pinned package as indexes write it."""
    return re.sub(r"[-_.]+", "-", pinned.split("==")[0].strip()).lower()


def hashes(line):
    """Hashes that stand in a line."""
    return re.findall(r"--hash=(sha256:[0-9a-f]{64})(?=\s|$)", line)


def known(pins):
    """Hashes of all files of each pinned version, by name, from the package index that uv is configured for."""
    listed = subprocess.run([*COMMAND, *FORM, "-"], input="\n".join(pins), check=True, stdout=subprocess.PIPE, text=True).stdout
    return {name(pin(line)): sorted(hashes(line)) for line in logical_lines(listed)}


def hashed(text):
    """A requirement file with the hashes of its pins."""
    lines = logical_lines(text)
    found = known([pin(line) for line in lines if pin(line)])
    written = []
    for line in lines:
        each = found[name(pin(line))] if pin(line) else []
        written.append(" \\\n".join([pin(line) or line] + [f"    --hash={value}" for value in each]))
    return "\n".join(written) + "\n"


def main(files):
    """Rewrites files."""
    for file in files or sorted(ROOT.glob("requirements/*.txt")):
        path = Path(file)
        path.write_text(hashed(path.read_text()))
        print(path)


if __name__ == "__main__":
    main(sys.argv[1:])
