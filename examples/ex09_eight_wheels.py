"""Example 9: eight wheels, stepped one after the other and on threads.

    make eight-wheels

A master in Python steps wheels at the same time with nothing but threads: while the FMU computes, its caller does not hold
the lock of the interpreter. Every instance has its own state; equal ones share their model. Wheels whose brakes differ take steps of
different length: a `Team` gives the next wheel to whichever thread is free.
"""

import argparse
from contextlib import ExitStack
from time import perf_counter

from wheelrail import Fmu, Team, Wheel

WHEELS, STEP = 8, 1e-3  # number, s
BATCH = 10  # steps that are timed together, some 20 ms as in the benchmark of the Rust library
START = {"initial.velocity": 27.8}
MOMENTS = [-500.0 * k for k in range(WHEELS)]  # N m


def run(wheels, steps, team):
    """Steps all wheels; wall seconds of every batch of steps."""
    seconds = []
    for _ in range(steps // BATCH):
        begin = perf_counter()
        for _ in range(BATCH):
            team.map(lambda wheel: wheel.step(STEP), wheels)
        seconds.append(perf_counter() - begin)
    return seconds


def measure(fmu, settings, steps, threads):
    """Simulated over wall time, of the fastest batch and on average, and the last forces, on so many threads."""
    with ExitStack() as stack:
        parameters = START | settings
        wheels = [stack.enter_context(Wheel(fmu, parameters, {"drive.moment": moment})) for moment in MOMENTS]
        team = stack.enter_context(Team(threads))
        run(wheels, 100, team)
        seconds = run(wheels, steps, team)
        simulated = BATCH * STEP
        speeds = simulated / min(seconds), simulated * len(seconds) / sum(seconds)
        return speeds, [wheel.get("contact.force_x") for wheel in wheels]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmu", default="target/wheelrail.fmu")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--steps", type=int, default=1000, help=f"at least {BATCH}")
    parser.add_argument("--contact", default="grid", choices=("grid", "patch", "auto"), help="solver.contact")
    options = parser.parse_args()
    if options.steps < BATCH:
        parser.error(f"--steps {options.steps} is below {BATCH}, the number of steps that are timed together")
    print(f"{WHEELS} wheels, {options.steps} steps of {STEP:g} s: simulated over wall time, fastest {BATCH} steps (all steps)")
    print(f"{'':14}{'one thread':>16}{f'{options.threads} threads':>16}")
    with Fmu(options.fmu) as fmu:
        for name, heat in (("with heat", True), ("without heat", False)):
            settings = {"thermal.enabled": heat, "solver.contact": options.contact}
            (alone, forces), (together, same) = (measure(fmu, settings, options.steps, n) for n in (1, options.threads))
            if forces != same:
                raise SystemExit(f"{name}: threads changed the forces: {forces} and {same} N")
            columns = (f"{fastest:.2f} ({mean:.2f})" for fastest, mean in (alone, together))
            print(f"{name:14}" + "".join(f"{column:>16}" for column in columns))


if __name__ == "__main__":
    main()
