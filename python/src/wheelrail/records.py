"""Records of a wheel: its outputs over time as an xarray Dataset, with units, meanings and what the run was made from."""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Callable, Iterable
from fnmatch import fnmatchcase
from io import BytesIO
from math import isclose
from operator import itemgetter
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from fmpy.model_description import ScalarVariable

from . import output
from .instances import BUFFERS
from .origin import settings
from .tables import BadFile
from .units import ZERO_CELSIUS
from .values import Refused, first_line, kind, short

if TYPE_CHECKING:
    import pandas
    import xarray


Record, Made = TypeVar("Record"), TypeVar("Made")  # a Dataset or a DataArray; anything

# Profiles over the depth below the surface; all others lie across the contact patch.
BELOW = (
    "depth", "peak_temperature", "martensite", "temperature_wheel_below", "temperature_rail_below", "temperature_tread_below",
    "temperature_hottest_below",
)  # fmt: skip
# Profiles of every line of a patch, the last two with lateral creepage only, and what says where they are.
OF_PATCH = ("pressure", "shear", "slip", "temperature_wheel", "temperature_rail", "shear_z", "slip_z")
SHOWN = "contact.shown_line"
PLACED = ("profile.x", "line.position", "line.half_length")
SAME_TIME = 1e-12  # relative difference of times that is rounding


class Recorder:
    """Samples of a wheel, a `fmu.Wheel`, that its user steps: one when it is made, and one after every `every`-th step.

    `outputs` are names and patterns (`contact.*`) of variables, by themselves all outputs that are no profiles; `profiles`
    are those across the contact patch, all with `True`, or some by name (`["pressure", "slip"]`), and `depth` the
    temperatures and martensite below the surface in the same way. `patch` records the profiles of every line of the patch
    besides, as `patch.pressure` and so on over `time`, `line` and `node`, which `wheelrail.patch` lays on a grid. What each line
    of the patch has (`line.pressure_max`) is among the outputs where the patch has a width of its own; a patch of constant width
    has one line, recorded if it is named. Inputs are always recorded. `Wheel.record` makes recorders, and `Wheel.restore` takes
    back what came after the state that it returns to.
    """

    def __init__(
        self,
        wheel: Any,
        outputs: str | Iterable[str] | None = None,
        profiles: bool | str | Iterable[str] = False,
        depth: bool | str | Iterable[str] = False,
        every: int = 1,
        title: str = "",
        patch: bool = False,
    ) -> None:
        if isinstance(every, bool) or not isinstance(every, int) or every < 1:
            raise ValueError(f"every = {short(every)} is no number of steps, 1 or more")
        library("xarray")
        self.wheel, self.every, self.title = wheel, every, title
        fmu = wheel.fmu
        self.scalars, self.arrays = _chosen(wheel, outputs, profiles, depth, patch)
        self._patch = _patch_reader(wheel) if patch else None
        inputs = [v for v in fmu.variables.values() if v.causality == "input" and v not in self.scalars]
        variables = self.scalars + inputs + [point for points in self.arrays.values() for point in points]
        self._inputs = inputs
        self._readers = [_reader(wheel, sort, variables) for sort in BUFFERS]
        self._readers = [reader for reader in self._readers if reader]
        self._depths = wheel.profile("depth") if any(_place(name) == "depth" for name in self.arrays) else None
        self._settings = settings(wheel)
        self._warnings, self._heard = [], 0
        self._samples, self._steps = [], []  # (time, values); times
        self.sample()

    def stepped(self) -> None:
        """Takes note of a step, and a sample if it is its turn; of one that is known, nothing."""
        time = self.wheel.time
        if self._steps and self._steps[-1] == time:
            return
        if (len(self._steps) + 1) % self.every == 0:
            self.sample()
        self._steps.append(time)

    def sample(self) -> None:
        """Takes a sample now, in the place of one of the same time."""
        with self.wheel._calls, self.wheel._calls.lock:
            time, values = self.wheel.time, [reader() for reader in self._readers]
            if self._patch:
                values.append(self._patch())
            same = self._samples and isclose(self._samples[-1][0], time, rel_tol=SAME_TIME)
            self._samples[len(self._samples) - bool(same) :] = [(time, values)]
            self.listen()

    def rewind(self, time: float) -> None:
        """Drops steps, samples and warnings from after a time [s]."""
        for entries, at in ((self._warnings, itemgetter(0)), (self._steps, float), (self._samples, itemgetter(0))):
            while entries and at(entries[-1]) > time:
                entries.pop()

    def listen(self) -> None:
        """Takes note of new warnings and refusals, with the time that they name, or else that of the sample."""
        for message in self.wheel.log[self._heard :]:
            if message.status:
                named = re.match(r"t = (\S+) s: ", message)
                warning = {"time": float(named[1]) if named else self.wheel.time, "text": str(message)}
                self._warnings.append((self.wheel.time, warning))
        self._heard = len(self.wheel.log)

    def dataset(self) -> xarray.Dataset:
        """The Dataset: data variables by their FMU names, over `time` [s] and, of profiles, `node` or `depth` [m],
        and of what each line of the patch has, `line`.

        Inputs that never changed stand in the attribute `inputs`. Attributes besides: `fmu_version`, `preset`, `title`,
        `parameters` that differ from the preset, `warnings`; the last three of lists and values as JSON.
        """
        xarray = library("xarray")
        with self.wheel._calls, self.wheel._calls.lock:
            self.wheel._tell()
            self.listen()
            times, samples = zip(*self._samples)
        time = ("time", np.array(times), {"units": "s", "long_name": "Time"})
        data, coordinates, held = {}, {"time": time}, {}
        columns = [np.array([sample[k] for sample in samples]) for k in range(len(self._readers))]
        places = ((k, i, reference) for k, reader in enumerate(self._readers) for i, reference in enumerate(reader.references))
        column = {reference: (columns[k], i) for k, i, reference in places}

        def series(variable):
            block, i = column[variable.valueReference]
            return _values(variable, block[:, i])

        for variable in self.scalars + self._inputs:
            values = series(variable)
            if variable in self._inputs and (values == values[0]).all():
                held[variable.name] = values[0].item()
            else:
                data[variable.name] = ("time", values, attributes(variable))
        for name, points in self.arrays.items():
            block, first = column[points[0].valueReference]
            values = block[:, first : first + len(points)]
            data[name] = (("time", _place(name)), values, attributes(points[0]))
        if self._patch:
            rows = np.array([sample[-1] for sample in samples])
            for k, quantity in enumerate(self._patch.quantities):
                about = attributes(self.wheel.fmu.variable(self.wheel.fmu.points(quantity)[0]))
                data[f"patch.{quantity}"] = (("time", "line", "node"), rows[:, :, k], about)
        # The zone in which there may be contact does not move. Positions grow with the load; line.position has them at every time.
        for coordinate, name in (("x", "profile.x"), ("z", "line.position")):
            if name in data:
                coordinates[coordinate] = (data[name][0][1], data[name][1][0], data[name][2])
        if self._depths is not None:
            coordinates["depth"] = ("depth", self._depths, attributes(self.wheel.fmu.variable(self.wheel.fmu.points("depth")[0])))
        origin = self._settings | {"inputs": held, "warnings": [warning for _, warning in self._warnings]}
        texts = {name: value if isinstance(value, str) else json.dumps(value) for name, value in origin.items()}
        return xarray.Dataset(data, coordinates, texts | {"title": self.title or f"wheel on rail, {self._settings['preset']}"})


def _patch_reader(wheel):
    """A function that reads the profiles of all lines of a patch: an array (line, quantity, node)."""
    lateral = bool(wheel.get("contact.lateral")) if "contact.lateral" in wheel.fmu.variables else False
    number = [wheel.fmu.variable(SHOWN).valueReference]
    quantities = OF_PATCH if lateral else OF_PATCH[:-2]
    points = [wheel.fmu.variable(point) for quantity in quantities for point in wheel.fmu.points(quantity)]
    reader, lines = _reader(wheel, "Real", points), wheel.lines()
    show = lambda line: wheel._calls(wheel.slave.setInteger, number, [line])

    def read():
        shown, found = wheel.get(SHOWN), []
        try:
            for line in range(lines):
                show(line + 1)
                found.append(np.reshape(reader(), (len(quantities), -1)))
        finally:
            show(shown)
        return np.array(found)

    read.quantities = quantities
    return read


def _place(name):
    """The dimension besides the time of what is recorded at several points."""
    if name.startswith("line."):
        return "line"
    return "depth" if name.removeprefix("profile.") in BELOW else "node"


def attributes(variable: ScalarVariable) -> dict[str, str]:
    """Unit and meaning of a variable: in short as `long_name`, and if there is more to say, all of it as `comment`."""
    text = variable.description or variable.name
    text = text.rsplit(", point ", 1)[0] if "[" in variable.name else text
    short_name = re.split("[;:] ", text)[0]
    more = {"comment": text} if short_name != text else {}
    return ({"units": variable.unit} if variable.unit else {}) | {"long_name": short_name} | more


def table(run: xarray.Dataset) -> pandas.DataFrame:
    """A DataFrame of what a record has over time alone: outputs, not profiles. Attributes are kept in its `attrs`."""
    library("pandas")
    flat = _checked(run, "table").drop_dims([name for name in run.sizes if name != "time"])
    frame = flat.to_dataframe()
    frame.attrs = {"run": dict(run.attrs), "variables": {name: dict(run[name].attrs) for name in (*flat.data_vars, "time")}}
    return frame


def celsius(record: Record) -> Record:
    """A Dataset or DataArray with temperatures in °C in the place of K."""

    def shown(values):
        return (values - ZERO_CELSIUS).assign_attrs(values.attrs, units="°C") if values.attrs.get("units") == "K" else values

    if hasattr(record, "data_vars"):
        return record.assign({name: shown(values) for name, values in record.data_vars.items()})
    return shown(record)


def save(run: xarray.Dataset, path: str | Path) -> Path:
    """Writes a record: all of it as NetCDF (`.nc`), or what `table` gives of it as Parquet (`.parquet`)."""
    path, _ = _kind_of_file(path), _checked(run, "save")
    place = path.absolute()  # the process may go elsewhere meanwhile
    library("h5netcdf" if path.suffix == ".nc" else "pyarrow")
    made = BytesIO()
    # In memory: a file that HDF5 cannot finish takes Python down with it.
    if path.suffix == ".nc":
        run.to_netcdf(made, engine="h5netcdf")
    else:
        table(run).to_parquet(made, engine="pyarrow")
    output.write(place, made.getbuffer())
    return path


def load(path: str | Path) -> xarray.Dataset:
    """Reads what `save` has written: a Dataset with all attributes."""
    path = _kind_of_file(path)
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist")
    xarray = library("xarray")
    try:
        if path.suffix == ".nc":
            return of_netcdf(path)
        library("pyarrow")
        frame = library("pandas").read_parquet(path, engine="pyarrow")
    except (OSError, ValueError) as failure:
        raise ValueError(f"{path} is no {path.suffix[1:]} file that can be read: {first_line(failure)}") from failure
    if "variables" not in frame.attrs or frame.index.name != "time":
        raise ValueError(f"{path} holds a table, but none that wheelrail.save has written")
    run = xarray.Dataset.from_dataframe(frame).assign_attrs(frame.attrs["run"])
    for name, text in frame.attrs["variables"].items():
        run[name].attrs = text
    return run


def of_netcdf(path: str | Path) -> xarray.Dataset:
    """The Dataset of a file whose spans of time are such; numbers of seconds stay numbers."""
    library("h5netcdf")
    return library("xarray").load_dataset(path, engine="h5netcdf")


def made_of(path: str | Path, function: Callable[[xarray.Dataset], Made]) -> Made:
    """What a function makes of the record in a file; what is wrong with one of them is refused with the path."""
    try:
        return function(load(path))
    except (ImportError, ValueError) as error:
        raise BadFile(str(error) if str(path) in str(error) else f"{path}: {error}") from None


def _kind_of_file(path):
    """The path of a file of records, whose ending says its kind."""
    if not hasattr(path, "__fspath__") and not isinstance(path, str):
        raise ValueError(f"{short(path)} is not the path of a file")
    if Path(path).suffix not in (".nc", ".parquet"):
        raise ValueError(f"{path}: records are .nc (NetCDF) or .parquet files")
    return Path(path)


def _checked(run, call):
    """A record, as `simulate` and `Recorder.dataset` give it."""
    if not isinstance(run, library("xarray").Dataset) or "time" not in run.sizes:
        expected = "expected the Dataset of a run, of simulate() or of a recorder's dataset()"
        raise ValueError(f"{call}({type(run).__name__}): {expected}")
    return run


def library(name: str) -> ModuleType:
    """A library of the extras, or in one line what is missing."""
    try:
        return importlib.import_module(name)
    except ImportError as failure:
        extra = "parquet" if name == "pyarrow" else "records"
        raise ImportError(f"records need {name}, which is not installed: pip install wheelrail[{extra}]") from failure


def _chosen(wheel, outputs, profiles, depth, patch=False):
    """Scalar variables, and the points of profiles and lines by name, of which a record is asked for."""
    fmu, several = wheel.fmu, wheel.lines() > 1
    arrays = [f"profile.{quantity}" for quantity in fmu.profiles()] + fmu.of_lines()
    scalars = [v for v in fmu.variables.values() if "[" not in v.name]
    if isinstance(outputs, str):
        outputs = [outputs]
    names = {v.name: v for v in scalars if v.causality == "output"} if outputs is None else {}
    wanted = {f"profile.{q}" for q in _quantities(fmu, profiles, "profiles", lambda name: name not in BELOW)}
    wanted |= {f"profile.{q}" for q in _quantities(fmu, depth, "depth", lambda name: name in BELOW)}
    if outputs is None and several:
        wanted |= set(fmu.of_lines())
    if patch:
        wanted |= set(PLACED)
        names.setdefault("contact.width", fmu.variable("contact.width"))
    for pattern in outputs or ():
        if not isinstance(pattern, str):
            raise ValueError(f"{short(pattern)} is not the name of a variable or a pattern such as 'contact.*'")
        if not any(letter in pattern for letter in "*?["):
            if pattern in arrays:
                wanted.add(pattern)
            else:
                names[pattern] = fmu.variable(pattern)
            continue
        found = {v.name: v for v in scalars if v.causality == "output" and fnmatchcase(v.name, pattern)}
        # The only line of a patch of constant width says again what contact.* does.
        seen = several or pattern.startswith("line.")
        among = [name for name in arrays if fnmatchcase(name, pattern) and (seen or not name.startswith("line."))]
        if not found and not among:
            known = [v.name for v in scalars if v.causality == "output"] + fmu.of_lines()
            groups = sorted({name.split(".")[0] for name in known})
            raise Refused(f"no output matches {pattern!r}; outputs are {', '.join(f'{group}.*' for group in groups)}")
        names |= found
        wanted.update(among)
    for variable in names.values():
        if kind(variable) == "String":
            raise Refused(f"{variable.name} is a text, which does not change over time and is not recorded")
    return list(names.values()), _points(wheel, arrays, wanted)


def _points(wheel, arrays, wanted):
    """The points of what was asked for, with those that say where they are."""
    places, lines, fmu = {_place(name) for name in wanted}, wheel.lines(), wheel.fmu
    own = {"node": "profile.x", "line": "line.position"}
    wanted = (wanted | {own[place] for place in places if place in own}) - {"profile.depth"}
    variables = lambda name: [fmu.variable(point) for point in fmu.points(name.removeprefix("profile."))]
    return {name: variables(name)[: lines if _place(name) == "line" else None] for name in arrays if name in wanted}


def _quantities(fmu, asked, what, belongs):
    """Quantities of profiles that are asked for: all that belong there, some by name, or none."""
    known = [name for name in fmu.profiles() if belongs(name)]
    if isinstance(asked, bool):
        if asked and not known:
            raise Refused(f"{what} = True: the FMU has none, being built without")
        return set(known if asked else ())
    asked = [asked] if isinstance(asked, str) else asked
    if not hasattr(asked, "__iter__"):
        raise ValueError(f"{what} = {short(asked)} is neither True nor False nor a list of {', '.join(known)}")
    wanted = {str(name).removeprefix("profile.") for name in asked}
    if wrong := sorted(wanted - set(known)):
        raise Refused(f"{what} has no {wrong[0]!r}; it has {', '.join(known)}")
    return wanted


def _reader(wheel, sort, variables):
    """A function that reads all variables of a type at once, or None without any."""
    references = [v.valueReference for v in variables if kind(v) == sort]
    if not references:
        return None
    reader = wheel.slave.reader(sort, references)

    def read():
        return wheel._calls(reader)

    read.references = references
    return read


def _values(variable, values):
    """A column as its type has it: choices by name."""
    if variable.type == "Boolean":
        return values.astype(bool)
    if variable.type == "Enumeration":
        return np.array([item.name for item in variable.declaredType.items])[values - 1]
    return values
