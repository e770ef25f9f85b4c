"""Example 2: masters that own the inertia. Explicit and iterative coupling of the wheel near standstill.

    make study NAME=masters

1. A start state without tangential force (`free_rolling`).
2. A wheel brakes from 2 m/s almost to rest under masters that differ in what they own and exchange (below).
3. Error of each against the run in which the FMU owns everything, over the communication step.
4. The same with steps that follow the energy which the coupling creates (`wheelrail.ecco`).
5. Largest stable step of the explicit masters, over the speed.
6. A plot of errors and limits, and of the force.

What they own and exchange:

    monolithic     the FMU owns all inertia (force and moment control): nothing is exchanged
    vehicle        the master owns the vehicle: it prescribes V, the FMU returns the force on the hub
    wheel          the master owns vehicle, hub and wheel: it prescribes V and omega, the FMU returns force and moment

    Jacobi         explicit: both sides step with what the other had at the beginning of the step
    Gauss-Seidel   explicit: the master steps with the old forces, the FMU follows to the new velocities
    iterative      implicit: BDF2 in the master, the interface solved by Broyden's method, the FMU rolled back for
                   every trial with fmi2SetFMUstate

Creep forces are stiff at low speed. On Carter's slope the contact is a damper c = 2 F_n R/(a V) between V and R omega, so
an explicit master of the wheel is expected to need h < 2 m/c with the effective mass 1/m = 1/m_x + R^2/I. At low speed
the contact almost holds the rim, and the hub swings on the elastic wheel with m of the hub alone; the contact takes
energy out of the swing, the lag of the master, h/2 (Gauss-Seidel) or 3h/2 (Jacobi), puts energy in: h < 2 m/c or 2/3 m/c.
The example prints accuracy over the communication step and the measured limit over the speed, and draws both.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, Wheel
from wheelrail.ecco import StepControl, bond
from wheelrail.plots import Picture, save

SPEED = 2.0  # m/s at the start
RESIDUAL_SPEED = 0.05  # m/s, about, at the end
DURATION = 2.0  # s, of the braking
SIMULATED = DURATION  # s, of it
VEHICLE = 9872.0  # kg, the wheel's share of the vehicle
TOLERANCE = 1e-9  # m/s, of the interface velocities
WATCHED = ("wheel.velocity", "contact.force_x")
TRIALS = 30  # of a step of the iterative master
COLD = {"thermal.enabled": False}  # the masters are about forces


class Unbalanced(Exception):
    """An iterative step that finds no balance."""


def free_rolling(fmu, speed):
    """Start state without tangential force: at zero creepage the deformed wheel still feels some."""
    creepage, force = [0.0, 1e-6], []
    while abs(creepage[-1] - creepage[-2]) > 1e-12:
        for xi in creepage[len(force) :]:
            with Wheel(fmu, COLD | {"initial.velocity": speed, "initial.creepage": xi}) as wheel:
                force.append(wheel.get("contact.force_x"))
        slope = (force[-1] - force[-2]) / (creepage[-1] - creepage[-2])
        creepage.append(creepage[-1] - force[-1] / slope)
    return COLD | {"initial.velocity": speed, "initial.creepage": creepage[-1]}


class Rolling:
    """What masters need to know of the wheel: inertia [kg, kg m^2] and the sizes of the contact."""

    def __init__(self, wheel):
        self.radius, self.mass, self.inertia = wheel.get("wheel.radius", "wheel.mass", "wheel.inertia")
        self.half_width, self.load = wheel.get("contact.half_width", "contact.force_y")

    def effective_mass(self):
        """Inertia against slip between rim and rail [kg]."""
        return 1.0 / (1.0 / (self.mass + VEHICLE) + self.radius**2 / self.inertia)

    def carter_limit(self, speed):
        """Largest stable explicit step 2 m/c on Carter's slope [s]."""
        damping = 2.0 * self.load * self.radius / (self.half_width * speed)
        return 2.0 * self.effective_mass() / damping

    def brake_moment(self, time):
        """Brake moment [N m]: a smooth pulse that takes the speed from SPEED to RESIDUAL_SPEED in DURATION."""
        rolling_mass = self.mass + VEHICLE + self.inertia / self.radius**2
        peak = 2.0 * rolling_mass * self.radius * (SPEED - RESIDUAL_SPEED) / DURATION
        return -peak * np.sin(np.pi * time / DURATION) ** 2


class Split:
    """The FMU under prescribed velocities: V alone (`owns="vehicle"`) or V and omega (`owns="wheel"`).

    `inertia` is what the master owns, `forces` what the FMU exerts on it at the present velocities.
    """

    def __init__(self, fmu, owns, speed):
        self.both = owns == "wheel"
        inputs = {"control.translation": "velocity", "drive.velocity": speed}
        start = free_rolling(fmu, speed)
        with Wheel(fmu, start) as probe:
            self.rolling = Rolling(probe)
            if self.both:
                inputs |= {"control.rotation": "velocity", "drive.omega": probe.get("wheel.omega")}
        self.wheel = Wheel(fmu, start | {"vehicle.mass": 0.0}, inputs)
        own = [self.rolling.mass + VEHICLE, self.rolling.inertia] if self.both else [VEHICLE]
        self.inertia = np.array(own)
        # The FMU keeps the inertia of the wheel; its share in the reaction is taken out where the master owns it too.
        self.counted_twice = np.array([self.rolling.mass, self.rolling.inertia]) if self.both else np.zeros(1)

    def velocities(self):
        names = ("wheel.velocity", "wheel.omega")[: len(self.inertia)]
        return np.array(self.wheel.get(*names, "wheel.omega")[:-1])

    def forces(self):
        count = len(self.inertia)
        accelerations = self.wheel.get("wheel.acceleration", "wheel.angular_acceleration")[:count]
        reactions = self.wheel.get("hub.force_x", "hub.moment")[:count]
        return self.counted_twice * accelerations - reactions

    def loads(self, moment):
        """External loads on what the master owns."""
        return np.array([0.0, moment]) if self.both else np.zeros(1)

    def step(self, h, velocities, moment):
        """Takes the FMU to the new velocities, under the brake moment if it owns the rotation."""
        self.wheel.set({"drive.velocity": velocities[0]} | ({"drive.omega": velocities[1]} if self.both else {}))
        if not self.both:
            ramp(self.wheel, h, moment)
        self.wheel.step(h)

    def close(self):
        self.wheel.close()


def ramp(wheel, h, moment):
    """The moment rises from its present value to the given one over the next step."""
    present = wheel.get("hub.moment")
    wheel.set({"drive.moment": present})
    wheel.set_rates({"drive.moment": (moment - present) / h})


def explicit(split, h, moments, lag):
    """Explicit Euler in the master; the FMU gets its new velocities (`lag = 0`, Gauss-Seidel) or its old ones
    (`lag = 1`, Jacobi). Yields the velocities of the master after each step.
    """
    velocities = split.velocities()
    for moment in moments:
        before, velocities = velocities, velocities + h * (split.forces() + split.loads(moment)) / split.inertia
        split.step(h, before if lag else velocities, moment)
        yield velocities


def iterative(split, h, moments, trials=None):
    """BDF2 in the master, started by backward Euler; Broyden's method on the interface velocities with rollback.

    Yields the velocities after each step; `trials` collects the number of trial steps.
    """
    now = split.velocities()
    before, jacobian = None, None
    for moment in moments:
        if before is None:
            gain, known, guess = 1.0 / h, -now / h, now.copy()
        else:
            gain, known, guess = 1.5 / h, (-2.0 * now + 0.5 * before) / h, 2.0 * now - before
        if jacobian is None or before is None:
            jacobian = np.diag(split.inertia * gain)
        start = split.wheel.save()
        count = 0

        def residual(velocities):
            """Momentum balance of the master after a trial step [N, N m]."""
            nonlocal count
            if count:
                split.wheel.restore(start)
            count += 1
            split.step(h, velocities, moment)
            return split.inertia * (gain * velocities + known) - split.loads(moment) - split.forces()

        balance = residual(guess)
        while True:
            change = -np.linalg.solve(jacobian, balance)
            guess, previous = guess + change, balance
            balance = residual(guess)
            if np.max(np.abs(change)) < TOLERANCE:
                break
            if count >= TRIALS:
                raise Unbalanced(f"no balance in {count} trials at {split.wheel.time:g} s: last change {change}")
            jacobian += np.outer(balance - previous - jacobian @ change, change) / (change @ change)
        split.wheel.forget(start)
        before, now = now, guess
        if trials is not None:
            trials.append(count)
        yield now


MASTERS = {
    "Jacobi": lambda split, h, moments: explicit(split, h, moments, lag=1),
    "Gauss-Seidel": lambda split, h, moments: explicit(split, h, moments, lag=0),
    "iterative": iterative,
}


def moments_of(rolling, h, duration=None):
    """Brake moments at the end of each step [N m]."""
    return [rolling.brake_moment((k + 1) * h) for k in range(round((duration or SIMULATED) / h))]


def monolithic(fmu, h, duration=None):
    """WATCHED at the communication points from the FMU that owns everything."""
    with Wheel(fmu, free_rolling(fmu, SPEED) | {"vehicle.mass": VEHICLE}) as wheel:
        rows = [wheel.get(*WATCHED)]
        for moment in moments_of(Rolling(wheel), h, duration):
            ramp(wheel, h, moment)
            wheel.step(h)
            rows.append(wheel.get(*WATCHED))
    return np.array(rows)


def coupled(fmu, owns, master, h, duration=None, trials=None):
    """WATCHED at the communication points from a master; raises Refused or Unbalanced when it fails. `trials` collects
    the number of trial steps of the iterative master.
    """
    split = Split(fmu, owns, SPEED)
    options = {} if trials is None else {"trials": trials}
    try:
        rows = [split.wheel.get(*WATCHED)]
        for _ in MASTERS[master](split, h, moments_of(split.rolling, h, duration), **options):
            rows.append(split.wheel.get(*WATCHED))
    finally:
        split.close()
    return np.array(rows)


def controlled(fmu, owns, energy, duration=None):
    """Times [s] and WATCHED of an explicit Gauss-Seidel master whose steps follow the energy [J] that its bonds create: held forces
    beside those that the FMU exerts, at the same velocities."""
    split, control, h = Split(fmu, owns, SPEED), StepControl(energy, 2, 1e-4, 2e-2), SHOWN
    rows, velocities, felt = [(0.0, *split.wheel.get(*WATCHED))], split.velocities(), split.forces()
    try:
        while (left := (duration or SIMULATED) - split.wheel.time) > 1e-9:
            h = min(h, left)
            moment = split.rolling.brake_moment(split.wheel.time + h)
            before, velocities = velocities, velocities + h * (felt + split.loads(moment)) / split.inertia
            split.step(h, velocities, moment)
            exerted, flows = split.forces(), zip(before, velocities)
            bonds = [bond(h, ((-a, -a), flow), ((-a, -b), flow)) for a, b, flow in zip(felt, exerted, flows)]
            h, felt = control.next(h, bonds), exerted
            rows.append((split.wheel.time, *split.wheel.get(*WATCHED)))
    finally:
        split.close()
    return np.array(rows)


def errors(table, reference):
    """Largest differences of speed [m/s] and tangential force [N] from a reference with a multiple of the points."""
    return np.abs(table - reference[:: (len(reference) - 1) // (len(table) - 1)]).max(axis=0)


def slip_growth(fmu, master, speed, h):
    """Growth of a small slip (creepage 3e-5) in free rolling under a master that owns the wheel, from the first to the
    last third of six passages of the half-width through the contact: below one it dies out.
    """
    split = Split(fmu, "wheel", speed)
    radius = split.rolling.radius
    steps = max(150, round(6.0 * split.rolling.half_width / speed / h))
    # A pulse of moment in the first step gives the slip, more than the torsion that the start leaves.
    pulse = 3e-5 * speed / radius * split.rolling.inertia / h
    slip = []
    try:
        for v in MASTERS[master](split, h, [pulse] + [0.0] * (steps - 1)):
            slip.append(v[0] - radius * v[1])
            if abs(slip[-1]) > 1e-3 * speed:
                return np.inf
    except (Refused, Unbalanced):
        return np.inf
    finally:
        split.close()
    first, last = (np.ptp(part) for part in (slip[: steps // 3], slip[-steps // 3 :]))
    return last / first


def stability_limit(fmu, master, speed, guess, accuracy=1.1):
    """Largest communication step [s] at which slip dies out, within the factor `accuracy`."""
    low, high = guess, guess
    while slip_growth(fmu, master, speed, low) >= 1.0:
        high, low = low, 0.5 * low
    while slip_growth(fmu, master, speed, high) < 1.0:
        low, high = high, 2.0 * high
    while high > accuracy * low:
        middle = (low * high) ** 0.5
        low, high = (middle, high) if slip_growth(fmu, master, speed, middle) < 1.0 else (low, middle)
    return (low * high) ** 0.5


STEPS = (4e-3, 2e-3, 1e-3, 5e-4)  # s
REFERENCE_STEP = 1.25e-4  # s
ENERGIES = (1e-1, 1e-2)  # J, that a step may create
LIMIT_SPEEDS = (10.0, 5.0, 2.0, 1.0)  # m/s
EXPLICIT = ("Jacobi", "Gauss-Seidel")
SHOWN = 1e-3  # s, step of the runs whose force is drawn
BRIEF = {
    "STEPS": (4e-3,), "REFERENCE_STEP": 2e-3, "SHOWN": 4e-3, "ENERGIES": (1e-1,), "LIMIT_SPEEDS": (10.0,),
    "SIMULATED": 0.4,
}  # fmt: skip


def accuracy(fmu, reference):
    """Errors of every coupling and step; prints them."""
    found = {}
    print(f"Largest error of V [m/s] / F_x [N] while braking from {SPEED:g} to {reference[-1, 0]:.2g} m/s, against")
    print(f"the monolithic run with {1e3 * REFERENCE_STEP:g} ms. Communication step [ms]:\n")
    print(f"{'':24}" + "".join(f"{1e3 * h:>20g}" for h in STEPS))
    runs = [("monolithic", None)] + [(owns, master) for owns in ("vehicle", "wheel") for master in MASTERS]
    for owns, master in runs:
        cells, trials = [], []
        for h in STEPS:
            try:
                counted = trials if master == "iterative" else None
                table = coupled(fmu, owns, master, h, trials=counted) if master else monolithic(fmu, h)
                found[owns, master, h] = errors(table, reference)
                cells.append("{:.1e} / {:.1e}".format(*found[owns, master, h]))
            except (Refused, Unbalanced):
                cells.append("fails")
        note = f"   {np.mean(trials):.1f} trials a step" if trials else ""
        print(f"{owns:11}{master or '':13}" + "".join(f"{cell:>20}" for cell in cells) + note)
    return found


def by_energy(fmu, reference):
    """Prints errors and numbers of steps of the explicit master of the vehicle whose steps follow the energy it creates."""
    print("\nOwner of the vehicle, Gauss-Seidel, steps by the energy created; J tolerated, steps, error of V [m/s] / F_x [N]:\n")
    times = REFERENCE_STEP * np.arange(len(reference))
    for energy in ENERGIES:
        table = controlled(fmu, "vehicle", energy)
        off = [np.abs(table[:, k + 1] - np.interp(table[:, 0], times, reference[:, k])).max() for k in (0, 1)]
        print(f"{energy:8g}{len(table) - 1:8d}{off[0]:12.1e} / {off[1]:.1e}", flush=True)


def limits(fmu):
    """Stability limits [s] of the explicit masters that own the wheel, and that of Carter's slope; prints them."""
    rows = []
    print("\nLargest stable step of a master that owns the wheel [microseconds]\n")
    print(f"{'V [m/s]':>8}{'2 m/c':>9}" + "".join(f"{master:>15}" for master in EXPLICIT))
    for speed in LIMIT_SPEEDS:
        with Wheel(fmu, COLD | {"initial.velocity": speed}) as wheel:
            carter = Rolling(wheel).carter_limit(speed)
        rows.append([carter, *(stability_limit(fmu, master, speed, 0.3 * carter) for master in EXPLICIT)])
        print(f"{speed:8g}" + "".join(f"{1e6 * h:{width}.1f}" for h, width in zip(rows[-1], (9, 15, 15))), flush=True)
    return np.array(rows)


COLOUR = {"Jacobi": "#D55E00", "Gauss-Seidel": "#E69F00", "iterative": "#0072B2", None: "#777777"}
STYLE = {"wheel": "o-", "vehicle": "s--", "monolithic": "x:"}


def plot(path, found, limit, reference, shown):
    """Draws error over step, limit over speed, and the force with one step."""
    figure = Picture(figsize=(8, 5.8))
    axes = figure.subplot_mosaic([["error", "limit"], ["force", "legend"]], width_ratios=(1, 1))
    draw_error(axes["error"], found)
    draw_limit(axes["limit"], limit)
    draw_force(axes["force"], reference, shown)
    entries = {}
    for axis in axes.values():
        handles, labels = axis.get_legend_handles_labels()
        entries |= {label: handle for handle, label in zip(handles, labels) if label not in entries}
    axes["legend"].axis("off")
    title = "master owns, and how it exchanges"
    axes["legend"].legend(entries.values(), entries, title=title, loc="center left", alignment="left")
    save(path, figure)


def draw_error(axis, found):
    """Error of the velocity over the communication step."""
    for owns, master in dict.fromkeys(key[:2] for key in found):
        steps = [h for h in STEPS if (owns, master, h) in found]
        label = f"{owns}: {master}" if master else f"nothing: {owns}"
        error = [found[owns, master, h][0] for h in steps]
        axis.loglog([1e3 * h for h in steps], error, STYLE[owns], color=COLOUR[master], label=label, markersize=4)
    axis.set(title="Error of $V$, braking from 2 m/s", xlabel="communication step [ms]", ylabel="m/s")
    axis.set_xticks([1e3 * h for h in STEPS], [f"{1e3 * h:g}" for h in STEPS])
    axis.minorticks_off()


def draw_limit(axis, limit):
    """Largest stable step over the speed."""
    axis.loglog(LIMIT_SPEEDS, 1e6 * limit[:, 0], ":", color=COLOUR[None], label=r"limit $2m/c$ by Carter's slope")
    for k, master in enumerate(EXPLICIT, start=1):
        axis.loglog(LIMIT_SPEEDS, 1e6 * limit[:, k], STYLE["wheel"], color=COLOUR[master], label=f"wheel: {master}", markersize=4)
    axis.set(title="Largest stable step, master owns wheel", xlabel="$V$ [m/s]", ylabel="µs")
    axis.set_xticks(LIMIT_SPEEDS, [f"{speed:g}" for speed in LIMIT_SPEEDS])
    axis.set_yticks([10, 20, 50, 100, 200], ["10", "20", "50", "100", "200"])
    axis.minorticks_off()


def draw_force(axis, reference, shown):
    """Tangential force over time with one step."""
    for master, table in shown.items():
        time = SHOWN * np.arange(len(table))
        axis.plot(time, table[:, 1] / 1e3, color=COLOUR[master], linewidth=0.8, alpha=0.4 if master in EXPLICIT else 1.0)
    time = REFERENCE_STEP * np.arange(len(reference))
    axis.plot(time, reference[:, 1] / 1e3, ":", color="black", label="nothing: reference", linewidth=1.4)
    axis.set(title=f"Tangential force, master owns wheel, {1e3 * SHOWN:g} ms", xlabel="time [s]", ylabel="kN")


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    parser.add_argument("--brief", action="store_true", help="one step and one speed, and a fifth of the braking")
    return parser.parse_args()


def run(options):
    """The comparison."""
    globals().update(BRIEF if options.brief else {})
    with Fmu(options.fmu) as fmu:
        reference = monolithic(fmu, REFERENCE_STEP)
        found = accuracy(fmu, reference)
        by_energy(fmu, reference)
        limit = limits(fmu)
        shown = {master: coupled(fmu, "wheel", master, SHOWN) for master in ("Gauss-Seidel", "iterative")}
    options.out.mkdir(parents=True, exist_ok=True)
    plot(options.out / "masters.png", found, limit, reference, shown)
    print(f"\nwritten: {options.out / 'masters.png'}")


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
