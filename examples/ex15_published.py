"""Example 15: published tests and observations beside what the FMU computes.

    make study NAME=published

Each case says where its numbers are from, what was fitted to them and what is predicted:

1. Creep curve of a locomotive to 21 % of creep (example 8): the law of friction and the elastic layer were fitted to it by others.
2. Contact temperature of a sliding ellipse of pressure, closed solution for the case of Ertz and Knothe: predicted.
3. Skidding wheels, Galton 1878: friction falls with the speed because the contact is hot; predicted with the default softening,
   which was chosen for other reasons. His numbers are from memory. Wagons of Poirée and Bochet, whose wheels carried 15 to 25 kN:
   the friction of light wheels is higher because they heat less; predicted likewise.
4. Drag braking by blocks of the European specification for freight wagons: power and time are given, the temperature of the rim is
   predicted; between which temperatures it should lie is literature in general, not that specification.
5. Adhesion over speed of Curtius and Kniffler beside the wet preset: a fit to locomotives of 1944, which no parameter follows.

A case outside of the limits that it names ends the example with 1. `--brief` takes fewer points and shorter slides.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from ex08_creep_curve import CREEPS, FITTED, LAYER, adhesion, judged
from wheelrail import Fmu, Refused, Wheel, steady
from wheelrail.output import write_rows
from wheelrail.plots import COLOURS, save, subplots

KMH = 1.0 / 3.6
# Galton 1878, steel tyre on steel rail: mph and friction, FROM MEMORY; no readable source of the table was found.
GALTON = ((27, 34, 41, 55), (0.070, 0.065, 0.057, 0.038))
MPH = 1.609344 * KMH
# Poirée and Bochet, locked wheels of wagons: feet per minute and friction (quoted by Molesworth, Pocket-book, p. 421), and the load
# of a wheel [N]: 300 to 500 kg/cm² on 20 cm² under four wheels (Bochet, Annales des Mines (5) 19 (1861), p. 56).
WAGONS = ((900, 4000), (0.21, 0.14), (15e3, 20e3, 25e3))
# The case of Ertz and Knothe, Wear 253 (2002) 498-508, as set in the user guide of CONTACT: half-length and largest pressure,
# speed, sliding speed, friction, steel. CONTACT itself prints 166.8, which counts the heat of each element twice.
ERTZ = {"a": 5.88e-3, "p": 770.6e6, "v": 30.0, "slide": 1.0, "friction": 0.3, "conductivity": 50.0, "density": 7850.0, "heat": 450.0}
# Drag braking: power of a wheel [W], speed [m/s], time [s] (TSI on freight wagons: 21 per mille, 70 km/h, 40 km), and the limits of
# the literature for the rim [°C].
DRAG = (45e3, 70.0 * KMH, 2040.0, (250.0, 450.0))


def locomotive(fmu, brief):
    """Case 1: rows of creep, measured range and computed adhesion with the layer and of clean steel, and whether all of the former
    and those of the latter from the fit on lie inside."""
    creeps, rows, fine = CREEPS[::3] if brief else CREEPS, [], True
    layered, clean = ([(creep, adhesion(fmu, creep, layer)) for creep in creeps] for layer in (LAYER, 0.0))
    for ((low, _, least, most), points, inside), (_, others, clean_inside) in zip(judged(layered), judged(clean)):
        for (creep, value), (_, other) in zip(points, others):
            rows.append(("creep curve of a locomotive", f"{creep:g} % of creep", f"{least:g} to {most:g}", f"{value:.3f}; clean {other:.3f}"))
        fine &= inside and (clean_inside or low < FITTED)
    return rows, fine, layered


def flash(fmu):
    """Case 2: rise of the contact temperature [K], in closed form and computed."""
    c = ERTZ
    effusivity = (c["conductivity"] * c["density"] * c["heat"]) ** 0.5
    closed = 2.188 * 0.5 * c["friction"] * c["p"] * c["slide"] * (c["a"] / (np.pi * c["v"])) ** 0.5 / effusivity
    load = 0.5 * np.pi * c["a"] * c["p"]  # N/m
    modulus = 210e9 / (2.0 * (1.0 - 0.3**2))
    radius, width = np.pi * modulus * c["a"] ** 2 / (4.0 * load), 14e-3
    parameters = {
        "material.youngs_modulus": 210e9, "material.poissons_ratio": 0.3, "material.conductivity": c["conductivity"],
        "material.density": c["density"], "material.specific_heat": c["heat"], "wheel.radius": radius, "model.contact_width": width,
        "model.nominal_load": width * load, "friction.coefficient": c["friction"], "friction.softening": 0.0,
        "initial.velocity": c["v"], "initial.creepage": 2.0 * c["slide"] / (2.0 * c["v"] - c["slide"]), "mesh.elements_per_half_width": 20,
    }  # fmt: skip
    inputs = {"control.rotation": "velocity", "control.translation": "velocity", "drive.load": width * load}
    with Wheel(fmu, parameters, inputs) as wheel:
        for _ in range(20):
            wheel.step(1e-3)
        found = 0.5 * sum(wheel.get("temperature.wheel_max", "temperature.rail_max")) - wheel.get("thermal.reference")
    row = ("flash temperature, Ertz and Knothe", "30 m/s, sliding 1 m/s", f"{closed:.1f} K, closed form", f"{found:.1f} K")
    return [row], abs(found / closed - 1.0) < 0.05


def locked(fmu, speed, steps, load=1e5):
    """Mean friction of a wheel that is locked within 20 ms at a speed [m/s], under a load [N]."""
    inputs = {"control.rotation": "velocity", "control.translation": "velocity", "drive.velocity": speed}
    with Wheel(fmu, {"initial.velocity": speed, "model.nominal_load": load, "drive.load": load}, inputs) as wheel:
        omega, found = wheel.get("wheel.omega"), []
        for k in range(steps):
            wheel.set({"drive.omega": omega * max(0.0, 1.0 - (k + 1) / 20)})
            wheel.step(1e-3)
            found.append(-wheel.get("contact.adhesion"))
    return float(np.mean(found[40:]))


def wagons(fmu, steps):
    """Light wheels of case 3: friction of the lightest and the heaviest load beside what was published."""
    rows, fine = [], True
    for feet, published in zip(*WAGONS[:2]):
        speed = feet * 0.3048 / 60.0
        most, middle, least = (locked(fmu, speed, steps, load) for load in WAGONS[2])
        about = f"{speed / KMH:.0f} km/h, 25 to 15 kN"
        rows.append(("locked wagon wheels, Poirée and Bochet", about, f"{published:.2f}", f"{least:.3f} to {most:.3f}"))
        fine &= least < middle < most and abs(middle / published - 1.0) < 0.35
    return rows, fine


def skidding(fmu, brief):
    """Case 3: mean friction of a locked wheel over the speed, and of light wheels."""
    steps = 120 if brief else 520
    (rows, fine), curve = wagons(fmu, steps), []
    for speed in (60.0,) if brief else (40.0, 60.0, 80.0):
        remembered, computed = float(np.interp(speed * KMH, np.array(GALTON[0]) * MPH, GALTON[1])), locked(fmu, speed * KMH, steps)
        rows.append(("skidding wheels, Galton 1878", f"{speed:g} km/h", f"{remembered:.3f}, from memory", f"{computed:.3f}"))
        fine &= abs(computed / remembered - 1.0) < 0.35
        curve.append((speed, remembered, computed))
    return rows, fine and all(a[2] > b[2] for a, b in zip(curve, curve[1:])), curve


def drag(fmu):
    """Case 4: temperature of the whole wheel after 34 minutes of drag braking."""
    power, speed, duration, (low, high) = DRAG
    inputs = {"control.translation": "velocity", "drive.velocity": speed}
    with Wheel(fmu, {"initial.velocity": speed, "solver.max_step": 500.0}, inputs) as wheel:
        moment = power / (speed / wheel.get("wheel.radius"))
        for k in range(10):  # s, in which blocks are applied
            wheel.set({"drive.tread_heat": power * (k + 1) / 10, "drive.moment": -moment * (k + 1) / 10})
            wheel.step(1.0)
        for _ in range(29):
            wheel.step((duration - 10.0) / 29)
        found = wheel.get("temperature.wheel_bulk") - 273.15
    row = ("drag braking, TSI on freight wagons", "45 kW, 70 km/h, 34 min", f"{low:g} to {high:g} °C, literature", f"{found:.0f} °C")
    return [row], low < found < high


def adhesion_over_speed(fmu, brief):
    """Case 5: highest adhesion in traction over speed of the wet preset, beside the formula of Curtius and Kniffler."""
    rows, curve = [], []
    for speed in (40.0, 160.0) if brief else (20.0, 40.0, 80.0, 120.0, 160.0):
        found = steady({"preset": "railway_wet"}, creepage=-np.geomspace(1e-3, 0.1, 9), velocity=speed * KMH, outputs="contact.adhesion", fmu=fmu)
        computed, formula = float(np.abs(found["contact.adhesion"]).max()), 7.5 / (speed + 44.0) + 0.161
        rows.append(("adhesion in traction, Curtius and Kniffler", f"{speed:g} km/h", f"{formula:.3f}, fit of 1944", f"{computed:.3f}, wet"))
        curve.append((speed, formula, computed))
    return rows, all(a[2] >= b[2] for a, b in zip(curve, curve[1:])), curve


def plot(path, loco, skid, adhesions):
    """Curves of cases 1, 3 and 5."""
    figure, axes = subplots(1, 3, figsize=(12, 3.6))
    axes[0].plot(*zip(*loco), "o-", color=COLOURS[0], markersize=3, label="FMU")
    for k, (low, high, least, most) in enumerate(row for row, *_ in judged(loco)):
        about = {"label": "measured"} if k == 0 else {}
        axes[0].fill_between([low, max(high, low + 0.3)], least, most, color=COLOURS[1], alpha=0.3, linewidth=0, **about)
    axes[0].set(title="Locomotive", xlabel="creep [%]", ylabel="adhesion [1]")
    for axis, curve, title in ((axes[1], skid, "Skidding wheels"), (axes[2], adhesions, "Adhesion in traction")):
        speeds, published, computed = zip(*curve)
        axis.plot(speeds, computed, "o-", color=COLOURS[0], label="FMU")
        axis.plot(speeds, published, "s", color=COLOURS[1], label="published")
        axis.set(title=title, xlabel="speed [km/h]", ylim=(0, None))
    for axis in axes:
        axis.legend()
    save(path, figure)


def run(options):
    """All cases; true if none lies outside its limits."""
    with Fmu(options.fmu) as fmu:
        (one, fine, loco), (two, hot), (three, skids, skid) = locomotive(fmu, options.brief), flash(fmu), skidding(fmu, options.brief)
        (four, warm), (five, falls, adhesions) = drag(fmu), adhesion_over_speed(fmu, options.brief)
    rows = [*one, *two, *three, *four, *five]
    widths = [max(len(row[k]) for row in rows) for k in range(4)]
    print("\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows))
    table, picture = options.out / "published.csv", options.out / "published.png"
    write_rows(table, [("case", "at", "published", "computed"), *rows])
    plot(picture, loco, skid, adhesions)
    judged_cases = {"locomotive": fine, "flash temperature": hot, "skidding wheels": skids, "drag braking": warm, "adhesion falls with speed": falls}
    outside = [name for name, inside in judged_cases.items() if not inside]
    print(f"\n{'outside: ' + ', '.join(outside) if outside else 'all within their limits'}; written: {table}, {picture}")
    return not outside


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for table and picture")
    parser.add_argument("--brief", action="store_true", help="fewer points and shorter slides, in seconds")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        sys.exit(0 if run(arguments()) else 1)
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
