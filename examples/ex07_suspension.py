"""Example 7: masters of a vehicle on its primary suspension. A wheel brakes from 5 m/s to rest; how do the sides exchange?

    make suspension

The vehicle (a quarter of a bogie's load) hangs on the wheel by a spring and a damper along the track, as stiff as in the
Manchester coach; the brake is inside the FMU. Exchanges, over a communication step h:

    held        the FMU owns the wheel, the suspension's force at the beginning of the step is held
    ramped      the FMU owns the wheel, the force ramps to that of an implicit step in which the wheel is a mass under the
                last contact force (what `wheelrail.train` does)
    velocity    the master owns the wheel's mass, prescribes its velocity and gets contact.force_x
    iterative   as ramped, and the step is repeated from a saved state until the force at its end fits the motion found

Printed for each and every step: stopping distance against that of the iterative master with the smallest step, the largest
swing of the suspension's force while it brakes steadily, and its swing after two seconds of standstill. Drawn: all of them.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, Wheel

SPEED = 5.0  # m/s
VEHICLE = 8460.0  # kg on one wheel's suspension
STIFFNESS, DAMPING = 31.391e6, 30e3  # N/m, N s/m along the track, one wheel (Manchester vehicle 1; damping: judgement)
TORQUE, BUILD = 5200.0, 0.5  # N m, s: about 1.2 m/s2
HUB_MASS, HUB_INERTIA = 834.2, 48.25  # kg, kg m2: half a wheelset of 1813 kg, 112 kg m2 without its rim
LOAD = 1e5  # N
AT_REST = 2e-3  # m/s
WATCHED = 2.5  # s after standstill
STEPS = (5e-3, 2e-3, 1e-3, 5e-4, 2.5e-4)  # s
CLOSE, TRIALS = 1.0, 12  # N, of the force at the end of a step; trials
COLD = {"thermal.enabled": False, "vehicle.mass": 0.0, "wheel.hub_mass": HUB_MASS, "wheel.hub_inertia": HUB_INERTIA}
SEEN = ("wheel.distance", "wheel.velocity", "contact.force_x", "wheel.omega")


class Vehicle:
    """A mass behind the suspension [m, m/s], by the trapezoidal rule."""

    def __init__(self, speed):
        self.place, self.velocity = 0.0, speed

    def force(self, place, velocity):
        """Of the suspension on a wheel [N]."""
        return STIFFNESS * (self.place - place) + DAMPING * (self.velocity - velocity)

    def advance(self, h, begin, end):
        """Moves under the forces at the beginning and the end of a step [N], those on the wheel."""
        before = self.velocity
        self.velocity -= 0.5 * h * (begin + end) / VEHICLE
        self.place += 0.5 * h * (before + self.velocity)


def together(h, vehicle, place, velocity, mass, other):
    """Force [N] at the end of a step in which vehicle and wheel, a mass under a constant force [N], move implicitly."""
    inverse = 1.0 / VEHICLE + 1.0 / mass
    relative, rate = vehicle.place - place, vehicle.velocity - velocity
    begin = STIFFNESS * relative + DAMPING * rate
    # f = k u + c w, w' = -inverse f - other/mass, both by the trapezoidal rule.
    gain = STIFFNESS * 0.25 * h * h + DAMPING * 0.5 * h
    known = STIFFNESS * (relative + h * rate) + DAMPING * rate
    known -= gain * (inverse * begin + 2.0 * other / mass)
    return known / (1.0 + gain * inverse)


class Run:
    """A stop under one master."""

    def __init__(self, fmu, master, h):
        self.master, self.h = master, h
        inputs = {"drive.load": LOAD}
        if master == "velocity":
            inputs |= {"control.translation": "velocity", "drive.velocity": SPEED}
        self.wheel = Wheel(fmu, COLD | {"initial.velocity": SPEED}, inputs)
        self.mass, self.inertia, self.radius = self.wheel.get("wheel.mass", "wheel.inertia", "wheel.radius")
        self.vehicle = Vehicle(SPEED)
        self.place, self.speed, self.contact, self.omega = self.wheel.get(*SEEN)
        self.rows = []

    def step(self):
        """One communication step."""
        h, wheel = self.h, self.wheel
        torque = [TORQUE * min(t / BUILD, 1.0) for t in (wheel.time, wheel.time + h)]
        wheel.set({"brake.torque": torque[0]})
        rates = {"brake.torque": (torque[1] - torque[0]) / h}
        begin = self.vehicle.force(self.place, self.speed)
        getattr(self, self.master)(h, begin, rates)
        force = self.vehicle.force(self.place, self.speed)
        self.rows.append((wheel.time, self.vehicle.velocity, self.vehicle.place, force, self.contact))

    def held(self, h, begin, rates):
        """The force of the beginning."""
        self.wheel.set({"drive.force": begin})
        self._take(h, rates)
        self.vehicle.advance(h, begin, begin)

    def ramped(self, h, begin, rates):
        """The force ramps to the predicted one."""
        end = self._predicted(h, begin)
        self.wheel.set({"drive.force": begin})
        self._take(h, rates | {"drive.force": (end - begin) / h})
        self.vehicle.advance(h, begin, end)

    def iterative(self, h, begin, rates):
        """The force ramps to the one that fits the motion; secants on it."""
        start, vehicle = self.wheel.save(), (self.vehicle.place, self.vehicle.velocity)
        ends, misses = [self._predicted(h, begin)], []
        for trial in range(TRIALS):
            if trial:
                self.wheel.restore(start)
                self.vehicle.place, self.vehicle.velocity = vehicle
            self.wheel.set({"drive.force": begin})
            self._take(h, rates | {"drive.force": (ends[-1] - begin) / h})
            self.vehicle.advance(h, begin, ends[-1])
            misses.append(self.vehicle.force(self.place, self.speed) - ends[-1])
            if abs(misses[-1]) < CLOSE:
                break
            slope = (misses[-1] - misses[-2]) / (ends[-1] - ends[-2]) if trial and ends[-1] != ends[-2] else -1.0
            ends.append(ends[-1] - misses[-1] / slope)
        self.wheel.forget(start)

    def velocity(self, h, begin, rates):
        """The master moves the wheel's mass under the last contact force; the FMU follows."""
        end = together(h, self.vehicle, self.place, self.speed, self.mass, self.contact)
        before = self.speed
        self.speed += h * (0.5 * (begin + end) + self.contact) / self.mass
        self.place += 0.5 * h * (before + self.speed)
        self.wheel.set({"drive.velocity": self.speed})
        self.wheel.set_rates(rates)
        self.wheel.step(h)
        self.contact, self.omega = self.wheel.get("contact.force_x", "wheel.omega")
        self.vehicle.advance(h, begin, end)

    def _predicted(self, h, begin):
        """Force at the end of the step, with the wheel as a mass: with its rotation while it rolls, held when it stands."""
        slip = abs(self.speed - self.radius * self.omega)
        if self.omega == 0.0 and abs(self.speed) < 0.02:
            return together(h, self.vehicle, self.place, self.speed, 1e6 * self.mass, -begin)
        if slip > 0.01 * abs(self.speed):
            return together(h, self.vehicle, self.place, self.speed, self.mass, self.contact)
        whole = self.mass + self.inertia / self.radius**2
        other = whole / self.mass * (begin + self.contact) - begin
        return together(h, self.vehicle, self.place, self.speed, whole, other)

    def _take(self, h, rates):
        """The FMU's step, and what it says then."""
        self.wheel.set_rates(rates)
        self.wheel.step(h)
        self.place, self.speed, self.contact, self.omega = self.wheel.get(*SEEN)

    def run(self):
        """To rest, and on for a while: time, speed, place, force of the suspension, contact force."""
        rest = None
        while rest is None or self.wheel.time < rest + WATCHED:
            self.step()
            if rest is None and self.vehicle.velocity < AT_REST:
                rest = self.wheel.time
            if self.wheel.time > 4.0 * SPEED or not abs(self.rows[-1][3]) < 1e7:
                raise Refused("no standstill")
        return np.array(self.rows), rest


MASTERS = ("held", "ramped", "velocity", "iterative")
STYLES = {"held": "s-", "ramped": "o-", "velocity": "^-", "iterative": "x:"}


def swing(table, chosen, column=3):
    """Half the peak-to-peak value of a column [kN], less its straight trend."""
    time, values = table[chosen, 0], table[chosen, column]
    return 0.5e-3 * float(np.ptp(values - np.polyval(np.polyfit(time, values, 1), time)))


def figures(fmu, master, h):
    """Distance [m], swing while braking and after two seconds of standstill [kN]; none if it fails."""
    run = Run(fmu, master, h)
    try:
        table, rest = run.run()
    except Refused:
        return None
    finally:
        run.wheel.close()
    time = table[:, 0]
    stop = table[np.argmax(time >= rest - 1e-9), 2]
    return stop, swing(table, (time > 1.5) & (time < rest - 0.5)), swing(table, time > rest + 2.0)


def plot(path, found, reference):
    """Error of the distance and both swings over the step."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "legend.frameon": False})
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.4), layout="constrained")
    titles = ("Error of the stopping distance [%]", "Swing while braking [kN]", "Swing after 2 s of standstill [kN]")
    for axis, title, k in zip(axes, titles, range(3)):
        for master in MASTERS:
            rows = [(1e3 * h, found[master, h][k]) for h in STEPS if found[master, h]]
            values = [max(100.0 * abs(v / reference - 1.0) if k == 0 else v, 1e-5) for _, v in rows]
            axis.loglog([h for h, _ in rows], values, STYLES[master], label=master, markersize=4)
        axis.set(title=title, xlabel="communication step [ms]")
        axis.set_xticks([1e3 * h for h in STEPS], [f"{1e3 * h:g}" for h in STEPS])
        axis.minorticks_off()
    axes[0].axhline(0.3, color="#777777", linestyle=":")
    axes[0].legend()
    figure.savefig(path, dpi=110)


def run(options):
    """The comparison."""
    found = {}
    with Fmu(options.fmu) as fmu:
        for master in MASTERS:
            for h in STEPS:
                found[master, h] = figures(fmu, master, h)
    reference = found["iterative", STEPS[-1]][0]
    print(f"{reference:.4f} m by the iterative master with {1e3 * STEPS[-1]:g} ms. Error of the distance [%] / swing of the")
    print("suspension's force while braking / after 2 s of standstill [kN]; communication step [ms]:\n")
    print(f"{'':10}" + "".join(f"{1e3 * h:>26g}" for h in STEPS))
    for master in MASTERS:
        cells = []
        for h in STEPS:
            row = found[master, h]
            cells.append(f"{100.0 * (row[0] / reference - 1.0):+.3f} / {row[1]:.3f} / {row[2]:.3f}" if row else "fails")
        print(f"{master:10}" + "".join(f"{cell:>26}" for cell in cells), flush=True)
    options.out.mkdir(parents=True, exist_ok=True)
    plot(options.out / "suspension.png", found, reference)
    print(f"\nwritten: {options.out / 'suspension.png'}")


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
