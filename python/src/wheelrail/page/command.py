"""Command line: `python -m wheelrail report RUN`."""

from pathlib import Path

from ..files import BadFile
from ..fmu import default_path
from . import drawable, of_file, of_stops


def add_command(commands):
    """Adds the command to those of `wheelrail`."""
    command = commands.add_parser("report", help="a page in one file: curves, the contact patch as a film, balances")
    command.add_argument(
        "run", type=Path, help="NetCDF record, CSV of `wheelrail simulate --out`, or directory of results of `train`"
    )
    command.add_argument("--out", type=Path, help="HTML file; default: beside RUN")
    command.add_argument("--fmu", type=Path, help=f"says units and meanings for a CSV and the mass of the vehicle, default {default_path()}")


def of_train(path, stops, scenario):
    """Writes the page of the stops of `train`, or says what it needs: `path` is None where plotly is not installed."""
    if path is None:
        print("no page of the stops, which plotly draws: pip install 'wheelrail[report]'")
        return
    about = [
        ("vehicle", scenario.vehicle.name), ("brake", scenario.brake.name), ("track", scenario.track.name),
        ("speed at the start", f"{3.6 * scenario.speed:g} km/h"), ("communication step", f"{1e3 * scenario.step:g} ms"),
        *((name, str(value)) for name, value in scenario.wheel.items()),
        *((f"right wheel: {name}", str(value)) for name, value in scenario.right_wheel.items()),
        *([("friction of the right rail over the left one's", f"{scenario.right_friction:g}")] if scenario.right_friction != 1.0 else []),
    ]  # fmt: skip
    of_stops(path, stops, scenario.name, about)


def run(options):
    """Writes the page and says where it is and how large."""
    if options.out and options.out.suffix.lower() not in (".html", ".htm"):
        raise BadFile(f"--out {options.out}: a page ends in .html")
    written = of_file(options.run, options.out, options.fmu)
    print(f"written: {written} ({written.stat().st_size / 1e6:.1f} MB), to be opened in a browser")
