"""Builds the Python package from python/: a wheel with an FMU, examples and licences inside, and an sdist without an FMU.

    .venv/bin/python packaging/wheel.py FMU [--out FOLDER]      the wheel; `make wheel` and `make wheel ALL=1` call this
    .venv/bin/python packaging/wheel.py --sdist [--out FOLDER]  the sdist, for platforms that the wheel does not run on

The wheel bears the names of the platforms whose libraries are in the FMU, so that pip refuses it elsewhere.
"""

import argparse
import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# As packaging/check.py demands of the binaries of `make fmu ALL=1`.
PORTABLE = {"linux64": "manylinux_2_17_x86_64.manylinux2014_x86_64", "win64": "win_amd64"}
# Examples that need a checkout: programs in Rust, and the run that is packed.
CHECKOUT_ONLY = {"ex03_endurance", "ex04_random_parameters", "fields", "reference", "__pycache__"}


def staged(folder):
    """The package with examples and licences, copied to a folder."""
    hidden = shutil.ignore_patterns("__pycache__", "*.fmu", "*.egg-info")
    package = Path(shutil.copytree(ROOT / "python", folder / "python", ignore=hidden))
    inside = package / "src" / "wheelrail" / "examples" / "files"
    shutil.copytree(ROOT / "examples", inside, ignore=lambda _, names: CHECKOUT_ONLY & set(names))
    for licence in ("LICENSE-MIT", "LICENSE-APACHE", "docs/LICENSE-THIRD-PARTY"):
        shutil.copy(ROOT / licence, package)
    return package


def platforms(fmu):
    """Platform tag of a wheel with this FMU."""
    with zipfile.ZipFile(fmu) as archive:
        parts = [name.split("/") for name in archive.namelist()]
    found = {part[1] for part in parts if part[0] == "binaries" and len(part) > 2}
    if found == set(PORTABLE):
        return ".".join(PORTABLE[name] for name in sorted(found))
    if len(found) != 1:
        sys.exit(f"error: {fmu} has libraries for {', '.join(sorted(found)) or 'no platform'}: expected those of `make fmu` or `make fmu ALL=1`")
    return sysconfig.get_platform().replace("-", "_").replace(".", "_")


def build(package, hook, out):
    """File that a hook of the build backend makes of a package."""
    code = f"import flit_core.buildapi as b; print(b.{hook}({str(out)!r}))"
    environment = os.environ | {"SOURCE_DATE_EPOCH": os.environ.get("SOURCE_DATE_EPOCH", "1577836800")}
    run = subprocess.run([sys.executable, "-c", code], cwd=package, check=True, stdout=subprocess.PIPE, text=True, env=environment)
    return out / run.stdout.split()[-1]


def wheel(fmu, out):
    """The wheel with an FMU inside."""
    tag = platforms(fmu)
    with tempfile.TemporaryDirectory() as temporary:
        package = staged(Path(temporary))
        shutil.copy(fmu, package / "src" / "wheelrail" / "wheelrail.fmu")
        made = build(package, "build_wheel", Path(temporary))
        command = [sys.executable, "-m", "wheel", "tags", "--remove", "--platform-tag", tag, made]
        name = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.split()[-1]
        return shutil.move(made.with_name(name), out / name)


def sdist(out):
    """The sdist."""
    with tempfile.TemporaryDirectory() as temporary:
        return build(staged(Path(temporary)), "build_sdist", out)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmu", type=Path, nargs="?")
    parser.add_argument("--sdist", action="store_true")
    parser.add_argument("--out", type=Path, default=ROOT / "target")
    arguments = parser.parse_args()
    if arguments.sdist == (arguments.fmu is not None):
        parser.error("name an FMU or --sdist")
    if arguments.fmu and not arguments.fmu.is_file():
        parser.error(f"{arguments.fmu} does not exist: build it with `make fmu` or `make fmu ALL=1`")
    arguments.out.mkdir(parents=True, exist_ok=True)
    out = arguments.out.resolve()
    made = sdist(out) if arguments.sdist else wheel(arguments.fmu, out)
    print(f"{made}: {Path(made).stat().st_size / 1e6:.2f} MB")


if __name__ == "__main__":
    main()
