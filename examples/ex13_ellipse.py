"""Example 13: one brake application on patches of constant width, of an ellipse and of real profiles: pressure, heat, creepage.

    make study NAME=ellipse

From 100 km/h the brake torque grows to 11 kN m within a second, four fifths of what friction can take. `railway` and
`railway_damage` have one line, as wide as creep forces or peak pressures need it; `railway_ellipse` has the ellipse of Hertz on
seven lines, whose size follows from the load and the curvatures; `railway_s1002_*` have the patches of a wheel S1002 on a rail
UIC60, centred and 3 mm towards the flange. The wheel of these is that of a wheelset of 1300 kg, twice as heavy as
theirs: a hundredth of the braking force is what that takes more.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, Wheel
from wheelrail.plots import COLOURS, save, subplots

SPEED, TORQUE, RAMP, STEP = 100.0 / 3.6, 11e3, 1.0, 1e-3  # m/s, N m, s, s
PRESETS = ("railway", "railway_damage", "railway_ellipse", "railway_s1002_0mm", "railway_s1002_3mm")
KELVIN = 273.15
SEEN = ("contact.force_x", "contact.creepage", "temperature.wheel_max")  # over time
FIGURES = (  # of the last instant: name, text, factor, offset
    ("contact.width", "width of the patch [mm]", 1e3, 0.0), ("contact.half_width", "half its length [mm]", 1e3, 0.0),
    ("contact.pressure_max", "largest pressure [MPa]", 1e-6, 0.0), ("contact.stick_fraction", "sticks [%]", 100.0, 0.0),
    ("contact.force_x", "force along the rail [kN]", 1e-3, 0.0), ("contact.creepage", "creepage [%]", 100.0, 0.0),
    ("heat.friction_power", "friction power [kW]", 1e-3, 0.0), ("temperature.wheel_max", "hottest, wheel [°C]", 1.0, -KELVIN),
)  # fmt: skip
ACROSS = ("position", "half_length", "pressure_max", "stick_fraction", "force_x", "temperature_wheel_max")


def braked(fmu, preset, duration=RAMP):
    """Time with SEEN as columns, FIGURES of the last instant, and what its lines have, by ACROSS."""
    rows = []
    with Wheel(fmu, {"preset": preset, "initial.velocity": SPEED}) as wheel:
        for k in range(round(duration / STEP)):
            wheel.set({"brake.torque": TORQUE * k * STEP / RAMP})
            wheel.set_rates({"brake.torque": TORQUE / RAMP})
            wheel.step(STEP)
            rows.append([wheel.time, *wheel.get(*SEEN)])
        figures = wheel.get(*(name for name, *_ in FIGURES))
        return np.array(rows), dict(zip((name for name, *_ in FIGURES), figures)), {name: wheel.line(name) for name in ACROSS}


def report(found):
    """Prints the last instant, and the lines of the patches that have several."""
    print(f"{'':28}" + "".join(f"{preset:>19}" for preset in found))
    for name, text, factor, offset in FIGURES:
        print(f"{text:28}" + "".join(f"{factor * figures[name] + offset:19.4g}" for _, figures, _ in found.values()))
    for preset, (_, _, lines) in found.items():
        if len(lines["position"]) == 1:
            continue
        print(f"\nlines of {preset}: z [mm], half length [mm], pressure [MPa], sticks [%], force [kN], wheel [°C]")
        for z, length, pressure, stick, force, hottest in zip(*lines.values()):
            values = (1e3 * z, 1e3 * length, 1e-6 * pressure, 100.0 * stick, 1e-3 * force, hottest - KELVIN)
            print("".join(f"{value:11.4g}" for value in values))


def across(axis, found, quantity, shown):
    """A quantity of the lines over the width; that of a single line holds over all of it."""
    for colour, (preset, (_, figures, lines)) in zip(COLOURS, found.items()):
        z, values = 1e3 * np.array(lines["position"]), shown(np.array(lines[quantity]))
        if len(z) == 1:
            z, values = 500.0 * figures["contact.width"] * np.array([-1.0, 1.0]), np.repeat(values, 2)
        axis.plot(z, values, "o-" if len(z) > 2 else "-", color=colour, markersize=4, label=preset)
    axis.set_xlabel("z [mm]")
    axis.set_ylim(0.0, None)


def plot(path, found):
    """Creepage and temperature over the force, pressure and temperature across the patch at the end."""
    figure, axes = subplots(2, 2, figsize=(8, 5.5))
    for colour, (preset, (rows, _, _)) in zip(COLOURS, found.items()):
        _, force, creepage, hottest = rows.T
        axes[0, 0].plot(-1e-3 * force, 100.0 * creepage, color=colour, label=preset)
        axes[0, 1].plot(-1e-3 * force, hottest - KELVIN, color=colour)
    axes[0, 0].set(title="Creepage", xlabel="braking force [kN]", ylabel="%")
    axes[0, 1].set(title="Hottest place of the wheel", xlabel="braking force [kN]", ylabel="°C")
    across(axes[1, 0], found, "pressure_max", lambda pressure: 1e-6 * pressure)
    axes[1, 0].set(title="Largest pressure across the patch", ylabel="MPa")
    across(axes[1, 1], found, "temperature_wheel_max", lambda kelvin: kelvin - KELVIN)
    axes[1, 1].set(title="Hottest place of the wheel across the patch", ylabel="°C")
    axes[0, 0].legend(loc="upper left")
    save(path, figure)


def run(options):
    """All presets, their figures and the picture."""
    with Fmu(options.fmu) as fmu:
        found = {preset: braked(fmu, preset, 0.1 * RAMP if options.brief else RAMP) for preset in PRESETS}
    report(found)
    options.out.mkdir(parents=True, exist_ok=True)
    plot(options.out / "ellipse.png", found)
    print(f"\nwritten: {options.out / 'ellipse.png'}")


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    parser.add_argument("--brief", action="store_true", help="the first tenth of the application, in seconds")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
