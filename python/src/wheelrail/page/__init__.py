"""The report page: one HTML file with curves, the contact patch as a film, parameters, warnings and balances of a run.

`write(path, dataset)` takes what `wheelrail.records` makes, or a `run.Run`; `of_stops` the stops of a train; `of_file` whatever
`python -m wheelrail report` takes. plotly draws (`pip install 'wheelrail[report]'`) and is inside the page, which needs no
network.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import output
from ..files import BadFile
from . import sources
from .html import drawable
from .run import Run, of_dataset
from .stops import Stop, of_table
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
    """Writes the page of stops side by side: name to the table of `train.Stop.run` or (table, rail map), or to a `stops.Stop`.
    `about` has rows of texts on the scenario, name and value. Returns the path."""
    place, found = Path(path).absolute(), {
        name: stop if isinstance(stop, Stop) else of_table(stop[0] if isinstance(stop, tuple) else stop)
        for name, stop in stops.items()
    }
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
