"""Example 14: an angle of attack while braking: forces and temperature beside those of the same wheel without it.

    make study NAME=angle-of-attack

A right-hand wheel on an elliptical patch brakes from 100 km/h with half of what friction can take. After 0.2 s it is turned by 10
mrad to the right within 50 ms, as by a curve, and its plane of contact rises by 50 mrad. The tread then slides forward and to the
left, and the rail pushes it to the right: friction, which is one force, turns against the slip, and the same braking force takes
more creepage and makes more heat. The last column is the wheel turned to the left, whose spin acts against its angle of attack.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, Wheel
from wheelrail.plots import COLOURS, save, subplots

SPEED, TORQUE, STEP = 100.0 / 3.6, 7e3, 1e-3  # m/s, N m, s
BEGIN, RAMP, END = 0.2, 0.05, 0.6  # s
CONTACT_ANGLE = 0.05  # rad
ATTACKS = {"straight": 0.0, "10 mrad to the right": 10e-3, "10 mrad to the left": -10e-3}  # rad, clockwise from above
KELVIN = 273.15
SEEN = (
    "contact.force_x", "contact.force_z", "contact.moment_y", "contact.creepage", "contact.lateral_creepage", "contact.spin",
    "contact.slip_direction", "contact.utilisation", "heat.friction_power", "temperature.wheel_max",
)  # fmt: skip
SHOWN = (  # text, factor, offset
    ("force along the rail [kN]", 1e-3, 0.0), ("lateral force [kN]", 1e-3, 0.0), ("spin moment [N m]", 1.0, 0.0),
    ("creepage [%]", 100.0, 0.0), ("lateral creepage [%]", 100.0, 0.0), ("spin [1/m]", 1.0, 0.0),
    ("direction of slip [deg]", 180.0 / np.pi, 0.0), ("friction in use [%]", 100.0, 0.0), ("friction power [kW]", 1e-3, 0.0),
    ("hottest, wheel [°C]", 1.0, -KELVIN),
)  # fmt: skip
ARROWS = ("position", "half_length", "force_x", "force_z", "tread_slip", "tread_slip_z")


def share(time):
    """How much of the angle of attack there is at a time [s]: 0 to 1."""
    return float(np.clip((time - BEGIN) / RAMP, 0.0, 1.0))


def attacked(fmu, angle, duration=END):
    """Time with SEEN as columns, and what the lines have at the end, by ARROWS, of a wheel turned to the right by an angle [rad]."""
    rows, parameters = [], {"preset": "railway_ellipse", "contact.lateral": True, "initial.velocity": SPEED}
    with Wheel(fmu, parameters, {"brake.torque": TORQUE, "drive.contact_angle": CONTACT_ANGLE}) as wheel:
        for k in range(round(duration / STEP)):
            # Reached at the end of the step, as every velocity is. What points to the right of its travel slides to the left.
            turned = angle * share((k + 1) * STEP)
            wheel.set({"drive.lateral_velocity": -np.sin(turned) * wheel.get("wheel.velocity") / np.cos(CONTACT_ANGLE)})
            wheel.step(STEP)
            rows.append([wheel.time, *wheel.get(*SEEN)])
        return np.array(rows), {name: wheel.line(name) for name in ARROWS}


def report(found):
    """Prints the last instant."""
    print(f"{'':28}" + "".join(f"{name:>24}" for name in found))
    for k, (text, factor, offset) in enumerate(SHOWN, 1):
        print(f"{text:28}" + "".join(f"{factor * rows[-1, k] + offset:24.4g}" for rows, _ in found.values()))


def arrows(axis, lines):
    """Force on every line of the wheel, and its slip on the rail, from above: travel to the right, z downward, which is to the right."""
    z = 1e3 * np.array(lines["position"])
    for name, colour, of in (("force on the wheel", COLOURS[0], "force"), ("slip", COLOURS[1], "tread_slip")):
        along = np.array(lines["force_x" if of == "force" else of])
        across = np.array(lines[f"{of}_z"])
        longest = max(np.hypot(along, across).max(), 1e-12)
        size = 0.6e3 * max(lines["half_length"]) / longest
        axis.quiver(np.zeros_like(z), z, size * along, size * across, color=colour, angles="xy", scale_units="xy", scale=1.0, label=name)
    half = 1e3 * np.array(lines["half_length"])
    axis.plot(np.concatenate([half, -half[::-1]]), np.concatenate([z, z[::-1]]), ".", color="0.6", markersize=3)
    reach = 1.2 * half.max()
    axis.set(xlim=(-reach, reach), ylim=(z.max() + 0.5 * reach, z.min() - 0.5 * reach), xlabel="x [mm]", ylabel="z [mm]")


def plot(path, found):
    """Forces and temperature over time, and the patch from above at the end."""
    figure, axes = subplots(2, 2, figsize=(8, 5.5))
    places = [(axes[0, 0], 1, "Force along the rail"), (axes[0, 1], 2, "Lateral force"), (axes[1, 0], 10, "Hottest place of the wheel")]
    for colour, (name, (rows, _)) in zip(COLOURS, found.items()):
        for axis, k, title in places:
            _, factor, offset = SHOWN[k - 1]
            axis.plot(rows[:, 0], factor * rows[:, k] + offset, color=colour, label=name)
            axis.set(title=title, xlabel="time [s]", ylabel="°C" if k == 10 else "kN")
    axes[0, 1].legend(loc="upper left")
    axes[1, 1].set_title("Patch from above, 10 mrad to the right")
    arrows(axes[1, 1], found["10 mrad to the right"][1])
    axes[1, 1].legend(loc="lower right")
    save(path, figure)


def run(options):
    """All angles, their figures and the picture."""
    with Fmu(options.fmu) as fmu:
        found = {name: attacked(fmu, angle, BEGIN + 2.0 * RAMP if options.brief else END) for name, angle in ATTACKS.items()}
    report(found)
    options.out.mkdir(parents=True, exist_ok=True)
    plot(options.out / "angle_of_attack.png", found)
    print(f"\nwritten: {options.out / 'angle_of_attack.png'}")


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    parser.add_argument("--brief", action="store_true", help="half of the run, in seconds")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
