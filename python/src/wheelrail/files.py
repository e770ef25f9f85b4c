"""Readable files with a schema: JSON and CSV in, values in attributes out, or an error with file, line, name and range."""

import json
import math
import re
from collections.abc import Callable
from copy import deepcopy
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

from .tables import BadFile, nearest, number_in, read_table, text_of
from .units import UnitError, converted, headed, named, unit_of
from .warn import warn

FAR = 10.0  # times its usual size a value is doubtful
REFERENCE = 293.15  # K: of excess temperatures, unless thermal.reference is set
SMALL = 100.0  # and by this factor below it, where another unit would make it usual


@dataclass(frozen=True)
class Real:
    """A number from `low` to `high`. Without a `default` it must be given, unless it is `optional`: then it may be None.

    `usual` is its usual size, and `others` are units in which it may be meant by mistake. A value far from its usual size is doubted. A
    `relative` one is a difference, and may be meant as a temperature.
    """

    low: float
    high: float
    unit: str
    about: str
    default: float | None = None
    whole: bool = False
    optional: bool = False
    usual: float | None = None
    others: tuple = ()
    relative: bool = False

    def check(self, value):
        """What is wrong with it."""
        number = isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
        if not number or (self.whole and value != int(value)):
            return f"is {value!r}, not a {'whole ' if self.whole else ''}number"
        if not self.low <= value <= self.high:
            unit = self._unit()
            return f"= {value:g}{unit} is outside {self.low:g} to {self.high:g}{unit}{self._meant(value)}"
        return None

    def doubt(self, value):
        """What is doubtful about a value that is allowed; None if nothing is."""
        if not self.usual or not value or self.usual / SMALL <= abs(value) < FAR * self.usual:
            return None
        meant = self._meant(value)
        if abs(value) < self.usual and not meant:
            return None
        return f"= {value:g}{self._unit()} is far from its usual size of {self.usual:g}{self._unit()} ({self.about}){meant}"

    def _unit(self):
        return f" {self.unit}" if self.unit not in ("", "1") else ""

    def _meant(self, value):
        """Words about the units in which a value would be allowed, and usual if that is known."""
        texts, found = [], {name: unit_of(name).to_si(value) for name in self.others}
        for name, meant in (found | ({"K absolute": value - REFERENCE} if self.relative else {})).items():
            near = self.usual is None or self.relative or self.usual / FAR <= abs(meant) <= FAR * self.usual
            if near and self.low <= meant <= self.high:
                texts.append(f"; if {value:g} {name} {'are' if name else 'is'} meant, write {meant:.6g}")
        return "".join(texts)


@dataclass(frozen=True)
class Text:
    """A text, one of `choices` if there are any."""

    about: str
    default: str | None = None
    choices: tuple = ()

    def check(self, value):
        """What is wrong with the value."""
        if not isinstance(value, str):
            return f"is {value!r}, not a text"
        if self.choices and value not in self.choices:
            return f"= {value!r} is none of {', '.join(self.choices)}"
        return None


@dataclass(frozen=True)
class Flag:
    """true or false."""

    about: str
    default: bool | None = None

    def check(self, value):
        """What is wrong with the value."""
        return None if isinstance(value, bool) else f"is {value!r}, neither true nor false"


@dataclass(frozen=True)
class Setting:
    """A number, a text or a flag: the value of a parameter, whose type and range the FMU knows."""

    about: str
    default: float | None = None

    def check(self, value):
        """What is wrong with the value."""
        known = isinstance(value, str) or isinstance(value, (int, float)) and math.isfinite(value)
        return None if known else f"is {value!r}, no number, text or flag"


@dataclass(frozen=True)
class Several:
    """A list of values of one kind."""

    item: Real | Text
    about: str
    default: tuple | None = None

    def check(self, value):
        """What is wrong with the value."""
        if not isinstance(value, list) or not value:
            return f"is {value!r}, not a list with entries"
        return next((f"entry {wrong}" for wrong in map(self.item.check, value) if wrong), None)


@dataclass(frozen=True)
class Named:
    """An object whose names are free and whose values are of one kind: a field, or a group of fields."""

    item: object
    about: str
    default: dict | None = None


@dataclass(frozen=True)
class Swept:
    """An object whose names are dotted paths to fields and whose values are lists for them. `field_of` gives the field of a path,
    or a text about what is wrong with it; `apart` are names with fields of their own, `common` those that editors offer."""

    field_of: Callable
    about: str
    apart: dict
    common: tuple = ()
    default = None


# Names that every object may have: where its numbers come from, and the schema for editors.
REMARKS = ("source", "$schema")


def read_json(path, schema):
    """The values of a JSON file as attributes. Names that are neither in the schema nor `REMARKS` are errors."""
    path = Path(path)
    text = text_of(path)
    try:
        values = json.loads(text, object_pairs_hook=_once, parse_constant=_refuse)
    except json.JSONDecodeError as error:
        raise BadFile(f"{path}:{error.lineno}: not JSON: {error.msg}") from None
    except RecursionError:
        raise BadFile(f"{path}: nested too deeply") from None
    except ValueError as error:
        raise BadFile(f"{path}: {error}") from None
    return _Reader(path, _lines(text)).group(values, schema, ())


def read_csv(path, columns, wrong=lambda row, before: None):
    """The columns of a CSV file: name to list of values. The first line names them; all of `columns` without default must
    be there, no others. `wrong` says what is wrong with a row, name to value, after the row before it, if there is one."""
    headings, head, rows = read_table(path)
    names, units = zip(*(named(heading, columns) for heading in headings))
    for name in names:
        if name not in columns:
            raise BadFile(f"{path}:{head}: unknown column {name!r}{meant(name, columns)}")
        if names.count(name) > 1:
            raise BadFile(f"{path}:{head}: column {name!r} twice; leave one of them out")
    unit_of = dict(zip(names, units))
    for name, field in columns.items():
        if name not in names and _needed(field):
            raise BadFile(f"{path}:{head}: column {name!r} is missing ({field.about})")
    found, doubted = [], set()
    for line, cells in rows:
        given = dict(zip(names, cells))
        entry = lambda name, field: _entry(path, line, name, field, given[name], unit_of[name]) if name in given else field.default
        row = {name: entry(name, field) for name, field in columns.items()}
        if problem := wrong(row, found[-1] if found else None):
            raise BadFile(f"{path}:{line}: {problem}")
        for name in given.keys() - doubted:
            if doubt := doubt_of(columns[name], row[name]):
                doubted.add(name)
                warn(f"{path}:{line}: {name} {doubt}")
        found.append(row)
    if not found:
        raise BadFile(f"{path}:{head + 1}: no line of values")
    return {name: [row[name] for row in found] for name in columns}


def json_schema(schema):
    """The schema as JSON Schema (2020-12), for editors that complete and check."""
    properties = {name: _describe(field) for name, field in schema.items()}
    required = [name for name, field in schema.items() if _needed(field)]
    properties |= {name: {"type": "string"} for name in REMARKS}
    return {"type": "object", "additionalProperties": False, "required": required, "properties": properties}


def _describe(field):
    """JSON Schema of one field."""
    if isinstance(field, dict):
        return json_schema(field)
    about = {"description": f"{field.about} [{field.unit}]" if isinstance(field, Real) else field.about}
    if field.default is not None:
        about["default"] = field.default
    match field:
        case Real():
            kind = "integer" if field.whole else "number"
            return {"type": kind, "minimum": field.low, "maximum": field.high} | about
        case Text():
            return {"type": "string"} | ({"enum": list(field.choices)} if field.choices else {}) | about
        case Flag():
            return {"type": "boolean"} | about
        case Setting():
            return {"type": ["number", "string", "boolean"]} | about
        case Several():
            return {"type": "array", "minItems": 1, "items": _describe(field.item)} | about
        case Named():
            return {"type": "object", "additionalProperties": _describe(field.item)} | about
        case Swept():
            lists = {name: Several(field.field_of(name), f"values of {name}") for name in field.common}
            properties = {name: _describe(item) for name, item in (lists | field.apart).items()}
            properties |= {name: {"type": "string"} for name in REMARKS}
            return {"type": "object", "properties": properties, "additionalProperties": {"type": "array", "minItems": 1}} | about
    raise TypeError(f"no JSON Schema for {field!r}")


def _needed(field):
    """Whether a field, or any field of a group, must be given."""
    if isinstance(field, dict):
        return any(map(_needed, field.values()))
    return field.default is None and not getattr(field, "optional", False) and not isinstance(field, Swept)


class _Reader:
    """Checks the values of one file against a schema."""

    def __init__(self, path, lines):
        self.path, self.lines = path, lines

    def fail(self, place, problem):
        """Raises with file, line and name."""
        name = ".".join(map(str, place)) or "the file"
        raise BadFile(f"{self.path}:{self.line(place)}: {name} {problem}")

    def line(self, place):
        """Line of a name, or of what it is in."""
        return self.lines[next(place[:n] for n in range(len(place), -1, -1) if place[:n] in self.lines)]

    def group(self, values, schema, place):
        """An object whose names the schema lists."""
        if not isinstance(values, dict):
            self.fail(place, f"is {values!r}, not an object")
        for name in values:
            if name not in schema and name not in REMARKS:
                self.fail((*place, name), f"is unknown{meant(name, schema)}")
        return SimpleNamespace(**{name: self.one(values, name, field, place) for name, field in schema.items()})

    def one(self, values, name, field, place):
        """The value of one name."""
        place = (*place, name)
        if name not in values:
            if isinstance(field, dict) and not _needed(field):
                return self.group({}, field, place)
            if _needed(field):
                about = "" if isinstance(field, dict) else f" ({field.about})"
                self.fail(place, f"is missing{about}")
            return self.swept({}, field, place) if isinstance(field, Swept) else deepcopy(field.default)
        value = values[name]
        if isinstance(field, dict):
            return self.group(value, field, place)
        if isinstance(field, Named):
            return self.named(value, field, place)
        if isinstance(field, Swept):
            return self.swept(value, field, place)
        wrong = field.check(value)
        if wrong:
            self.fail(place, wrong)
        if doubt := doubt_of(field, value):
            warn(f"{self.path}:{self.line(place)}: {'.'.join(map(str, place))} {doubt}")
        return number(value, field)

    def named(self, value, field, place):
        """An object with free names."""
        if not isinstance(value, dict):
            self.fail(place, f"is {value!r}, not an object")
        return {name: self.one(value, name, field.item, place) for name in value if name not in REMARKS}

    def swept(self, value, field, place):
        """Lists for dotted paths, as attributes; those that stand apart are there in any case."""
        if not isinstance(value, dict):
            self.fail(place, f"is {value!r}, not an object")
        found = {name: self.one(value, name, item, place) for name, item in field.apart.items()}
        for name in value:
            if name in (*REMARKS, *field.apart):
                continue
            kind = field.field_of(name)
            if isinstance(kind, str):
                self.fail((*place, name), kind)
            found[name] = self.one(value, name, Several(kind, f"values of {name}"), place)
            for entry in found[name]:
                if found[name].count(entry) > 1:
                    self.fail((*place, name), f"entry {entry!r} is there twice")
        return SimpleNamespace(**found)


def number(value, field):
    """The value; numbers that need not be whole are floats, however they are written, for arrays of integers cut off what is
    put into them."""
    if isinstance(field, Several):
        return [number(entry, field.item) for entry in value]
    return (int(value) if field.whole else float(value)) if isinstance(field, Real) else value


def _once(pairs):
    """An object, unless a name comes twice."""
    names = [name for name, _ in pairs]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"{name} twice in one object")
    return dict(pairs)


def _refuse(constant):
    """NaN and infinities are no JSON."""
    raise ValueError(f"{constant} is not a number")


def doubt_of(field, value):
    """What is doubtful about a value of a field."""
    if isinstance(field, Several):
        return next((f"entry {doubt}" for doubt in (doubt_of(field.item, entry) for entry in value) if doubt), None)
    return field.doubt(value) if isinstance(field, Real) else None


def meant(name, known):
    """A hint at a name that resembles the unknown one."""
    base, unit = headed(name)
    if unit is not None and base in known:
        return f": write {base!r}, and its value in {getattr(known[base], 'unit', '') or 'no unit' if hasattr(known, 'items') else 'SI units'}"
    return nearest(name, known) or f"; known: {', '.join(known)}"


def _entry(path, line, name, field, text, unit):
    """One entry of a CSV file, in a unit that the heading of its column may name."""
    if unit and not isinstance(field, Real):
        raise BadFile(f"{path}:{line}: {name} is no number: take the unit {unit!r} out of its heading")
    value = number_in(path, line, name, text) if isinstance(field, Real) else text
    try:
        value = converted(name, value, unit, getattr(field, "unit", ""), getattr(field, "relative", False))
    except UnitError as error:
        raise BadFile(f"{path}:{line}: {error}") from None
    wrong = field.check(value)
    if wrong:
        raise BadFile(f"{path}:{line}: {name} {wrong}")
    return value


_TOKEN = re.compile(r'"(?:\\.|[^"\\])*"|[{}\[\]:,]|[^\s{}\[\]:,"]+')


def _lines(text):
    """Line of every name in a valid JSON text: (names from the outside in) to line, from 1."""
    found, place, expecting = {(): 1}, [], False
    kinds, key = [], None
    for token in _TOKEN.finditer(text):
        word = token.group()
        if word in "{[":
            kinds.append(word)
            place.append(key)
            key, expecting = None, word == "{"
        elif word in "}]":
            kinds.pop()
            key = place.pop()
            expecting = False
        elif word == ",":
            expecting = bool(kinds) and kinds[-1] == "{"
        elif word != ":" and expecting:
            key, expecting = json.loads(word), False
            names = tuple(name for name in (*place, key) if name is not None)
            found[names] = text.count("\n", 0, token.start()) + 1
    return found
