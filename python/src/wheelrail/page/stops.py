"""Stops of a train as a page shows them: curves of the coach and of every axle, and key figures side by side.

A stop is the table of `train.Stop.run`.
"""

import numpy as np

from .. import report, train
from ..report import column
from ..units import converted
from .charts import chart, trace
from .units import CELSIUS, KMH, PERCENT, Shown, number, shown

# Columns in °C of the files of `train`, and those in K of the table that they are made from.
IN_CELSIUS = {column: name for name, (column, _) in report.IN_CELSIUS.items()}
BAR = Shown("bar", 1e-5)


def reached(table):
    """Distance and time of a stop until it rests as a text."""
    known = report.figures(table)
    return f"{number(known['stopping distance'][0])} m in {number(known['stopping time'][0])} s"


def _of_table(name):
    """The name that a column of a CSV has in a table."""
    kind, _, axle = name.rpartition("_")
    return f"{IN_CELSIUS[kind]}_{axle}" if kind in IN_CELSIUS else name


def _columns(names):
    """Columns of the table that has these axles."""
    return train.columns(max(1, sum(name.startswith("peripheral_") for name in names) // train.AXLES))


def recognised(names):
    """Whether these are the columns of a stop."""
    names = {_of_table(name) for name in names}
    return names >= set(_columns(names))


def of_columns(columns):
    """The table of the columns of a CSV: name to (unit or None, values). Those in °C become the ones in K, unknown ones 0 K."""
    found = {}
    for name, (unit, values) in columns.items():
        kind, own = name.rpartition("_")[0], _of_table(name)
        if own != name:
            unit, values = "K", np.nan_to_num(converted(name, values, unit or "°C", "K"))
        of = train.OF_VEHICLE.get(own) or train.OF_AXLE.get(own.rpartition("_")[0]) or (train.COUPLER if kind == "coupler" else None)
        found[own] = converted(name, values, unit, of[0]) if of else values
    return np.column_stack([found[name] for name in _columns(found)])


def _axles(table, name):
    """A column of every axle, by words."""
    return {f"axle {k + 1}": column(table, name, k) for k in report.axles_of(table)}


def _couplers(table):
    """Forces of the couplers, by words."""
    return {f"coupler {k}": column(table, f"coupler_{k}") for k in range(1, report.coaches_of(table))}


def charts(table, among):
    """Charts of a stop, in units that fit the stops `among` which it is, too."""
    each = lambda name: _axles(table, name)
    fitting = lambda unit, of, *name: shown(unit, *(values for other in among for values in of(other, *name).values()))
    slide = {f"axle {k + 1}": np.where(moving, values, np.nan) for k in report.axles_of(table) for values, moving in [report.slide(table, k)]}
    used = {axle: -each("force")[axle] / np.where(load > 0.0, load, np.nan) for axle, load in each("load").items()}
    hot = {axle: np.where(v > 0.0, v, np.nan) for axle, v in each("hottest").items()}
    groups = [
        ("Speed of travel and of the treads", {"coach": column(table, "speed"), **each("peripheral")}, KMH, ""),
        ("Slide", slide, PERCENT, "(V − rω)/V, drawn above 1 m/s."),
        ("Pressure in the cylinders", {"control": column(table, "control_pressure"), **each("pressure")}, BAR, "Over ambient."),
        ("Adhesion used", used, Shown(""), "Braking force over load."),
        ("Friction of the rail that the axle meets", each("friction"), Shown(""), ""),
        ("Hottest place of the contact", hot, CELSIUS, ""), ("Energy of friction so far", each("energy"), fitting("J", _axles, "energy"), "Both wheels."),
        ("Load on the rails", each("load"), fitting("N", _axles, "load"), "Both wheels."),
        ("Torque of the brake", each("torque"), fitting("N.m", _axles, "torque"), ""),
        ("Force of the couplers", _couplers(table), fitting("N", _couplers), "Tension positive."),
    ]  # fmt: skip
    found = []
    for title, curves, unit, note in groups:
        curves = {name: v for name, v in curves.items() if np.isfinite(v).any()}
        if curves:
            found.append(chart(title, unit.label, _curves(column(table, "time"), curves, unit), note))
    return found


def _curves(time, curves, unit):
    """Curves of the coach (colour −1, that of the text) and of axles."""
    axle = lambda name: int(name.split()[1]) - 1 if name.split()[-1].isdigit() else -1
    return [trace(time, unit(v), name, axle(name), dash="solid" if axle(name) >= 0 else "dash") for name, v in curves.items()]


def side_by_side(found):
    """Charts in which all stops are: speed over time and over distance."""
    over = lambda name: [trace(column(t, name), KMH(column(t, "speed")), stop, k) for k, (stop, t) in enumerate(found.items())]
    return [
        chart("Speed of the train", "km/h", over("time")),
        chart("Speed over the distance", "km/h", over("travelled"), x="distance [m]"),
    ]


def figures(found):
    """Key figures of stops as rows of texts, the first one the head."""
    known = {name: report.figures(table) for name, table in found.items()}
    names = list(known)
    rows = [["", *names]]
    for figure, (_, unit) in known[names[0]].items():
        label = figure if unit in ("", "1") else f"{figure} [{unit}]"
        rows.append([label, *(_cell(known[name][figure][0]) if figure in known[name] else "–" for name in names)])
    return rows


def _cell(value, digits=4):
    """One number, or one per axle; what is unknown is a dash."""
    if isinstance(value, list):
        cells = [_cell(v, 3) for v in value]
        return "–" if set(cells) == {"–"} else " · ".join(cells)
    if isinstance(value, str):
        return value
    return "–" if not np.isfinite(value) else number(value, digits)
