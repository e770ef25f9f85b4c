"""Units beside values: what a person, a table or another library says a number is in, and the same number in SI units.

A unit is written as a product of powers of symbols: `km/h`, `kN m`, `kN·m`, `W/(m2.K)`, `m s-1`, `°C`. pint knows the units; angles
are no numbers here. `beside` finds the unit that a value brings along, `named` that in a name; `converted` takes a number to SI units
or refuses it by its name.
"""

from __future__ import annotations

import re
from collections.abc import Container, Iterable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any


ZERO_CELSIUS = 273.15  # K
DERIVED = ("N", "Pa", "J", "W")  # units that stay as they are written
NONE = ("", "1", "-", "dimensionless", "none", "unitless")  # of a number without a unit
LETTERS = "gmsKANJWthdl%‰"  # that are units by themselves behind a name
SPELLED = str.maketrans({"·": "*", "⋅": "*", "×": "*", ".": "*", "−": "-"})
CELSIUS = re.compile(r"℃|(?:°|deg(?:ree)?s?)[ _]?c(?:elsius)?\b|\bcelsius\b", re.IGNORECASE)
POWER = re.compile(r"(?<=[^\W\d_])\^?(?=[+-]?\d)")  # between a symbol and its exponent
WORD = re.compile(r"[^\W\d_]{4,}")  # which is a name, no symbol, whatever its letters
TOGETHER = re.compile(r"\b(\w?[NW])([ms])\b")  # two symbols without a space
# A name with its unit, as people head columns: `force [kN]`, `force (kN)`, `force/kN`, `force in kN`, `force, kN`.
HEADED = re.compile(r"^\s*(?P<name>[\w.]+(?:\[\d+\])?(?: +[\w.]+)*?)\s*(?:\[(?P<a>[^\]]*)\]|\((?P<b>.*)\)|/\s*(?P<c>.+)|\s+in\s+(?P<d>.+)|,\s*(?P<e>.+))?\s*$")
TIMES = ("time", "t")  # names of columns of times, in small letters


class UnitError(ValueError):
    """A unit that is not known, or not one of the quantity; the text says what is, and what was expected."""


@dataclass(frozen=True)
class Unit:
    """`value × factor + offset` is in `si`, a product of powers of SI units, pairs of symbol and exponent; `bases` are those of the
    base units that it consists of."""

    factor: Fraction
    offset: Fraction
    si: tuple[tuple[str, int], ...]
    bases: frozenset[tuple[str, int]]

    def name(self) -> str:
        """The SI unit, as the FMU spells it."""
        text = lambda symbol, power: symbol + (str(power) if power != 1 else "")
        above, below = (".".join(text(s, abs(p)) for s, p in self.si if p * sign > 0) for sign in (1, -1))
        return (above or "1") + ("/" + (f"({below})" if "." in below else below) if below else "")

    def to_si(self, values: Any, relative: bool = False) -> Any:
        """A number, or an array of them, in SI units; a `relative` one is a difference, which knows no zero."""
        factor, offset = self.factor, 0 if relative else self.offset
        # Whole numbers one after the other round like the number that is meant: 9 ms are .009 s. As floats they fit any array of integers.
        return values * float(factor.numerator) / float(factor.denominator) + float(offset) if (factor, offset) != (1, 0) else values


@cache
def _registry():
    """The units of pint, with exact factors; an angle is a quantity of its own."""
    import pint

    registry = pint.UnitRegistry(non_int_type=Fraction, on_redefinition="ignore")
    registry.define("radian = [angle] = rad")
    for name, also in (("kilometer_per_hour", "kmh"), ("force_kilogram", "kp")):
        registry.define(f"@alias {name} = {also}")
    return registry, {registry.parse_units(symbol).dimensionality: symbol for symbol in DERIVED}


@cache
def unit_of(text: str) -> Unit:
    """The unit of a text; `UnitError` if nobody knows it."""
    if text.strip().lower() in NONE:
        return Unit(Fraction(1), Fraction(0), (), frozenset())
    bare = text.strip().removeprefix("Δ").removeprefix("delta_")
    spelled = CELSIUS.sub("degC", bare)
    spelled = POWER.sub("**", TOGETHER.sub(r"\1 \2", spelled.replace("**", "^").translate(SPELLED)))
    for written in (spelled, WORD.sub(lambda word: word[0].lower(), spelled)):
        try:
            return _of_pint(written, relative=bare != text.strip())
        except Exception:  # whatever it says of a text that is no unit
            continue
    raise UnitError(f"{text!r} is no unit that is known here")


def _of_pint(text, relative):
    """The unit that pint reads."""
    registry, derived = _registry()
    unit = registry.parse_units(text)
    base = lambda of: [(registry.get_symbol(name), int(power)) for name, power in registry.get_base_units(of)[1]._units.items()]
    factor, bases = registry.get_base_units(unit)[0], frozenset(base(unit))
    offset = 0 if "rad" in dict(bases) else registry.Quantity(Fraction(0), unit).to_base_units().magnitude
    if offset and bases != {("K", 1)}:
        raise UnitError("a logarithm, such as dB")
    si = {}
    for name, power in unit._units.items():
        part = registry.Unit(name)
        for symbol, exponent in [(derived[part.dimensionality], 1)] if part.dimensionality in derived else base(part):
            si[symbol] = si.get(symbol, 0) + int(power) * exponent
    return Unit(Fraction(factor), Fraction(0 if relative else offset), tuple((s, power) for s, power in si.items() if power), bases)


def converted(name: str, values: Any, unit: str | None, expected: str, relative: bool = False, shown: str = "") -> Any:
    """Numbers of a quantity `name` in a unit as what the quantity is `expected` in; None is no unit. `relative` ones are differences;
    `shown` is a unit in which people read them."""
    if unit is None or unit == expected:
        return values
    wanted = f"expected {expected if expected not in NONE else 'a number without a unit'}" + (f", or {shown}" if shown else "")
    try:
        known = unit_of(unit)
    except UnitError as error:
        raise UnitError(f"{name}: {error}; {wanted}") from None
    if known.bases != unit_of(expected or "1").bases:
        raise UnitError(f"{name} is in {unit!r}: {wanted}")
    if relative and known.offset:
        raise UnitError(f"{name} is a difference, for which {unit!r} can be read in two ways: write it in K")
    return known.to_si(values, relative)


def headed(text: Any) -> tuple[Any, str | None]:
    """Name and unit of a heading, `force [kN]`; what has no unit behind it, or is no heading, stays whole."""
    match = HEADED.match(text) if isinstance(text, str) else None
    if match is None:
        return text, None
    unit = next((match[group] for group in "abcde" if match[group] is not None), None)
    return match["name"], None if unit is None else unit.strip()


def named(text: Any, known: Container[str]) -> tuple[Any, str | None]:
    """A name that is `known`, and the unit behind it; a text that is known, or no such heading, stays whole."""
    name, unit = headed(text)
    return (name, unit) if text not in known and name in known else (text, None)


def behind(name: Any) -> str | None:
    """The unit behind the name of a column or an index, None without: in square brackets whatever it is, by other marks what is one,
    for names may have these, too: `left/right`, `force (mean)`. A letter that only pint knows is none there: `L/V`."""
    unit = headed(name)[1]
    if not unit or unit.isdecimal():  # numbers are those of points
        return None
    if not name.rstrip().endswith("]"):
        try:
            unit_of(unit)
        except UnitError:
            return None
        if len(unit) == 1 and unit not in LETTERS:
            return None
    return unit


def noted(attrs: Any, name: Any = None) -> str | None:
    """The unit in attributes of xarray or pandas: of one quantity (`units`, `unit`), or of a column `name` among several."""
    if not hasattr(attrs, "items"):
        return None
    of = attrs.get("variables")
    if hasattr(of, "get") and hasattr(of.get(name), "items"):  # as `wheelrail.table` notes them
        return noted(of[name])
    found = next((value for key, value in attrs.items() if str(key).lower() in ("unit", "units")), None)
    found = found.get(name) if hasattr(found, "get") else found
    return None if found is None or not str(found).strip() else str(found)


def beside(given: Any) -> tuple[Any, str | None]:
    """What is given without the unit that it has beside it, and that unit: quantities of pint, astropy and the like, arrays of xarray and
    columns of pandas with attributes or names that say it."""
    if isinstance(given, (int, float, str, list, tuple, dict)):
        return given, None
    if not hasattr(given, "attrs"):
        return _quantity(given)
    data, name = getattr(given, "data", None), getattr(given, "name", None)
    if type(data).__module__.partition(".")[0] == "pint":  # in an array of xarray
        given = given.copy(data=data.magnitude).assign_attrs(units=f"{data.units:~C}")
    return given, agreed(str(name), (noted(given.attrs, name), behind(name)))


def _quantity(given):
    """Magnitude and unit of a quantity; anything else as it is."""
    unit = getattr(given, "units", None) if hasattr(given, "units") else getattr(given, "unit", None)
    if unit is None or isinstance(unit, str) or callable(getattr(given, "total_seconds", None)):
        return given, None
    if hasattr(given, "magnitude"):  # pint
        return given.magnitude, f"{unit:~C}"
    for name in ("value", "d"):  # astropy, unyt
        if hasattr(given, name):
            return getattr(given, name), str(unit)
    return given, str(unit)


def agreed(name: str, units: Iterable[str | None]) -> str | None:
    """The unit that stands beside a value in several places; two that differ are refused."""
    found = [unit for unit in units if unit is not None]
    if len(set(found)) > 1 and len({unit_of(unit) for unit in found}) > 1:
        raise UnitError(f"{name} is in {found[0]!r} by one mark and in {found[1]!r} by another: leave one of them out")
    return found[0] if found else None


def in_si(record: Any) -> Any:
    """A Dataset over `time` with its values in SI units and its times in seconds, as runs are recorded: spans of time are such seconds, dates
    count from the first. What has another unit in its attributes is converted; one that is not known is refused where the FMU's
    variables are, whose names have dots."""
    changed = {}
    for name in record.variables:
        # Other marks behind a name are part of it, or are said by attributes: `Y/Q`, `contact.force_x (mean)`.
        array, unit = beside(record[name] if str(name).endswith("]") else record[name].rename(None))
        values = array.values
        if values.dtype.kind in "mM" and name == "time":
            spans = values - values[:1] if values.dtype.kind == "M" else values
            values, unit, array = spans.astype("m8[ns]").astype(float) / 1e9, "s", array.variable
        elif unit is None or values.dtype.kind not in "iuf":
            continue
        try:
            known = unit_of(unit)
        except UnitError as error:
            if "." in str(name) or name == "time":
                raise UnitError(f"{name}: {error}") from None
            continue
        if values is not array.values or known.factor != 1 or known.offset:
            changed[name] = (array.dims, known.to_si(values), array.attrs | {"units": known.name()})
    return record.assign_coords({name: of for name, of in changed.items() if name in record.coords}).assign(
        {name: of for name, of in changed.items() if name not in record.coords}
    )
