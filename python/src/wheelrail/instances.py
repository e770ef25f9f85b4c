"""Instances of the FMU's library, of FMI 2.0 or 3.0, with one set of functions: those of fmpy's FMU2Slave.

FMI 3.0 has arrays where FMI 2.0 lists their elements, and one type for each size of numbers. Here both have the variables of FMI
2.0, by the same names and value references.
"""

from copy import copy
from ctypes import CDLL, c_double, c_int, c_uint
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

import fmpy
import numpy as np
from fmpy import fmi2, fmi3

from .calls import callbacks, listener, opening
from .values import Refused

TYPES = {"Float64": "Real", "Int32": "Integer"}  # names that differ between the versions
QUIET = ["logEvents", "logProgress"]  # categories of which FMI 2.0 is silent unless asked
TIME = 0  # value reference of the time in FMI 3.0
RAMPS = 20  # from the value reference of an input to that of its time derivative
BUFFERS = {"Real": c_double, "Integer": c_int, "Boolean": c_int}


@dataclass(frozen=True)
class Place:
    """Where FMI 3.0 has a variable of FMI 2.0: value reference, type and size of the array that it is an element of."""

    reference: int
    type: str
    index: int = 0
    size: int = 1


def scalars(description):
    """The variables of FMI 2.0 by name, and the places where FMI 3.0 has them by value reference: none for FMI 2.0 itself."""
    if description.fmiVersion.startswith("2"):
        return {v.name: v for v in description.modelVariables}, {}
    variables, places = {}, {}
    for row in description.modelVariables:
        if row.causality == "independent":
            continue
        size = int(row.dimensions[0].start) if row.dimensions else None
        for index in range(size or 1):
            element = copy(row)
            element.type = TYPES.get(row.type, row.type)
            if size:
                element.name, element.valueReference = f"{row.name}[{index + 1}]", row.valueReference + 1 + index
                element.dimensions, element.shape, element.causality = [], None, "local"
            variables[element.name] = element
            places[element.valueReference] = Place(row.valueReference, row.type, index, size or 1)
    return variables, places


class Owner:
    """The only owner of an instance's handle: whoever has a wheel or a copy of it, on any thread, calls the FMU through this
    object, one call at a time, and is refused once the instance has been freed. It takes the place of the constructor of fmpy's
    classes, which changes the working directory of the process while it loads the library."""

    def __init__(self, fmu, name, calls):
        d = fmu.description
        self.guid, self.modelIdentifier = d.guid, d.coSimulation.modelIdentifier
        self.unzipDirectory, self.instanceName = fmu.directory, name
        self.fmiCallLogger, self.requireFunctions, self._functions = None, True, {}
        self.component = self.callbacks = None
        self.calls, self.freed = calls, False
        file = self.modelIdentifier + fmpy.sharedLibraryExtension
        with opening:
            self.dll = CDLL(str(Path(fmu.directory, "binaries", self.PLATFORM, file).absolute()))
        self._loadFunctions()

    def _call(self, name, *arguments):
        with self.calls.lock:
            if self.freed:
                raise Refused("the wheel is closed: read its results before, or record them")
            return super()._call(name, *arguments)

    def freeInstance(self):
        with self.calls.lock:
            if not self.freed:
                self.freed = True
                super()._call(self.FREE, self.component)
                self.freeLibrary()


class Functions2(Owner):
    """What an instance of FMI 2.0 has besides the functions of fmpy's class."""

    PLATFORM, FREE = fmpy.platform, "fmi2FreeInstance"

    def start(self, log):
        """Makes the instance, whose messages go to the list `log`."""
        self.instantiate(callbacks=callbacks(log))

    def reached(self):
        """The time up to which the FMU has simulated [s]."""
        return self.getRealStatus(fmi2.fmi2LastSuccessfulTime)

    def reader(self, sort, references):
        """A function that reads variables of one type at once, as an array."""
        count = len(references)
        asked, values = (c_uint * count)(*references), (BUFFERS[sort] * count)()
        get = getattr(self, "fmi2Get" + sort)

        def read():
            get(self.component, asked, count, values)
            return np.array(values)

        return read


class Plan:
    """Arrays of one type that must be read for some of their elements, and where these stand in what has been read."""

    def __init__(self, places):
        self.rows = list(dict.fromkeys(place.reference for place in places))
        sizes = {place.reference: place.size for place in places}
        starts = dict(zip(self.rows, np.cumsum([0, *(sizes[row] for row in self.rows)]).tolist()))
        self.size = sum(sizes.values())
        self.picked = [starts[place.reference] + place.index for place in places]


class Functions3(Owner):
    """What an instance of FMI 3.0 has besides the functions of fmpy's class."""

    PLATFORM, FREE = fmpy.platform_tuple, "fmi3FreeInstance"

    def __init__(self, fmu, name, calls):
        super().__init__(fmu, name, calls)
        self.places, self._plans, self._rates = fmu.places, {}, {}

    def start(self, log):
        """Makes the instance, whose messages go to the list `log`: as many as FMI 2.0 sends unasked."""
        self.instantiate(loggingOn=True, logMessage=listener(log))
        self.setDebugLogging(False, QUIET)

    def reached(self):
        """The time up to which the FMU has simulated [s]."""
        return self.getFloat64([TIME])[0]

    def setupExperiment(self):
        """Nothing: FMI 3.0 has it in `enterInitializationMode`, whose experiment begins at 0 s, too, unless it is told otherwise."""

    def _plan(self, references):
        """The plan for elements of one type."""
        key = tuple(references)
        if key not in self._plans:
            self._plans[key] = Plan([self.places[reference] for reference in key])
        return self._plans[key]

    def _get(self, references):
        """Values of variables, each by the function of its type."""
        values = {}
        for sort in dict.fromkeys(self.places[reference].type for reference in references):
            of_type = [reference for reference in references if self.places[reference].type == sort]
            plan = self._plan(of_type)
            read = getattr(super(), f"get{FUNCTIONS.get(sort, sort)}")(plan.rows, plan.size)
            values |= zip(of_type, (read[k] for k in plan.picked))
        return [values[reference] for reference in references]

    getReal = getInteger = getBoolean = getString = _get

    def _set(self, references, values):
        """Sets variables, each by the function of its type."""
        pairs = [(self.places[reference], value) for reference, value in zip(references, values)]
        for sort, group in groupby(pairs, key=lambda pair: pair[0].type):
            places, given = zip(*group)
            getattr(super(), f"set{FUNCTIONS.get(sort, sort)}")([place.reference for place in places], list(given))

    setReal = setInteger = setBoolean = setString = _set

    def setRealInputDerivatives(self, references, orders, values):
        """Takes time derivatives for the next step: of forces they are inputs, motions move linearly to their end."""
        if set(orders) - {1}:
            raise Refused(f"derivatives of order {max(orders)}: only order 1 is possible")
        self._rates |= dict(zip(references, values))

    def doStep(self, currentCommunicationPoint, communicationStepSize, noSetFMUStatePriorToCurrentPoint=True):
        ramped = {k + RAMPS: rate for k, rate in self._rates.items() if k + RAMPS in self.places}
        moved = [k for k in self._rates if k + RAMPS not in self.places]
        if moved:
            ends = [value + communicationStepSize * self._rates[k] for k, value in zip(moved, self.getReal(moved))]
            self.setReal(moved, ends)
        if ramped:
            self.setReal(list(ramped), list(ramped.values()))
        self._rates = {}
        try:
            return super().doStep(currentCommunicationPoint, communicationStepSize, noSetFMUStatePriorToCurrentPoint)
        finally:
            if ramped:
                self.setReal(list(ramped), [0.0] * len(ramped))

    def getDirectionalDerivative(self, vUnknown_ref, vKnown_ref, dvKnown):
        plan = self._plan(vUnknown_ref)
        found = super().getDirectionalDerivative(plan.rows, vKnown_ref, dvKnown, nSensitivity=plan.size)
        return [found[k] for k in plan.picked]

    def reader(self, sort, references):
        """A function that reads variables of one type at once, as an array."""
        by_type = {}
        for k, reference in enumerate(references):
            by_type.setdefault(self.places[reference].type, []).append(k)
        parts = []
        for of_type, places in by_type.items():
            plan = self._plan([references[k] for k in places])
            rows, values = (c_uint * len(plan.rows))(*plan.rows), (CELLS[of_type] * plan.size)()
            get = getattr(self, f"fmi3Get{FUNCTIONS.get(of_type, of_type)}")
            parts.append((get, rows, values, places, plan.picked))
        result = np.zeros(len(references), float if sort == "Real" else int)

        def read():
            for get, rows, values, places, picked in parts:
                get(self.component, rows, len(rows), values, len(values))
                result[places] = np.array(values)[picked]
            return result.copy()

        return read

    def setFMUstate(self, state):
        rates, self._rates = self._rates, {}
        try:
            self.setFMUState(state)
        except Exception:
            self._rates = rates
            raise


FUNCTIONS = {"Enumeration": "Int64"}  # of a type, where its name is another
CELLS = {"Float64": fmi3.fmi3Float64, "Int32": fmi3.fmi3Int32, "Enumeration": fmi3.fmi3Int64, "Boolean": fmi3.fmi3Boolean}


def loaded(fmu, name, calls):
    """An instance that has not been made yet, with the library loaded for it. Its class is made anew, because fmpy may have been
    reloaded, and has a name from which fmpy knows the version."""

    class FMU2Instance(Functions2, fmi2.FMU2Slave):
        pass

    class FMU3Instance(Functions3, fmi3.FMU3Slave):
        getFMUstate, freeFMUstate = fmi3.FMU3Slave.getFMUState, fmi3.FMU3Slave.freeFMUState
        serializeFMUstate, deSerializeFMUstate = fmi3.FMU3Slave.serializeFMUState, fmi3.FMU3Slave.deserializeFMUState

    return (FMU3Instance if fmu.places else FMU2Instance)(fmu, name, calls)
