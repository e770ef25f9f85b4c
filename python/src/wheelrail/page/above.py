"""The contact patch seen from above: its lines side by side, with their pressure, stick and temperature over time."""

import numpy as np

from .charts import rounded
from .units import CELSIUS, shown


def of_run(run, time):
    """Frames of the lines of a run's patch at times [s], in units that are shown: rows over the lines.

    `z` and `half_length` [mm]; `edges` [mm] between the lines, half way, and at the sides of the patch; `pressure`, the largest
    of each line; `adheres` [mm], how far along the rail a line sticks from its leading edge, and `ahead`, on which side that
    is; `temperature_wheel` and `temperature_rail` [°C], the highest of each line, unless the run has no heat. `shear` and
    `slip`, each a pair of rows along and across, are the mean traction on the wheel and the mean slip of each line, where
    anything goes across.
    """
    at = {name: _at(run.lines, name, time) for name in run.lines.values}
    pressure = shown("Pa", at["pressure_max"])
    rows = {"z": 1e3 * at["position"], "half_length": 1e3 * at["half_length"], "edges": 1e3 * _edges(run, at["position"], time)}
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
    return found | arrows | {"ahead": _ahead(run, time), "units": units | arrow_units}


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


def _edges(run, position, time):
    """Where strips of the lines meet [m]; without contact.width the outermost ones are as wide as half of them is known to be."""
    middle = 0.5 * (position[:, 1:] + position[:, :-1])
    first, last = 2.0 * position[:, :1] - middle[:, :1], 2.0 * position[:, -1:] - middle[:, -1:]
    if run.has("contact.width"):
        # Positions may begin anywhere, as those of a table of rows do.
        beyond = 0.5 * (np.interp(time, run.time, run.get("contact.width"))[:, None] - (last - first))
        first, last = np.minimum(first - beyond, position[:, :1]), np.maximum(last + beyond, position[:, -1:])
    return np.hstack([first, middle, last])


def _ahead(run, time):
    """1 where the wheel travels ahead, -1 where it travels back."""
    velocity = run.get("wheel.velocity")
    return [1] * len(time) if velocity is None else np.where(np.interp(time, run.time, velocity) < 0.0, -1, 1).tolist()
