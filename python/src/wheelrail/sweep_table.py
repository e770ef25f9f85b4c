"""Files of a sweep: rows as they come, what a stop that was interrupted had done, what the columns are.

A row names the scenario it belongs to by a fingerprint, so that rows of another one are never taken for its own.
"""

import csv
import json
import os
from io import StringIO

from .files import BadFile, Flag, Real, Several
from .output import append, write_columns, write_rows
from .scenario import field_of

SCENARIO = "scenario"
REASON = "reason"  # why a stop has no results
DRY, EXTENSION = "dry distance", "extension over dry"
# Results of a stop: name to unit and meaning. Where there is one value per axle it is that of the worst axle.
RESULTS = {
    "stopping distance": ("m", "from the demand to standstill"),
    "stopping time": ("s", "from the demand to standstill"),
    "slide while sliding, p95": ("%", "slide over 1 % that is not exceeded for 95 % of its time, largest of the axles"),
    "longest lock": ("s", "of an axle below 0.1 m/s while the coach was faster than 3 m/s"),
    "mean adhesion": ("1", "used over the whole stop, smallest of the axles"),
    "energy into rail and tread": ("kJ", "of friction, largest of the axles"),
    "peak temperature": ("°C", "of the tread, largest of the axles; nan if unknown"),
    "depth above Ac1": ("mm", "of the tread, largest of the axles"),
    "air used": ("l", "of all cylinders, at ambient pressure"),
}
OVER_DRY = {
    DRY: ("m", "stopping distance on dry rail with the same speed, load and brake; nan if it is not known"),
    EXTENSION: ("%", "by which the stop is longer than the dry one; nan if that is not known"),
}
OF_DRY = {name: RESULTS[name] for name in ("stopping distance", "stopping time")}


def cell(value):
    """A value as text."""
    return value if isinstance(value, str) else json.dumps(value) if isinstance(value, bool | list | tuple) else repr(value)


def shown(value):
    """A value as a person reads it."""
    return f"{value:g}" if isinstance(value, int | float) and not isinstance(value, bool) else cell(value)


def parsed(key, text):
    """The value of a swept key in a file."""
    field = field_of(key)
    if isinstance(field, Flag | Several):
        return json.loads(text)
    return (int(text) if field.whole else float(text)) if isinstance(field, Real) else text


class Table:
    """Rows in a file at `path`, of the scenario named `name`: values of `keys`, then those of `results`. Rows that are there are
    read; a torn last line is cut off; those of another scenario are an error."""

    def __init__(self, path, name, keys, results):
        self.path, self.name, self.keys, self.results = path, name, list(keys), list(results)
        self.rows = self._read()

    def header(self):
        """Names of the columns."""
        return [SCENARIO, *self.keys, *self.results]

    def has(self, point):
        """Whether there is a row of a point."""
        return self.identity(point) in {self.identity(row) for row in self.rows}

    def identity(self, row):
        """What tells a row from others."""
        return tuple(cell(row[key]) for key in self.keys)

    def add(self, row):
        """Writes a row at once."""
        new, text = not self.path.is_file() or not self.path.stat().st_size, StringIO(newline="")
        csv.writer(text).writerows([*([self.header()] if new else []), self._line(row)])
        append(self.path, text.getvalue())
        self.rows.append(row)

    def rewrite(self):
        """Writes all rows anew, or leaves the file as it was."""
        write_rows(self.path, [self.header(), *map(self._line, self.rows)])

    def _line(self, row):
        return [self.name, *(cell(row[name]) for name in self.header()[1:])]

    def _read(self):
        """Rows of the file."""
        if not self.path.is_file():
            return []
        text = self.path.read_bytes()
        if not text.endswith(b"\n"):
            text = text[: text.rfind(b"\n") + 1]
            os.truncate(self.path, len(text))
        text = text.decode()
        rows, other = list(csv.DictReader(text.splitlines())), "; add --force to begin anew, or take another --out"
        for line, row in enumerate(rows, start=2):
            if list(row) != self.header():
                raise BadFile(f"{self.path}:1: not the columns of this sweep but {', '.join(map(str, row))}{other}")
            if row[SCENARIO] != self.name:
                raise BadFile(f"{self.path}:{line}: a row of another scenario ({row[SCENARIO]}, this is {self.name}){other}")
        try:
            return [{k: parsed(k, row[k]) for k in self.keys} | {k: float(row[k]) for k in self.results} for row in rows]
        except (ValueError, TypeError) as error:
            raise BadFile(f"{self.path}: a row cannot be read: {error}{other}") from None


def write_unfinished(path, name, keys, failed):
    """Names stops without results in a file; without any there is no file."""
    if not failed:
        path.unlink(missing_ok=True)
        return
    rows = ([name, *(cell(row.get(key, "")) for key in keys), row[REASON]] for row in failed)
    write_rows(path, [(SCENARIO, *keys, REASON), *rows])


def write_meanings(path, keys):
    """Explains the columns."""
    rows = [(SCENARIO, "", "fingerprint of all files, swept values apart")]
    rows += [(key, getattr(field_of(key), "unit", ""), field_of(key).about) for key in keys]
    rows += [(name, *about) for name, about in (RESULTS | OVER_DRY).items()]
    write_columns(path, rows)
