"""The contact patch seen from above, on a grid between its lines: pressure, shear, slip, stick and temperatures over time."""

import base64

import numpy as np

from ..grid import edges, laid
from .charts import rounded
from .units import CELSIUS, SHAPES, shown

ALONG, ACROSS = 49, 25  # places of the grid
FINER = 3  # times as many in the picture, with values in between
LEVELS = 8000  # whole numbers for the values of a quantity


def of_run(run, time):
    """Frames of the lines of a run's patch at times [s], in units that are shown: rows over the lines.

    `z` and `half_length` [mm]; `edges` [mm] between the lines, half way, and at the sides of the patch; `pressure`, the largest
    of each line; `adheres` [mm], how far along the rail a line sticks from its leading edge, and `ahead`, on which side that
    is; `temperature_wheel` and `temperature_rail` [°C], the highest of each line, unless the run has no heat. `grid` has
    what lies between the lines (`_grid`). `shear` and `slip`, each a pair of rows along and across, are the mean traction on the wheel and the mean slip of each line, where
    anything goes across.
    """
    at = {name: _at(run.lines, name, time) for name in run.lines.values}
    pressure, between = shown("Pa", at["pressure_max"]), edges(at["position"], run.at("contact.width", time))
    rows = {"z": 1e3 * at["position"], "half_length": 1e3 * at["half_length"], "edges": 1e3 * between}
    rows["pressure"] = pressure(at["pressure_max"])
    units = {"pressure": pressure.label}
    if "stick_fraction" in at:
        rows["adheres"] = 2.0 * rows["half_length"] * at["stick_fraction"]
    for body in ("wheel", "rail"):
        hottest = at.get(f"temperature_{body}_max")
        # A run without heat has temperatures of 0 K.
        if hottest is not None and np.any(hottest):
            rows[f"temperature_{body}"] = CELSIUS(hottest)
    found = {name: [rounded(row, 5) for row in values] for name, values in rows.items()}
    arrows, arrow_units = _arrows(at, rows)
    return found | arrows | {"ahead": _ahead(run, time), "units": units | arrow_units, "grid": _grid(run, time, at, between)}


def _grid(run, time, at, between):
    """Quantities between the lines, whose strips meet at `between` [m], at the recorded instants nearest to some times: places `x` and
    `z` [mm]; `rim`, the ends of the patch along the rail at `finer` times as many places across; and for each quantity its unit, least
    and largest value and, packed, its values as whole numbers up to LEVELS, those unknown beyond it.

    Of a run without profiles of its lines only the pressure is known, as half an ellipse along each line.
    """
    half = at["half_length"]
    reach, margin = 1.06 * max(half.max(), 1e-6), 0.03 * float(np.ptp(between))
    x, z = np.linspace(-reach, reach, ALONG), np.linspace(between.min() - margin, between.max() + margin, ACROSS)
    rim = np.linspace(z[0], z[-1], FINER * (ACROSS - 1) + 1)
    sides = between[:, [0, -1]]
    frames = [laid(*_lines(run, at, k, t, reach), at["position"][k], half[k], sides[k], x, z, rim) for k, t in enumerate(time)]
    known = [name for name in frames[0] if name.removesuffix("_z") in (*SHAPES, "state")]
    names = known if run.across is not None else ["pressure"]
    found = {name: _levels(name, np.array([frame[name] for frame in frames])) for name in names}
    ends = [[rounded(1e3 * frame["rim"][:, k], 4) for k in (0, 1)] for frame in frames]
    places = {"x": rounded(1e3 * x, 5), "z": rounded(1e3 * z, 5), "finer": FINER, "rim": ends}
    return places | {"quantities": {name: v for name, v in found.items() if v}}


def _lines(run, at, k, instant, reach):
    """Quantities of the lines in a frame, (line, node), and the places of the nodes [m]."""
    if run.across is None:
        nodes = np.linspace(-1.2 * reach, 1.2 * reach, 61)
        share = np.clip(1.0 - (nodes / np.maximum(at["half_length"][k][:, None], 1e-12)) ** 2, 0.0, None)
        return {"pressure": at["pressure_max"][k][:, None] * np.sqrt(share)}, nodes
    sample = int(np.abs(run.lines.time - instant).argmin())
    return {name: v[sample] for name, v in run.across.values.items() if name != "x"}, run.across.values["x"]


def _levels(name, values):
    """A quantity in the unit that is shown, as whole numbers; None where it has none, as temperatures of a run without heat."""
    unit = SHAPES.get(name.removesuffix("_z"), "")
    if unit == "K" and not np.any(np.nan_to_num(values)):
        return None
    how = CELSIUS if unit == "K" else shown(unit, values) if unit else None
    values = values if how is None else how(values)
    low, high = (0.0, 2.0) if how is None else (float(np.nanmin(values)), float(np.nanmax(values)))
    share = (values - low) / ((high - low) or 1.0)
    whole = np.where(np.isfinite(values), np.floor(np.nan_to_num(share) * LEVELS), LEVELS + 1).astype("<u2")
    packed = base64.b64encode(whole.tobytes()).decode()
    return {"unit": how.label if how else "", "low": low, "high": high, "levels": LEVELS, "packed": packed}


def _arrows(at, rows):
    """Mean shear and slip of the lines along and across, and their units; nothing where nothing goes across."""
    if not {"force_x", "force_z", "tread_slip", "tread_slip_z"} <= set(at) or not np.any(at["force_z"]):
        return {}, {}
    area = 2.0 * at["half_length"] * (1e-3 * np.diff(rows["edges"], axis=1))
    shear = [np.divide(at[name], area, out=np.zeros_like(area), where=area > 0.0) for name in ("force_x", "force_z")]
    found, units = {}, {}
    for name, unit, pair in (("shear", "Pa", shear), ("slip", "m/s", [at["tread_slip"], at["tread_slip_z"]])):
        how = shown(unit, np.hypot(*pair))
        found[name], units[name] = [[rounded(row, 5) for row in how(part)] for part in pair], how.label
    return found, units


def _at(lines, name, time):
    """A quantity of the lines at other times."""
    return np.column_stack([np.interp(time, lines.time, column) for column in lines.values[name].T])


def _ahead(run, time):
    """1 where the wheel travels ahead, -1 where it travels back."""
    velocity = run.at("wheel.velocity", time)
    return [1] * len(time) if velocity is None else np.where(velocity < 0.0, -1, 1).tolist()
