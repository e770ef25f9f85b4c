"""An opened FMU of FMI 2.0 or 3.0, and wheels of it, on fmpy: variables by name, enumerations by item name, SI units."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import count
from math import isclose
from numbers import Real
from pathlib import Path
from typing import Any
from weakref import finalize
from xml.etree import ElementTree

import fmpy
from fmpy.model_description import ScalarVariable

from .calls import Calls, opening
from .folder import TemporaryFolder
from .instances import loaded, scalars
from .records import Recorder
from .tables import nearest
from .times import after
from .units import named
from .values import Refused, Unique, check_names, first_line, kind, plain, saved_state, short, to_fmu

ROUNDING = 1e-14  # relative difference of times that is rounding of one sum
_numbers = count(1)


def default_path() -> Path:
    """The FMU named by the environment variable WHEELRAIL_FMU, else the one inside this package, else that of a checkout."""
    inside, built = Path(__file__).with_name("wheelrail.fmu"), Path("target/wheelrail.fmu")
    return Path(os.environ.get("WHEELRAIL_FMU") or (inside if inside.is_file() else built))


def fmu_file(path: str | os.PathLike, instead: str = "") -> Path:
    """The path of an FMU, if a file is there; else it is refused with what may be named instead."""
    path = Path(path)
    if path.is_dir():
        raise FileNotFoundError(f"{path} is a folder and no FMU: name the file, such as {path / 'wheelrail.fmu'}{instead}")
    if not path.is_file():
        raise FileNotFoundError(f"{path} does not exist: build it with `make fmu`, or name one by the variable WHEELRAIL_FMU{instead}")
    return path


def _unpacked(path):
    """A temporary folder with the content of an FMU."""
    folder = None
    try:
        folder = TemporaryFolder("wheelrail-")
        fmpy.extract(str(path), unzipdir=str(folder.path))
        return folder
    except Exception as failure:  # whatever zip and fmpy say of what is no archive
        if folder:
            folder.remove()
        if isinstance(failure, OSError):
            where = folder.path.parent if folder else "a temporary folder"
            room = "make room there, or name another folder by the variable TMPDIR"
            raise Refused(f"{path} cannot be unpacked into {where}: {failure.strerror or failure}; {room}") from failure
        raise _no_fmu(path, failure) from failure


def _no_fmu(path, failure):
    """The refusal of a file that is no FMU."""
    return Refused(f"{path} is no FMU: {first_line(failure)}")


@lru_cache(4)
def _described(path, _changed):
    """Variables by name of the FMU at a path, of which only the description is read."""
    try:
        with opening:
            return scalars(fmpy.read_model_description(path, validate=False))[0]
    except Exception as failure:  # whatever zip, XML and fmpy say
        raise _no_fmu(path, failure) from failure


def known_unit(name: str, shown: bool = False) -> str:
    """Unit of a variable by the description of the default FMU, or the one in which people read it; of a profile that of its points.
    Empty where nothing says it, or where there is no such file."""
    path = default_path()
    variables = _described(path, path.stat().st_mtime_ns) if path.is_file() else {}
    variable = variables.get(name) or variables.get(f"{name}[1]")
    return (variable.displayUnit if shown else variable.unit) or "" if variable else ""


class Fmu(Unique):
    """An FMU extracted once, for any number of instances: that at `path`, or at `default_path()`. A context manager."""

    INSTEAD = "open the FMU once more by its path, also in another process"

    def __init__(self, path: str | os.PathLike | None = None) -> None:
        path = default_path() if path is None else path
        if not isinstance(path, (str, os.PathLike)):
            raise ValueError(f"Fmu({path!r}): expected the path of an FMU, or nothing")
        path = fmu_file(path)
        with opening:
            self._folder = _unpacked(path)
            self._read(path)

    def _read(self, path):
        """Reads the description of what was unpacked."""
        try:
            self.directory = str(self._folder.path)
            # Without a check against the schema of FMI, of which lxml makes one at a time: the tests of the packed FMU have it.
            self.description = fmpy.read_model_description(self.directory, validate=False)
        except Exception as failure:  # whatever XML and fmpy say of what is no description
            self._folder.remove()
            raise _no_fmu(path, failure) from failure
        if self.description.coSimulation is None or self.description.fmiVersion[0] not in "23":
            self._folder.remove()
            raise Refused(f"{path} is no FMU of FMI 2.0 or 3.0 for co-simulation")
        self.variables, self.places = scalars(self.description)
        notes = ElementTree.parse(Path(self.directory, "modelDescription.xml")).iter("Retired")
        self.retired = {note.get("name"): note.get("refusal") for note in notes}

    def variable(self, name: str) -> ScalarVariable:
        """The variable of a name."""
        if not isinstance(name, str):
            raise ValueError(f"{name!r} is not the name of a variable, such as 'contact.force_x'")
        if name in self.retired:
            raise Refused(self.retired[name])
        if name not in self.variables:
            raise Refused(f"the FMU has no variable {name or repr(name)}{nearest(name, self.variables)}")
        return self.variables[name]

    def settings(self, values: Mapping[str, object], change: str | None = None) -> list[tuple[ScalarVariable, float | int | str]]:
        """Variables and their values as the FMU wants them, of values by names, which may have units behind them
        (`drive.velocity [km/h]`); `change` says that they are differences, or with "/s" rates."""
        found = {}
        for text, value in values.items():
            name, unit = named(text, self.variables)
            variable = self.variable(name)
            if name in found:
                raise Refused(f"{name} is given twice: leave one of them out")
            found[name] = variable, to_fmu(variable, value, unit, change)
        return list(found.values())

    def profiles(self) -> list[str]:
        """Names of the quantities of `Wheel.profile`."""
        points = (name.removeprefix("profile.") for name in self.variables if name.startswith("profile."))
        return list(dict.fromkeys(point.split("[")[0] for point in points))

    def of_lines(self) -> list[str]:
        """Names of the quantities that each line of the patch has, such as `line.pressure_max`."""
        return list(dict.fromkeys(name.split("[")[0] for name in self.variables if name.startswith("line.")))

    def points(self, quantity: str) -> list[str]:
        """Names of the variables that are the points of a profile, or of a quantity of lines (`line.pressure_max`)."""
        stem = quantity if quantity in self.of_lines() else f"profile.{quantity}"
        names = [name for name in self.variables if name.startswith(f"{stem}[")]
        if names:
            return names
        if str(quantity).startswith("line.") and self.of_lines():
            raise Refused(f"lines have no {quantity!r}; they have {', '.join(self.of_lines())}")
        known = self.profiles()
        raise Refused(f"the FMU has no profile {quantity!r}; it has {', '.join(known) or 'none, being built without'}")

    def close(self) -> None:
        """Removes what was extracted: wheels that are open step on, and no other is opened."""
        self._folder.remove()


def fmu_of_wheel(path: str | os.PathLike, instead: str) -> Fmu:
    """An FMU that a command was given, opened if it is that of a wheel; `instead` as of `fmu_file`."""
    fmu = Fmu(fmu_file(path, instead))
    if "contact.force_x" not in fmu.variables:
        fmu.close()
        raise Refused(f"{path} is an FMU, but not that of a wheel")
    return fmu


class Wheel(Unique):
    """A wheel that is ready to step.

    `parameters` are set before and `inputs` in Initialization Mode. All of them count, those too that have their declared
    start values: `initial.given` is `written` unless given. Refused calls raise `Refused` with the FMU's own words. Use as
    a context manager, or call `close`.

    Warnings of the FMU are said as `WheelrailWarning`, each once, when the call that led to them is done: the wheel is as it is
    without them, also where a filter makes errors of them. `log` is a list of all that the FMU has said so far, texts with a
    `status`: 1 of warnings, 2 of steps that were discarded, 3 of calls that were refused.
    """

    INSTEAD = "make another one of the same parameters"

    def __init__(
        self,
        fmu: Fmu,
        parameters: Mapping[str, object] | None = None,
        inputs: Mapping[str, object] | None = None,
        name: str = "wheel",
    ) -> None:
        if not hasattr(fmu, "description"):
            raise ValueError(f"Wheel({short(fmu)}): expected an opened FMU, `with Fmu(path) as fmu: Wheel(fmu)`")
        for values in (parameters, inputs):
            check_names(values or {}, "Wheel")
        self.fmu, self.name = fmu, name
        self._time, self._moves, self._begun = 0.0, None, None  # s; where a call leads to that moves it; begin of a step not yet recorded
        self._recorders, self._calls = [], Calls(name)
        self.log = self._calls.log
        self.slave = instance(fmu, f"{name}-{next(_numbers)}", self._calls)
        self._free = finalize(self, _free, self.slave, self._calls)
        self._free.atexit = False
        try:
            with self._calls, self._calls.lock:
                self._calls(self.slave.setupExperiment)
                # Other FMUs of this project, such as the coach, have no such choice.
                given = {"initial.given": "written"} if "initial.given" in fmu.variables else {}
                self._set(given | (parameters or {}))
                self._calls(self.slave.enterInitializationMode)
                self._set(inputs or {})
                self._begin()
        except BaseException:
            self._free()
            raise

    @property
    def time(self) -> float:
        """Present time [s], which is the FMU's, also where a call was interrupted."""
        with self._calls.lock:
            if self._moves and not self.slave.freed:
                reached = self._calls(self.slave.reached)  # a sum of floats
                known = self._time if isclose(reached, self._time, rel_tol=ROUNDING) else self._moves()
                self.time = known if isclose(reached, known, rel_tol=ROUNDING) else reached
            return self._time

    @time.setter
    def time(self, time: float) -> None:
        for recorder in self._recorders:
            recorder.rewind(time)
        self._time, self._moves = time, None

    def _begin(self):
        """Ends initialization, after which the wheel steps."""
        self._calls(self.slave.exitInitializationMode)

    def close(self) -> None:
        """Terminates and frees the instance, when calls of other threads have come to their ends; nothing happens if that has been
        done. Records keep what they have. A process that was forked leaves the instance to the one that made it."""
        with self._calls, self._calls.lock:
            if self.slave.freed:
                return
            try:
                if not self._calls.foreign():
                    self._tell()
                    self._time = self.time
                    self._calls(self.slave.terminate)
            finally:
                self._free()

    def set(self, values: Mapping[str, object]) -> None:
        """Sets variables: `set({"drive.load": 8e4, "control.rotation": "velocity"})`."""
        check_names(values, "set")
        self._set(values)

    def _set(self, values):
        given = self.fmu.settings(values)
        reals = [(variable.valueReference, value) for variable, value in given if variable.type == "Real"]
        with self._calls, self._calls.lock:
            for variable, value in given:
                if variable.type != "Real":
                    self._calls(getattr(self.slave, "set" + kind(variable)), [variable.valueReference], [value])
            if reals:
                self._calls(self.slave.setReal, *map(list, zip(*reals)))

    def set_rates(self, values: Mapping[str, float]) -> None:
        """Sets time derivatives of real inputs for the next step only: they ramp instead of holding their values."""
        check_names(values, "set_rates")
        given = self.fmu.settings(values, "/s")
        for variable, _ in given:
            if variable.type != "Real":
                raise Refused(f"{variable.name} is a choice, which has no rate")
        references, rates = [variable.valueReference for variable, _ in given], [rate for _, rate in given]
        self._calls(self.slave.setRealInputDerivatives, references, [1] * len(references), rates)

    def get(self, *names: str) -> Any:
        """Values of variables of any types, choices by number; one name gives a scalar, several a list."""
        if not names:
            raise ValueError("get() needs the name of a variable, such as get('contact.force_x')")
        variables, values = [self.fmu.variable(name) for name in names], {}
        with self._calls, self._calls.lock:
            for sort in dict.fromkeys(map(kind, variables)):
                references = [v.valueReference for v in variables if kind(v) == sort]
                values |= zip(references, self._calls(getattr(self.slave, "get" + sort), references))
        values = [plain(variable, values[variable.valueReference]) for variable in variables]
        return values[0] if len(names) == 1 else values

    def profile(self, quantity: str) -> list[float]:
        """A profile as a list over its points.

        Across the contact patch: `x` [m], positive ahead of the wheel centre, `pressure` [Pa], `shear` [Pa], `slip` [m/s], and across `shear_z`, `slip_z`,
        `temperature_wheel` and `temperature_rail` [K] of the surfaces. Below the surface: `depth` [m],
        `temperature_wheel_below` and `temperature_rail_below` [K] under the contact point, `temperature_tread_below` [K] under
        the point of the tread at `thermal.tread_point`, `peak_temperature` [K] so far of the places that were heated in one
        piece. `Fmu.profiles` lists them.
        """
        return self.get(*self.fmu.points(quantity))

    def derivatives(self, outputs: Iterable[str], inputs: Mapping[str, float]) -> list[float]:
        """What real outputs gain in the last step by changes of its inputs, such as `{"drive.force": 1.0}` or `{"drive.force [kN]": 1.0}`."""
        check_names(inputs, "derivatives")
        unknown, given = [self.fmu.variable(name).valueReference for name in outputs], self.fmu.settings(inputs, "")
        known, changes = [variable.valueReference for variable, _ in given], [change for _, change in given]
        return list(self._calls(self.slave.getDirectionalDerivative, unknown, known, changes))

    def lines(self) -> int:
        """Number of lines of the patch across its width: `contact.line_count`, at most `contact.lines`."""
        return int(self.get("contact.line_count"))

    def has_constant_width(self) -> bool:
        """Whether the patch is a line of constant width: `contact.shape` = line."""
        shape = self.fmu.variables.get("contact.shape")
        return shape is None or shape.declaredType.items[int(self.get(shape.name)) - 1].name == "line"

    def line(self, quantity: str) -> list[float]:
        """What each line of the patch has as a list in the order of their positions: `line("pressure_max")`."""
        points = self.fmu.points(f"line.{str(quantity).removeprefix('line.')}")[: self.lines()]
        values = self.get(*points)
        return values if len(points) > 1 else [values]

    def step(self, h: float, end: float | None = None) -> None:
        """Advances by `h` seconds, to the time `end` [s] where that is known better than by their sum."""
        if not isinstance(h, Real):
            raise ValueError(f"step({short(h)}): expected a number of seconds")
        with self._calls, self._calls.lock:
            self._tell()
            self._begun = self.time
            self.advance(h, end)
            self._tell()

    def _tell(self):
        """Tells the recorders of a step that has been done, which an interrupt may have kept from them."""
        if self._begun is not None and self.time > self._begun:
            for recorder in self._recorders:
                recorder.stepped()
        self._begun = None

    def record(
        self,
        *outputs: str,
        profiles: bool | str | Iterable[str] = False,
        depth: bool | str | Iterable[str] = False,
        every: int = 1,
        title: str = "",
        patch: bool = False,
    ) -> Recorder:
        """A recorder of this wheel, which takes a sample now and after every `every`-th `step`: see `records.Recorder`.

        Recorders are told of steps and of states that are restored."""
        recorder = Recorder(self, outputs or None, profiles=profiles, depth=depth, every=every, title=title, patch=patch)
        self._recorders.append(recorder)
        return recorder

    def sample(self) -> None:
        """Lets all records take a sample now, whose turn it may not be."""
        for recorder in self._recorders:
            recorder.sample()

    def advance(self, h: float, end: float | None = None) -> None:
        """Advances by a part of `h` seconds of a step, to the time `end` [s] if it is known; records do not count it."""
        with self._calls, self._calls.lock:
            now = self.time
            self._moves = lambda: after(now, h) if end is None else end
            self._calls(self.slave.doStep, now, h)
            self.time = self._moves()

    def save(self) -> tuple[object, float]:
        """A handle for `restore`; free it with `forget`."""
        with self._calls, self._calls.lock:
            return self._calls(self.slave.getFMUstate), self.time

    def restore(self, saved: tuple[object, float]) -> None:
        """Returns to a saved state; records lose what came after it."""
        state, time = saved_state(saved)
        with self._calls, self._calls.lock:
            self._tell()
            for recorder in self._recorders:
                recorder.listen()
            self._moves = lambda: time
            self._calls(self.slave.setFMUstate, state)
            self.time = time

    def forget(self, saved: tuple[object, float]) -> None:
        """Frees a saved state."""
        self._calls(self.slave.freeFMUstate, saved_state(saved)[0])


def instance(fmu: Fmu, name: str, call: Calls) -> Any:
    """An instance of the FMU's library, which is loaded with it."""
    if not Path(fmu.directory).is_dir():
        raise Refused("the FMU is closed: open wheels within `with Fmu() as fmu`")
    try:
        slave = loaded(fmu, name, call)
    except (OSError, AttributeError) as failure:  # no library, one of another machine, or one that lacks a function
        raise Refused(f"the library of the FMU cannot be loaded on this machine: {failure}") from failure
    try:
        call(slave.start, call.log)
    except Exception as failure:
        raise Refused("; ".join(call.log) or str(failure)) from failure
    return slave


def _free(slave, call):
    """Frees an instance that this process has made; one of another process is only forgotten."""
    with call.lock:
        if call.foreign():
            slave.freed = True
        else:
            slave.freeInstance()
