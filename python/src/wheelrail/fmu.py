"""One instance of wheelrail.fmu on fmpy's FMU2Slave: variables by name, enumerations by item name, SI units."""

import difflib
import os
from ctypes import byref
from itertools import count
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

import fmpy
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi2 import fmi2CallbackAllocateMemoryTYPE, fmi2CallbackFreeMemoryTYPE
from fmpy.logging import addLoggerProxy


class Refused(Exception):
    """A call that the FMU refused; the text is what it logged."""


# fmpy formats messages through one proxy per process, which knows one logger only: the messages of all instances arrive
# here and are told apart by the unique instance name.
_messages = {}
_numbers = count(1)


@fmi2CallbackLoggerTYPE
def _receive(_component, instance, _status, _category, message):
    _messages.setdefault(instance.decode(), []).append(message.decode())


_callbacks = fmi2CallbackFunctions()
_callbacks.logger = _receive
_callbacks.allocateMemory = fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
_callbacks.freeMemory = fmi2CallbackFreeMemoryTYPE(fmpy.free)
addLoggerProxy(byref(_callbacks))


def default_path():
    """The FMU named by the environment variable WHEELRAIL_FMU, else the one inside this package, else that of a checkout."""
    inside, built = Path(__file__).with_name("wheelrail.fmu"), Path("target/wheelrail.fmu")
    return Path(os.environ.get("WHEELRAIL_FMU") or (inside if inside.is_file() else built))


class Fmu:
    """An FMU extracted once, for any number of instances: that at `path`, or at `default_path()`. A context manager."""

    def __init__(self, path=None):
        path = default_path() if path is None else path
        if not Path(path).is_file():
            raise FileNotFoundError(f"{path} does not exist: build it with `make fmu`, or name one by the variable WHEELRAIL_FMU")
        self._temporary = TemporaryDirectory(prefix="wheelrail-")
        self.directory = fmpy.extract(str(path), unzipdir=self._temporary.name)
        self.description = fmpy.read_model_description(self.directory)
        self.variables = {v.name: v for v in self.description.modelVariables}
        notes = ElementTree.parse(Path(self.directory, "modelDescription.xml")).iterfind("VendorAnnotations/Tool//Retired")
        self.retired = {note.get("name"): note.get("refusal") for note in notes}

    def variable(self, name):
        """The variable of a name."""
        if name in self.retired:
            raise Refused(self.retired[name])
        if name not in self.variables:
            close = difflib.get_close_matches(name, self.variables, n=1)
            raise Refused(f"the FMU has no variable {name}" + "".join(f"; did you mean {other}?" for other in close))
        return self.variables[name]

    def profiles(self):
        """Names of the quantities of `Wheel.profile`."""
        return list(dict.fromkeys(name.split("[")[0].removeprefix("profile.") for name in self.variables if name.startswith("profile.")))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._temporary.cleanup()


class Wheel:
    """A wheel that is ready to step.

    `parameters` are set before and `inputs` in Initialization Mode. All of them count, those too that have their declared
    start values: `initial.given` is `written` unless given. Refused calls raise `Refused` with the FMU's own words. Use as
    a context manager, or call `close`.
    """

    def __init__(self, fmu, parameters=None, inputs=None, name="wheel"):
        self.fmu, self.time = fmu, 0.0
        name = f"{name}-{next(_numbers)}"
        self.log = _messages[name] = []
        d = fmu.description
        identifier = d.coSimulation.modelIdentifier
        self.slave = FMU2Slave(
            guid=d.guid, unzipDirectory=fmu.directory, modelIdentifier=identifier, instanceName=name
        )
        self.slave.instantiate(callbacks=_callbacks)
        try:
            self._call(self.slave.setupExperiment, startTime=0.0)
            # Other FMUs of this project, such as the coach, have no such choice.
            given = {"initial.given": "written"} if "initial.given" in fmu.variables else {}
            self.set(given | (parameters or {}))
            self._call(self.slave.enterInitializationMode)
            self.set(inputs or {})
            self._call(self.slave.exitInitializationMode)
        except BaseException:
            self.slave.freeInstance()
            raise

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def close(self):
        """Terminates and frees the instance."""
        try:
            self._call(self.slave.terminate)
        finally:
            self.slave.freeInstance()

    def set(self, values):
        """Sets variables: `set({"drive.load": 8e4, "control.rotation": "velocity"})`."""
        references, reals = [], []
        for name, value in values.items():
            variable = self.fmu.variable(name)
            if variable.type == "Real":
                references.append(variable.valueReference)
                reals.append(value)
                continue
            if variable.type == "Enumeration" and isinstance(value, str):
                items = [item.name for item in variable.declaredType.items]
                if value not in items:
                    raise Refused(f"{name} = {value!r} is none of {', '.join(items)}")
                value = 1 + items.index(value)
            if isinstance(value, float):
                if not value.is_integer():
                    raise Refused(f"{name} = {value!r} is not a whole number")
                value = int(value)
            self._call(self._access("set", variable), [variable.valueReference], [value])
        if references:
            self._call(self.slave.setReal, references, reals)

    def set_rates(self, values):
        """Sets time derivatives of real inputs for the next step only: they ramp instead of holding their values."""
        references = [self.fmu.variable(name).valueReference for name in values]
        self._call(self.slave.setRealInputDerivatives, references, [1] * len(references), list(values.values()))

    def get(self, *names):
        """Values of variables; one name gives a scalar, several a list. Several must be of one type."""
        variables = [self.fmu.variable(name) for name in names]
        values = self._call(self._access("get", variables[0]), [v.valueReference for v in variables])
        return values[0] if len(names) == 1 else values

    def profile(self, quantity):
        """A profile across the contact patch: x [m], pressure [Pa], shear [Pa] or slip [m/s], or another of `profiles`."""
        names = [name for name in self.fmu.variables if name.startswith(f"profile.{quantity}[")]
        if not names:
            raise Refused(f"the FMU has no profile {quantity!r}; it has {', '.join(self.fmu.profiles())}")
        return self.get(*names)

    def step(self, h):
        """Advances by `h` seconds."""
        self._call(self.slave.doStep, self.time, h)
        self.time += h

    def save(self):
        """A handle for `restore`; free it with `forget`."""
        return self._call(self.slave.getFMUstate), self.time

    def restore(self, saved):
        """Returns to a saved state."""
        self._call(self.slave.setFMUstate, saved[0])
        self.time = saved[1]

    def forget(self, saved):
        """Frees a saved state."""
        self._call(self.slave.freeFMUstate, saved[0])

    def _access(self, direction, variable):
        kind = "Integer" if variable.type == "Enumeration" else variable.type
        return getattr(self.slave, direction + kind)

    def _call(self, function, *arguments, **named):
        seen = len(self.log)
        try:
            return function(*arguments, **named)
        except FMICallException as failure:
            raise Refused("; ".join(self.log[seen:]) or str(failure)) from failure
