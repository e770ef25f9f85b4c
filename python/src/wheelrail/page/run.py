"""A run as a page shows it: quantities over time with unit and meaning, profiles over patch and depth, what was set."""

import json
from dataclasses import dataclass, field

import numpy as np

from .. import damage
from ..fmu import known_unit
from ..tables import BadFile
from ..units import UnitError, in_si, unit_of
from ..warn import warn

PLACES = ("time", "node", "depth", "line")  # dimensions of a record


@dataclass
class Series:
    """A quantity over time in SI units; `meaning` is the description of the FMU."""

    values: np.ndarray
    unit: str = ""
    meaning: str = ""


@dataclass
class Profiles:
    """Quantities over place and time: `time` [s] of every row, `values` name to array (time, place), SI units."""

    time: np.ndarray
    values: dict


@dataclass
class Field:
    """A temperature [K] over time [s] and depth [m]."""

    time: np.ndarray
    depth: np.ndarray
    values: np.ndarray
    meaning: str = ""


@dataclass
class Run:
    """A wheel over time. `series` are the FMU's variables by name; `about` may hold fmu_version, preset, parameters (those
    that differ from the preset), inputs (the constant ones), warnings (texts, or pairs of time [s] and text). `lines` has what each
    line of a patch with a width of its own has, by names without `line.`, over time and line; `across` the profiles of these lines,
    by names without `patch.`, over time, line and node, whose places [m] are its `x`. `damage` is a `wheelrail.damage.Damage`.
    `about["figures"]` are rows of texts, name and value, that stand in the place of the page's own duration and distance."""

    title: str
    time: np.ndarray
    series: dict
    patch: Profiles | None = None
    fields: dict = field(default_factory=dict)
    about: dict = field(default_factory=dict)
    lines: Profiles | None = None
    across: Profiles | None = None
    damage: object | None = None

    def __post_init__(self):
        # A run without heat has temperatures of 0 K.
        self.series = {name: s for name, s in self.series.items() if s.unit != "K" or np.any(s.values)}

    def get(self, name):
        """Values of a series, None if there is none or it has no finite value."""
        found = self.series.get(name)
        return found.values if found is not None and np.isfinite(found.values).any() else None

    def at(self, name, time):
        """Values of a series at other times, None if there is none."""
        values = self.get(name)
        return None if values is None else np.interp(time, self.time, values)

    def has(self, *names):
        """Whether all of these are there."""
        return all(self.get(name) is not None for name in names)


def of_table(title, fmu, names, table, patch=None, about=None):
    """The run of a table whose columns are `time` and the variables `names` of an opened `Fmu`, which says what they are."""
    table = np.asarray(table, float)
    known = {name: fmu.variable(name) for name in names}
    series = {name: Series(table[:, k], v.unit or "", v.description or "") for k, (name, v) in enumerate(known.items(), 1)}
    about = {"fmu_version": fmu.description.version or ""} | (about or {})
    return Run(title, table[:, 0], series, seen_rows(patch) if patch else None, about=about)


def of_dataset(dataset):
    """The run of an xarray Dataset as `wheelrail.records` makes them, in any units and with any times. `BadFile` if it is of several
    runs, or has nothing over time."""
    dataset = _of_one_run(dataset)
    time = np.asarray(dataset["time"].values, float)
    series, patch, fields, lines, across = {}, {}, {}, {}, {}
    for name, variable in dataset.data_vars.items():
        unit, meaning = variable.attrs.get("units", ""), variable.attrs.get("comment", variable.attrs.get("long_name", ""))
        values = _numbers(variable)
        if values is None:
            continue
        if variable.dims == ("time",):
            series[name] = Series(values, unit, meaning)
        elif variable.dims == ("time", "depth") and unit in ("K", ""):
            seen = np.isfinite(values).any(axis=1)
            fields[name.removeprefix("profile.")] = Field(time[seen], np.asarray(dataset["depth"].values, float), values[seen], meaning)
        elif variable.dims == ("time", "line", "node"):
            across[name.removeprefix("patch.")] = values
        elif variable.dims == ("time", "line"):
            lines[name.removeprefix("line.")] = values
        elif variable.dims == ("time", "node"):
            patch[name.removeprefix("profile.")] = values
    if not series and not fields and not patch and not lines:
        raise BadFile("the record has no numbers over time alone, which a page could show as curves")
    about = {name: _loaded(value) for name, value in dataset.attrs.items()}
    title = str(about.pop("title", "") or "Run")
    seen = seen_lines(time, lines)
    between = Profiles(time, across | {"x": np.asarray(dataset["x"].values, float)}) if across and seen else None
    return Run(title, time, series, seen_rows(Profiles(time, patch)), fields, about, seen, between, _damage(dataset))


def _of_one_run(dataset):
    """A record in SI units, without instants of which it has nothing, as those of other runs with which it was joined."""
    if "time" not in dataset.coords or dataset["time"].ndim != 1:
        raise BadFile("the record has no coordinate time with an instant for each of its samples")
    try:
        dataset = in_si(dataset)
    except UnitError as error:
        raise BadFile(str(error)) from None
    apart = {name: v.dims for name, v in dataset.data_vars.items() if "time" in v.dims and not set(v.dims) <= set(PLACES)}
    more = sorted({place for dims in apart.values() for place in dims} - set(PLACES))
    drawn = [name for name, v in dataset.data_vars.items() if v.dims == ("time",) and v.dtype.kind in "fiub"]
    if more and not drawn:
        size = dataset.sizes[more[0]]
        raise BadFile(
            f"the record is over {more[0]} ({size}) besides time, and a page shows one run: write a page of each, such as of "
            f"record.isel({more[0]}=0)"
        )
    if more:
        warn(f"not on the page, being over {' and '.join(more)} besides time: {', '.join(apart)}")
    for name in dataset.data_vars:
        unit, expected = dataset[name].attrs.get("units", ""), known_unit(name)
        try:
            if unit and expected and unit_of(unit).bases != unit_of(expected).bases:
                raise UnitError(f"expected {expected}")
        except UnitError as error:
            raise BadFile(f"{name} is in {unit!r}: {error}") from None
    seen = [np.isfinite(dataset[name].values) for name in drawn if dataset[name].dtype.kind == "f"]
    return dataset.isel(time=np.any(seen, axis=0)) if seen else dataset


def _damage(dataset):
    """What a slide left, where the record has it and something was heated."""
    try:
        found = damage.report(dataset)
    except damage.NoDamage:
        return None
    return found if found.flats else None


def _numbers(variable):
    """Values as floats, of flags too; None of texts, which choices are."""
    values = np.asarray(variable.values)
    return values.astype(float) if values.dtype.kind in "fiub" else None


def _loaded(value):
    """An attribute, decoded if it is JSON."""
    if isinstance(value, str) and value[:1] in "[{":
        try:
            return json.loads(value)
        except ValueError:
            return value
    return value.item() if isinstance(value, np.generic) else value


def seen_rows(profiles):
    """Profiles without the rows in which nothing was recorded; None if nothing is left."""
    if "x" not in profiles.values or not len(profiles.time):
        return None
    x = np.asarray(profiles.values["x"], float)
    rows = np.isfinite(x).any(axis=1) if x.ndim == 2 else np.ones(len(profiles.time), bool)
    whole = lambda v: np.broadcast_to(v, (len(profiles.time), len(v))) if np.ndim(v) == 1 else np.asarray(v, float)
    values = {name: whole(v)[rows] for name, v in profiles.values.items()}
    return Profiles(np.asarray(profiles.time, float)[rows], values) if rows.any() else None


def seen_lines(time, values):
    """What several lines of a patch have, without lines that are not there; None if that is no patch with a width."""
    if not {"position", "half_length", "pressure_max"} <= set(values):
        return None
    there = np.isfinite(values["position"]).all(axis=1)
    # Those beyond contact.lines are 0 all the time.
    used = np.any(values["half_length"][there] > 0.0, axis=0) if there.any() else np.zeros(0, bool)
    if used.sum() < 2:
        return None
    return Profiles(time[there], {name: v[there][:, used] for name, v in values.items()})
