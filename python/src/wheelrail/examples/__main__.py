"""Copies the examples and the FMU into a folder, in which they run as in a checkout: `python -m wheelrail.examples FOLDER`."""

import argparse
import shutil
import sys
from pathlib import Path

from .. import __version__
from ..fmu import default_path

INSIDE = Path(__file__).with_name("files")


def copied(folder):
    """Copies examples and FMU into a new or empty folder; returns the first example there."""
    if not INSIDE.is_dir():
        raise FileNotFoundError("this package was built without examples: they are in the folder examples of the checkout")
    fmu = default_path()
    if not fmu.is_file():
        raise FileNotFoundError(f"{fmu} does not exist: name an FMU by the environment variable WHEELRAIL_FMU")
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise FileExistsError(f"{folder} is not an empty folder: name another one")
    shutil.copytree(INSIDE, folder / "examples", ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "target").mkdir()
    shutil.copy(fmu, folder / "target" / "wheelrail.fmu")
    return folder / "examples" / "ex00_minimal.py"


def main(argv=None):
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m wheelrail.examples", description="Copies the examples and the FMU into a folder.")
    parser.add_argument("folder", type=Path, nargs="?", default=Path("wheelrail-examples"), help="default: %(default)s")
    parser.add_argument("--version", action="version", version=f"wheelrail {__version__}")
    folder = parser.parse_args(argv).folder
    try:
        first = copied(folder)
    except OSError as error:
        sys.exit(f"error: {error}")
    print(f"{folder}: examples and target/wheelrail.fmu. The first one:\n\n    cd {folder}\n    python {first.relative_to(folder)}")


if __name__ == "__main__":
    main()
