"""Stops of a train as a page shows them: curves of the coach and of every axle, and key figures side by side."""

from dataclasses import dataclass

import numpy as np

from .. import report, train
from ..units import converted
from .charts import chart, trace
from .units import CELSIUS, KMH, PERCENT, Shown, number, shown

# Columns in °C of the files of `train`, and those in K of the table that they are made from.
IN_CELSIUS = {column: name for name, (column, _) in report.IN_CELSIUS.items()}
BAR = Shown("bar", 1e-5)


@dataclass
class Stop:
    """Columns of a stop in SI units: name to values."""

    columns: dict

    def axles(self):
        """Numbers of the axles, from 1."""
        return [k for k in range(1, 1000) if f"peripheral_{k}" in self.columns]

    def travelled(self):
        """Distance to the end [m]."""
        return float(np.nanmax(self.columns["travelled"])) if "travelled" in self.columns else float(self.columns["time"][-1])

    def table(self):
        """The table of `train.Stop.run`, None if a column is missing."""
        names = train.columns(max(1, len(self.axles()) // train.AXLES))
        return np.column_stack([self.columns[n] for n in names]) if all(n in self.columns for n in names) else None


def reached(stop):
    """Distance and time of a stop as a text: until it rests, as everywhere, or where that is not known to its end."""
    table = stop.table()
    if table is None:
        return f"{number(stop.travelled())} m in {number(float(stop.columns['time'][-1]))} s"
    known = report.figures(table)
    return f"{number(known['stopping distance'][0])} m in {number(known['stopping time'][0])} s"


def recognised(names):
    """Whether these are the columns of a stop."""
    return {"time", "speed", "peripheral_1"} <= set(names)


def of_columns(columns):
    """A stop of the columns of a CSV: name to (unit or None, values). Those in °C become the ones in K, unknown ones 0 K."""
    found = {}
    for name, (unit, values) in columns.items():
        kind, _, axle = name.rpartition("_")
        if kind in IN_CELSIUS:
            name, unit, values = f"{IN_CELSIUS[kind]}_{axle}", "K", np.nan_to_num(converted(name, values, unit or "°C", "K"))
        of = train.OF_VEHICLE.get(name) or train.OF_AXLE.get(name.rpartition("_")[0]) or (train.COUPLER if kind == "coupler" else None)
        found[name] = converted(name, values, unit, of[0]) if of else values
    return Stop(found)


def of_table(table):
    """A stop of a table of `train.Stop.run`."""
    return Stop(dict(zip(train.columns(report.coaches_of(table)), np.asarray(table, float).T)))


def charts(stop, among=()):
    """Charts of a stop, in units that fit the stops `among` which it is, too."""
    c, axles, time = stop.columns, stop.axles(), stop.columns["time"]
    fitting = lambda start, unit: shown(unit, *(v for s in among or (stop,) for name, v in s.columns.items() if name.startswith(f"{start}_")))
    each = lambda name: {f"axle {k}": c[f"{name}_{k}"] for k in axles if f"{name}_{k}" in c}
    speeds = {"coach": c["speed"], **each("peripheral")}
    slide = {f"axle {k}": _slide(c[f"velocity_{k}"], c[f"peripheral_{k}"]) for k in axles if f"velocity_{k}" in c}
    used = {
        f"axle {k}": -c[f"force_{k}"] / np.where(c[f"load_{k}"] > 0.0, c[f"load_{k}"], np.nan) for k in axles if f"load_{k}" in c
    }
    pressures = ({"control": c["control_pressure"]} if "control_pressure" in c else {}) | each("pressure")
    hot = {name: np.where(v > 0.0, v, np.nan) for name, v in each("hottest").items()}
    couplers = {name.replace("_", " "): values for name, values in c.items() if name.startswith("coupler_")}
    groups = [
        ("Speed of travel and of the treads", speeds, KMH, ""), ("Slide", slide, PERCENT, "(V − rω)/V, drawn above 1 m/s."),
        ("Pressure in the cylinders", pressures, BAR, "Over ambient."),
        ("Adhesion used", used, Shown(""), "Braking force over load."),
        ("Friction of the rail that the axle meets", each("friction"), Shown(""), ""),
        ("Hottest place of the contact", hot, CELSIUS, ""), ("Energy of friction so far", each("energy"), fitting("energy", "J"), "Both wheels."),
        ("Load on the rails", each("load"), fitting("load", "N"), "Both wheels."),
        ("Torque of the brake", each("torque"), fitting("torque", "N.m"), ""),
        ("Force of the couplers", couplers, fitting("coupler", "N"), "Tension positive."),
    ]  # fmt: skip
    found = []
    for title, curves, unit, note in groups:
        curves = {name: v for name, v in curves.items() if np.isfinite(v).any()}
        if curves:
            found.append(chart(title, unit.label, _curves(time, curves, unit), note))
    return found


def _curves(time, curves, unit):
    """Curves of the coach (colour −1, that of the text) and of axles."""
    axle = lambda name: int(name.split()[1]) - 1 if name.split()[-1].isdigit() else -1
    return [trace(time, unit(v), name, axle(name), dash="solid" if axle(name) >= 0 else "dash") for name, v in curves.items()]


def _slide(velocity, peripheral):
    """Slide, nan where the axle is too slow for a ratio."""
    return np.where(velocity > report.MOVING, 1.0 - peripheral / np.where(velocity > report.MOVING, velocity, 1.0), np.nan)


def side_by_side(found):
    """Charts in which all stops are: speed over time and over distance."""
    over_time = [trace(s.columns["time"], KMH(s.columns["speed"]), name, k) for k, (name, s) in enumerate(found.items())]
    charts = [chart("Speed of the train", "km/h", over_time)]
    if all("travelled" in s.columns for s in found.values()):
        over_way = [trace(s.columns["travelled"], KMH(s.columns["speed"]), name, k) for k, (name, s) in enumerate(found.items())]
        charts.append(chart("Speed over the distance", "km/h", over_way, x="distance [m]"))
    return charts


def figures(found):
    """Key figures of stops as rows of texts, the first one the head; empty if a column is missing."""
    tables = {name: stop.table() for name, stop in found.items()}
    if any(table is None for table in tables.values()):
        return []
    known = {name: report.figures(table) for name, table in tables.items()}
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
