"""Example 9: eight wheels, stepped one after the other and on threads.

    make study NAME=eight-wheels
    make study NAME=eight-wheels ARGS="--before older.fmu"

A master in Python steps wheels at the same time with nothing but threads: while the FMU computes, its caller does not hold
the lock of the interpreter. Every instance has its own state; equal ones share their model. Wheels whose brakes differ take steps of
different length: a `Team` gives the next wheel to whichever thread is free.

Wheels with one line of contact and on an elliptical patch of seven lines (or with the preset that `--set preset=` names)
brake at half the adhesion limit, with moments that are held and that vary by ±30 % in 40 ms, or as `--change` and `--period`
say, those of each wheel at another time; and they slide, locked by their brakes, at a speed that is held. An older FMU runs
beside the present one, some steps in turn, so that both see the same load of the machine.
"""

import argparse
from contextlib import ExitStack
from time import perf_counter, process_time

from wheelrail import Fmu, Refused, Team, Wheel

WHEELS, STEP = 8, 1e-3  # number, s
BATCH = 10  # steps that are timed together, some 20 ms as in the benchmark of the Rust library
SPEED = 27.8  # m/s
PRESETS = ("railway", "railway_ellipse")
LOCKING = 40e3  # torque of a brake that locks a wheel on a dry rail, N m
DRIVES = ("held", "varying", "slide")


class Brakes:
    """Brakes of one of `DRIVES`, whose moments vary by the share `change` in the time `period` (s) if they do."""

    def __init__(self, drive, change, period, settling=None):
        self.drive, self.change, self.period = drive, change if drive == "varying" else 0.0, period
        self.start = {"initial.velocity": SPEED} | ({"control.translation": "velocity"} if drive == "slide" else {})
        # Until what is measured begins, s.
        self.settling = settling if settling is not None else 0.3 if drive == "slide" else 0.1

    def inputs(self, wheel, time):
        """Inputs of a wheel: half of the adhesion limit, and a triangle that each wheel has at another time; or a brake that locks it."""
        if self.drive == "slide":
            return {"brake.torque": LOCKING * min(1.0, time / 0.1)}
        triangle = 1.0 - 4.0 * abs((time / self.period + wheel / WHEELS) % 1.0 - 0.5)
        return {"drive.moment": (-7000.0 + 100.0 * wheel) * (1.0 + self.change * triangle)}

    def step(self, numbered):
        """One step of a wheel that comes with its number."""
        k, wheel = numbered
        wheel.set(self.inputs(k, wheel.time))
        wheel.step(STEP)


def run(fleets, steps, team, brakes):
    """Steps all wheels of every fleet in turn; wall and CPU seconds of every batch of steps, by fleet."""
    seconds = [[] for _ in fleets]
    for _ in range(steps // BATCH):
        for fleet, times in zip(fleets, seconds):
            wall, cpu = perf_counter(), process_time()
            for _ in range(BATCH):
                team.map(brakes.step, fleet)
            times.append((perf_counter() - wall, process_time() - cpu))
    return seconds


def speeds(seconds):
    """Simulated over wall time, on average and of the fastest batch, and simulated over CPU time, of batches."""
    (walls, cpus), simulated = zip(*seconds), BATCH * STEP
    return simulated * len(walls) / sum(walls), simulated / min(walls), simulated * len(cpus) / sum(cpus)


def measure(fmus, settings, steps, threads, brakes):
    """By FMU: speeds and the last forces, on so many threads."""
    with ExitStack() as stack:
        def fleet(fmu, own):
            return [(k, stack.enter_context(Wheel(fmu, own, brakes.inputs(k, 0.0)))) for k in range(WHEELS)]

        fleets = [fleet(fmu, brakes.start | settings | own) for fmu, own in fmus]
        team = stack.enter_context(Team(threads))
        run(fleets, round(brakes.settling / STEP), team, brakes)
        seconds = run(fleets, steps, team, brakes)
        return [(speeds(times), [wheel.get("contact.force_x") for _, wheel in fleet]) for times, fleet in zip(seconds, fleets)]


def setting(text):
    """Name and value of `NAME=VALUE`."""
    name, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text}: expected NAME=VALUE, such as contact.lines=5")
    if value in ("true", "false"):
        return name, value == "true"
    try:
        return name, float(value)
    except ValueError:
        return name, value


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmu", default="target/wheelrail.fmu")
    parser.add_argument("--before", metavar="FMU", help="an older FMU that runs in turn")
    parser.add_argument("--set", type=setting, action="append", default=[], metavar="NAME=VALUE", help="a parameter of --fmu only")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=2.0, help=f"simulated time of each row, at least {BATCH * STEP:g}")
    parser.add_argument("--drives", nargs="+", choices=DRIVES, default=DRIVES, help="what the wheels do")
    parser.add_argument("--change", type=float, default=0.3, help="share by which moments vary")
    parser.add_argument("--period", type=float, default=0.04, help="time in which they do (s)")
    parser.add_argument("--settling", type=float, metavar="S", help="simulated time before what is measured; 0.3 of slides, 0.1 of others")
    options = parser.parse_args()
    if not options.seconds >= BATCH * STEP:
        parser.error(f"--seconds {options.seconds:g} is below {BATCH * STEP:g}, the time of the steps that are timed together")
    if not 0.0 <= options.change <= 1.0:
        parser.error(f"--change {options.change:g} is not in 0 to 1")
    if not options.period > 0.0:
        parser.error(f"--period {options.period:g} is not above 0")
    if options.threads < 1:
        parser.error(f"--threads {options.threads} is below 1")
    return options


def rows(options):
    """Name, parameters and brakes of every row of the table."""
    chosen = dict(options.set).get("preset")
    for preset in (chosen,) if chosen else PRESETS:
        for heat in (True, False):
            for drive in options.drives:
                name = f"{preset}, {'with' if heat else 'without'} heat, {drive}"
                yield name, {"preset": preset, "thermal.enabled": heat}, Brakes(drive, options.change, options.period, options.settling)


def main():
    options = arguments()
    steps, labels = round(options.seconds / STEP), ["before", "after"] if options.before else [""]
    print(f"{WHEELS} wheels, {options.seconds:g} s in steps of {STEP:g} s: simulated over wall time (of the fastest {BATCH} steps)")
    print(f"{'':52}{'one thread':>16}{'its CPU time':>16}{f'{options.threads} threads':>16}")
    with ExitStack() as stack:
        older = [(stack.enter_context(Fmu(options.before)), {})] if options.before else []
        fmus = older + [(stack.enter_context(Fmu(options.fmu)), dict(options.set))]
        for name, settings, brakes in rows(options):
            alone, together = (measure(fmus, settings, steps, n, brakes) for n in (1, options.threads))
            for label, (one, forces), (many, same) in zip(labels, alone, together):
                if forces != same:
                    raise SystemExit(f"{name}: threads changed the forces: {forces} and {same} N")
                columns = f"{one[0]:.2f} ({one[1]:.2f})", f"{one[2]:.2f}", f"{many[0]:.2f} ({many[1]:.2f})"
                print(f"{name:44}{label:8}" + "".join(f"{column:>16}" for column in columns), flush=True)


if __name__ == "__main__":
    try:
        main()
    except Refused as refusal:
        raise SystemExit(str(refusal))
