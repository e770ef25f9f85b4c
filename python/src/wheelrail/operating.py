"""Stationary rolling: forces over creepage, of an FMU that is only started and never stepped.

`steady` gives a Dataset over the creepage; `wheelrail steady` prints it as a CSV.
"""

from __future__ import annotations

from argparse import ArgumentTypeError
from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .fmu import Fmu, Wheel
from .records import attributes, library
from .units import UnitError, beside, converted, headed
from .values import Refused, check_names, number, short

if TYPE_CHECKING:
    import xarray

OUTPUTS = (
    "contact.creepage", "contact.force_x", "contact.adhesion", "contact.utilisation", "contact.stick_fraction",
    "contact.half_width", "contact.pressure_max", "contact.moment", "contact.friction", "temperature.wheel_max",
    "temperature.rail_max", "heat.friction_power",
)  # fmt: skip
RANGE, COUNT = 1.5, 16  # of Carter's full slip, and points up to there
MOST = 1_000_000  # points of a range
PASSES, TOLERANCE = 8, 1e-12  # that find the growth of a warm wheel, and what they may miss of its radius
PRESCRIBED = {"control.rotation": "velocity", "control.translation": "velocity"}
FOLLOWS = ("drive.velocity", "drive.omega", "initial.creepage")


class OperatingPoint(Wheel):
    """A wheel in stationary rolling with prescribed speeds, which stays before its first step."""

    def __init__(self, fmu: Fmu, parameters: Mapping[str, object], inputs: Mapping[str, object]):
        wrong = next((name for name in (*parameters, *inputs) if headed(name)[0] in FOLLOWS), None)
        if wrong:
            raise Refused(f"{wrong} follows from velocity and creepage and cannot be set")
        choices = {name: value for name, value in PRESCRIBED.items() if name in fmu.variables}
        start = {"initial.temperature": "stationary"} | dict(parameters)
        super().__init__(fmu, start, choices | dict(inputs), name="steady")

    def _begin(self):
        """Leaves the wheel in initialization, in which every creepage has its stationary state."""

    def close(self) -> None:
        """Frees the instance."""
        try:
            self._calls(self.slave.exitInitializationMode)
        except Refused:
            self._free()  # What cannot start need not be terminated.
            return
        super().close()

    def roll(self, velocity: float, creepage: float) -> None:
        """Moves on to a creepage [1] at a velocity [m/s], that of the radius to which the wheel then grows."""
        omega = velocity * (2.0 - creepage) / (2.0 + creepage)  # of 2 (V − rΩ)/(V + rΩ), times the radius
        radius, growth = self.get("wheel.radius"), 0.0
        for _ in range(PASSES):
            self._set({"drive.velocity": velocity, "drive.omega": omega / (radius + growth)})
            growth, before = self.get("thermal.growth"), growth
            if abs(growth - before) <= TOLERANCE * radius:
                return


def steady(
    parameters: Mapping[str, object] | None = None,
    inputs: Mapping[str, object] | None = None,
    *,
    creepage: float | Iterable[float] | None = None,
    velocity: float | None = None,
    outputs: str | Iterable[str] | None = None,
    fmu: Fmu | str | Path | None = None,
) -> xarray.Dataset:
    """Stationary rolling at one or many creepages: a Dataset over `creepage` [1], as many points as creepages are given.

    `creepage` is 2 (V − rΩ)/(V + rΩ), positive when braking: by itself 16 points up to 1.5 times Carter's full slip μa/R.
    `velocity` [m/s] is `initial.velocity` if it is not given. `outputs` are names of outputs. Temperatures are those that the
    wheel has after long rolling. A state that is refused raises `Refused`; what ends a curve half-way carries its beginning as its
    attribute `run`.
    """
    xarray = library("xarray")
    names = list(OUTPUTS) if outputs is None else [outputs] if isinstance(outputs, str) else list(outputs)
    parameters, inputs = parameters or {}, inputs or {}
    check_names(parameters, "steady")
    check_names(inputs, "steady")
    with ExitStack() as stack:
        opened = fmu if isinstance(fmu, Fmu) else stack.enter_context(Fmu(fmu))
        wheel = stack.enter_context(OperatingPoint(opened, parameters, inputs))
        speed = _speed(wheel, velocity)
        places = _range(wheel, speed) if creepage is None else _creepages(creepage)
        about = {name: attributes(opened.variable(name)) for name in (*names, "contact.creepage")}
        attrs = {"velocity": speed, "preset": wheel.get("preset"), "fmu_version": opened.description.version or ""}
        rows = []

        def curve():
            columns = np.array(rows, float).reshape(len(rows), len(names)).T
            data = {name: ("creepage", column, about[name]) for name, column in zip(names, columns)}
            over = {"creepage": ("creepage", np.asarray(places, float)[: len(rows)], about["contact.creepage"])}
            return xarray.Dataset(data, over, attrs)

        try:
            for place in places:
                wheel.roll(speed, place)
                rows.append(np.atleast_1d(wheel.get(*names)))
        except BaseException as failure:
            if rows:
                failure.run = curve()
            raise
        return curve()


def _speed(wheel: Wheel, velocity: float | None) -> float:
    """The velocity [m/s], which is none of standstill."""
    given = wheel.get("initial.velocity") if velocity is None else velocity
    speed = number("velocity", given, "m/s")
    if speed is None or abs(speed) < 0.02:
        raise ValueError(f"velocity = {short(given)} is no velocity in m/s of a wheel that travels")
    return speed


def _range(wheel: OperatingPoint, speed: float) -> np.ndarray:
    """Creepages up to well beyond full slip."""
    wheel.roll(speed, 0.0)
    friction, half_width, radius = wheel.get("contact.friction", "contact.half_width", "wheel.radius")
    full_slip = friction * half_width / radius
    if not full_slip > 0.0:
        raise Refused("no full slip without friction and load to range up to: name a creepage")
    return np.linspace(0.0, RANGE * full_slip, COUNT)


def _creepages(given: float | Iterable[float]) -> np.ndarray:
    """Creepages as an array; each must be one that a travelling wheel can have."""
    given, unit = beside(given)
    try:
        values = converted("creepage", np.atleast_1d(np.asarray(given, float)), unit, "1")
    except UnitError:
        raise
    except (TypeError, ValueError):
        raise ValueError(f"creepage = {short(given)} is no number and no list of numbers") from None
    wrong = values[~(np.abs(values) < 2.0)].tolist()
    if values.ndim != 1 or wrong or not len(values):
        raise ValueError(f"creepage = {short(wrong[0] if wrong else given)} is outside -2 to 2, or no list")
    return values


def ranged(text: str) -> np.ndarray:
    """Creepages of a command line: one, or FROM:TO:COUNT with both ends."""
    try:
        first, *rest = text.split(":")
        if not rest:
            return _creepages(float(first))
        if len(rest) != 2:
            raise ValueError(f"{len(rest) + 1} parts")
        last, count = rest
        if not 2 <= int(count) <= MOST:
            raise ValueError(f"2 to {MOST} points for a range")
        return _creepages(np.linspace(float(first), float(last), int(count)))
    except ValueError as error:
        raise ArgumentTypeError(f"{text!r}: expected one number or FROM:TO:COUNT ({error})") from None
