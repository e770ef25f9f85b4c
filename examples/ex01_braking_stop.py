"""Example 1: a wheel brakes from 100 km/h to standstill. Result table, CSV and plot.

    make demo

1. The wheel rolls freely under its load and carries its share of the vehicle.
2. A brake moment is ramped up and held. A moment beyond the adhesion limit locks the wheel: try --utilisation 1.5.
3. At walking speed it is eased, as a driver does.
4. When the wheel is about to stop, the brake grips: control of the rotation switches from moment to angular velocity,
   which goes to zero and stays there, while the vehicle swings out on the elasticity of wheel and rail.
5. Outputs of every step become a table, a CSV and a plot with one look into the contact patch at half the speed.
"""

import argparse
import csv
import sys
import time
from pathlib import Path

import numpy as np
from tqdm import tqdm

from wheelrail import Fmu, Refused, Wheel

# Recorded once, at half the speed.
PROFILES = ("x", "pressure", "shear", "temperature_wheel", "temperature_rail")

# Recorded at every communication point.
COLUMNS = (
    "wheel.velocity", "wheel.omega", "wheel.distance", "wheel.acceleration", "wheel.angular_acceleration",
    "contact.force_x", "contact.force_y", "contact.moment", "contact.creepage", "contact.slip_velocity",
    "contact.adhesion", "contact.utilisation", "contact.stick_fraction", "contact.half_width",
    "contact.pressure_max", "contact.approach", "hub.force_x", "hub.force_y", "hub.moment",
    "temperature.wheel_max", "temperature.rail_max", "temperature.wheel_mean", "temperature.rail_mean",
    "temperature.wheel_nominal", "temperature.rail_nominal", "temperature.wheel_bulk",
    "heat.friction_power", "heat.to_wheel", "heat.to_rail", "heat.conduction", "contact.friction",
    "damage.t_gamma", "damage.time_above_ac1", "solver.energy_residual", "solver.heat_residual",
)  # fmt: skip

ROLL = 0.2  # s of free rolling before the brake is applied
RAMP = 0.5  # s, in which the brake moment builds up
EASE_SPEED = 1.0  # m/s, below which the brake is eased in proportion to the speed ...
EASE_TO = 0.1  # ... down to this share of the moment
GRIP_SPEED = 0.05  # m/s: peripheral speed at which the brake grips
HOLD = 0.5  # s, for which the wheel is watched after standstill
TOO_LONG = 600.0  # s
AT_REST = 0.01  # m/s: slower counts as standstill
KELVIN = 273.15  # K at 0 °C
ROLLING = 1.0  # m/s: creepage is a ratio of speeds, its peak is taken above this one


def brake_to_standstill(wheel, moment, step, see=lambda wheel, row: None):
    """Brakes a rolling wheel with `moment` [N m] (positive) until it rests; returns a table of COLUMNS over time.

    `see(wheel, row)` is called after every step.
    """
    radius = wheel.get("wheel.radius")
    rows = [[0.0, *wheel.get(*COLUMNS)]]

    def advance():
        wheel.step(step)
        rows.append([wheel.time, *wheel.get(*COLUMNS)])
        row = dict(zip(("time", *COLUMNS), rows[-1]))
        see(wheel, row)
        if wheel.time > TOO_LONG:
            raise Refused(f"no standstill within {TOO_LONG:g} s: still {row['wheel.velocity']:.3g} m/s")
        return row

    row = advance()
    while radius * row["wheel.omega"] > GRIP_SPEED:
        applied = np.clip((wheel.time - ROLL) / RAMP, 0.0, 1.0)
        eased = np.clip(row["wheel.velocity"] / EASE_SPEED, EASE_TO, 1.0)
        wheel.set({"drive.moment": -moment * applied * eased})
        row = advance()

    # From here the angular velocity is prescribed: on to zero at the deceleration of the last steps, then held.
    recent = [row[2] for row in rows[-20:]]
    omega, decrement = recent[-1], (recent[0] - recent[-1]) / (len(recent) - 1)
    wheel.set({"control.rotation": "velocity"})
    rest = None
    while rest is None or wheel.time < rest + HOLD:
        omega = max(0.0, omega - decrement)
        wheel.set({"drive.omega": omega})
        row = advance()
        if rest is None and omega == 0.0 and abs(row["wheel.velocity"]) < AT_REST:
            rest = wheel.time
    return np.array(rows)


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
    power = column(table, "heat.friction_power")
    return [
        ("stopping distance", distance[-1] - distance[0], "m"),
        ("stopping time", t[min(last, len(t) - 1)] - t[0], "s"),
        ("peak creepage", np.abs(column(table, "contact.creepage")[rolling]).max() * 100, "%"),
        ("peak adhesion utilisation", column(table, "contact.utilisation").max() * 100, "%"),
        ("energy dissipated in the contact", np.trapezoid(power, t) / 1e3, "kJ"),
        ("highest contact temperature", column(table, "temperature.wheel_max").max() - KELVIN, "°C"),
        ("energy residual", column(table, "solver.energy_residual")[-1] * 100, "%"),
        ("heat residual", column(table, "solver.heat_residual")[-1] * 100, "%"),
    ]


def write_csv(path, table):
    """Writes the table with a header of names."""
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(("time", *COLUMNS))
        writer.writerows([f"{value:.9g}" for value in row] for row in table)


def plot(path, table, snapshot, friction, radius):
    """Draws the stop and one look into the contact patch."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    blue, orange, green, grey = "#0072B2", "#D55E00", "#009E73", "#777777"
    plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False})
    plt.rcParams.update({"axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.4})
    figure, axes = plt.subplots(2, 4, figsize=(15, 6.2), layout="constrained")
    table = braking(table)
    t, v = column(table, "time") - ROLL, column(table, "wheel.velocity")
    peripheral = radius * column(table, "wheel.omega")

    axis = axes[0, 0]
    axis.plot(t, 3.6 * v, color=blue, label="travel $V$")
    axis.plot(t, 3.6 * peripheral, "--", color=orange, label=r"peripheral $r\omega$")
    axis.set(title="Speed", ylabel="km/h", xlabel="time [s]")
    axis.legend()

    axis = axes[0, 1]
    rolling = v > ROLLING
    axis.plot(t[rolling], 100 * column(table, "contact.creepage")[rolling], color=blue)
    axis.set(title=f"Creepage (above {ROLLING:g} m/s)", ylabel="%", xlabel="time [s]")

    axis = axes[0, 2]
    axis.plot(t, 100 * column(table, "contact.utilisation"), color=blue)
    axis.axhline(100, color=grey, linestyle=":")
    axis.set(title=r"Adhesion utilisation $|F_x|/\mu F_y$", ylabel="%", xlabel="time [s]", ylim=(0, 105))

    axis = axes[0, 3]
    axis.plot(t, column(table, "heat.friction_power"), color=orange, label="friction power")
    axis.plot(t, column(table, "heat.to_wheel"), color=blue, label="heat to wheel")
    axis.plot(t, column(table, "heat.to_rail"), "--", color=green, label="heat to rail")
    axis.set(title="Heat", ylabel="W", xlabel="time [s]")
    axis.legend()

    axis = axes[1, 0]
    for name, color in (("max", orange), ("mean", blue), ("nominal", green)):
        axis.plot(t, column(table, f"temperature.wheel_{name}") - KELVIN, color=color, label=f"wheel, {name}")
    axis.plot(t, column(table, "temperature.wheel_bulk") - KELVIN, ":", color=grey, label="wheel, bulk")
    axis.set(title="Temperature in the contact", ylabel="°C", xlabel="time [s]")
    axis.legend()

    axis = axes[1, 3]
    late = t > t[-1] - HOLD - 0.5
    axis.plot(t[late], 1e3 * v[late], color=blue, label="travel $V$")
    axis.plot(t[late], 1e3 * peripheral[late], "--", color=orange, label=r"peripheral $r\omega$")
    axis.set(title="Standstill: the vehicle swings out", ylabel="mm/s", xlabel="time [s]")
    axis.legend()

    axis = axes[1, 1]
    x, pressure, shear, wheel, rail = (np.array(values) for values in snapshot["profiles"])
    near = np.abs(x) < 1.3 * snapshot["half_width"]
    axis.fill_between(1e3 * x[near], pressure[near] / 1e6, color=blue, alpha=0.15)
    axis.plot(1e3 * x[near], pressure[near] / 1e6, color=blue, label="pressure $p$")
    axis.plot(1e3 * x[near], -shear[near] / 1e6, color=orange, label="shear against travel")
    axis.plot(1e3 * x[near], friction * pressure[near] / 1e6, ":", color=grey, label=r"limit $\mu p$")
    title = f"Patch at {3.6 * snapshot['velocity']:.0f} km/h (travel to the right)"
    axis.set(title=title, ylabel="MPa", xlabel="x [mm]")
    axis.legend()

    axis = axes[1, 2]
    axis.plot(1e3 * x[near], wheel[near] - KELVIN, color=orange, label="wheel")
    axis.plot(1e3 * x[near], rail[near] - KELVIN, "--", color=blue, label="rail")
    axis.set(title="Surface temperatures in the patch", ylabel="°C", xlabel="x [mm]")
    axis.legend()

    figure.savefig(path, dpi=120)


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for CSV and plot")
    parser.add_argument("--step", type=float, default=1e-3, help="communication step [s], default %(default)s")
    parser.add_argument("--speed-kmh", type=float, default=100.0, help="speed at the start [km/h]")
    parser.add_argument("--preset", default="railway", help="parameter set, default %(default)s")
    brake = parser.add_mutually_exclusive_group()
    brake.add_argument("--utilisation", type=float, default=0.6, help="brake moment over mu P r, default %(default)s")
    brake.add_argument("--moment", type=float, help="brake moment [N m]")
    return parser.parse_args()


def run(options):
    """The demonstration."""
    speed = options.speed_kmh / 3.6
    parameters = {"preset": options.preset, "initial.velocity": speed}
    inputs = {"control.rotation": "moment", "control.translation": "force", "control.vertical": "force"}
    with Fmu(options.fmu) as fmu, Wheel(fmu, parameters, inputs) as wheel:
        friction, load, radius = wheel.get("rail.friction", "drive.load", "wheel.radius")
        moment = options.moment or options.utilisation * friction * load * radius
        snapshot = {}
        form = "{desc}: {percentage:3.0f}% |{bar}| [{elapsed}<{remaining}{postfix}]"
        with tqdm(total=100, desc="braking", bar_format=form) as bar:

            def see(wheel, row):
                v = row["wheel.velocity"]
                if not snapshot and v < 0.5 * speed:
                    profiles = [wheel.profile(quantity) for quantity in PROFILES]
                    snapshot.update(velocity=v, half_width=row["contact.half_width"], profiles=profiles)
                share = int(100 * (1.0 - max(v, 0.0) / speed))
                if share > bar.n:
                    bar.set_postfix_str(f"{3.6 * v:5.1f} km/h, {row['wheel.distance']:5.1f} m", refresh=False)
                    bar.update(share - bar.n)

            began = time.perf_counter()
            table = brake_to_standstill(wheel, moment, options.step, see)
            wall = time.perf_counter() - began
            bar.set_postfix_str("at rest", refresh=False)
            bar.update(100 - bar.n)

    figures = results(table)
    figures += [
        ("communication steps", len(table) - 1, ""),
        ("wall time", wall, "s"),
        ("real-time factor (simulated / wall)", table[-1, 0] / wall, ""),
    ]
    print(f"\nBraking stop from {options.speed_kmh:g} km/h: preset {options.preset}, ", end="")
    print(f"load {load / 1e3:g} kN, friction {friction:g}, brake moment {moment / 1e3:.2f} kN m\n")
    for name, value, unit in figures:
        number = f"{value:d}" if isinstance(value, int) else f"{value:.4g}"
        print(f"  {name:<38}{number:>10} {unit}")

    options.out.mkdir(parents=True, exist_ok=True)
    data, picture = options.out / "braking_stop.csv", options.out / "braking_stop.png"
    write_csv(data, table)
    plot(picture, table, snapshot, friction, radius)
    print(f"\nwritten: {data}, {picture}")


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
