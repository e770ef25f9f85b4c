"""The report page: one HTML file with curves, the contact patch as a film, parameters, warnings and balances of a run.

`write(path, dataset)` takes what `wheelrail.records` makes, or a `run.Run`; `of_stops` the stops of a train; `of_file` whatever
`python -m wheelrail report` takes. plotly draws (`pip install 'wheelrail[report]'`) and is inside the page, which needs no
network.
"""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from .. import output
from ..files import BadFile
from ..fmu import default_path
from . import sources
from .html import drawable
from .run import Run, of_dataset
from .writing import run_page, stops_page

if TYPE_CHECKING:
    import xarray

__all__ = ["BadFile", "Run", "drawable", "of_file", "of_stops", "write"]


def write(path: str | Path, dataset: xarray.Dataset | Run) -> Path:
    """Writes the page of a run, an xarray Dataset or a `Run`; returns its path."""
    place = Path(path).absolute()  # the process may go elsewhere meanwhile
    output.write(place, run_page(dataset if isinstance(dataset, Run) else of_dataset(dataset), _now()))
    return Path(path)


def of_stops(path: str | Path, stops: Mapping[str, Any], title: str = "A train brakes", about: Sequence[tuple[str, str]] = ()) -> Path:
    """Writes the page of stops side by side: name to the table of `train.Stop.run` or (table, rail map). `about` has rows of texts
    on the scenario, name and value. Returns the path."""
    place, found = Path(path).absolute(), {name: stop[0] if isinstance(stop, tuple) else stop for name, stop in stops.items()}
    output.write(place, stops_page(title, found, about, _now()))
    return Path(path)


def of_file(source: str | Path, out: str | Path | None = None, fmu: str | Path | None = None) -> Path:
    """Writes the page of a NetCDF record, a CSV or a directory of results; returns its path, by default beside the source."""
    source = Path(source)
    found = sources.read(source, fmu)
    out = Path(out) if out else (source / "report.html" if source.is_dir() else source.with_suffix(".html"))
    return write(out, found) if isinstance(found, Run) else of_stops(out, found, source.stem.replace("_", " "))


def _now():
    return f"{datetime.now():%Y-%m-%d %H:%M}"


def add_command(commands: Any) -> None:
    """Adds the command to those of `wheelrail`."""
    command = commands.add_parser("report", help="a page in one file: curves, the contact patch as a film, balances")
    command.add_argument(
        "run", type=Path, help="NetCDF record, CSV of `wheelrail simulate --out`, or directory of results of `train`"
    )
    command.add_argument("--out", type=Path, help="HTML file; default: beside RUN")
    command.add_argument("--fmu", type=Path, help=f"says units and meanings for a CSV and the mass of the vehicle, default {default_path()}")


def of_train(path: Path | None, stops: Mapping[str, Any], scenario: SimpleNamespace) -> None:
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


def command(options: Namespace) -> None:
    """Writes the page and says where it is and how large."""
    if options.out and options.out.suffix.lower() not in (".html", ".htm"):
        raise BadFile(f"--out {options.out}: a page ends in .html")
    written = of_file(options.run, options.out, options.fmu)
    print(f"written: {written} ({written.stat().st_size / 1e6:.1f} MB), to be opened in a browser")
