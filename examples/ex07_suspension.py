"""Example 7: masters of a vehicle on its primary suspension. A wheel brakes from 5 m/s to rest; how do the sides exchange?

    make study NAME=suspension

The vehicle (a quarter of a bogie's load) hangs on the wheel by a spring and a damper along the track, as stiff as in the
Manchester coach; the brake is inside the FMU. Exchanges, over a communication step h:

    held        the FMU owns the wheel, the suspension's force at the beginning of the step is held
    ramped      the FMU owns the wheel, the force ramps to that of an implicit step in which the wheel is a mass under the
                last contact force (what `wheelrail.train` does)
    velocity    the master owns the wheel's mass, prescribes its velocity and gets contact.force_x
    iterative   as ramped, and the step is repeated from a saved state until the force at its end fits the motion found

Printed for each and every step: stopping distance against that of the iterative master with the smallest step, the largest
swing of the suspension's force while it brakes steadily, and its swing after two seconds of standstill. Then, for held and
ramped forces, how far the force is off over the whole run and how many steps it took: with steps that are all equal, and with
steps controlled by the energy that the coupling creates (`wheelrail.ecco`). Drawn: all of them.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, Wheel
from wheelrail.ecco import StepControl, Suspension
from wheelrail.plots import COLOURS, save, subplots

SPEED = 5.0  # m/s
VEHICLE = 8460.0  # kg on one wheel's suspension
STIFFNESS, DAMPING = 31.391e6, 30e3  # N/m, N s/m along the track, one wheel (Manchester vehicle 1; damping: judgement)
SUSPENSION = Suspension(STIFFNESS, DAMPING)
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
        return SUSPENSION.force(*self.elongation(place, velocity))

    def elongation(self, place, velocity):
        """Of the suspension [m], and its rate [m/s]."""
        return self.place - place, self.velocity - velocity

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
    """A stop under one master. With a `control` the steps after the first follow the energy that the coupling creates, which
    `bonds` collects: time [s], step [s], `Bond`."""

    def __init__(self, fmu, master, h, control=None):
        self.master, self.h, self.control, self.bonds = master, h, control, []
        if control and master not in CONTROLLED:
            raise ValueError(f"master = {master!r}: steps are controlled for {', '.join(CONTROLLED)}")
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
        before, speed = self.vehicle.elongation(self.place, self.speed), self.speed
        getattr(self, self.master)(h, begin, rates)
        force = self.vehicle.force(self.place, self.speed)
        if self.master in CONTROLLED:
            bond = SUSPENSION.residual(h, before, self.vehicle.elongation(self.place, self.speed), self.felt)
            self.bonds.append((wheel.time, h, bond))
            if self.control:
                self.h = self.control.next(h, [bond], self.horizon((speed - self.speed) / h))
        self.rows.append((wheel.time, self.vehicle.velocity, self.vehicle.place, force, self.contact))

    def horizon(self, deceleration):
        """Time [s] to what is foreseen: the end of the brake's build-up, and standstill at a deceleration [m/s2]."""
        building = BUILD - self.wheel.time
        stopping = self.speed / deceleration if deceleration > 0.0 and self.omega > 0.0 else np.inf
        return min(building if building > 0.0 else np.inf, stopping)

    def held(self, h, begin, rates):
        """The force of the beginning."""
        self.felt = begin, begin
        self.wheel.set({"drive.force": begin})
        self._take(h, rates)
        self.vehicle.advance(h, begin, begin)

    def ramped(self, h, begin, rates):
        """The force ramps to the predicted one."""
        end = self._predicted(h, begin)
        self.felt = begin, end
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
CONTROLLED = {"held": 2, "ramped": 3}  # power of the step with which the energy falls that the coupling creates in it
ENERGIES = (1e-3, 1e-4, 1e-5)  # J, tolerated in a step
SMALLEST, LARGEST = 1e-4, 1e-2  # s, steps
REFERENCE = 1e-4  # s, step of the ramped run with which forces are compared
BRIEF = {"STEPS": (5e-3,), "ENERGIES": (1e-1,), "REFERENCE": 5e-3}
LEAST = 1e-5  # %, kN: what is smaller is drawn here
STYLES = {"held": "s-", "ramped": "o-", "velocity": "^-", "iterative": "x:"}


def swing(table, chosen, column=3):
    """Half the peak-to-peak value of a column [kN], less its straight trend."""
    time, values = table[chosen, 0], table[chosen, column]
    return 0.5e-3 * float(np.ptp(values - np.polyval(np.polyfit(time, values, 1), time)))


def figures(fmu, master, h):
    """Distance [m], swing while braking and after two seconds of standstill [kN]; none if it fails."""
    try:
        _, table, rest = course(fmu, master, h)
    except Refused:
        return None
    time = table[:, 0]
    stop = table[np.argmax(time >= rest - 1e-9), 2]
    return stop, swing(table, (time > 1.5) & (time < rest - 0.5)), swing(table, time > rest + 2.0)


def control(master, energy):
    """Steps of a master that follow the energy [J] that its coupling creates."""
    return StepControl(energy, CONTROLLED[master], SMALLEST, LARGEST)


def course(fmu, master, h, control=None):
    """A stop: the run, its table and when it came to rest [s]."""
    run = Run(fmu, master, h, control)
    try:
        return run, *run.run()
    finally:
        run.wheel.close()


def deviation(table, reference, end):
    """Root mean square difference of the suspension's force [N] from a reference, up to a time [s]."""
    time = np.linspace(0.0, end, round(end / REFERENCE))
    force = [np.interp(time, rows[:, 0], rows[:, 3]) for rows in (table, reference)]
    return float(np.sqrt(np.mean((force[0] - force[1]) ** 2)))


def equal_and_controlled(fmu):
    """Steps and deviation of the force [N] up to two seconds of standstill: (master, controlled) to a list of pairs; printed."""
    _, reference, rest = course(fmu, "ramped", REFERENCE)
    end, found = rest + 2.0, {}
    count = lambda table: int(np.sum(table[:, 0] < end))
    print(f"\nDeviation of the force [N] from steps of {1e3 * REFERENCE:g} ms, root mean square, and number of steps; energy [J] tolerated:\n")
    for master in CONTROLLED:
        cells = {f"{1e3 * h:g} ms": (h, None) for h in STEPS} | {f"{e:g} J": (1e-3, control(master, e)) for e in ENERGIES}
        for name, (h, controlled) in cells.items():
            try:
                _, table, _ = course(fmu, master, h, controlled)
            except Refused:
                print(f"{master:10}{name:>10}     fails", flush=True)
                continue
            found.setdefault((master, bool(controlled)), []).append((count(table), deviation(table, reference, end)))
            print(f"{master:10}{name:>10}{found[master, bool(controlled)][-1][1]:10.1f}{count(table):10d}", flush=True)
    return found


def plot(path, found, reference, steps):
    """Error of the distance and both swings over the step; deviation of the force over the number of steps."""
    figure, grid = subplots(2, 2, figsize=(8, 6))
    axes = grid.flat
    quantities = (
        ("Error of the stopping distance", "%"), ("Swing while braking", "kN"), ("Swing after 2 s of standstill", "kN"),
    )  # fmt: skip
    for axis, (title, unit), k in zip(axes[:3], quantities, range(3)):
        for master in MASTERS:
            rows = [(1e3 * h, found[master, h][k]) for h in STEPS if found[master, h]]
            values = [max(100.0 * abs(v / reference - 1.0) if k == 0 else v, LEAST) for _, v in rows]
            axis.loglog([h for h, _ in rows], values, STYLES[master], label=master, markersize=4)
        axis.set(title=title, xlabel="communication step [ms]", ylabel=unit)
        axis.set_xticks([1e3 * h for h in STEPS], [f"{1e3 * h:g}" for h in STEPS])
        axis.minorticks_off()
    axes[2].set_yticks([1, 2, 5], ["1", "2", "5"])
    axes[0].legend(loc="center left", bbox_to_anchor=(0.0, 0.42))
    for (master, controlled), points in steps.items():
        label = f"{master}, by energy" if controlled else f"{master}, equal steps"
        line = "*--" if controlled else STYLES[master]
        axes[3].loglog(*zip(*points), line, label=label, color=COLOURS[MASTERS.index(master)], markersize=8 if controlled else 4)
    axes[3].set(title="Deviation of the force, rms", xlabel="steps", ylabel="N", ylim=(0.03, None))
    axes[3].set_xticks([1e3, 3e3, 1e4, 3e4], ["1,000", "3,000", "10,000", "30,000"])
    axes[3].minorticks_off()
    axes[3].legend(loc="lower left")
    save(path, figure)


def run(options):
    """The comparison."""
    globals().update(BRIEF if options.brief else {})
    found = {}
    with Fmu(options.fmu) as fmu:
        for master in MASTERS:
            for h in STEPS:
                found[master, h] = figures(fmu, master, h)
        report(found)
        steps = equal_and_controlled(fmu)
    options.out.mkdir(parents=True, exist_ok=True)
    plot(options.out / "suspension.png", found, found["iterative", STEPS[-1]][0], steps)
    print(f"\nwritten: {options.out / 'suspension.png'}")


def report(found):
    """Prints the figures of every master and step."""
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


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    parser.add_argument("--brief", action="store_true", help="one step, in seconds")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
