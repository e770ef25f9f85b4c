"""What `python -m wheelrail report` reads: a record as NetCDF, a CSV of `wheelrail simulate --out`, the results of `train`."""

import re
from contextlib import nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np

from .. import report
from ..files import BadFile
from ..fmu import Fmu, Refused, default_path
from ..origin import preset_values
from ..tables import comma, headings_of, read_table
from ..records import of_netcdf
from ..units import UnitError, converted, headed, unit_of
from ..values import first_line
from . import stops
from .run import Profiles, Run, Series, of_dataset, seen_lines, seen_rows

HDF, CLASSIC = b"\x89HDF", b"CDF"
FLAGS = {"true": 1.0, "false": 0.0}
POINT = re.compile(r"^(?P<of>profile|line)\.(?P<name>\w+)\[(?P<point>\d+)\]$")


def read(path, fmu=None):
    """Content of a file or directory: a `Run`, or a dict of stops, name to table. `fmu` is a path: what its
    description says of units and meaning holds for a CSV without units."""
    path = Path(path)
    if path.is_dir():
        return _directory(path)
    try:
        with open(path, "rb") as file:
            start = file.read(4)
    except OSError as error:
        raise BadFile(
            f"{path}: cannot be read ({error.strerror}); expected a NetCDF or CSV file, or a directory of results"
        ) from error
    if start.startswith((HDF, CLASSIC)):
        return _netcdf(path, fmu)
    header, columns = table(path)
    if stops.recognised(header):
        return {path.stem: _stop(path, columns)}
    with _opened(fmu) as known:
        described = {name: (v.unit or "", v.description or "") for name, v in known.variables.items()} if known else {}
    return _of_csv(path, columns, described)


def _netcdf(path, fmu):
    try:
        loaded = of_netcdf(path)
    except ImportError as error:
        raise BadFile(f"{path}: {error}") from None
    except Exception as error:  # Whatever the libraries below say of a file that is damaged or something else.
        raise BadFile(f"{path}: is no NetCDF file that xarray reads ({first_line(error)})") from error
    try:
        run = of_dataset(loaded)
    except BadFile as error:
        raise BadFile(f"{path}: {error}") from None
    _ascending(path, run.time)
    run.title = path.stem if run.title == "Run" else run.title
    mass = _vehicle_mass(fmu, run.about)
    return replace(run, about=run.about | ({} if mass is None else {"vehicle_mass": mass}))


def _vehicle_mass(fmu, about):
    """vehicle.mass [kg] of a record: its own, else that of its preset in an FMU of its version, else None."""
    given, name = about.get("parameters") or {}, "vehicle.mass"
    if name in given:
        return float(given[name])
    with _opened(fmu) as known:
        same = known and name in known.variables and str(about.get("fmu_version")) == str(known.description.version)
        return float(preset_values(known, about.get("preset"))[name]) if same else None


def table(path):
    """Names and columns of a CSV: name to (unit or None, values), times in s. Columns may say `name [unit]`."""
    try:
        headings, head, lines = read_table(path)
    except BadFile as failure:
        raise BadFile(f"{failure}; expected a record in NetCDF or a CSV, such as that of `wheelrail simulate --out`") from None
    names = [headed(heading) for heading in headings]
    if "time" not in dict(names):
        raise BadFile(f"{path}:{head}: no column `time`; the first line names the columns")
    rows = [[_number(path, line, *pair) for pair in zip(headings, cells)] for line, cells in lines]
    if len(rows) < 2:
        raise BadFile(f"{path}: {len(rows)} lines of values; a curve needs two")
    columns = {name: (unit, column) for (name, unit), column in zip(names, np.array(rows).T)}
    columns["time"] = "s", _in(path, "time", columns["time"], "s")
    _ascending(path, columns["time"][1])
    return list(columns), columns


def _in(path, name, column, expected):
    """The values of a column, a pair of unit and values, in the unit that is expected of it."""
    try:
        return converted(name, column[1], column[0], expected)
    except UnitError as error:
        raise BadFile(f"{path}: {error}") from None


def _number(path, line, name, cell):
    """The number in a cell; flags, as FMI (true) or Python and pandas (True) write them, count 1 and 0, an empty one is unknown."""
    try:
        return FLAGS[cell.lower()] if cell.lower() in FLAGS else float(cell or "nan")
    except ValueError:
        raise BadFile(f"{path}:{line}: {name} is {cell[:40]!r}, no number{comma(cell)}") from None


def _ascending(path, time):
    """Refuses times that do not grow."""
    back = np.flatnonzero(~(np.diff(time) > 0.0)) if len(time) > 1 else [0]
    if len(back):
        k = int(back[0])
        after = f"{time[k]:g} s is followed by {time[k + 1]:g} s" if len(time) > 1 else f"{len(time)} instant"
        raise BadFile(f"{path}: time must grow from row to row: {after}")


def _opened(fmu):
    """The FMU at a path, as a context; without a path the default one, or None where that is missing."""
    if fmu is None and not default_path().is_file():
        return nullcontext()
    try:
        return Fmu(fmu)
    except (Refused, FileNotFoundError) as error:
        raise BadFile(f"--fmu {error}") from None


def _of_csv(path, columns, described):
    """The run of a CSV of `wheelrail simulate --out`."""
    time, series, points = columns.pop("time")[1], {}, {"profile": {}, "line": {}}
    for name, column in columns.items():
        known, meaning = described.get(name, ("", ""))
        found = Series(_in(path, name, column, known), known, meaning) if name in described else _as_written(*column)
        if point := POINT.match(name):
            points[point["of"]].setdefault(point["name"], {})[int(point["point"])] = found.values
        else:
            series[name] = found
    patch, lines = (
        {name: np.column_stack([found[k] for k in sorted(found)]) for name, found in points[of].items()} for of in points
    )
    about = {} if described else {"note": "There is no FMU here that says units and meanings."}
    return Run(path.stem, time, series, seen_rows(Profiles(time, patch)), about=about, lines=seen_lines(time, lines))


def _as_written(unit, values):
    """A quantity of which nothing else is known: in SI units if its unit is known, else as it is."""
    try:
        known = unit_of(unit or "")
    except UnitError:
        return Series(values, unit)
    return Series(known.to_si(values), known.name() if unit else "")


def _directory(path):
    """The stops of a directory of results: every CSV with columns of a stop, the shortest first."""
    found = {}
    for file in sorted(path.glob("*.csv")):
        if stops.recognised(headed(heading)[0] for heading in headings_of(file)):
            found[file.stem.removeprefix("train_").replace("_", " ")] = _stop(file, table(file)[1])
    if not found:
        raise BadFile(
            f"{path}: no CSV of a stop in it (columns time, speed … of all axles); expected results of `python -m wheelrail train`"
        )
    return dict(sorted(found.items(), key=lambda item: report.column(item[1], "travelled")[-1]))


def _stop(path, columns):
    """The stop of the columns of a CSV."""
    try:
        return stops.of_columns(columns)
    except UnitError as error:
        raise BadFile(f"{path}: {error}") from None
