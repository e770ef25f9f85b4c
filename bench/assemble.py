"""Puts the page of the bench together: the files of bench/page, the core in core.js, and a basis for each patch.

    bench/assemble.py --core bench.wasm --library libbench.so --fmu wheelrail.fmu --out FOLDER

From a file a browser reads nothing but scripts, pictures and style. So the core, its worker and the bases are texts in
scripts: bytes packed by gzip, written by the 64 characters of base64. Bases are those that are stored in the FMU; which
one a patch needs the library of this machine tells.
"""

import argparse
import base64
import gzip
import json
import re
import shutil
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "bench"))

from library import Library  # noqa: E402

PATCHES = ("line", "ellipse", "s1002")


def packed(data):
    """Bytes as a text that the worker unpacks. The same bytes give the same text."""
    return base64.b64encode(gzip.compress(data, 9, mtime=0)).decode("ascii")


def write(path, text):
    """Writes a text and says how long it is."""
    path.write_text(text, encoding="utf-8")
    return len(text)


def bases(fmu, names, out):
    """Scripts with the bases of these names that are stored in an FMU."""
    with zipfile.ZipFile(fmu) as archive:
        stored = {Path(name).name: name for name in archive.namelist() if name.endswith(".bin")}
        missing = sorted(set(names) - set(stored))
        if missing:
            raise SystemExit(f"{fmu} has no basis {', '.join(missing)}: make it anew by `make fmu`")
        for name in names:
            write(out / f"{name}.js", f'BENCH_BASES["{name}"] = "{packed(archive.read(stored[name]))}";\n')


def main():
    """The command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--core", type=Path, required=True, help="module of WebAssembly")
    parser.add_argument("--library", type=Path, required=True, help="the same code for this machine")
    parser.add_argument("--fmu", type=Path, required=True, help="FMU with stored bases")
    parser.add_argument("--out", type=Path, required=True, help="folder of the page")
    given = parser.parse_args()
    library = Library(given.library)
    names = [library.text("basis_name", f"patch={patch}") for patch in PATCHES]
    shutil.rmtree(given.out, ignore_errors=True)
    (given.out / "bases").mkdir(parents=True)
    for file in sorted((ROOT / "bench" / "page").iterdir()):
        if file.name != "worker.js":
            shutil.copyfile(file, given.out / file.name)
    bases(given.fmu, names, given.out / "bases")
    core = {
        "version": re.search(r'^version = "(.+)"', (ROOT / "Cargo.toml").read_text(), re.M)[1],
        "bases": names,
        "worker": (ROOT / "bench" / "page" / "worker.js").read_text(encoding="utf-8"),
        "wasm": packed(given.core.read_bytes()),
    }
    write(given.out / "core.js", f"const BENCH_CORE = {json.dumps(core)};\n")
    size = sum(file.stat().st_size for file in given.out.rglob("*") if file.is_file())
    print(f"written: {given.out / 'index.html'}, {size / 1e6:.1f} MB with {len(names)} bases")


if __name__ == "__main__":
    main()
