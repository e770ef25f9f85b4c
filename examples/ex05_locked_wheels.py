"""Example 5: locked wheels. Wheels of every preset that slide for two seconds, at several speeds, steps and meshes.

    make study NAME=locked-wheels
    python examples/ex05_locked_wheels.py --speeds 60 --steps 1e-3,2e-4 --meshes 10,20

A wheel rolls, its rotation is stopped within 20 ms while the vehicle goes on, and it slides. What stops it is its prescribed
angular velocity, or with `--by brake` a brake that is stronger than any friction. Two runs are computed at a time. Printed for each:

    p max, p mean  highest peak pressure, and its mean in time while locked, in MPa
    T max          highest surface temperature of wheel and rail in the contact, in °C
    force, mu      mean tangential force while locked in kN, and mean friction coefficient: force over load
    signs          share of the steps whose change of the wheel's temperature has the other sign than that before, in %: a
                   solution that jumps from step to step has 100. Changes count that the error control would not let pass,
                   solver.tolerance of the rise, while the load changes by less than 5 %: the temperature of a wheel that
                   hops follows its load
    energy         energy that the audit misses at the end over that which has flowed: dissipated, put in at the hub or stored, in %
    Ac1            time from the start of braking until wheel or rail is austenitic, in ms
    halved         share of the steps that the error control had to divide, in %
    ended          when a run stopped early (a discarded step), with its message

Then for each speed: how far the results of coarser steps and meshes are from those of the finest, which limits are broken,
and friction over speed beside Galton's trials of 1878, as they are remembered (`GALTON`). A broken limit ends the study with 1.
"""

import argparse
import csv
import itertools
import json
import os
import sys
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import wheelrail
from wheelrail import run_commands
from wheelrail.__main__ import ended_in_a_line
from wheelrail.fmu import default_path

KELVIN = 273.15  # K at 0 °C
LOCK = 0.02  # s, in which the rotation stops
STRONGER = 2.0  # strength of the brake over what a friction coefficient of 1 holds
SETTLED = 0.05  # s, from which on the slide counts
COLD = 100.0  # K: smaller rises of a temperature count as much for solver.tolerance
HOPS = 0.05  # of the mean load: larger changes of it in a step take the temperature with them
MPH = 1.609344  # km/h

# What the results must keep.
YIELD = 2.97 * 550e6  # Pa: pressure at which a cold wheel steel flows in a line contact, (2 + pi)/sqrt(3) times its yield stress
SUPERHEAT = 50.0  # K: so far above the liquidus temperatures may be
SIGNS = 0.10  # share of the steps
AUDIT = 0.01  # of the energy that has flowed
SPREAD = 0.06  # of the result of the finest run: on ten elements and nodes mean pressures miss 5 %

# Steel tyre sliding on a dry steel rail, speed in mph and friction coefficient. D. Galton and G. Westinghouse, Proc.
# IMechE 1878-79; quoted FROM MEMORY, the table of the reports could not be read. Published and read: the force of a
# skidding wheel is less than a third of that of a braked, rolling one, and falls with speed and sliding time.
GALTON = ((7, 0.088), (14, 0.072), (27, 0.070), (34, 0.065), (41, 0.057), (55, 0.038), (60, 0.027))

OUTPUTS = (
    "wheel.omega", "contact.force_x", "contact.force_y", "contact.pressure_max", "contact.half_width",
    "contact.friction", "temperature.wheel_max", "temperature.rail_max", "solver.energy_residual",
    "solver.internal_steps", "energy.friction", "energy.plastic", "energy.damping", "energy.stored", "energy.hub_work",
    "energy.thermal_work",
)  # fmt: skip
# Recorded, too, if the FMU has them.
IF_THERE = ("damage.yielded", "damage.melted", "damage.flattening")


def galton(speed):
    """Friction coefficient after Galton at a speed [km/h], linear between his speeds; `None` beyond them."""
    mph = speed / MPH
    for (low, mu), (high, nu) in itertools.pairwise(GALTON):
        if low <= mph <= high:
            return mu + (nu - mu) * (mph - low) / (high - low)
    return None


def sign_changes(values, start, loads, tolerance):
    """Share of the steps of a sequence of temperatures whose change has the other sign than the one before, both more than
    the tolerance of the rise over the start, while the load stays as it is."""
    steady = HOPS * sum(loads) / max(1, len(loads))
    changes = [(b - a, abs(q - p)) for (a, p), (b, q) in itertools.pairwise(zip(values, loads))]
    turns = [
        a * b < 0.0 and min(abs(a), abs(b)) > tolerance * max(value - start, COLD) and max(p, q) < steady
        for value, ((a, p), (b, q)) in zip(values[1:], itertools.pairwise(changes))
    ]
    return sum(turns) / max(1, len(turns))


def unaccounted(table):
    """Energy that the audit misses at the end over the largest of what was dissipated, put in at the hub and stored. Only the
    first of these is what solver.energy_residual is related to, and nothing is dissipated where there is no friction."""
    friction, plastic, damping, stored, hub, heat = (
        table[f"energy.{name}"][-1] for name in ("friction", "plastic", "damping", "stored", "hub_work", "thermal_work")
    )
    dissipated = friction + plastic + damping
    flowed = max(abs(dissipated), abs(stored), abs(hub))
    return (hub + heat - stored - dissipated) / flowed if flowed else 0.0


def crossing(times, values, limit):
    """First time at which a sequence passes a limit, linear between its points; `None` if it does not."""
    for (s, a), (t, b) in itertools.pairwise(zip(times, values)):
        if a < limit <= b:
            return s + (t - s) * (limit - a) / (b - a)
    return None


def figures(table, austenitisation, tolerance):
    """Figures of a slide from its table, a dictionary of columns with `time`."""
    late = [i for i, t in enumerate(table["time"]) if t >= SETTLED]
    hottest = [max(pair) for pair in zip(table["temperature.wheel_max"], table["temperature.rail_max"])]
    mean = lambda name: sum(table[name][i] for i in late) / max(1, len(late))
    pick = lambda name: ([table[name][i] for i in late], table[name][0])
    force = -mean("contact.force_x")
    divided = [n > 1 for n in table["solver.internal_steps"]]
    found = {
        "p max": max(table["contact.pressure_max"]),
        "p mean": mean("contact.pressure_max"),
        "T max": max(hottest) - KELVIN,
        "force": force,
        "mu": force / mean("contact.force_y") if late else 0.0,
        "signs": sign_changes(*pick("temperature.wheel_max"), pick("contact.force_y")[0], tolerance),
        "energy": unaccounted(table),
        "Ac1": crossing(table["time"], hottest, austenitisation),
        "halved": sum(divided) / len(divided),
        "end": table["time"][-1],
    }
    return found | {name: max(table[name]) for name in IF_THERE if name in table}


class Preset:
    """Wheels of a preset, with what their runs need to know about it."""

    def __init__(self, fmu, options, preset):
        self.fmu, self.options, self.preset, self.stopped = fmu, options, preset, False
        self.starts = {name: variable.start for name, variable in fmu.variables.items()}
        content = json.loads(Path(fmu.directory, "resources", f"{preset}.json").read_text())
        self.starts |= {f"{group}.{name}": v for group, values in content.items() for name, v in values.items()}
        self.starts |= dict(options.settings)
        self.outputs = OUTPUTS + tuple(name for name in IF_THERE if name in self.starts)

    def number(self, name):
        """A parameter of the runs."""
        return float(self.starts[name])

    def inputs(self, velocity, by):
        """Inputs that lock a wheel at a speed [m/s] by its prescribed speed or by its brake."""
        radius = self.number("wheel.radius")
        if by == "speed":
            head, rotation, free, locked = "drive.omega", "velocity", velocity / radius, 0.0
        else:
            strongest = STRONGER * max(self.number("friction.coefficient"), 1.0) * self.number("model.nominal_load") * radius
            head, rotation, free, locked = "brake.torque", "moment", 0.0, strongest
        course = [0.0, LOCK, max(self.options.stop, LOCK)], [free, locked, locked]

        def kept(_):
            if self.stopped:  # Ctrl-C does not reach the thread of a run
                raise KeyboardInterrupt
            return velocity

        return {"control.rotation": rotation, "control.translation": "velocity", "drive.velocity": kept, head: course}

    def slide(self, speed, step, elements, by):
        """Runs a slide from a speed [km/h] with a step [s] on a mesh; returns its figures."""
        velocity, name = speed / 3.6, f"{self.preset}_{by}_{speed:g}kmh_{step * 1e3:g}ms_{elements}"
        parameters, inputs = run_commands.given(self, self.fmu)
        parameters |= {"initial.velocity": velocity, "mesh.elements_per_half_width": elements}
        inputs |= self.inputs(velocity, by)
        began, error = time.perf_counter(), ""
        try:
            record = wheelrail.simulate(
                parameters, inputs, stop=self.options.stop, step=step, outputs=self.outputs, fmu=self.fmu, progress=False
            )
        except wheelrail.Refused as failure:
            record, error = failure.run, str(failure)
        rows = wheelrail.table(record)
        if self.options.keep:
            rows.to_csv(self.options.keep / f"{name}.csv")
        table = {"time": list(rows.index)} | {name: [float(value) for value in rows[name]] for name in self.outputs}
        found = figures(table, self.number("thermal.austenitisation"), self.number("solver.tolerance"))
        found |= {"error": error, "liquidus": self.number("material.liquidus") - KELVIN}
        case = {"preset": self.preset, "by": by, "speed": speed, "step": step, "elements": elements}
        return found | case | {"wall": time.perf_counter() - began}

    @property
    def settings(self):
        """What the command line sets."""
        return self.options.settings


HEAD = (
    f"{'preset':>20} {'by':>5} {'km/h':>5} {'step':>8} {'mesh':>5} {'p max':>8} {'p mean':>8} {'T max':>8} {'force':>7} {'mu':>7} {'signs':>6} "
    f"{'energy':>7} {'Ac1':>6} {'halved':>6} {'wall':>6}"
)


def line(r):
    """A run as a line of the table."""
    ac1 = "-" if r["Ac1"] is None else f"{r['Ac1'] * 1e3:.2f}"
    ended = f"  ended at {r['end']:.4g} s: {r['error'][:150]}" if r["error"] else ""
    extra = "".join(f"  {name.split('.')[1]} {r[name]:.3g}" for name in IF_THERE if name in r)
    return (
        f"{r['preset']:>20} {r['by']:>5} {r['speed']:5g} {r['step'] * 1e3:5g} ms {r['elements']:5d} {r['p max'] / 1e6:8.0f} {r['p mean'] / 1e6:8.0f} "
        f"{r['T max']:8.0f} {r['force'] / 1e3:7.3f} {r['mu']:7.4f} {r['signs'] * 100:6.1f} {r['energy'] * 100:7.3f} "
        f"{ac1:>6} {r['halved'] * 100:6.2f} {r['wall']:6.1f}{extra}{ended}"
    )


def apart(value, finest):
    """Distance of a value from that of the finest run, over the latter; forces of frictionless presets are zero."""
    return 0.0 if value == finest else abs(value / finest - 1.0) if finest else float("inf")


def spread(runs, names=("p max", "p mean", "T max", "force")):
    """Largest distance of each figure from that of the finest run, over the latter, and that run; of runs that reached
    their end, if there are any."""
    runs = [r for r in runs if not r["error"]]
    if not runs:
        return {}, None
    finest = min(runs, key=lambda r: (r["step"], -r["elements"]))
    return {name: max(apart(r[name], finest[name]) for r in runs) for name in names}, finest


def broken(r):
    """The limits that a run does not keep."""
    checks = (
        (r["p max"] > YIELD * 1.001, f"peak pressure above {YIELD / 1e6:.0f} MPa"),
        (r["T max"] > r["liquidus"] + SUPERHEAT, f"temperature above {r['liquidus'] + SUPERHEAT:.0f} °C"),
        (r["signs"] > SIGNS, f"more than {SIGNS:.0%} sign changes"),
        (abs(r["energy"]) > AUDIT, f"energy audit beyond {AUDIT:.0%}"),
        (bool(r["error"]), "a discarded step"),
        (r["preset"] == "railway" and r["speed"] == 60.0 and not (r["Ac1"] and 1e-3 <= r["Ac1"] <= 0.03), "Ac1 not within 1 to 30 ms"),
    )
    return [text for wrong, text in checks if wrong]


def report(results):
    """Prints, speed by speed, what the runs show together; returns how many limits are broken."""
    count = 0
    print("\nDistance from the finest run, limits broken (number of runs)")
    for preset, by, speed in sorted({(r["preset"], r["by"], r["speed"]) for r in results}):
        runs = [r for r in results if (r["preset"], r["by"], r["speed"]) == (preset, by, speed)]
        distances, finest = spread(runs)
        failures = [text for r in runs for text in broken(r)]
        failures += [f"{name} differs by more than {SPREAD:.0%}" for name, d in distances.items() if d > SPREAD]
        count += len(failures)
        words = ", ".join(f"{name} {d * 100:.1f} %" for name, d in distances.items())
        print(f"{preset}, by {by}, {speed:5g} km/h: {words or 'no run reached its end'}")
        for text in dict.fromkeys(failures):
            print(f"            ! {text} ({failures.count(text)})")
    print("\nFriction coefficient of the locked wheel over speed (finest run of each; Galton: from memory, not checked)")
    for preset, speed in sorted({(r["preset"], r["speed"]) for r in results}):
        finest = spread([r for r in results if (r["preset"], r["speed"]) == (preset, speed)])[1]
        if finest is None:
            print(f"{preset:>20} {speed:5g} km/h: -")
            continue
        trial = galton(speed)
        beside = "beyond his trials" if trial is None else f"{trial:.3f}"
        print(f"{preset:>20} {speed:5g} km/h: {finest['mu']:.4f}   Galton {beside}")
    print(f"\n{count} broken limits in {len(results)} runs")
    return count


def of_pages(results):
    """Lines with the figures of docs/validation.md, as tools/figures.py reads them: of one preset, or of all."""
    if len({r["preset"] for r in results}) > 1:
        lines = [f"figure: locked.presets.signs = {r['signs']:.2e}" for r in results]
        return [*lines, f"figure: locked.presets.temperature [°C] = {max(r['T max'] for r in results):.0f} ± 0.01"]
    lines = []
    for r in results:
        lines += [f"figure: locked.signs = {r['signs']:.2e}", f"figure: locked.energy = {r['energy']:.1e}"]
    for speed in sorted({r["speed"] for r in results}):
        finest = spread([r for r in results if r["speed"] == speed])[1]
        lines += [f"figure: locked.force.{speed:g} [kN] = {finest['force'] / 1e3:.3f} ± 0.01"] if finest else []
    # Runs on one mesh show what the step does, and those of one step what the mesh does.
    for what, kept in (("step", "elements"), ("mesh", "step")):
        for group in sorted({(r["speed"], r[kept]) for r in results}):
            apart = spread([r for r in results if (r["speed"], r[kept]) == group])[0].values()
            lines.append(f"figure: locked.by.{what} = " + ", ".join(f"{distance:.2e}" for distance in apart))
    pressures, temperatures = ([r[name] for r in results] for name in ("p max", "T max"))
    lines.append(f"figure: locked.pressure = {min(pressures) / YIELD:.3f}, {max(pressures) / YIELD:.3f} ± 0.03")
    return [*lines, f"figure: locked.temperature [°C] = {min(temperatures):.0f}, {max(temperatures):.0f} ± 0.01"]


def numbers(text):
    """A list of numbers on the command line."""
    return [float(word) for word in text.split(",")]


def words(text):
    """A list of words on the command line."""
    return text.split(",")


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=default_path(), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the table")
    parser.add_argument("--name", default="locked_wheels", help="name of the table")
    parser.add_argument("--keep", type=Path, help="directory for the CSV files of all runs")
    parser.add_argument("--presets", type=words, default=["railway"], help="names, or all; default: %(default)s")
    parser.add_argument("--by", type=words, default=["speed"], help="what stops the wheel: speed, brake")
    parser.add_argument(
        "--set", dest="settings", type=run_commands.setting, action="append", default=[], metavar="NAME=VALUE", help="parameter, repeatable"
    )
    parser.add_argument("--speeds", type=numbers, default=[40.0, 60.0, 80.0, 120.0, 160.0], help="km/h")
    parser.add_argument("--steps", type=numbers, default=[1e-3, 2e-4, 5e-5], help="communication steps [s]")
    parser.add_argument("--meshes", type=numbers, default=[10, 20, 40], help="elements per half-width")
    parser.add_argument("--stop", type=float, default=2.0, help="end of the slide [s]")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    return parser.parse_args()


def study(options):
    """All runs."""
    meshes, results = [int(n) for n in options.meshes], []
    if options.keep:
        options.keep.mkdir(parents=True, exist_ok=True)
    with wheelrail.Fmu(options.fmu) as fmu, ThreadPoolExecutor(options.jobs) as pool:
        every = sorted(path.stem for path in Path(fmu.directory, "resources").glob("*.json"))
        presets = [Preset(fmu, options, preset) for preset in (every if options.presets == ["all"] else options.presets)]
        cases = list(itertools.product(presets, options.speeds, options.steps, meshes, options.by))
        # Long runs first: no core idles at the end.
        cases.sort(key=lambda case: (case[2], -case[3]))
        waiting = [pool.submit(preset.slide, *case) for preset, *case in cases]
        print(f"{len(cases)} runs of {options.stop:g} s, {options.jobs} at a time\n{HEAD}", flush=True)
        try:
            for done in as_completed(waiting):
                results.append(done.result())
                print(f"{line(results[-1])}  [{len(results)}/{len(cases)}]", flush=True)
        except BaseException:
            for preset in presets:
                preset.stopped = True
            pool.shutdown(cancel_futures=True)
            raise
    results.sort(key=lambda r: (r["preset"], r["by"], r["speed"], -r["step"], r["elements"]))
    print(f"\nIn order:\n{HEAD}\n" + "\n".join(line(r) for r in results))
    count = report(results)
    if os.environ.get("WHEELRAIL_FIGURES"):
        print("\n".join(of_pages(results)))
    options.out.mkdir(parents=True, exist_ok=True)
    table = options.out / f"{options.name}.csv"
    with open(table, "w", newline="") as file:
        writer = csv.DictWriter(file, results[0])
        writer.writeheader()
        writer.writerows(results)
    print(f"written: {table}")
    return 1 if count else 0


if __name__ == "__main__":
    with ended_in_a_line():
        code = study(arguments())
    sys.exit(code)
