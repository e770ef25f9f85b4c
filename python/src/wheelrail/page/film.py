"""The contact patch over time: pressure, shear, friction limit, slip, temperatures; which parts stick and which slip."""

import numpy as np

from ..grid import STICKS
from . import above
from .charts import rounded
from .units import CELSIUS, KMH, PERCENT, SHAPES, shown

FRAMES = 400  # instants of the film at most
STRIKING = 50.0  # K: a rise on which the map of the patch begins zoomed
STILL = 0.5  # K: a field that changes less is not drawn
# Titles of temperatures over the depth, in plain words.
BELOW = {
    "temperature_wheel_below": "Wheel, below the contact", "temperature_rail_below": "Rail, below the contact",
    "temperature_hottest_below": "Wheel, below its hottest place", "temperature_tread_below": "Wheel, below a point of its tread",
    "peak_temperature": "Highest so far where the wheel was heated in one piece",
}  # fmt: skip
READINGS = (
    ("travel", "wheel.velocity", KMH), ("force along the rail", "contact.force_x", None), ("load", "contact.force_y", None),
    ("friction μ", "contact.friction", None), ("limit in use", "contact.utilisation", PERCENT),
    ("sticks", "contact.stick_fraction", PERCENT), ("hottest, wheel", "temperature.wheel_max", CELSIUS),
)  # fmt: skip


def most_of(rows):
    """The largest value of each row; of rows without any the least of them all, or 0."""
    known = np.isfinite(rows).any(axis=1)
    most = np.where(np.isfinite(rows), rows, -np.inf).max(axis=1)
    return np.where(known, most, most[known].min() if known.any() else 0.0)


def chosen(time, values):
    """Indices of at most `FRAMES` rows, as dense in time as they were recorded, and those of the largest value of each quantity."""
    if len(time) <= FRAMES:
        return np.arange(len(time))
    peaks = {int(np.argmax(most_of(np.abs(v)))) for v in values if np.isfinite(v).any()}
    even = np.linspace(0, len(time) - 1, FRAMES - len(peaks)).round().astype(int)
    return np.array(sorted(peaks | set(even.tolist())))


def of_run(run):
    """Frames of a run in units that are shown: of profiles of pressure over x, of the lines of a patch as its `lines`, or of
    both; None without any."""
    film = _along(run)
    if run.lines is None:
        return film
    if film is None:
        shown_most = [run.lines.values[name] for name in ("pressure_max", "temperature_wheel_max") if name in run.lines.values]
        kept = chosen(run.lines.time, shown_most)
        time = run.lines.time[kept]
        film = {"time": rounded(time, 7), "of": len(run.lines.time), "window": None, "readings": _readings(run, time)}
        film["start"] = int(np.argmax(most_of(shown_most[-1][kept])))
    return film | {"lines": above.of_run(run, np.array(film["time"], float))}


def _along(run):
    """Frames of the profiles along the patch, None without profiles of pressure over x."""
    if run.patch is None or not {"x", "pressure"} <= set(run.patch.values):
        return None
    known = {name: run.patch.values[name] for name in SHAPES if name in run.patch.values}
    if not np.any(known.get("temperature_wheel", 1.0)):
        # A run without heat has temperatures of 0 K.
        known = {name: v for name, v in known.items() if not name.startswith("temperature")}
    kept = chosen(run.patch.time, list(known.values()))
    time, known = run.patch.time[kept], {name: v[kept] for name, v in known.items()}
    x = 1e3 * run.patch.values["x"][kept]
    film = {"time": rounded(time, 7), "x": _rows(x[:1] if np.ptp(x, axis=0).max() < 1e-9 else x), "of": len(run.patch.time)}
    friction = run.at("contact.friction", time)
    pressure_unit = shown("Pa", known["pressure"])
    if friction is not None:
        film["limit"] = _rows(pressure_unit(friction[:, None] * known["pressure"]))
    # What goes across slips, too.
    beside = {name: run.patch.values[f"{name}_z"][kept] for name in ("slip", "shear") if f"{name}_z" in run.patch.values}
    lengths = {name: np.hypot(known[name], across) for name, across in beside.items() if name in known}
    film["state"] = _states(known | lengths, friction).tolist()
    film["units"] = {}
    for name, values in known.items():
        unit = pressure_unit if name == "shear" else CELSIUS if SHAPES[name] == "K" else shown(SHAPES[name], values)
        film[name], film["units"][name] = _rows(unit(values)), unit.label
    film["window"] = _window(time, known)
    film["readings"] = _readings(run, time)
    hottest = known.get("temperature_wheel", known["pressure"])
    film["start"] = int(np.argmax(most_of(hottest)))
    return film


def _window(time, known):
    """Time in which the wheel is hot, with as much before and after it, if that is a small part of the run; else None."""
    if "temperature_wheel" not in known:
        return None
    hottest = most_of(known["temperature_wheel"])
    hot = time[hottest > hottest.min() + 0.1 * np.ptp(hottest)]
    if np.ptp(hottest) < STRIKING or np.ptp(hot) > 0.2 * np.ptp(time):
        return None
    room = max(np.ptp(hot), 0.01 * np.ptp(time))
    return [float(max(time[0], hot[0] - room)), float(min(time[-1], hot[-1] + room))]


def _states(known, friction):
    """0 where nothing touches, 1 where the surfaces stick, 2 where they slip; 3 if neither slip nor friction is known."""
    touches = known["pressure"] > 0.0
    if "slip" in known:
        slips = np.abs(known["slip"]) > STICKS
        if friction is not None:
            slips |= (friction == 0.0)[:, None]
    elif "shear" in known and friction is not None:
        slips = np.abs(known["shear"]) >= 0.9999 * friction[:, None] * known["pressure"]
    else:
        return np.where(touches, 3, 0)
    return np.where(touches, np.where(slips, 2, 1), 0)


def _rows(values):
    """Rows for JSON."""
    return [rounded(row, 5) for row in values]


def _readings(run, time):
    """What stands beside the film: label and one text per frame."""
    found = []
    for label, name, unit in READINGS:
        values = run.at(name, time)
        if values is not None and (unit is not CELSIUS or values.any()):
            how = unit or shown(run.series[name].unit or "1", values)
            found.append([label, how.label, rounded(how(values), 4)])
    return found


def fields(run):
    """Temperatures over depth and time in °C, those of the tread in the order of BELOW, down to where they differ from the coldest by 2 % of the largest rise."""
    found = []
    for name, field in sorted(run.fields.items(), key=lambda item: [*BELOW, item[0]].index(item[0])):
        if name == "martensite":
            continue
        if not np.isfinite(field.values).any() or np.nanmax(field.values) - np.nanmin(field.values) < STILL:
            continue
        kept = chosen(field.time, [field.values])
        values = field.values[kept]
        rise = np.nanmax(np.abs(values - np.nanmin(values)), axis=0)
        warm = np.flatnonzero(rise > 0.02 * max(rise.max(), 1e-9))
        deep = min(len(field.depth), int(warm[-1]) + 2 if len(warm) else len(field.depth))
        found.append({
            "title": BELOW.get(name) or field.meaning or name.replace("_", " ").capitalize(), "note": "", "time": rounded(field.time[kept], 7),
            "depth": rounded(1e3 * field.depth[:deep], 5), "values": _rows(CELSIUS(values[:, :deep].T)),
        })  # fmt: skip
    return found
