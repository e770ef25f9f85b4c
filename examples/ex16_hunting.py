"""Example 16: a wheelset of two FMU wheels on springs hunts.

    make study NAME=hunting

A wheelset runs along straight track, held by springs in a frame that moves with constant speed. Below the critical speed its motion dies
out, above it grows to a limit cycle. First wheels are cones: the table compares frequency and growth with those of linear theory, whose
creep coefficients are measured on the same FMU. Then they have the profile S1002 on rails 60E1: patch, angle and radius are those of a
table over the shift, which the example makes from their files, and the flange ends the motion.

The wheelset is the master's: mass and springs. Both wheels are told its pose (`inputs`) and answer with force and moment about its
middle, as docs/coupling.md says. Replace `Wheelset.step` to couple a vehicle of your own. Left out is that the wheelset leans.
An ellipse says nothing of the shape of the wheel: the radius of the cones is a factor on the angular velocity.
"""

import argparse
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, Wheel
from wheelrail.__main__ import main
from wheelrail.plots import COLOURS, save, subplots

STEP, DURATION = 1e-3, 2.0  # s
SPEEDS = (50.0, 65.0, 75.0)  # of the cones [m/s]
FAST = (50.0, 60.0, 70.0)  # of the profiles [m/s]
PROFILES = Path(__file__).parent / "profiles"
SHIFTS, COARSE, LINES = "-6.2:6.2:0.1", "-6.2:6.2:1.24", 9  # of the table, and with --brief [mm], and rows of each
FAR = 4e-3  # shift at the start on profiles [m]
LOAD = 100e3  # vertical load of a wheel [N]
FIXED = {
    "preset": "railway_ellipse", "contact.lateral": True, "thermal.enabled": False, "friction.softening": 0.0, "physics.yielding": False,
    "model.nominal_load": LOAD,
}  # fmt: skip
TRACK = {"rail.support_stiffness": 81e6, "rail.support_damping": 120e3, "rail.support_mass": 400.0}  # on ballast
SIDES = {1: "right", -1: "left"}
CONTROL = {"control.rotation": "velocity", "control.translation": "velocity"}
FELT = ("wheelset.force_z", "wheelset.moment_y")
OF_CONTACT = ("contact.force_x", "contact.force_z", "contact.force_y", "contact.moment_y")
RIGHT, LEFT = SIDES


@dataclass
class Wheelset:
    """A rigid wheelset on springs. Positions: y to the right [m], yaw clockwise seen from above, which is to the right [rad]."""

    speed: float  # m/s
    y: float = 2e-4
    yaw: float = 0.0
    y_rate: float = 0.0
    yaw_rate: float = 0.0
    mass: float = 1500.0  # kg
    inertia: float = 900.0  # of yaw [kg m2]
    lateral_stiffness: float = 1e6  # N/m
    yaw_stiffness: float = 2e6  # N m/rad
    half_spacing: float = 0.75  # m
    conicity: float = 0.1

    def parameters(self, side):
        """Parameters of a wheel."""
        return FIXED | {"initial.velocity": self.speed, "wheelset.side": SIDES[side], "wheelset.half_spacing": self.half_spacing}

    def pose(self):
        """Where both wheels are told that the wheelset is."""
        return {
            "wheelset.lateral": self.y,
            "wheelset.lateral_rate": self.y_rate,
            "wheelset.yaw": self.yaw,
            "wheelset.yaw_rate": self.yaw_rate,
        }

    def inputs(self, side, radius):
        """What a wheel is told, at the end of the coming step."""
        omega = self.speed / radius * (1.0 + side * self.conicity * self.y / radius)
        return {"drive.velocity": self.speed, "drive.omega": omega} | self.pose()

    def step(self, force, moment, h):
        """Moves on under force and moment of both contacts: the trapezoidal rule in the springs."""

        def moved(place, rate, inertia, stiffness, load):
            share = h * h * stiffness / (4.0 * inertia)
            new = (rate * (1.0 - share) + h * (load - stiffness * place) / inertia) / (1.0 + share)
            return place + 0.5 * h * (rate + new), new

        self.y, self.y_rate = moved(self.y, self.y_rate, self.mass, self.lateral_stiffness, force)
        self.yaw, self.yaw_rate = moved(self.yaw, self.yaw_rate, self.inertia, self.yaw_stiffness, moment)


@dataclass
class Profiled(Wheelset):
    """A wheelset with the patches of a table over its shift. What its flanges throw up comes down on a track that yields."""

    y: float = FAR
    table: Path = Path()

    def parameters(self, side):
        return super().parameters(side) | {"contact.shape": "rows", "contact.rows": str(self.table), "contact.lines": LINES} | TRACK

    def inputs(self, side, radius):
        return super().inputs(side, radius) | {"drive.omega": self.speed / radius}


def patches(folder, shifts=SHIFTS):
    """Table of the patches of S1002 on 60E1, inclined 1:40, at shifts of the wheelset."""
    table = folder / "hunting_patches.csv"
    main(["patch", *(str(PROFILES / name) for name in ("s1002.prw", "60e1.prr")), "--inclination", "1:40", "--shift", shifts, "--load", f"{LOAD:g}", "--out", str(table)])
    return table


def hunting(fmu, wheelset, duration=DURATION, step=STEP, ahead=True):
    """Rows of time, y, yaw, the lateral force of both wheels on the wheelset and that of the right one, and the lateral place of the load
    on the right wheel. It ends early where the wheelset leaves the track; beyond the shifts of a table a wheel refuses its step.

    Contacts act on the wheelset with the forces of the middle of the coming step, extrapolated from the last two steps. Without
    `ahead` those of the last step are held, which damps the motion falsely."""
    made = [Wheel(fmu, wheelset.parameters(side), CONTROL | wheelset.pose()) for side in SIDES]
    rows = []
    with made[0] as right, made[1] as left:
        wheels = {RIGHT: right, LEFT: left}
        radius = right.get("wheel.radius")

        def load():
            """Force to the right [N] and moment clockwise [N m] of both wheels."""
            forces, moments = np.transpose([wheel.get(*FELT) for wheel in wheels.values()])
            return np.array([forces.sum(), -moments.sum()])

        now = before = load()
        for k in range(round(duration / step)):
            wheelset.step(*(1.5 * now - 0.5 * before if ahead else now), step)
            for side, wheel in wheels.items():
                wheel.set(wheelset.inputs(side, radius))
                wheel.step(step)
            now, before = load(), now
            rows.append((step * (k + 1), wheelset.y, wheelset.yaw, now[0], *right.get("wheelset.force_z", "contact.load_position")))
            if abs(wheelset.y) > 0.02:
                break
    return np.array(rows)


def coefficients(fmu, speed):
    """Creep coefficients of one wheel from small creepages: f11, f22, f23, f33, and the moment by lateral creepage; and the radius."""
    found = {}
    for creepage, lateral, spin in ((2e-5, 0.0, 0.0), (0.0, 2e-5, 0.0), (0.0, 0.0, 0.01)):
        parameters = FIXED | {"initial.velocity": speed, "initial.creepage": creepage}
        with Wheel(fmu, parameters, CONTROL | {"drive.lateral_velocity": lateral * speed, "drive.spin": spin}) as wheel:
            for _ in range(10):
                wheel.step(STEP)
            found[bool(creepage), bool(lateral)] = wheel.get(*OF_CONTACT, "contact.creepage", "contact.lateral_creepage", "contact.spin")
            radius = wheel.get("wheel.radius")
    along, across, turned = found[True, False], found[False, True], found[False, False]
    f11, f22, f23 = -along[0] / along[4], -across[1] / across[5], -turned[1] / turned[6]
    return f11, f22, f23, turned[3] / turned[6], across[3] / across[5], radius


def mode(wheelset, found):
    """Growth [1/s] and frequency [Hz] of the least damped motion by linear theory, with the creepages (y' - V yaw)/V and yaw'/V."""
    f11, f22, f23, f33, cross, radius = found
    b, speed, inertia = wheelset.half_spacing, wheelset.speed, np.diag([1.0 / wheelset.mass, 1.0 / wheelset.inertia])
    damping = 2.0 / speed * np.array([[f22, f23], [cross, f11 * b**2 + f33]])
    lever = 2.0 * f11 * wheelset.conicity * b / radius
    stiffness = np.array([[wheelset.lateral_stiffness, -2.0 * f22], [lever, wheelset.yaw_stiffness - 2.0 * cross]])
    values = np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-inertia @ stiffness, -inertia @ damping]]))
    least = values[np.argmax(values.real)]
    return least.real, abs(least.imag) / (2.0 * np.pi)


def growth(time, y):
    """Growth [1/s] and frequency [Hz] of an oscillation, from its maxima after the first third."""
    time, y = time[len(time) // 3 :], y[len(y) // 3 :]
    top = np.flatnonzero((y[1:-1] > y[:-2]) & (y[1:-1] >= y[2:]) & (y[1:-1] > 0.0)) + 1
    if len(top) < 2:
        return np.nan, np.nan
    # A maximum lies between samples: that of the parabola through three of them.
    a, b, c = y[top - 1], y[top], y[top + 1]
    shift = 0.5 * (a - c) / (a - 2.0 * b + c)
    times, heights = time[top] + shift * (time[1] - time[0]), b - 0.25 * (a - c) * shift
    return np.polyfit(times, np.log(heights), 1)[0], (len(times) - 1) / (times[-1] - times[0])


def klingel(wheelset, radius):
    """Frequency [Hz] of a free wheelset without mass, by geometry alone."""
    return wheelset.speed / (2.0 * np.pi) * np.sqrt(wheelset.conicity / (radius * wheelset.half_spacing))


def plot(path, cones, profiles):
    """Shift over time of cones and profiles, one speed below the other, then force and place of load of the fastest ones."""
    count = max(len(cones), len(profiles))
    figure, axes = subplots(count + 1, 2, figsize=(10, 1.8 * (count + 1)), squeeze=False)
    for column, (runs, name) in zip(axes.T, ((cones, "cones"), (profiles, "S1002 on 60E1"))):
        for axis, colour, (speed, rows) in zip(column, COLOURS, runs.items()):
            axis.plot(rows[:, 0], 1e3 * rows[:, 1], color=colour)
            axis.set(title=f"{name}, {speed:.0f} m/s", ylabel="y [mm], right")
        column[count - 1].set_xlabel("time [s]")
    last = profiles[max(profiles)][-400:]
    for axis, values, label in zip(axes[-1], (1e-3 * last[:, 4], 1e3 * last[:, 5]), ("right wheel, force\nto the right [kN]", "place of its load\non the wheel [mm]")):
        axis.plot(last[:, 0], values, color=COLOURS[len(profiles) - 1])
        axis.set(title=f"S1002 on 60E1, {max(profiles):.0f} m/s", ylabel=label, xlabel="time [s]")
    save(path, figure)


def run_cones(fmu, speeds, duration):
    """Cones at all speeds beside linear theory."""
    print(f"{'speed [m/s]':>12}{'frequency [Hz]':>18}{'linear':>10}{'growth [1/s]':>16}{'linear':>10}{'y at the end [mm]':>20}")
    found, runs = coefficients(fmu, 50.0), {}
    for speed in speeds:
        rows = runs[speed] = hunting(fmu, Wheelset(speed), duration)
        (rate, frequency), (rate0, frequency0) = growth(rows[:, 0], rows[:, 1]), mode(Wheelset(speed), found)
        print(f"{speed:12.1f}{frequency:18.3f}{frequency0:10.3f}{rate:16.3f}{rate0:10.3f}{1e3 * rows[-1, 1]:20.3f}", flush=True)
    return runs


def run_profiles(fmu, speeds, duration, table):
    """Profiles at all speeds."""
    print(f"\n{'speed [m/s]':>12}{'y at first [mm]':>18}{'at the end':>12}{'largest force of a wheel [kN]':>32}")
    runs = {}
    for speed in speeds:
        rows = runs[speed] = hunting(fmu, Profiled(speed, table=table), duration)
        last = rows[-min(len(rows) // 2, 250) :]
        print(f"{speed:12.1f}{1e3 * FAR:18.2f}{1e3 * np.abs(last[:, 1]).max():12.2f}{1e-3 * np.abs(last[:, 4]).max():32.1f}", flush=True)
    return runs


def run(options):
    """All speeds, the tables and the picture."""
    options.out.mkdir(parents=True, exist_ok=True)
    duration, shifts = (0.03, COARSE) if options.brief else (options.duration, SHIFTS)
    with Fmu(options.fmu) as fmu:
        cones = run_cones(fmu, options.speeds, 0.4 if options.brief else options.duration)
        profiles = run_profiles(fmu, FAST[-1:] if options.brief else FAST, duration, patches(options.out, shifts))
    plot(options.out / "hunting.png", cones, profiles)
    print(f"\nwritten: {options.out / 'hunting.png'}")


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    parser.add_argument("--speeds", type=float, nargs="+", default=SPEEDS, help="of the cones [m/s]; default: %(default)s")
    parser.add_argument("--duration", type=float, default=DURATION, help="s; default: %(default)s")
    parser.add_argument("--brief", action="store_true", help="0.4 s of each cone, 0.03 s of the fastest profile")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
