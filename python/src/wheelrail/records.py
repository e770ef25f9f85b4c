"""Records of a wheel: its outputs over time as an xarray Dataset, with units, meanings and what the run was made from."""

import importlib
import json
import re
from fnmatch import fnmatchcase
from io import BytesIO
from math import isclose
from pathlib import Path

import numpy as np

from . import output
from .instances import BUFFERS
from .values import Refused, kind, short

# Profiles over the depth below the surface; all others lie across the contact patch.
BELOW = ("depth", "peak_temperature", "temperature_wheel_below", "temperature_rail_below", "temperature_tread_below")
SAME_TIME = 1e-12  # relative difference of times that is rounding


class Recorder:
    """Samples of a wheel that its user steps: one when it is made, and one after every `every`-th step.

    `outputs` are names and patterns (`contact.*`) of variables, by themselves all outputs that are no profiles; `profiles`
    are those across the contact patch, all with `True`, or some by name (`["pressure", "slip"]`), and `depth` the
    temperatures below the surface in the same way. What each line of the patch has (`line.pressure_max`) is among the
    outputs where the patch has a width of its own; a patch of constant width has one line, recorded if it is named.
    Inputs are always recorded. `Wheel.record` makes recorders, and
    `Wheel.restore` takes back what came after the state that it returns to.
    """

    def __init__(self, wheel, outputs=None, profiles=False, depth=False, every=1, title=""):
        if isinstance(every, bool) or not isinstance(every, int) or every < 1:
            raise ValueError(f"every = {short(every)} is no number of steps, 1 or more")
        _library("xarray")
        self.wheel, self.every, self.title = wheel, every, title
        fmu = wheel.fmu
        self.scalars, self.arrays = _chosen(wheel, outputs, profiles, depth)
        inputs = [v for v in fmu.variables.values() if v.causality == "input" and v not in self.scalars]
        variables = self.scalars + inputs + [point for points in self.arrays.values() for point in points]
        self._inputs = inputs
        self._readers = [_reader(wheel, sort, variables) for sort in BUFFERS]
        self._readers = [reader for reader in self._readers if reader]
        self._depths = wheel.profile("depth") if self._over_depth() else None
        self._settings = _settings(wheel)
        self._warnings, self._heard = [], 0
        self._times, self._samples, self._steps = [], [], []
        self.sample()

    def _over_depth(self):
        return any(name.removeprefix("profile.") in BELOW for name in self.arrays)

    def stepped(self):
        """Takes note of a step, and a sample if it is its turn."""
        self._steps.append(self.wheel.time)
        if len(self._steps) % self.every == 0:
            self.sample()

    def sample(self):
        """Takes a sample now, in the place of one of the same time."""
        values = [reader() for reader in self._readers]
        if self._times and isclose(self._times[-1], self.wheel.time, rel_tol=SAME_TIME):
            self._times[-1], self._samples[-1] = self.wheel.time, values
        else:
            self._times.append(self.wheel.time)
            self._samples.append(values)
        self.listen()

    def rewind(self):
        """Drops steps, samples and warnings from after the present time of the wheel."""
        self._warnings = [(heard, warning) for heard, warning in self._warnings if heard <= self.wheel.time]
        while self._steps and self._steps[-1] > self.wheel.time:
            self._steps.pop()
        while self._times and self._times[-1] > self.wheel.time:
            self._times.pop()
            self._samples.pop()

    def listen(self):
        """Takes note of new warnings and refusals, with the time that they name, or else that of the sample."""
        for message in self.wheel.log[self._heard :]:
            if message.status:
                named = re.match(r"t = (\S+) s: ", message)
                warning = {"time": float(named[1]) if named else self.wheel.time, "text": str(message)}
                self._warnings.append((self.wheel.time, warning))
        self._heard = len(self.wheel.log)

    def dataset(self):
        """The Dataset: data variables by their FMU names, over `time` [s] and, of profiles, `node` or `depth` [m],
        and of what each line of the patch has, `line`.

        Inputs that never changed stand in the attribute `inputs`. Attributes besides: `fmu_version`, `preset`, `title`,
        `parameters` that differ from the preset, `warnings`; the last three of lists and values as JSON.
        """
        xarray = _library("xarray")
        self.listen()
        time = ("time", np.array(self._times), {"units": "s", "long_name": "Time"})
        data, coordinates, held = {}, {"time": time}, {}
        columns = [np.array([sample[k] for sample in self._samples]) for k in range(len(self._readers))]
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
        if "profile.x" in data:
            # The zone in which there may be contact does not move, and neither do the points.
            coordinates["x"] = ("node", data["profile.x"][1][0], data["profile.x"][2])
        if "line.position" in data:
            # Positions grow with the load; line.position has them at every time.
            coordinates["z"] = ("line", data["line.position"][1][0], data["line.position"][2])
        if self._depths is not None:
            coordinates["depth"] = ("depth", self._depths, attributes(self.wheel.fmu.variable(self.wheel.fmu.points("depth")[0])))
        settings = self._settings | {"inputs": held, "warnings": [warning for _, warning in self._warnings]}
        texts = {name: value if isinstance(value, str) else json.dumps(value) for name, value in settings.items()}
        return xarray.Dataset(data, coordinates, texts | {"title": self.title or f"wheel on rail, {self._settings['preset']}"})


def _place(name):
    """The dimension besides the time of what is recorded at several points."""
    if name.startswith("line."):
        return "line"
    return "depth" if name.removeprefix("profile.") in BELOW else "node"


def attributes(variable):
    """Unit and meaning of a variable: in short as `long_name`, and if there is more to say, all of it as `comment`."""
    text = variable.description or variable.name
    text = text.rsplit(", point ", 1)[0] if "[" in variable.name else text
    short_name = re.split("[;:] ", text)[0]
    more = {"comment": text} if short_name != text else {}
    return ({"units": variable.unit} if variable.unit else {}) | {"long_name": short_name} | more


def table(run):
    """A DataFrame of what a record has over time alone: outputs, not profiles. Attributes are kept in its `attrs`."""
    _library("pandas")
    flat = _checked(run, "table").drop_dims([name for name in run.sizes if name != "time"])
    frame = flat.to_dataframe()
    frame.attrs = {"run": dict(run.attrs), "variables": {name: dict(run[name].attrs) for name in (*flat.data_vars, "time")}}
    return frame


def celsius(record):
    """A Dataset or DataArray with temperatures in °C in the place of K."""

    def shown(values):
        return (values - 273.15).assign_attrs(values.attrs, units="°C") if values.attrs.get("units") == "K" else values

    if hasattr(record, "data_vars"):
        return record.assign({name: shown(values) for name, values in record.data_vars.items()})
    return shown(record)


def save(run, path):
    """Writes a record: all of it as NetCDF (`.nc`), or what `table` gives of it as Parquet (`.parquet`)."""
    path, _ = _kind_of_file(path), _checked(run, "save")
    _library("h5netcdf" if path.suffix == ".nc" else "pyarrow")
    made = BytesIO()
    # In memory: a file that HDF5 cannot finish takes Python down with it.
    if path.suffix == ".nc":
        run.to_netcdf(made, engine="h5netcdf")
    else:
        table(run).to_parquet(made, engine="pyarrow")
    output.write(path, made.getbuffer())
    return path


def load(path):
    """Reads what `save` has written: a Dataset with all attributes."""
    path = _kind_of_file(path)
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist")
    xarray = _library("xarray")
    try:
        if path.suffix == ".nc":
            _library("h5netcdf")
            return xarray.load_dataset(path, engine="h5netcdf", decode_timedelta=False)
        _library("pyarrow")
        frame = _library("pandas").read_parquet(path, engine="pyarrow")
    except (OSError, ValueError) as failure:
        raise ValueError(f"{path} is no {path.suffix[1:]} file that can be read: {_first_line(failure)}") from failure
    if "variables" not in frame.attrs or frame.index.name != "time":
        raise ValueError(f"{path} holds a table, but none that wheelrail.save has written")
    run = xarray.Dataset.from_dataframe(frame).assign_attrs(frame.attrs["run"])
    for name, text in frame.attrs["variables"].items():
        run[name].attrs = text
    return run


def _kind_of_file(path):
    """The path of a file of records, whose ending says its kind."""
    if not hasattr(path, "__fspath__") and not isinstance(path, str):
        raise ValueError(f"{short(path)} is not the path of a file")
    if Path(path).suffix not in (".nc", ".parquet"):
        raise ValueError(f"{path}: records are .nc (NetCDF) or .parquet files")
    return Path(path)


def _checked(run, call):
    """A record, as `simulate` and `Recorder.dataset` give it."""
    if not isinstance(run, _library("xarray").Dataset) or "time" not in run.sizes:
        expected = "expected the Dataset of a run, of simulate() or of a recorder's dataset()"
        raise ValueError(f"{call}({type(run).__name__}): {expected}")
    return run


def _first_line(failure):
    """The first line of what went wrong."""
    return (str(failure).splitlines() or [type(failure).__name__])[0]


def _library(name):
    """A library of the extras, or in one line what is missing."""
    try:
        return importlib.import_module(name)
    except ImportError as failure:
        extra = "parquet" if name == "pyarrow" else "records"
        raise ImportError(f"records need {name}, which is not installed: pip install wheelrail[{extra}]") from failure


def _chosen(wheel, outputs, profiles, depth):
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
    slave, reader = wheel.slave, wheel.slave.reader(sort, references)

    def read():
        # That of a wheel which has been closed says so.
        return wheel._call(reader if wheel.slave is slave else wheel.slave.reader)

    read.references = references
    return read


def _values(variable, values):
    """A column as its type has it: choices by name."""
    if variable.type == "Boolean":
        return values.astype(bool)
    if variable.type == "Enumeration":
        return np.array([item.name for item in variable.declaredType.items])[values - 1]
    return values


def _settings(wheel):
    """Version, preset and the parameters that differ from it, choices by name."""
    fmu = wheel.fmu
    parameters = [v for v in fmu.variables.values() if v.causality == "parameter"]
    values = {v.name: wheel.get(v.name) for v in parameters}
    preset = values.pop("preset", "")
    base = {v.name: _start(v) for v in parameters} | _preset(fmu, preset)
    # The package itself writes the first of these, so that everything counts that is written.
    base["initial.given"] = "written"
    named = {v.name: _choice(v, values[v.name]) for v in parameters if v.name in values}
    differ = {name: value for name, value in named.items() if value != base.get(name)}
    return {"fmu_version": fmu.description.version or "", "preset": preset, "parameters": differ}


def _choice(variable, value):
    """The name of a choice; any other value itself."""
    return variable.declaredType.items[int(value) - 1].name if variable.type == "Enumeration" else value


def _start(variable):
    """The start value of a parameter, which the description has as text."""
    text = variable.start
    if text is None or variable.type == "String":
        return text
    if variable.type == "Boolean":
        return text == "true"
    return float(text) if variable.type == "Real" else _choice(variable, text) if variable.type == "Enumeration" else int(text)


def _preset(fmu, preset):
    """What a preset sets besides the start values."""
    path = Path(fmu.directory, "resources", f"{preset}.json")
    groups = json.loads(path.read_text()) if path.is_file() else {}
    return {f"{group}.{name}": value for group, values in groups.items() for name, value in values.items()}
