"""Key figures of a stop in the manner of EN 15595: table of several stops side by side, and CSV."""

import math
from itertools import groupby

import numpy as np

from .output import write_columns, write_rows
from .train import AT_REST, AXLES, COUPLER, OF_AXLE, OF_VEHICLE, columns
from .units import ZERO_CELSIUS

MOVING = 1.0  # m/s: slide is a ratio of speeds, it is taken above this one
SLIDING = 0.01  # slide from which an axle counts as sliding
LOCKED_BELOW = 0.1  # m/s, of the periphery
LOCKED_ABOVE = 3.0  # m/s, of travel


def coaches_of(table):
    """How many coaches a table of `Stop.run` is of."""
    return (table.shape[1] - len(OF_VEHICLE) + 1) // (AXLES * len(OF_AXLE) + 1)


def axles_of(table):
    """The axles of a table, counted from 0."""
    return range(AXLES * coaches_of(table))


def column(table, name, axle=None):
    """A column of a table of `Stop.run`, of an axle (from 0) if one is given."""
    return table[:, columns(coaches_of(table)).index(name if axle is None else f"{name}_{axle + 1}")]


def slide(table, axle):
    """Slide (V - r omega)/V of an axle, and whether it moves fast enough for that."""
    velocity = column(table, "velocity", axle)
    moving = velocity > MOVING
    return np.where(moving, 1.0 - column(table, "peripheral", axle) / np.where(moving, velocity, 1.0), 0.0), moving


def figures(table):
    """Key figures of a stop, of a table of `Stop.run`: name to (value or list of one per axle, unit)."""
    time, speed = column(table, "time"), column(table, "speed")
    rest = int(np.argmax(speed < AT_REST)) if np.any(speed < AT_REST) else len(table) - 1
    running, step = table[: rest + 1], time[1] - time[0]
    axles = axles_of(table)
    slides = [slide(running, k) for k in axles]
    sliding = [values[moving & (values > SLIDING)] for values, moving in slides]
    share = lambda values, q: float(np.percentile(values, q)) if len(values) else 0.0
    locked = lambda k: (column(running, "peripheral", k) < LOCKED_BELOW) & (column(running, "velocity", k) > LOCKED_ABOVE)
    adhesion = [-column(running, "force", k) / column(running, "load", k) for k in axles]
    found = {
        "stopping distance": (float(column(table, "travelled")[rest]), "m"),
        "stopping time": (float(time[rest]), "s"),
        "time of slide, over 1 %": ([step * len(values) for values in sliding], "s"),
        "slide while sliding, p50": ([100.0 * share(values, 50) for values in sliding], "%"),
        "slide while sliding, p95": ([100.0 * share(values, 95) for values in sliding], "%"),
        "locked time": ([step * float(np.sum(locked(k))) for k in axles], "s"),
        "longest lock": ([step * longest(locked(k)) for k in axles], "s"),
        "mean adhesion": ([float(np.mean(values)) for values in adhesion], "1"),
        "mean adhesion while sliding": (
            [mean(a[m & (values > SLIDING)]) for a, (values, m) in zip(adhesion, slides)], "1",
        ),
        "energy into rail and tread": ([column(table, "energy", k)[-1] / 1e3 for k in axles], "kJ"),
        "peak temperature": ([float(celsius(column(table, "peak", k))[-1]) for k in axles], "°C"),
        "depth above Ac1": ([1e3 * float(column(table, "ac1_depth", k)[-1]) for k in axles], "mm"),
        "air used": (1e3 * float(column(table, "air")[-1]), "l"),
        "sand used": (float(column(table, "sand")[-1]), "kg"),
        "smallest load": ([1e-3 * float(column(running, "load", k).min()) for k in axles], "kN"),
        "largest load": ([1e-3 * float(column(running, "load", k).max()) for k in axles], "kN"),
        **couplers(table),
        "force on a standing axle, last 0.5 s": (standing(table), "kN"),
    }  # fmt: skip
    return found


def couplers(table):
    """Largest forces of the couplers, if there are any."""
    forces = [column(table, f"coupler_{k + 1}") for k in range(coaches_of(table) - 1)]
    if not forces:
        return {}
    return {
        "largest coupler push": ([-1e-3 * float(force.min()) for force in forces], "kN"),
        "largest coupler pull": ([1e-3 * float(force.max()) for force in forces], "kN"),
    }


def mean(values):
    """Mean, 0 of nothing."""
    return float(np.mean(values)) if len(values) else 0.0


def celsius(values):
    """Temperatures [K] in °C; 0 K stands for one that is unknown, and becomes nan."""
    return np.where(values > 0.0, values - ZERO_CELSIUS, np.nan)


def known(values):
    """Those that are known: a rigid wheelset has no temperature. All, if none is."""
    return [value for value in values if value == value] or values


def longest(flags):
    """Most flags in a row."""
    return max((len(list(run)) for flag, run in groupby(flags) if flag), default=0)


def standing(table):
    """Half the swing of the suspension's force on each axle in the last half second [kN]."""
    late = column(table, "time") > column(table, "time")[-1] - 0.5
    return [0.5e-3 * float(np.ptp(column(table, "pull", k)[late])) for k in axles_of(table)]


def lines(stops):
    """A text table of several stops: name to `figures`. One named `dry` is what the others are compared with."""
    names = list(stops)
    width = 34
    yield f"{'':42}" + "".join(f"{name:>{width}}" for name in names)
    dry = stops["dry"]["stopping distance"][0] if "dry" in stops else math.nan
    extension = [f"{100.0 * (stops[name]['stopping distance'][0] / dry - 1.0):.1f}" for name in names]
    for figure in stops[names[0]]:
        cells = [_cell(stops[name][figure][0]) for name in names]
        yield f"{figure + ' [' + stops[names[0]][figure][1] + ']':42}" + "".join(f"{cell:>{width}}" for cell in cells)
        if figure == "stopping distance" and "dry" in stops:
            yield f"{'extension over dry [%]':42}" + "".join(f"{cell:>{width}}" for cell in extension)


def _cell(value):
    """One entry: a number, or one per axle; of a set of coaches the smallest and the largest."""
    if isinstance(value, list) and len(value) > AXLES:
        return f"{_cell(min(known(value)))} to {_cell(max(known(value)))}"
    if isinstance(value, list):
        return " ".join(f"{_cell(entry):>7}" for entry in value)
    return value if isinstance(value, str) else f"{value:.4g}"


# Columns of files that are not those of the table: temperatures, which a person reads in °C; nan if unknown.
IN_CELSIUS = {
    "hottest": ("contact_celsius", "highest temperature of the wheels in the contact now; nan if unknown"),
    "peak": ("tread_peak_celsius", "highest temperature of the tread so far; nan if unknown"),
}


def write_csv(path, table):
    """Writes a table with a line of plain names, which `write_columns` explains; temperatures in °C."""
    names, values = columns(coaches_of(table)), table.copy()
    for k, name in enumerate(names):
        kind, _, axle = name.rpartition("_")
        if kind in IN_CELSIUS:
            names[k] = f"{IN_CELSIUS[kind][0]}_{axle}"
            values[:, k] = celsius(values[:, k])
    write_rows(path, [names, *([f"{value:.9g}" for value in row] for row in values)])


def described(table):
    """Name, unit and description of the columns that `write_csv` writes."""
    yield from ((name, *about) for name, about in OF_VEHICLE.items())
    for axle in axles_of(table):
        for name, (unit, about) in OF_AXLE.items():
            if name in IN_CELSIUS:
                (name, about), unit = IN_CELSIUS[name], "°C"
            yield f"{name}_{axle + 1}", unit, f"axle {axle + 1}: {about}"
    yield from ((f"coupler_{k + 1}", *COUPLER) for k in range(coaches_of(table) - 1))
