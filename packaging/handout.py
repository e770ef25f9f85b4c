"""Gathers what is handed out with a version in one folder: `make release` calls this when all of it has been made.

    python3 packaging/handout.py FOLDER    FMUs, bill of materials, wheel, sdist, package SSP, pages, notes, checksums

The notes are those of the version in CHANGELOG.md. Nothing is uploaded.
"""

import hashlib
import re
import shutil
import sys
import zipfile
from pathlib import Path

from release import versions

ROOT = Path(__file__).resolve().parent.parent
# Patterns below target/, each of which names one file.
FILES = (
    "wheelrail-all.fmu", "wheelrail-slim-all.fmu", "wheelrail-fmi3-all.fmu", "wheelrail-all.cdx.json",
    "dist/wheelrail-{version}-*.whl", "dist/wheelrail-{version}.tar.gz", "coach_and_wheels.ssp",
)  # fmt: skip
DATE = (2020, 1, 1, 0, 0, 0)  # of all files in the archive of pages, so that equal pages are equal bytes


def notes(text, version):
    """The part of a changelog that belongs to a version."""
    found = re.search(rf"^## \[{re.escape(version)}\].*?\n(.*?)(?=^## \[|\Z)", text, re.MULTILINE | re.DOTALL)
    if not found or not found[1].strip():
        sys.exit(f"error: CHANGELOG.md says nothing of version {version}")
    return f"# wheelrail {version}\n\n{found[1].strip()}\n"


def made(target, version):
    """The files below a folder that are handed out; ends with the names of those that are missing."""
    found = {pattern: sorted(target.glob(pattern.format(version=version))) for pattern in FILES}
    wrong = [pattern.format(version=version) for pattern, files in found.items() if len(files) != 1]
    if not (target / "site" / "index.html").is_file():
        wrong.append("site/index.html")
    if wrong:
        sys.exit(f"error: missing, or several of a kind, in {target}: {', '.join(wrong)}")
    return [files[0] for files in found.values()]


def zipped(folder, path):
    """Writes all files of a folder into an archive, in the order of their names."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(folder.rglob("*")):
            if file.is_file():
                archive.writestr(zipfile.ZipInfo(str(file.relative_to(folder)), DATE), file.read_bytes(), zipfile.ZIP_DEFLATED)


def gather(target, out, version, changelog):
    """Copies everything to a folder that is made anew, and writes notes and checksums beside it; returns the paths."""
    files, text = made(target, version), notes(changelog, version)
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    for file in files:
        shutil.copy(file, out)
    zipped(target / "site", out / f"wheelrail-{version}-pages.zip")
    (out / "NOTES.md").write_text(text)
    gathered = sorted(out.iterdir())
    sums = [f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in gathered]
    (out / "SHA256SUMS").write_text("".join(sums))
    return gathered


def main(arguments):
    if len(arguments) != 1:
        sys.exit(__doc__)
    found = versions()
    if len(set(found.values())) > 1:
        sys.exit("error: versions differ: " + ", ".join(f"{name} {version}" for name, version in found.items()))
    version = found["Cargo.toml"]
    for file in gather(ROOT / "target", Path(arguments[0]), version, (ROOT / "CHANGELOG.md").read_text()):
        print(f"{file.stat().st_size / 1e6:8.2f} MB  {file.name}")
    print(f"{arguments[0]}: version {version}, with SHA256SUMS; to do by hand: tag v{version}, upload")


if __name__ == "__main__":
    main(sys.argv[1:])
