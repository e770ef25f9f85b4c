"""Controllers of one's own: what slide protection, sanding and driver must have, and the guards between them and a stop.

A class whose methods are those of `Protection`, `Sanding` or `Driving` takes the place of the built-in one when a file names
it, `"protection": "module:Class"`, or when it is put into a loaded scenario (`scenario.brake.protection = Gentle`). It need
not inherit anything. What it raises, or returns wrongly, ends the stop with its name, the time and the place in its file.
"""

import math
import numbers
from enum import Enum
from typing import Protocol

from .own import OwnClass, place
from .values import short

MOST_SAND = 1.0  # kg/s


class Valve(Enum):
    """What the valve of an axle does."""

    APPLY = 0
    HOLD = 1
    VENT = 2


class Protection(Protocol):
    """Slide protection of one coach: `"protection"` in the brake's file. An attribute `reference` [m/s], the speed that it takes
    for that of the train, is recorded if it is there."""

    def __init__(self, wsp, speeds, **parameters):
        """`wsp`: the values of that group of the file (`wsp.slide_high` ...); `speeds`: peripheral speeds of the axles at the
        start [m/s]; `parameters`: `protection_parameters` of the file."""

    def step(self, h, speeds):
        """One valve per axle for the next `h` [s], from their peripheral speeds [m/s]: `Valve.APPLY`, `HOLD` or `VENT`, or
        "apply", "hold", "vent". It is asked after every step; a controller with a longer cycle answers with its last valves."""


class Sanding(Protocol):
    """Sanding of one coach: `"sanding"` in the brake's file. It is asked while `sander.active`."""

    def __init__(self, sander, **parameters):
        """`sander`: the values of that group of the file; `parameters`: `sanding_parameters` of the file."""

    def step(self, h, speeds, valves):
        """Sand [kg/s], 0 to 1, on each rail in front of each of the axles `sander.axles` for the next `h` [s], from peripheral
        speeds [m/s] and valves (`Valve`) of all axles."""


class Driving(Protocol):
    """Demand of the driver: `"driver"` in the scenario."""

    def __init__(self, scenario, **parameters):
        """`scenario`: its values (`scenario.speed`, `scenario.demand` ...); `parameters`: `driver_parameters` of the file."""

    def step(self, h, time, speed, travelled):
        """Share of the full brake pressure, 0 to 1, for the next `h` [s], at a time [s] and speed [m/s], `travelled` [m] after
        the start."""


class ControllerFailed(Exception):
    """A controller of one's own that raised, or returned what cannot be used; the text names class, time and place."""


class Guard:
    """A controller of one's own, made and called so that its mistakes are said by name."""

    def __init__(self, found, arguments, parameters, of=""):
        """`found`: a class, or an `OwnClass` of a file; `of` says of which coach."""
        self.time, self.next = 0.0, 0.0  # s: of the last call, and of the next one
        self.name = f"{found.name if isinstance(found, OwnClass) else found.__qualname__}{of}"
        made = self._call("making it", lambda: found.load() if isinstance(found, OwnClass) else found)
        self.made = self._call("making it", lambda: made(*arguments, **parameters))

    def ask(self, h, *arguments):
        """What its `step` returns."""
        self.time = self.next
        self.next += h
        return self._call("step", lambda: self.made.step(h, *arguments))

    def refuse(self, problem):
        """Raises with name and time."""
        raise ControllerFailed(f"{self.name} at {self.time:.3f} s: {problem}")

    def _call(self, what, function):
        try:
            return function()
        except (Exception, SystemExit) as error:
            text = " ".join(f"{type(error).__name__}: {error}".split())
            raise ControllerFailed(f"{self.name} at {self.time:.3f} s: {what} failed: {text} ({place(error)})") from None

    def number(self, value, low, high, what):
        """The value as a float, if it is a number within its range."""
        if isinstance(value, bool) or not isinstance(value, numbers.Real) or not math.isfinite(value):
            self.refuse(f"step returned {short(value)} for {what}, not a number")
        if not low <= value <= high:
            self.refuse(f"step returned {what} = {float(value):g}, outside {low:g} to {high:g}")
        return float(value)


class OwnProtection(Guard):
    """Guard of a `Protection`. Where the slide protection is switched off (`wsp.active`), it is not asked."""

    def __init__(self, found, wsp, speeds, parameters, of=""):
        self.wsp, self.valves = wsp, [Valve.APPLY] * len(speeds)
        super().__init__(found, (wsp, list(speeds)), parameters, of)

    @property
    def reference(self):
        """Speed that it takes for that of the train [m/s]; nan if it has none."""
        value = self._call("reference", lambda: getattr(self.made, "reference", None))
        return float(value) if isinstance(value, numbers.Real) else math.nan

    def step(self, h, speeds):
        """Valves of all axles."""
        if not self.wsp.active:
            return self.valves
        found = self.ask(h, list(speeds))
        if isinstance(found, str) or not hasattr(found, "__len__") or len(found) != len(speeds):
            self.refuse(f"step returned {short(found)}, not a list of {len(speeds)} valves, one per axle")
        self.valves = [self._valve(axle, value) for axle, value in enumerate(found, start=1)]
        return self.valves

    def _valve(self, axle, value):
        """The valve of an axle, given as such or by its name."""
        if isinstance(value, Valve):
            return value
        if isinstance(value, str) and value.upper() in Valve.__members__:
            return Valve[value.upper()]
        return self.refuse(f"axle {axle}: valve {short(value)} is none of apply, hold, vent")


class OwnSanding(Guard):
    """Guard of a `Sanding`, which counts the sand."""

    def __init__(self, found, sander, parameters, of=""):
        self.sander, self.used = sander, 0.0
        super().__init__(found, (sander,), parameters, of)

    def step(self, h, speeds, valves):
        """Mass [kg] laid on each rail in front of each of the sander's axles."""
        if not self.sander.active:
            return 0.0
        flow = self.number(self.ask(h, list(speeds), list(valves)), 0.0, MOST_SAND, "sand [kg/s]")
        self.used += 2.0 * h * flow * len(self.sander.axles)
        return h * flow


class OwnDriver(Guard):
    """Guard of a `Driving`."""

    def step(self, h, time, speed, travelled):
        """Demand, 0 to 1."""
        return self.number(self.ask(h, time, speed, travelled), 0.0, 1.0, "demand")
