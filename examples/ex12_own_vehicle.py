"""Example 12: a vehicle of one's own on eight wheels in the FMU. A freight wagon brakes; both sides see one impulse.

    make study NAME=own-vehicle

The vehicle (`Wagon`: body and two bogies that pitch, springs and dampers) could be a multi-body program of yours: what `Coupled`
wants of it are `forces`, `advance` and `correct`. Every wheel is an FMU that owns the wheel's mass and inertia. A step of h:

1. The suspension's forces on the wheels now, where wheels and vehicle really are.
2. The vehicle's implicit step, in which wheels are masses under their last contact force: its forces at the end.
3. The wheels' steps, on the threads of a `Team`: forces ramp from 1 to 2. If a wheel refuses, all go back and the step is halved.
4. The correction: the vehicle's wheels are put where the FMUs have them. Bodies keep what 2 gave them: h/2 times the sum of 1
   and 2, which is what the wheels got. Whatever the prediction was worth, no momentum is made or lost.

From `--seize` on the second axle is held for half a second: control changes from moment to angular velocity and back, and the hot
wheel slides on under its brake. Printed: error of the speed over the change of speed for three steps, with the correction and
without; way and temperature of the stop. Drawn: speeds, loads, contact forces, temperatures.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, Team, Wheel
from wheelrail.plots import subplots

GRAVITY = 9.81  # m/s2
# A loaded four-axle wagon: masses [kg], pitch inertia [kg m2], heights above the rail [m]. Orders of magnitude.
BODY = {"mass": 70.8e3, "inertia": 2.0e6, "height": 1.9}
BOGIE = {"mass": 2.0e3, "inertia": 1.5e3, "height": 0.6}
WHEELSET = {"mass": 1.3e3, "inertia": 90.0, "radius": 0.46}
PIVOT, AXLE = 7.1, 0.9  # m: half distances of pivots, and of axles in a bogie
PIVOT_HEIGHT = 0.8  # m
# Stiffness [N/m] and damping [N s/m] of a pivot along and across, of one axle box along and across.
PIVOTS = {"along": (50e6, 100e3), "upward": (50e6, 100e3)}
BOX = {"along": (10e6, 20e3), "upward": (1.6e6, 15e3)}
SPEED, TORQUE, BUILD = 20.0, 3.7e3, 2.0  # m/s, N m on a wheel, s in which it builds up
WHEELS = 8
BODIES = 9  # coordinates x, y, pitch of body and bogies; then x of the wheels
HELD = 1e6  # times its mass counts a wheel that stands
HOLDING, SEIZING = 0.5, 0.05  # s, that a seized axle is held; s, in which it comes to rest
SMALLEST = 1e-5  # s, below which a step is not halved
SEEN = ("wheel.distance", "wheel.velocity", "wheel.omega", "contact.force_x", "hub.moment", "temperature.wheel_max")


def at(coordinate, arm, direction):
    """Row of the displacement of a point of a body: `along`, its arm the height over the centre, or `upward`, its place ahead."""
    row = np.zeros(BODIES + WHEELS)
    row[coordinate + (direction == "upward")], row[coordinate + 2] = 1.0, arm if direction == "upward" else -arm
    return row


class Wagon:
    """The vehicle: linear equations in the plane, from the static state. x along the track, y up, pitch counter-clockwise."""

    def __init__(self, speed):
        half = 0.5 * WHEELSET["mass"]
        rigid = [[part["mass"], part["mass"], part["inertia"]] for part in (BODY, BOGIE, BOGIE)]
        self.masses = np.array([*sum(rigid, []), *WHEELS * [half]])
        self.load = (BODY["mass"] + 2 * BOGIE["mass"] + 4 * WHEELSET["mass"]) * GRAVITY / WHEELS  # N, of a wheel at rest
        pivots, pulls, lifts, self.bogie_of = [], [], [], []
        for coordinate, ahead in ((3, PIVOT), (6, -PIVOT)):
            pivots.append(at(coordinate, 0.0, "upward") - at(0, ahead, "upward"))
            heights = [PIVOT_HEIGHT - part["height"] for part in (BOGIE, BODY)]
            pivots.append(at(coordinate, heights[0], "along") - at(0, heights[1], "along"))
            for axle in (AXLE, AXLE, -AXLE, -AXLE):  # left and right wheel of each
                pull = -at(coordinate, WHEELSET["radius"] - BOGIE["height"], "along")
                pull[BODIES + len(pulls)] = 1.0
                pulls.append(pull)
                lifts.append(-at(coordinate, axle, "upward"))
                self.bogie_of.append(coordinate)
        self.pulls, self.lifts = np.array(pulls), np.array(lifts)
        springs = 2 * [PIVOTS["upward"], PIVOTS["along"]] + WHEELS * [BOX["along"]] + WHEELS * [BOX["upward"]]
        rows, (k, c) = np.array(pivots + pulls + lifts), np.array(springs).T
        self.K, self.C = rows.T @ (k[:, None] * rows), rows.T @ (c[:, None] * rows)
        self.along = np.array([0, 3, 6, *range(BODIES, BODIES + WHEELS)])
        self.q, self.v, self.origin = np.zeros(len(self.masses)), np.zeros(len(self.masses)), 0.0
        self.v[self.along] = speed

    def forces(self):
        """On the wheels: of the boxes along the track [N], and the load that presses them on the rail [N]."""
        pull = -BOX["along"][0] * self.pulls @ self.q - BOX["along"][1] * self.pulls @ self.v
        lift = -BOX["upward"][0] * self.lifts @ self.q - BOX["upward"][1] * self.lifts @ self.v
        return pull, self.load - lift

    def advance(self, h, masses, others, moments):
        """Moves on by h [s], by the trapezoidal rule, with wheels as masses [kg] under boxes and other forces [N]; frames take the
        reaction of the `moments` [N m] on the wheels, forward positive. Returns the forces then."""
        m, f = self.masses.copy(), np.zeros(len(self.masses))
        m[BODIES:], f[BODIES:] = masses, others
        np.add.at(f, np.array(self.bogie_of) + 2, moments)
        A = np.diag(m) + 0.5 * h * self.C + 0.25 * h * h * self.K
        b = m * self.v + h * (f - self.K @ self.q - 0.5 * self.C @ self.v - 0.25 * h * self.K @ self.v)
        before, self.v = self.v, np.linalg.solve(A, b)
        self.q = self.q + 0.5 * h * (before + self.v)
        return self.forces()

    def correct(self, places, velocities):
        """Wheels are where they are found [m, m/s]. Places count from the first one, so that stiff springs see small numbers."""
        self.q[self.along] -= places[0] - self.origin
        self.origin = places[0]
        self.q[BODIES:], self.v[BODIES:] = places - self.origin, velocities

    def momentum(self):
        """Along the track, without the wheels [N s]."""
        return float(self.masses[[0, 3, 6]] @ self.v[[0, 3, 6]])


def hub(fmu):
    """Parameters that give a wheel half the mass and inertia of the wheelset: its rim is inside the FMU already."""
    with Wheel(fmu, {"wheel.radius": WHEELSET["radius"], "wheel.hub_mass": 0.0, "wheel.hub_inertia": 0.0}) as rim:
        mass, inertia = rim.get("wheel.mass", "wheel.inertia")
    return {"wheel.hub_mass": 0.5 * WHEELSET["mass"] - mass, "wheel.hub_inertia": 0.5 * WHEELSET["inertia"] - inertia}


class Coupled:
    """Wagon and wheels. `correction` False leaves the vehicle with the wheels that it predicted, for comparison only."""

    def __init__(self, fmu, speed=SPEED, parameters=None, correction=True, threads=None):
        self.wagon, self.correction, self.time = Wagon(speed), correction, 0.0
        # The state of the start on both sides: free rolling, springs under their static loads.
        own = {"initial.velocity": speed, "model.nominal_load": self.wagon.load, "wheel.radius": WHEELSET["radius"]}
        own |= {"vehicle.mass": 0.0, "vehicle.damping": BOX["upward"][1]} | hub(fmu) | (parameters or {})
        self.wheels, self.team = [], Team(threads)
        try:
            for k in range(WHEELS):
                self.wheels.append(Wheel(fmu, own, {"drive.load": self.wagon.load}, name=f"wheel {k + 1}"))
            self.seen = np.array([wheel.get(*SEEN) for wheel in self.wheels]).T
        except BaseException:
            self.close()
            raise
        self.felt = np.zeros(WHEELS)  # N s, impulses of the boxes on the wheels so far
        self.rows = [self.row()]

    def brake(self, time):
        """Torque on every wheel [N m]."""
        return np.full(WHEELS, TORQUE * min(time / BUILD, 1.0))

    def step(self, h):
        """One step of both sides; a step that a wheel refuses is taken in halves."""
        vehicle = self.wagon.q, self.wagon.v
        saved = [wheel.save() for wheel in self.wheels]
        try:
            self._step(h)
        except Refused:
            self.wagon.q, self.wagon.v = vehicle
            for wheel, state in zip(self.wheels, saved):
                wheel.restore(state)
            if 0.5 * h < SMALLEST:
                raise
            self.step(0.5 * h)
            self.step(0.5 * h)
        finally:
            for wheel, state in zip(self.wheels, saved):
                wheel.forget(state)

    def _step(self, h):
        begin, load = self.wagon.forces()
        masses, others = self.predicted(begin)
        # Vehicle first; `advance` makes new arrays, so that those of the beginning stay.
        end, new_load = self.wagon.advance(h, masses, others, self.seen[4])
        torque = self.brake(self.time), self.brake(self.time + h)
        ramps = {"drive.force": (begin, end), "drive.load": (load, new_load), "brake.torque": torque}
        self.team.map(lambda k: self.take(k, h, ramps), range(WHEELS))
        self.seen = np.array([wheel.get(*SEEN) for wheel in self.wheels]).T
        if self.correction:
            self.wagon.correct(self.seen[0], self.seen[1])
        self.time += h
        self.felt += 0.5 * h * (begin + end)
        self.rows.append(self.row())

    def take(self, k, h, ramps):
        """The step of one wheel: values at the beginning, and rates for this step."""
        wheel = self.wheels[k]
        wheel.set({name: begin[k] for name, (begin, _) in ramps.items()})
        wheel.set_rates({name: (end[k] - begin[k]) / h for name, (begin, end) in ramps.items()})
        try:
            wheel.step(h)
        except Refused as refusal:
            raise Refused(f"wheel {k + 1} at {self.time:g} s: {refusal}") from refusal

    def predicted(self, pulls):
        """Masses [kg] of the wheels in the vehicle's step and forces [N] on them beside the boxes': those of the contact now. A
        wheel that rolls counts with its rotation, one that stands does not move."""
        _, velocity, omega, contact, *_ = self.seen
        mass, rim = 0.5 * WHEELSET["mass"], WHEELSET["radius"] * omega
        rolling = np.abs(velocity - rim) < 0.01 * np.maximum(np.abs(velocity), np.abs(rim))
        stands = (np.abs(omega) < 1e-9) & (np.abs(velocity) < 0.02)
        masses = np.where(rolling, mass + 0.5 * WHEELSET["inertia"] / WHEELSET["radius"] ** 2, mass)
        masses = np.where(stands, HELD * mass, masses)
        return masses, np.where(stands, -pulls, masses / mass * (pulls + contact) - pulls)

    def turn(self, wheels, omega):
        """Prescribes the angular velocity [rad/s] of some wheels, to which they come linearly in the next step; `hub.moment` is
        what it takes."""
        for k in wheels:
            self.wheels[k].set({"control.rotation": "velocity", "drive.omega": omega})

    def release(self, wheels):
        """Gives the rotation of some wheels back to moment and brake."""
        for k in wheels:
            self.wheels[k].set({"control.rotation": "moment", "drive.moment": 0.0})

    def row(self):
        """Time [s], speed of the body [m/s] and its way [m]; of the wheels loads [kN], contact forces [kN], peripheral speeds [m/s]
        and hottest places [°C]."""
        kilo = [1e-3 * values for values in (self.wagon.forces()[1], self.seen[3])]
        of_wheels = [*kilo, WHEELSET["radius"] * self.seen[2], self.seen[5] - 273.15]
        return [self.time, self.wagon.v[0], self.wagon.origin + self.wagon.q[0], *np.concatenate(of_wheels)]

    def close(self):
        """Frees wheels and threads."""
        self.team.close()
        for wheel in self.wheels:
            wheel.close()


AXLE_WHEELS = (2, 3)  # of the second axle
CHECKED = (2.0, (5e-3, 2e-3, 1e-3), 2.5e-4)  # s: duration of the runs that are compared, their steps, that of the reference
BRIEF = (0.2, (5e-3,), 1e-3)  # likewise


def braked(fmu, h, duration, **options):
    """Speeds [m/s] of the body in a braking, from the start on."""
    coupled = Coupled(fmu, **options)
    try:
        for _ in range(round(duration / h)):
            coupled.step(h)
        return np.array(coupled.rows)[:, 1]
    finally:
        coupled.close()


def errors(fmu, duration, steps, reference, **options):
    """Largest error of the speed over its change by step [s] and correction, with or without: `{(step, correction): error}`."""
    exact = braked(fmu, reference, duration, **options)
    found = {}
    for h in steps:
        for correction in (True, False):
            speeds = braked(fmu, h, duration, correction=correction, **options)
            off = np.abs(speeds - exact[:: round(h / reference)]).max()
            found[h, correction] = off / (exact[0] - exact[-1])
    return found


def stop(fmu, h, seize, longest=3.0 * SPEED):
    """Brakes to rest, or for the time `longest` [s]; the second axle is held from the time `seize` [s] on for a while. Returns the table of `row`."""
    coupled, start = Coupled(fmu), None
    try:
        while coupled.wagon.v[0] > 0.01 and coupled.time < longest:
            since = coupled.time + h - seize  # s, at the end of the next step
            if 0.0 < since <= HOLDING:
                start = coupled.seen[2][AXLE_WHEELS[0]] if start is None else start
                coupled.turn(AXLE_WHEELS, start * max(1.0 - since / SEIZING, 0.0))
            elif since > HOLDING and start is not None:
                coupled.release(AXLE_WHEELS)
                start = None
            coupled.step(h)
        return np.array(coupled.rows)
    finally:
        coupled.close()


def plot(path, table):
    """Speeds, loads of the axles, contact forces and temperatures."""
    figure, axes = subplots(2, 2, figsize=(8, 5), sharex=True)
    time, of = table[:, 0], lambda block: table[:, 3 + block * WHEELS : 3 + (block + 1) * WHEELS : 2]
    titles = ("Load of a wheel [kN]", "Contact force of a wheel [kN]", "Speed [m/s]", "Hottest place of the tread [°C]")
    for block, (axis, title) in enumerate(zip((axes[0, 1], axes[1, 0], axes[0, 0], axes[1, 1]), titles)):
        for k, values in enumerate(of(block).T):
            axis.plot(time, values, label=f"axle {k + 1}")
        axis.set(title=title)
        axis.grid(alpha=0.3)
    axes[0, 0].plot(time, table[:, 1], "k--", label="body")
    axes[0, 0].legend()
    for axis in axes[1]:
        axis.set(xlabel="time [s]")
    figure.savefig(path, dpi=110)


def run(options):
    """The comparison, the stop and its picture."""
    with Fmu(options.fmu) as fmu:
        duration, steps, reference = BRIEF if options.brief else CHECKED
        found = errors(fmu, duration, steps, reference, parameters={"thermal.enabled": False})
        print(f"Error of the speed over its change in {duration:g} s, against steps of {1e3 * reference:g} ms:\n")
        print(f"{'step [ms]':>10}{'both sides see one impulse':>30}{'vehicle keeps its prediction':>32}")
        for h in steps:
            print(f"{1e3 * h:10g}{found[h, True]:30.1e}{found[h, False]:32.1e}")
        table = stop(fmu, options.step, options.seize, *([duration] if options.brief else []))
    way, hottest = table[-1, 2] - table[0, 2], table[:, -WHEELS:].max()
    end = "rest" if table[-1, 1] <= 0.01 else f"{table[-1, 1]:.2f} m/s"
    print(f"\n{table[0, 1]:g} m/s to {end} in {table[-1, 0]:.2f} s and {way:.1f} m; hottest place {hottest:.0f} °C")
    options.out.mkdir(parents=True, exist_ok=True)
    plot(options.out / "own_vehicle.png", table)
    print(f"written: {options.out / 'own_vehicle.png'}")


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    parser.add_argument("--step", type=float, default=5e-3, help="of the stop (s), default: %(default)s")
    parser.add_argument("--seize", type=float, default=4.0, help="when an axle seizes (s), inf: never; default: %(default)s")
    parser.add_argument("--brief", action="store_true", help="fewer steps and a fifth of a second of the stop")
    options = parser.parse_args()
    if not SMALLEST <= options.step <= 0.05:
        parser.error(f"--step {options.step:g} is not in {SMALLEST:g} to 0.05 s")
    if not options.seize >= 0.0:
        parser.error(f"--seize {options.seize:g} is below 0 s")
    return options


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
