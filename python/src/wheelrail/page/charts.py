"""Curves of a run in groups that belong together, thinned so that no extreme is lost."""

import math

import numpy as np

from .units import CELSIUS, KMH, PERCENT, shown

POINTS = 1200  # buckets of a curve, of each of which the lowest and the highest value are kept
ROLLING = 1.0  # m/s: ratios of speeds are drawn above this speed, or above a twentieth of the highest one

# Title, variables, unit; None: that of the variables.
GROUPS = (
    ("Speed", ("wheel.velocity", "peripheral"), KMH),
    ("Creepage and slide", ("contact.creepage", "contact.slide"), PERCENT),
    ("Slip", ("contact.slip_velocity", "contact.tread_slip"), None),
    ("Forces along the rail, on the wheel", ("contact.force_x", "hub.force_x"), None),
    ("Vertical forces on the wheel", ("contact.force_y", "hub.force_y"), None),
    ("Moments on the wheel", ("contact.moment", "hub.moment", "brake.torque_actual"), None),
    ("Friction and adhesion", ("contact.friction", "contact.adhesion", "rail.friction"), None),
    ("Use of the friction limit, share that sticks", ("contact.utilisation", "contact.stick_fraction"), PERCENT),
    ("Temperatures", (
        "temperature.wheel_max", "temperature.rail_max", "temperature.friction", "temperature.wheel_mean",
        "temperature.rail_mean", "temperature.wheel_bulk", "temperature.wheel_nominal", "temperature.rail_nominal"), CELSIUS),
    ("Heat flows", (
        "heat.friction_power", "heat.to_wheel", "heat.to_rail", "heat.conduction", "heat.to_air", "heat.to_hub"), None),
    ("Energy since the start", (
        "energy.stored", "energy.brake", "energy.hub_work", "energy.friction", "energy.damping", "energy.plastic",
        "energy.gravity", "energy.rail_work", "energy.thermal_work"), None),
    ("Residuals: energy and heat not accounted for", ("solver.energy_residual", "solver.heat_residual"), PERCENT),
    ("Half-width of the patch", ("contact.half_width",), None),
    ("Peak pressure", ("contact.pressure_max",), None),
)  # fmt: skip
# Figures that a reader wants first: those of motion and forces, and those of heat, which have a place of their own.
FIRST = (
    "Speed", "Creepage and slide", "Forces along the rail, on the wheel", "Vertical forces on the wheel", "Friction and adhesion",
    "Peak pressure",
)  # fmt: skip
HOT, HEATED = "hot", ("Temperatures", "Heat flows")
HIDDEN = {
    "temperature.wheel_mean",
    "temperature.rail_mean",
    "temperature.wheel_nominal",
    "temperature.rail_nominal",
    "contact.slide",
}
RATIOS = ("contact.creepage", "contact.slide")
NAMES = {
    "wheel.velocity": "travel V", "peripheral": "tread rω", "contact.slip_velocity": "V − rω",
    "contact.tread_slip": "tread on rail", "contact.force_x": "contact", "hub.force_x": "hub", "contact.force_y": "contact",
    "hub.force_y": "hub", "contact.moment": "contact", "hub.moment": "hub", "brake.torque_actual": "brake",
    "contact.friction": "friction coefficient μ", "contact.adhesion": "adhesion Fx/Fy", "rail.friction": "friction of the rail",
    "contact.utilisation": "friction limit in use", "contact.stick_fraction": "share that sticks",
    "contact.pressure_max": "peak pressure", "contact.half_width": "half-width",
}  # fmt: skip


def thinned(time, values):
    """Indices of at most 2 POINTS + 2 samples with the extremes of every stretch of time; gaps keep their ends."""
    if len(time) <= 2 * POINTS:
        return np.arange(len(time))
    size = -(-len(time) // POINTS)
    filled = np.full(POINTS * size, np.nan)
    filled[: len(values)] = values
    blocks, starts = filled.reshape(POINTS, size), size * np.arange(POINTS)
    gaps = ~np.isfinite(blocks)
    # A gap keeps its first sample, which draws it. The blocks' ends beyond the run are left out.
    low, high = np.where(gaps, np.inf, blocks).argmin(axis=1), np.where(gaps, -np.inf, blocks).argmax(axis=1)
    kept = np.concatenate([starts + low, starts + high, (starts + gaps.argmax(axis=1))[gaps.any(axis=1)], [0, len(time) - 1]])
    return np.unique(kept[kept < len(time)])


def rounded(values, digits=6):
    """Values as a list for JSON, with so many digits; what is not finite is null."""
    return [float(f"{value:.{digits}g}") if math.isfinite(value) else None for value in np.asarray(values, float).tolist()]


def trace(time, values, name, colour, **more):
    """A curve."""
    kept = thinned(time, values)
    return {"name": name, "x": rounded(time[kept], 7), "y": rounded(values[kept]), "colour": colour, **more}


def chart(title, unit, traces, note="", x="time [s]"):
    """A chart of curves with one unit."""
    return {"title": title, "unit": unit, "traces": traces, "note": note, "x": x}


def of_run(run):
    """Charts of a run: those of the groups, and of everything else by the first part of its name and its unit."""
    values = {name: series.values for name, series in run.series.items() if np.isfinite(series.values).any()}
    units = {name: run.series[name].unit for name in values}
    if "wheel.velocity" in values and "contact.slip_velocity" in values:
        values["peripheral"], units["peripheral"] = values["wheel.velocity"] - values["contact.slip_velocity"], "m/s"
    note, slow = "", None
    if "wheel.velocity" in values:
        speed = np.abs(values["wheel.velocity"])
        slow = speed < min(ROLLING, 0.05 * np.nanmax(speed))
        note = "Ratios of speeds, drawn while the wheel travels." if slow.any() else ""
    charts, done = [], set()
    for title, names, unit in GROUPS:
        names = [name for name in names if name in values]
        done.update(names)
        names = [name for name in names if np.any(values[name])] or names[:1]
        drawn = {n: np.where(slow, np.nan, values[n]) if n in RATIOS and slow is not None else values[n] for n in names}
        if names:
            charts.append(
                _group(
                    title, run.time, drawn, unit or shown(units[names[0]], *drawn.values()), note if names[0] in RATIOS else ""
                )
            )
    return charts, _others(run.time, {n: v for n, v in values.items() if n not in done}, units)


def sorted_out(charts):
    """Figures of `of_run` that a reader wants first, those of heat with their place, and the rest; all come first where none else does."""
    hot = [c | {"room": HOT} for c in charts if c["title"] in HEATED]
    first, rest = [c for c in charts if c["title"] in FIRST], [c for c in charts if c["title"] not in (*FIRST, *HEATED)]
    return (first + hot, rest) if first else (rest + hot, [])


def _group(title, time, drawn, unit, note=""):
    """A chart of quantities in one unit."""
    traces = [
        trace(
            time,
            unit(values),
            NAMES.get(name, plain(name)),
            k,
            hidden=name in HIDDEN,
            dash="dash" if name == "peripheral" else "solid",
        )
        for k, (name, values) in enumerate(drawn.items())
    ]
    return chart(title, unit.label, traces, note)


def plain(name):
    """A name without its first part, in words: `temperature.wheel_max` is `wheel max`."""
    return name.split(".", 1)[-1].replace("_", " ")


def _others(time, values, units):
    """Charts of the quantities that belong to no group, those that never change left out."""
    found = {}
    for name, v in values.items():
        if np.nanmax(v) != np.nanmin(v):
            found.setdefault((name.split(".")[0], units[name]), {})[name] = v
    charts = []
    for (room, unit), drawn in found.items():
        how = shown(unit, *drawn.values())
        title = ", ".join(plain(name) for name in drawn) if len(drawn) < 4 else f"{room}, {how.label or 'numbers'}"
        charts.append(_group(f"{room.capitalize()}: {title}" if len(drawn) < 4 else title.capitalize(), time, drawn, how))
    return charts


def constant(run):
    """Quantities that never change: name to (value, unit)."""
    return {
        name: (float(s.values[0]), s.unit)
        for name, s in run.series.items()
        if len(s.values) and np.isfinite(s.values).all() and np.ptp(s.values) == 0.0
    }
