"""Example 9: eight wheels, stepped one after the other and on threads.

    make eight-wheels
    make eight-wheels BEFORE=older.fmu

A master in Python steps wheels at the same time with nothing but threads: while the FMU computes, its caller does not hold
the lock of the interpreter. Every instance has its own state; equal ones share their model. Wheels whose brakes differ take steps of
different length: a `Team` gives the next wheel to whichever thread is free.

The moments of the brakes vary by ±30 % in 40 ms, or as `--change` and `--period` say, those of each wheel at another
time. An older FMU runs beside the present one, some steps in turn, so that both see the same load of the machine.
"""

import argparse
from contextlib import ExitStack
from time import perf_counter, process_time

from wheelrail import Fmu, Refused, Team, Wheel

WHEELS, STEP = 8, 1e-3  # number, s
BATCH = 10  # steps that are timed together, some 20 ms as in the benchmark of the Rust library
SETTLING = 0.1  # s
START = {"initial.velocity": 27.8}


class Brakes:
    """Brakes whose moments vary by the share `change` in the time `period` (s)."""

    def __init__(self, change, period):
        self.change, self.period = change, period

    def moment(self, wheel, time):
        """Moment on a wheel (N m): half of the adhesion limit, and a triangle that each wheel has at another time."""
        triangle = 1.0 - 4.0 * abs((time / self.period + wheel / WHEELS) % 1.0 - 0.5)
        return (-7000.0 + 100.0 * wheel) * (1.0 + self.change * triangle)

    def step(self, numbered):
        """One step of a wheel that comes with its number."""
        k, wheel = numbered
        wheel.set({"drive.moment": self.moment(k, wheel.time)})
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
            return [(k, stack.enter_context(Wheel(fmu, own, {"drive.moment": brakes.moment(k, 0.0)}))) for k in range(WHEELS)]

        fleets = [fleet(fmu, START | settings | own) for fmu, own in fmus]
        team = stack.enter_context(Team(threads))
        run(fleets, round(SETTLING / STEP), team, brakes)
        seconds = run(fleets, steps, team, brakes)
        return [(speeds(times), [wheel.get("contact.force_x") for _, wheel in fleet]) for times, fleet in zip(seconds, fleets)]


def setting(text):
    """Name and value of `NAME=VALUE`."""
    name, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text}: expected NAME=VALUE, such as solver.contact=auto")
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
    parser.add_argument("--seconds", type=float, default=5.0, help=f"simulated time, at least {BATCH * STEP:g}")
    parser.add_argument("--change", type=float, default=0.3, help="share by which moments vary; 0: they are held")
    parser.add_argument("--period", type=float, default=0.04, help="time in which they do (s)")
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


def main():
    options = arguments()
    brakes = Brakes(options.change, options.period)
    steps, labels = round(options.seconds / STEP), ["before", "after"] if options.before else [""]
    print(f"{WHEELS} wheels, {options.seconds:g} s in steps of {STEP:g} s: simulated over wall time (of the fastest {BATCH} steps)")
    print(f"{'':22}{'one thread':>16}{'its CPU time':>16}{f'{options.threads} threads':>16}")
    with ExitStack() as stack:
        older = [(stack.enter_context(Fmu(options.before)), {})] if options.before else []
        fmus = older + [(stack.enter_context(Fmu(options.fmu)), dict(options.set))]
        for name, heat in (("with heat", True), ("without heat", False)):
            alone, together = (measure(fmus, {"thermal.enabled": heat}, steps, n, brakes) for n in (1, options.threads))
            for label, (one, forces), (many, same) in zip(labels, alone, together):
                if forces != same:
                    raise SystemExit(f"{name}: threads changed the forces: {forces} and {same} N")
                columns = f"{one[0]:.2f} ({one[1]:.2f})", f"{one[2]:.2f}", f"{many[0]:.2f} ({many[1]:.2f})"
                print(f"{name:14}{label:8}" + "".join(f"{column:>16}" for column in columns), flush=True)


if __name__ == "__main__":
    try:
        main()
    except Refused as refusal:
        raise SystemExit(str(refusal))
