"""Example 1: a wheel brakes from 100 km/h to standstill, across leaves on the rail. Result table, CSV and picture.

    make demo

1. The wheel rolls freely under its load and carries its share of the vehicle.
2. The torque of the brake is ramped up and held, well within the adhesion of dry rail.
3. Leaves lie on a few metres of the rail: the wheel locks. On the dry rail behind them it stays locked, because the contact is
   so hot that friction does not turn it again.
4. The driver sees it, releases the brake, waits until the wheel rolls, and brakes again. A flat remains.
5. At walking speed the brake is eased; it holds the wheel at rest, while the vehicle swings out on the elasticity of wheel and
   rail.
6. Outputs of every step become a table and a CSV; profiles across the contact patch become a film, drawn by `ex01_picture.py`.
7. All of it becomes a page to look at in a browser, with the patch as a film: `results/report.html`.

Without leaves: --dry. A torque beyond the adhesion limit then locks the wheel until it stands: --dry --utilisation 1.5.
"""

import argparse
import csv
import sys
import time
from pathlib import Path

import numpy as np
from tqdm import tqdm

from ex01_picture import draw
from wheelrail import Fmu, Refused, Wheel, output, page
from wheelrail.page.run import Profiles, of_table

# Recorded across the contact patch.
PROFILES = ("x", "pressure", "shear", "slip", "temperature_wheel", "temperature_rail")

# Recorded at every communication point.
COLUMNS = (
    "wheel.velocity", "wheel.omega", "wheel.distance", "wheel.acceleration", "wheel.angular_acceleration",
    "contact.force_x", "contact.force_y", "contact.moment", "contact.creepage", "contact.slip_velocity",
    "contact.adhesion", "contact.utilisation", "contact.stick_fraction", "contact.half_width",
    "contact.pressure_max", "contact.approach", "hub.force_x", "hub.force_y", "hub.moment",
    "temperature.wheel_max", "temperature.rail_max", "temperature.wheel_mean", "temperature.rail_mean",
    "temperature.wheel_nominal", "temperature.rail_nominal", "temperature.wheel_bulk",
    "heat.friction_power", "heat.to_wheel", "heat.to_rail", "heat.conduction", "contact.friction",
    "rail.friction", "brake.torque", "damage.t_gamma", "damage.time_above_ac1", "damage.flattening",
    "solver.energy_residual", "solver.heat_residual",
    "heat.to_hub", "wheel.mass", "wheel.inertia", "energy.hub_work", "energy.thermal_work", "energy.stored", "energy.brake",
    "energy.friction", "energy.plastic", "energy.damping",
)  # fmt: skip

ROLL = 0.2  # s of free rolling before the brake is applied
RAMP = 0.5  # s, in which the torque of the brake builds up
LEAVES = (150.0, 160.0)  # m from the start, between which leaves lie on the rail ...
SLIPPERY = 0.08  # ... with this friction coefficient, cold
PATIENCE = 1.2  # s, for which a wheel is locked before the driver releases the brake
ROLLS = 0.97  # peripheral over travelling speed, from which a wheel counts as rolling again
EASE_SPEED = 1.0  # m/s, below which the brake is eased in proportion to the speed ...
EASE_TO = 0.1  # ... down to this share of the torque
HOLD = 0.5  # s, for which the wheel is watched after standstill
TOO_LONG = 600.0  # s
AT_REST = 0.01  # m/s: slower counts as standstill
KELVIN = 273.15  # K at 0 °C
ROLLING = 1.0  # m/s: creepage is a ratio of speeds, its peak is taken above this one
SLIDING = 0.01  # creepage, from which a film is taken with many pictures
FAST, SLOW = 5e-3, 0.1  # s between pictures of a film while the wheel slides, and else


class Driver:
    """A driver who brakes with `torque` [N m], eases it at walking speed, and releases a wheel locked for `patience` [s]."""

    def __init__(self, torque, radius, patience=np.inf):
        self.torque, self.radius, self.patience = torque, radius, patience
        self.since, self.locked, self.released = ROLL, None, False

    def brake(self, row):
        """The torque [N m] for the next step, after a row of outputs by name."""
        time, speed, peripheral = row["time"], row["wheel.velocity"], self.radius * row["wheel.omega"]
        if peripheral > 0.0 or speed < ROLLING:
            self.locked = None
        elif self.locked is None:
            self.locked = time
        if self.locked is not None and time - self.locked > self.patience:
            self.released = True
        if self.released and peripheral > ROLLS * speed:
            self.since, self.released = time, False
        if self.released:
            return 0.0
        built_up, eased = min(max((time - self.since) / RAMP, 0.0), 1.0), min(max(speed / EASE_SPEED, EASE_TO), 1.0)
        return self.torque * built_up * eased


def brake_to_standstill(wheel, torque, step, see=lambda wheel, row: None, leaves=None, patience=np.inf):
    """Brakes a rolling wheel with `torque` [N m] (positive) until it rests; returns a table of COLUMNS over time.

    `leaves` are the distances [m] between which they lie, `patience` [s] is the driver's. `see(wheel, row)` is called after
    every step.
    """
    driver = Driver(torque, wheel.get("wheel.radius"), patience)
    dry = wheel.get("rail.friction")
    read = lambda: dict(zip(("time", *COLUMNS), (wheel.time, *wheel.get(*COLUMNS))))
    row, rest = read(), None
    rows = [list(row.values())]
    while rest is None or wheel.time < rest + HOLD:
        covered = leaves is not None and leaves[0] <= row["wheel.distance"] < leaves[1]
        wheel.set({"brake.torque": driver.brake(row), "rail.friction": SLIPPERY if covered else dry})
        wheel.step(step)
        row = read()
        rows.append(list(row.values()))
        see(wheel, row)
        if rest is None and row["wheel.omega"] == 0.0 and abs(row["wheel.velocity"]) < AT_REST:
            rest = wheel.time
        if wheel.time > TOO_LONG:
            raise Refused(f"no standstill within {TOO_LONG:g} s: still {row['wheel.velocity']:.3g} m/s")
    return np.array(rows)


class Film:
    """Profiles across the contact patch: `times` [s], and for each of them an array with a row for each of PROFILES."""

    def __init__(self, fmu):
        self.names = [name for quantity in PROFILES for name in fmu.variables if name.startswith(f"profile.{quantity}[")]
        self.times, self.frames = [], []

    def see(self, wheel, row):
        """Takes a picture, if it is time for one."""
        slides = abs(row["contact.creepage"]) > SLIDING and row["wheel.velocity"] > ROLLING
        if not self.times or row["time"] > self.times[-1] + (FAST if slides else SLOW) - 1e-9:
            self.times.append(row["time"])
            self.frames.append(np.reshape(wheel.get(*self.names), (len(PROFILES), -1)))

    def profile(self, quantity):
        """A profile over all times: an array of times and points."""
        return np.array(self.frames)[:, PROFILES.index(quantity)]


def column(table, name):
    """A column of the table of `brake_to_standstill`."""
    return table[:, ("time", *COLUMNS).index(name)]


def braking(table):
    """The part of a table after the brake was applied."""
    return table[column(table, "time") >= ROLL]


def results(table):
    """Key figures of a stop: name, value, unit."""
    table = braking(table)
    t, v, distance = column(table, "time"), column(table, "wheel.velocity"), column(table, "wheel.distance")
    last = np.flatnonzero(np.abs(v) > AT_REST)[-1] + 1
    rolling = v > ROLLING
    locked = rolling & (column(table, "wheel.omega") == 0.0)
    power = column(table, "heat.friction_power")
    return [
        ("stopping distance", distance[-1] - distance[0], "m"),
        ("stopping time", t[min(last, len(t) - 1)] - t[0], "s"),
        ("peak creepage", np.abs(column(table, "contact.creepage")[rolling]).max() * 100, "%"),
        ("peak adhesion utilisation", column(table, "contact.utilisation").max() * 100, "%"),
        ("time with a locked wheel", np.diff(t)[locked[1:]].sum(), "s"),
        ("lowest coefficient of friction", column(table, "contact.friction").min(), ""),
        ("energy dissipated in the contact", np.trapezoid(power, t) / 1e3, "kJ"),
        ("highest contact temperature", column(table, "temperature.wheel_max").max() - KELVIN, "°C"),
        ("flattening", column(table, "damage.flattening").max() * 1e6, "µm"),
        ("energy residual", column(table, "solver.energy_residual")[-1] * 100, "%"),
        ("heat residual", column(table, "solver.heat_residual")[-1] * 100, "%"),
    ]


def write_columns(path, fmu):
    """Writes the units and meanings of the columns of the CSV."""
    about = [(name, fmu.variable(name).unit or "", fmu.variable(name).description) for name in COLUMNS]
    output.write_rows(path, [("column", "unit", "description"), ("time", "s", "Time"), *about])


def write_csv(path, table):
    """Writes the table with a header of names."""
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("time", *COLUMNS))
        writer.writerows([f"{value:.9g}" for value in row] for row in table)


def write_page(path, wheel, parameters, dry, table, film):
    """Writes the report page of the stop, if plotly is installed, which draws it; the paths that were written."""
    if not page.drawable():
        return []
    about = {
        "preset": parameters["preset"], "parameters": parameters, "inputs": {"drive.load": wheel.get("drive.load")},
        "warnings": list(wheel.log), "vehicle_mass": wheel.get("vehicle.mass"),
        "figures": [(name, f"{value:.4g} {unit}") for name, value, unit in results(table)[:2]],
    }  # fmt: skip
    patch = Profiles(np.array(film.times), {quantity: film.profile(quantity) for quantity in PROFILES})
    title = f"Braking stop from {3.6 * parameters['initial.velocity']:g} km/h"
    title += "" if dry else f", leaves after {LEAVES[0]:g} m"
    return [page.write(path, of_table(title, wheel.fmu, COLUMNS, table, patch, about))]


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for CSV, picture and page")
    parser.add_argument("--step", type=float, default=1e-3, help="communication step [s], default %(default)s")
    parser.add_argument("--speed-kmh", type=float, default=100.0, help="speed at the start [km/h]")
    parser.add_argument("--preset", default="railway", help="parameter set, default %(default)s")
    parser.add_argument("--dry", action="store_true", help="no leaves, and a driver who never releases the brake")
    brake = parser.add_mutually_exclusive_group()
    brake.add_argument("--utilisation", type=float, default=0.6, help="brake torque over mu P r, default %(default)s")
    brake.add_argument("--moment", type=float, help="brake torque [N m]")
    return parser.parse_args()


def stop(wheel, options, moment, film):
    """The stop with a progress bar; returns its table and the wall time [s]."""
    speed = options.speed_kmh / 3.6
    form = "{desc}: {percentage:3.0f}% |{bar}| [{elapsed}<{remaining}{postfix}]"
    with tqdm(total=100, desc="braking", bar_format=form) as bar:

        def see(wheel, row):
            film.see(wheel, row)
            share = int(100 * (1.0 - max(row["wheel.velocity"], 0.0) / speed))
            if share > bar.n:
                bar.set_postfix_str(f"{3.6 * row['wheel.velocity']:5.1f} km/h, {row['wheel.distance']:5.1f} m", refresh=False)
                bar.update(share - bar.n)

        began = time.perf_counter()
        slide = {} if options.dry else {"leaves": LEAVES, "patience": PATIENCE}
        table = brake_to_standstill(wheel, moment, options.step, see, **slide)
        wall = time.perf_counter() - began
        bar.set_postfix_str("at rest", refresh=False)
        bar.update(100 - bar.n)
    return table, wall


def run(options):
    """The demonstration."""
    parameters = {"preset": options.preset, "initial.velocity": options.speed_kmh / 3.6}
    with Fmu(options.fmu) as fmu, Wheel(fmu, parameters) as wheel:
        film = Film(fmu)
        friction, load, radius = wheel.get("rail.friction", "drive.load", "wheel.radius")
        moment = options.moment or options.utilisation * friction * load * radius
        table, wall = stop(wheel, options, moment, film)
        options.out.mkdir(parents=True, exist_ok=True)
        pages = write_page(options.out / "report.html", wheel, parameters, options.dry, table, film)
        columns = options.out / "braking_stop_columns.csv"
        write_columns(columns, fmu)

    figures = results(table)
    figures += [
        ("communication steps", len(table) - 1, ""),
        ("wall time", wall, "s"),
        ("real-time factor (simulated / wall)", table[-1, 0] / wall, ""),
    ]
    print(f"\nBraking stop from {options.speed_kmh:g} km/h: preset {options.preset}, ", end="")
    print(f"load {load / 1e3:g} kN, friction {friction:g}, brake torque {moment / 1e3:.2f} kN m")
    if not options.dry:
        print(f"leaves from {LEAVES[0]:g} to {LEAVES[1]:g} m, friction {SLIPPERY:g} there")
    print()
    for name, value, unit in figures:
        number = f"{value:d}" if isinstance(value, int) else f"{value:.4g}"
        print(f"  {name:<38}{number:>10} {unit}")

    data, picture = options.out / "braking_stop.csv", options.out / "braking_stop.png"
    write_csv(data, table)
    draw(picture, {name: column(table, name) for name in ("time", *COLUMNS)}, film, radius)
    print(f"\nwritten: {', '.join(map(str, (data, columns, picture, *pages)))}")


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
