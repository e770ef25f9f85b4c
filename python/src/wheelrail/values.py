"""Values of variables on their way to and from the FMU, and what is refused before it gets there."""

from __future__ import annotations

import os
from ctypes import c_void_p
from math import isfinite
from numbers import Integral, Real
from typing import Self

from fmpy.model_description import ScalarVariable

from .units import UnitError, agreed, beside, converted

# What a value that is no number at all should have been.
NUMBERS = {"Boolean": "True or False", "Integer": "a whole number", "Enumeration": "the name or number of a choice"}


class Refused(Exception):
    """A call that the FMU refused; the text is what it logged."""


class Unique:
    """What owns something of this process until `close`, and therefore can be neither copied nor pickled."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __reduce_ex__(self, _: object) -> None:
        raise Refused(f"a {type(self).__name__} can be neither copied nor pickled: {self.INSTEAD}")


def kind(variable: ScalarVariable) -> str:
    """The type by which a variable crosses the interface."""
    return "Integer" if variable.type == "Enumeration" else variable.type


def plain(variable: ScalarVariable, value: object) -> object:
    """A value as Python has it."""
    if variable.type == "String":
        return value.decode() if isinstance(value, bytes) else value
    return bool(value) if variable.type == "Boolean" else value


def check_names(values: object, call: str) -> None:
    """Refuses what maps no names to values."""
    if not hasattr(values, "items"):
        raise ValueError(f"{call}({short(values)}): expected names and values, such as {{'drive.load': 8e4}}")


def number(name: str, value: object, expected: str) -> float | None:
    """A number in an `expected` unit, of one that may have another one beside it; None if it is no finite number."""
    value, unit = beside(value)
    value = value.item() if getattr(value, "shape", None) == () else value
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value):
        return None
    return float(converted(name, value, unit, expected))


def to_fmu(variable: ScalarVariable, value: object, unit: str | None = None, change: str | None = None) -> float | int | str:
    """A value as the variable wants it, of a number in a `unit`, or with one beside it; a `change` is a difference, with "/s" a rate."""
    name, own = variable.name, variable.unit or ""
    expected = f"{own or 1}{change}" if change else own
    value, brought = beside(value)
    if getattr(value, "shape", None) == ():
        value = value.item()
    if variable.type == "String":
        if not isinstance(value, (str, os.PathLike)):
            raise Refused(f"{name} = {value!r} is not a text")
        return str(value)
    if variable.type == "Enumeration" and isinstance(value, str):
        items = [item.name for item in variable.declaredType.items]
        if value not in items:
            raise Refused(f"{name} = {value!r} is none of {', '.join(items)}")
        return 1 + items.index(value)
    if not isinstance(value, Real):
        raise Refused(f"{name} = {short(value)} is not {NUMBERS.get(variable.type, 'a number' + (f' [{expected}]' if expected else ''))}")
    try:
        relative = change is not None or bool(getattr(variable.declaredType, "relativeQuantity", None))  # fmpy misses that of a variable itself
        value = converted(name, value, agreed(name, (unit, brought)), expected, relative, "" if change else variable.displayUnit or "")
    except UnitError as error:
        raise Refused(str(error)) from None
    if variable.type == "Real":
        return float(value)
    if not isinstance(value, Integral) and not float(value).is_integer():
        raise Refused(f"{name} = {value!r} is not a whole number")
    return int(value)


def short(value: object) -> str:
    """A value in not too many characters."""
    text = " ".join(repr(value).split())
    return text if len(text) < 60 else text[:57] + "..."


def first_line(failure: BaseException) -> str:
    """The first line of what went wrong, or its kind."""
    return (str(failure).splitlines() or [type(failure).__name__])[0]


def saved_state(saved: object) -> tuple[object, float]:
    """State and time of what `save` gave."""
    if not (isinstance(saved, tuple) and len(saved) == 2 and isinstance(saved[0], c_void_p)):
        raise ValueError(f"{short(saved)} is not what save() returned")
    return saved
