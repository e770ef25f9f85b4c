"""Example 11: irregular surfaces. What force does this rail, this hole, this flat make?

    make study NAME=surfaces

1. Corrugation (Paper A, Fig. 11 and 12): waves of 5 um and 5 cm; amplitude of the force over the frequency of excitation beside
   the closed form of `wheelrail.surfaces`.
2. A sharp hole of 5 mm (Paper A, Fig. 13) at three speeds, without damping. The paper does not give its depth: 0.1 mm is ASSUMED.
3. Probability density of the force on a rough rail over speed, load and unsprung mass (Paper A, Fig. 8 to 10). The spectrum is
   our own, seeded, with peaks at 5 and 8 cm as the paper describes its measured one: TRENDS, not values. More mass widens the
   density while the resonance moves towards a peak of the spectrum; twice the mass of the wheel would leave it again.
4. A wheel flat of 40 mm, fresh and rounded: largest force and loss of contact over speed.
5. Roughness by the limit of EN ISO 3095: what the wheel met, analysed in one-third octaves.
6. The contact filter, from a wheel that stands on waves, beside the Bessel function and the table of CNOSSOS-EU.

Runs are independent and share two threads. Results become a table, a CSV and a picture.
"""

import argparse
import csv
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from time import perf_counter

import numpy as np
from tqdm import tqdm

from wheelrail import Fmu, Wheel, signals, surfaces
from wheelrail.plots import COLOURS, GREY, save, subplots

KMH = 1.0 / 3.6
LOAD = 4.7e6  # N, of Paper A on a width of 1 m
RAILWAY = {"preset": "railway", "thermal.enabled": False}
RAILWAY_LOAD = 1e5  # N, of the preset
# First natural frequency of the wheel of Paper A on its contact [rad/s], from an independent eigenvalue analysis.
RESONANCE = 2922.0
MASS = 8000.0 * np.pi * (0.46**2 - 0.046**2)  # kg, of 1 m of width
# Of the bounce, by a damper between hub and vehicle; the paper has it in the stiffness, 1e-4 s times half of that frequency.
DAMPER = 1e-4 * MASS * RESONANCE**2  # N s/m
PAPER = {"preset": "paper_a", "thermal.enabled": False, "vehicle.damping": DAMPER}
WAVE, WAVELENGTH = 5e-6, 0.05  # m
# dB re 1 um in the one-third octaves from 12.5 cm to 4 cm: 3.9 um root mean square, peaks at 8 and 5 cm.
ROUGH = "roughness(levels = [0, 2, 7, 2, 7, 0], longest = 0.125, seed = 3, length = 40, from = 0.1, blend = 0.2)"
ROUGH_WAY, SHORTEST = 8.3, 0.035  # m; the way of the paper
FLAT, FLAT_AT = 0.04, 0.1  # m
PERIOD, SAMPLES = 8.0, 3200  # m of rail that is analysed, and samples of it
SPEEDS = (30, 45, 60, 68, 75, 80, 84, 88, 92, 100, 110, 125, 150)  # km/h, over waves
HOLE_SPEEDS, FLAT_SPEEDS = (50, 100, 150), range(20, 141, 10)  # km/h
BRIEF = {"SPEEDS": (60, 92, 150), "HOLE_SPEEDS": (100,), "FLAT_SPEEDS": (60, 100), "ROUGH_WAY": 0.5}
FILTERED = (0.1, 0.08, 0.063, 0.05, 0.04, 0.0315, 0.025, 0.02)  # m


def roll(fmu, parameters, speed, way, step, outputs, load=None):
    """Rolls at a held speed over a way, in equal steps; table of time, distance and outputs at all communication points."""
    inputs = {"control.translation": "velocity", "drive.velocity": speed}
    if load is not None:
        inputs["drive.load"] = load
    with Wheel(fmu, parameters | {"initial.velocity": speed}, inputs) as wheel:
        names, rows = ("wheel.distance", *outputs), []
        for _ in range(int(np.ceil(way / speed / step - 1e-9))):
            wheel.step(step)
            rows.append([wheel.time, *wheel.get(*names)])
    return np.array(rows)


def corrugation(fmu, speed):
    """Amplitude of the force over waves, after the start has died away."""
    parameters = PAPER | {"rail.profile": f"sinusoid(amplitude = {WAVE}, wavelength = {WAVELENGTH})"}
    step, settled = WAVELENGTH / speed / 40, 0.015
    table = roll(fmu, parameters, speed, settled * speed + 5 * WAVELENGTH, step, ("contact.force_y",))
    kept = table[-200:]
    return signals.harmonic(kept[:, 0], kept[:, 2], speed / WAVELENGTH)[0]


def hole(fmu, speed):
    """Force on the way over a hole: distance from its middle and force."""
    parameters = PAPER | {"rail.profile": "hole(position = 0.03, length = 5e-3, depth = 1e-4)", "vehicle.damping": 0.0}
    table = roll(fmu, parameters, speed, 0.12, 1e-4 / speed, ("contact.force_y",))
    return table[:, 1] - 0.03, table[:, 2]


def rough(fmu, speed, load, mass):
    """Time and force on a rough rail, without the start."""
    parameters = PAPER | {"rail.profile": ROUGH, "wheel.hub_mass": mass}
    table = roll(fmu, parameters, speed, 0.6 + ROUGH_WAY, SHORTEST / 16 / speed, ("contact.force_y",), load)
    kept = table[table[:, 1] > 0.6]
    return kept[:, 0], kept[:, 2]


def flat(fmu, shape, speed):
    """Largest force and time without contact when a flat has passed."""
    parameters = RAILWAY | {"wheel.profile": f"flat(position = {FLAT_AT}, length = {FLAT}, shape = {shape})"}
    outputs = ("contact.force_y_max", "contact.lost_time")
    table = roll(fmu, parameters, speed, FLAT_AT + FLAT + 0.012 * speed, 2.5e-5, outputs)
    return table[:, 2].max(), table[-1, 3]


def spectrum(fmu):
    """One-third octaves of what the wheel met on one period of a rail by EN ISO 3095."""
    parameters = RAILWAY | {"rail.profile": f"roughness(spectrum = EN_ISO_3095, shortest = 0.02, length = {PERIOD}, seed = 1)"}
    speed = 100.0 * KMH
    table = roll(fmu, parameters, speed, PERIOD, PERIOD / SAMPLES / speed, ("rail.profile_height",))
    frequency, level = signals.octaves(table[:, 1], table[:, 2], 1e-6, "boxcar")
    known = [(1.0 / f, l) for f, l in zip(frequency, level) if 0.018 < 1.0 / f < 0.45]
    return np.array(known)


def standing(fmu, wavelength, phase):
    """Height of the hub on a wave, and half-width of the contact, of a wheel that stands."""
    wave = f"sinusoid(amplitude = 2e-6, wavelength = {wavelength}, phase = {phase})"
    with Wheel(fmu, RAILWAY | {"rail.profile": wave, "initial.velocity": 0.0}) as wheel:
        return wheel.get("hub.height", "contact.half_width")


def cases(fmu):
    """Everything to compute: key to function and arguments."""
    speeds = np.array(SPEEDS) * KMH
    tasks = {("corrugation", speed): (corrugation, speed) for speed in speeds}
    tasks |= {("hole", speed): (hole, speed) for speed in np.array(HOLE_SPEEDS) * KMH}
    base = (100.0 * KMH, LOAD, 0.0)
    varied = {"speed": [(v * KMH, *base[1:]) for v in (50, 75, 100)]}
    varied["load"] = [(base[0], share * LOAD, 0.0) for share in (0.5, 1.0, 1.5)]
    varied["unsprung mass"] = [(*base[:2], mass) for mass in (0.0, 1e3, 2e3)]
    tasks |= {("rough", *case): (rough, *case) for group in varied.values() for case in group}
    flats = np.array(FLAT_SPEEDS) * KMH
    tasks |= {("flat", shape, speed): (flat, shape, speed) for shape in ("fresh", "rounded") for speed in flats}
    tasks |= {("spectrum",): (spectrum,)}
    for phase in (0.5 * np.pi, -0.5 * np.pi):
        tasks |= {("standing", length, phase): (standing, length, phase) for length in FILTERED}
    return tasks, {"speeds": speeds, "flats": flats, "varied": varied}


def compute(fmu):
    """Results of all cases on two threads."""
    tasks, axes = cases(fmu)
    with ThreadPoolExecutor(2) as pool:
        running = {key: pool.submit(function, fmu, *arguments) for key, (function, *arguments) in tasks.items()}
        found = {key: future.result() for key, future in tqdm(running.items(), desc="surfaces", disable=None)}
    return found, axes


def closed_form(speeds, half_width):
    """Amplitude over waves of a mass on the contact spring that a damper holds [N]."""
    return surfaces.corrugation_force(speeds, WAVE, WAVELENGTH, half_width, MASS * RESONANCE**2, MASS, damper=DAMPER)


def report(found, axes, half_width):
    """Rows of the table: what, unit, found, expected or none."""
    speeds, rows = axes["speeds"], []
    for speed, exact in zip(speeds, closed_form(speeds, half_width)):
        rows.append((f"waves at {speed / KMH:.0f} km/h: amplitude of the force", "N", found["corrugation", speed], exact))
    for key in (key for key in found if key[0] == "hole"):
        force = found[key][1]
        rows += [(f"hole at {key[1] / KMH:.0f} km/h: {name} over load", "1", value / LOAD, None) for name, value in (("least", force.min()), ("largest", force.max()))]
    for name, group in axes["varied"].items():
        for k, case in enumerate(group):
            about = signals.statistics(*found["rough", *case])
            label = f"rough rail, {name} {k + 1} of 3"
            rows += [(f"{label}: mean", "N", about.mean, case[1]), (f"{label}: standard deviation", "N", about.deviation, None)]
    for key in (key for key in found if key[0] == "flat"):
        rows.append((f"{key[1]} flat at {key[2] / KMH:.0f} km/h: largest force", "N", found[key][0], None))
        rows.append((f"{key[1]} flat at {key[2] / KMH:.0f} km/h: without contact", "s", found[key][1], None))
    for length, level in found["spectrum",]:
        rows.append((f"roughness met at {length:.3g} m", "dB", level, surfaces.EN_ISO_3095[round(10 * np.log10(length))]))
    for length, level, exact in filtered(found):
        rows.append((f"contact filter at {length:.3g} m", "dB", level, exact))
    return rows


def filtered(found):
    """Wavelength, level of what lifts a standing wheel, and the Bessel function [dB]."""
    for length in FILTERED:
        (crest, width), (trough, _) = (found["standing", length, sign * 0.5 * np.pi] for sign in (1.0, -1.0))
        level = 20.0 * np.log10(abs(crest - trough) / 4e-6)
        yield length, level, float(surfaces.contact_filter_level(width, length))


def draw(path, found, axes, half_width):
    """The gallery. Forces are drawn over the static load: they belong to wheels of different width."""
    figure, grid = subplots(3, 3, figsize=(8, 8))
    waves, hole, met = grid[0]
    draw_waves(waves, found, axes["speeds"], half_width)
    for key, colour in zip((key for key in found if key[0] == "hole"), COLOURS):
        x, force = found[key]
        hole.plot(1e3 * x, force / LOAD, color=colour, label=f"{key[1] / KMH:.0f} km/h")
    hole.set(title="Sharp hole, 5 mm", xlabel="from its middle [mm]", ylabel="force / load [1]", ylim=(None, 1.25))
    draw_densities(grid[1], found, axes["varied"])
    draw_flats(grid[2, :2], found, axes["flats"])
    draw_levels(met, grid[2, 2], found)
    for axis in figure.axes:
        axis.legend(handlelength=1.2, borderpad=0.1, labelspacing=0.25)
    save(path, figure)


def draw_waves(axis, found, speeds, half_width):
    """Amplitude of the force over waves."""
    fine = np.linspace(speeds[0], speeds[-1], 300)
    omega = lambda speed: 2e-3 * np.pi * speed / WAVELENGTH
    axis.plot(omega(fine), closed_form(fine, half_width) / LOAD, color=GREY, label="closed form")
    axis.plot(omega(speeds), [found["corrugation", v] / LOAD for v in speeds], "o", color=COLOURS[0], label="FMU", markersize=4)
    axis.set(title="Waves of 5 µm, 5 cm", xlabel="excitation [rad/ms]", ylabel="amplitude / load [1]")


def draw_densities(axes, found, varied):
    """Densities of the force on a rough rail."""
    labels = {
        "speed": lambda k: f"{k[0] / KMH:.0f} km/h",
        "load": lambda k: f"load × {k[1] / LOAD:g}",
        "unsprung mass": lambda k: f"{(MASS + k[2]) / 1e3:.1f} t/m",
    }
    for axis, (name, group) in zip(axes, varied.items()):
        for case, colour in zip(group, COLOURS):
            edges, share = signals.density(*found["rough", *case], classes=40)
            axis.plot(0.5 * (edges[1:] + edges[:-1]) / LOAD, LOAD * share, color=colour, label=labels[name](case))
        axis.set(title=f"Rough rail: {name}", xlabel="force / load [1]", ylim=(0, 1.35 * axis.get_ylim()[1]))
    axes[0].set_ylabel("density [1]")


def draw_flats(axes, found, speeds):
    """Largest force of flats and how long they take contact away."""
    force, lost = axes
    for shape, colour in zip(("fresh", "rounded"), COLOURS):
        values = np.array([found["flat", shape, v] for v in speeds])
        force.plot(speeds / KMH, values[:, 0] / RAILWAY_LOAD, "o-", color=colour, label=shape, markersize=4)
        lost.plot(speeds / KMH, 1e3 * values[:, 1], "o-", color=colour, label=shape, markersize=4)
    force.set(title="Flat, 40 mm: strike", xlabel="speed [km/h]", ylabel="largest force / load [1]", ylim=(1, None))
    lost.set(title="Flat, 40 mm: in the air", xlabel="speed [km/h]", ylabel="time without contact [ms]")


def draw_levels(rough, filtering, found):
    """Roughness that the wheel met, and the contact filter."""
    met = found["spectrum",]
    limit = [surfaces.EN_ISO_3095[round(10 * np.log10(x))] for x in met[:, 0]]
    rough.semilogx(1e3 * met[:, 0], limit, "--", color=GREY, label="EN ISO 3095")
    rough.semilogx(1e3 * met[:, 0], met[:, 1], "o", color=COLOURS[0], label="met by the wheel", markersize=4)
    rough.set(title="Roughness", xlabel="wavelength [mm]", ylabel="level [dB re 1 µm]")
    lengths, levels, exact = np.array(list(filtered(found))).T
    filtering.semilogx(1e3 * lengths, exact, color=GREY, label="Bessel function")
    filtering.semilogx(1e3 * lengths, levels, "o", color=COLOURS[0], label="standing wheel", markersize=4)
    filtering.semilogx(1e3 * lengths, surfaces.cnossos_filter(lengths), "x", color=COLOURS[1], label="CNOSSOS-EU")
    filtering.set(title="Contact filter", xlabel="wavelength [mm]", ylabel="level [dB]")
    for axis, ticks in ((rough, [20, 50, 100, 200, 400]), (filtering, [20, 30, 50, 100])):
        axis.set_xticks(ticks)
        axis.xaxis.set_major_formatter("{x:g}")
        axis.xaxis.set_minor_formatter("")


def main():
    """Computes, prints, draws."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fmu", default="target/wheelrail.fmu")
    parser.add_argument("--out", type=Path, default=Path("results"))
    parser.add_argument("--brief", action="store_true", help="fewer speeds and a shorter rough rail, in seconds")
    options = parser.parse_args()
    globals().update(BRIEF if options.brief else {})
    began = perf_counter()
    with Fmu(options.fmu) as fmu:
        with Wheel(fmu, PAPER) as wheel:
            half_width = wheel.get("contact.half_width")
        found, axes = compute(fmu)
    rows = report(found, axes, half_width)
    for name, unit, value, exact in rows:
        beside = "" if exact is None else f"   {exact:12.5g}   {value - exact:+9.3g}" if unit == "dB" else f"   {exact:12.5g}   {100 * (value / exact - 1):+8.2f} %"
        print(f"{name:58} {value:12.5g} {unit:4}{beside}")
    options.out.mkdir(parents=True, exist_ok=True)
    with open(options.out / "surfaces.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([("name", "unit", "found", "expected"), *rows])
    draw(options.out / "surfaces.png", found, axes, half_width)
    print(f"{perf_counter() - began:.0f} s; written: {options.out / 'surfaces.csv'}, {options.out / 'surfaces.png'}")


if __name__ == "__main__":
    main()
