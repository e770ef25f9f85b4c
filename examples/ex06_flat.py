"""Example 6: a wheel flat. A wheel is locked, slides for two seconds, is released and rolls on for ten.

    make flat

1. The wheel rolls; its rotation is stopped within 20 ms while the vehicle keeps its speed. It slides.
2. After two seconds the brake lets go: the rail turns the wheel again, and the hot spot leaves the contact.
3. It rolls for ten seconds. The spot cools into the cold steel below it, faster than steel can transform back.
4. Beside the outputs of the FMU stands an independent computation: conduction in a half-plane whose surface has had the
   temperatures of the contact (`conduct`), with its own depth above Ac1, cooling rate and martensite.
5. A table compares with what was published. Every number has its source, and says what is judgement.
6. Results become a CSV and a plot.

7. The run is repeated with half the step, and with spots of half the elements and steps: what is found must not change.

Outputs that the FMU does not have (`damage.*` of an older one) are left out.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np
from tqdm import tqdm

from wheel import Fmu, Refused, Wheel

KELVIN = 273.15  # K at 0 °C
LOCK = 0.02  # s, in which the rotation stops
# Outputs of every communication point.
COLUMNS = (
    "wheel.velocity", "wheel.omega", "contact.force_x", "contact.force_y", "contact.pressure_max", "contact.half_width",
    "contact.friction", "temperature.wheel_max", "temperature.rail_max", "heat.to_wheel", "heat.to_rail",
    "solver.energy_residual", "solver.heat_residual",
)  # fmt: skip
# Of the damage, as far as the FMU has it.
DAMAGE = (
    "damage.peak_temperature", "damage.flattening", "damage.yielded", "damage.melted", "damage.ac1_depth",
    "damage.cooling_rate", "damage.martensite_depth", "damage.time_above_ac1", "damage.rail_peak", "damage.rail_heat",
)  # fmt: skip
# What is left of the slide, which must be independent of step and mesh.
LEFT = (
    "damage.peak_temperature", "damage.ac1_depth", "damage.cooling_rate", "damage.martensite_depth",
    "damage.time_above_ac1", "damage.flattening",
)  # fmt: skip
CONVERGED = 0.05  # change of these

# Steel of the independent computation, if the FMU has no parameters for it: start of the martensite transformation [K] by
# Andrews' formula 539 - 423 C - 30.4 Mn - 17.7 Ni - 12.1 Cr - 7.5 Mo [°C] (read in a second source) for an ASSUMED wheel
# steel 0.50 C 0.75 Mn 0.25 Cr 0.35 Si; cooling from 800 to 500 °C [K/s] from which no pearlite forms: JUDGEMENT, no value was
# found for wheel steel.
STEEL = {"damage.martensite_start": 302.0 + KELVIN, "damage.critical_cooling": 50.0}
# Coefficient of Koistinen and Marburger, 1 - exp(-b (Ms - T)) [1/K]: the form was read, the value is from memory.
KOISTINEN = 0.011
# Galton 1878, steel on steel, mph and friction coefficient: FROM MEMORY.
GALTON = ((7, 14, 27, 34, 41, 55, 60), (0.088, 0.072, 0.070, 0.065, 0.057, 0.038, 0.027))
MPH = 1.609344 / 3.6  # m/s

# Half-plane of the independent computation: along the tread, forward of the contact point of the locked wheel.
SPACING = 2e-4  # m
AROUND = (-0.020, 0.035)  # m
DEPTH = 0.015  # m
TURNED = 0.020  # m, by which the wheel turns before the spot has left the contact
FROM, TO = 800.0 + KELVIN, 500.0 + KELVIN  # K, between which cooling is measured
SHOWN = (0.0, 0.4e-3, 1e-3, 2e-3, 4e-3)  # m, depths drawn over time, multiples of the spacing


def steel(wheel, name):
    """A property of the steel, as the FMU has it."""
    return wheel.get(name) if name in wheel.fmu.variables else STEEL[name]


class Slide:
    """A run and all that is kept of it."""

    def __init__(self, wheel, options):
        self.wheel, self.options = wheel, options
        self.columns = COLUMNS + tuple(name for name in DAMAGE if name in wheel.fmu.variables)
        self.rows, self.surfaces = [], []
        self.x = np.array(wheel.profile("x"))

    def see(self):
        """Keeps the outputs, and the tread's temperatures until the hot place has left the contact."""
        wheel = self.wheel
        self.rows.append([wheel.time, *(wheel.get(name) for name in self.columns)])
        if wheel.time < LOCK + self.options.slide + 0.2:
            turned = wheel.get("wheel.radius") * wheel.get("wheel.angle")
            self.surfaces.append((wheel.time, turned, np.array(wheel.profile("temperature_wheel"))))

    def run(self):
        """Locks, slides, releases, rolls on."""
        o, wheel = self.options, self.wheel
        omega = wheel.get("wheel.omega")
        released = LOCK + o.slide
        wheel.set({"drive.velocity": o.speed_kmh / 3.6})
        self.see()
        steps = round((released + o.roll) / o.step)
        free = False
        for _ in tqdm(range(steps), desc="flat", unit="step", disable=None):
            if wheel.time < released - 0.5 * o.step:
                wheel.set({"drive.omega": omega * max(0.0, 1.0 - (wheel.time + o.step) / LOCK)})
            elif not free:
                wheel.set({"control.rotation": "moment", "drive.moment": 0.0})
                free = True
            wheel.step(o.step)
            self.see()
        return np.array(self.rows)

    def column(self, table, name):
        """A column of the table; `None` for an output that the FMU does not have."""
        names = ("time", *self.columns)
        return table[:, names.index(name)] if name in names else None


def surface_of(slide):
    """Times [s], distances turned since the wheel was locked [m], and surface temperatures [K] while the spot is near the contact."""
    times, turned, surfaces = (np.array(column) for column in zip(*slide.surfaces))
    turned = turned - turned[np.searchsorted(times, LOCK - 1e-9)]
    near = np.abs(turned) < TURNED
    return times[near], turned[near], surfaces[near]


def conduct(slide, wheel, end):
    """Conduction in a half-plane of the wheel's steel: as long as material is in the contact its surface has the temperatures
    that the contact has there, then it is insulated. The chill by the rail, once in a turn, is left out, as are the width of
    the contact, from which heat spreads sideways in the wheel of the FMU, and latent heat.

    Explicit differences. Returns a dictionary: `time` [s]; `record`, temperatures [K] over time at the depths SHOWN below the
    place that was hottest; over the depths `z` [m] the highest temperature of all places, `peak` [K], and the cooling rate
    [K/s] there, `rate`, with the rule of `damage.cooling_rate`, 0 where it was not above Ac1; `hottest`, that of the point
    which was hottest.
    """
    conductivity, density, heat = wheel.get("material.conductivity", "material.density", "material.specific_heat")
    diffusivity = conductivity / (density * heat)
    reference, ac1 = wheel.get("thermal.reference"), wheel.get("thermal.austenitisation")
    s, z = np.arange(*AROUND, SPACING), np.arange(0.0, DEPTH + 0.5 * SPACING, SPACING)
    field = np.full((len(z), len(s)), reference)
    number = 0.2
    step = number * SPACING**2 / diffusivity
    times, turned, surfaces = surface_of(slide)
    peak, upper, lower = field.copy(), np.zeros(field.shape), np.zeros(field.shape)
    kept, record, time = [], [], 0.0
    while time < end:
        # Mirrored at the surface; far away nothing happens.
        change = np.vstack((field[1:2], field[:-1])) + np.vstack((field[1:], field[-1:])) - 4.0 * field
        change[:, 1:-1] += field[:, 2:] + field[:, :-2]
        change[:, 0] = change[:, -1] = 0.0
        change[-1] = 0.0
        old, field = field, field + number * change
        time += step
        if times[0] <= time <= times[-1]:
            i = np.searchsorted(times, time)
            share = (time - times[i - 1]) / (times[i] - times[i - 1]) if i > 0 else 0.0
            between = lambda values: values[i] if i == 0 else (1.0 - share) * values[i - 1] + share * values[i]
            x = s - between(turned)
            inside = (x >= slide.x[0]) & (x <= slide.x[-1])
            field[0, inside] = np.interp(x[inside], slide.x, between(surfaces))
        peak = np.maximum(peak, field)
        start = np.where(peak > FROM, FROM, ac1)
        upper = np.where((old >= start) & (field < start) & (peak > ac1), time, upper)
        lower = np.where((old >= TO) & (field < TO), time, lower)
        if not kept or time - kept[-1] > 2e-3:
            kept.append(time)
            record.append(field[[round(depth / SPACING) for depth in SHOWN]])
    cooled = (upper > 0.0) & (lower > upper)
    rate = np.divide(np.where(peak > FROM, FROM, ac1) - TO, lower - upper, out=np.zeros(field.shape), where=cooled)
    deepest = np.argmax(peak, axis=1)
    place = int(np.argmax(np.max(np.array(record)[:, 0], axis=0)))
    return {
        "time": np.array(kept), "record": np.array(record)[:, :, place], "z": z,
        "peak": peak.max(axis=1), "rate": rate[np.arange(len(z)), deepest],
        "hottest": rate.flat[np.argmax(peak)],
    }  # fmt: skip


def depth_of(z, values, limit):
    """Depth [m] down to which values that fall with the depth are above a limit."""
    over = np.flatnonzero(values >= limit)
    if len(over) == 0:
        return 0.0
    i = over[-1]
    return z[i] if i + 1 == len(z) else z[i] + (z[i + 1] - z[i]) * (values[i] - limit) / (values[i] - values[i + 1])


def martensite(temperature, start):
    """Share of martensite at a temperature [K] after quenching, if it starts to form at `start` [K]."""
    return 1.0 - np.exp(-KOISTINEN * np.maximum(0.0, start - temperature))


def summary(slide, table, cooled, wheel):
    """Key figures: name, value, unit, source."""
    options = slide.options
    t = slide.column(table, "time")
    sliding = (t > 0.05) & (t <= LOCK + options.slide)
    force, load = (slide.column(table, f"contact.force_{axis}")[sliding] for axis in "xy")
    friction = -force.mean() / load.mean()
    austenitisation = wheel.get("thermal.austenitisation")
    _, _, z, peak, rate = cooled
    critical, start = (steel(wheel, name) for name in ("damage.critical_cooling", "damage.martensite_start"))
    hardened = np.where((peak >= austenitisation) & (rate > critical), peak, 0.0)
    radius = wheel.get("wheel.radius")
    mph = options.speed_kmh / 3.6 / MPH
    rows = [
        ("friction coefficient while sliding, mean", friction, "", "model"),
        ("Galton's at this speed", np.interp(mph, *GALTON), "", "from memory"),
        ("force of the slide over the friction limit at rest", friction / wheel.get("rail.friction"), "", "model"),
        ("the same, measured: less than", 1 / 3, "", "Galton, read in a biography of Westinghouse"),
        ("highest tread temperature", slide.column(table, "temperature.wheel_max").max() - KELVIN, "°C", "model"),
        ("highest peak pressure", slide.column(table, "contact.pressure_max").max() / 1e6, "MPa", "model"),
        ("depth above Ac1", depth_of(z, peak, austenitisation) * 1e3, "mm", "conduction in a half-plane"),
        ("cooling rate of the surface, 800 to 500 °C", rate[1], "K/s", "conduction in a half-plane"),
        ("critical cooling rate", critical, "K/s", "judgement"),
        ("depth of martensite", depth_of(z, hardened, austenitisation) * 1e3, "mm", "conduction in a half-plane"),
        ("share of martensite after cooling", martensite(wheel.get("thermal.reference"), start) * 100, "%", "from memory"),
    ]
    scale = {"K": (1.0, "K"), "m": (1e3, "mm")}
    for name in DAMAGE:
        values = slide.column(table, name)
        if values is None:
            continue
        unit = wheel.fmu.variables[name].unit or ""
        factor, shown = scale.get(unit, (1.0, unit if unit != "1" else ""))
        rows.append((name, values.max() * factor, shown, "model"))
        if name == "damage.flattening":
            chord = 2.0 * np.sqrt(2.0 * radius * values.max())
            rows.append(("length of a plane flat of that depth", chord * 1e3, "mm", "2 sqrt(2 r d)"))
    return rows


def observations(slide, table, cooled, wheel):
    """What was published, and whether the run agrees."""
    depth = slide.column(table, "damage.martensite_depth")
    hard = depth.max() if depth is not None else 0.0
    _, _, z, peak, rate = cooled
    alone = depth_of(z, np.where(rate > steel(wheel, "damage.critical_cooling"), peak, 0.0), wheel.get("thermal.austenitisation"))
    found = "yes" if max(hard, alone) > 0.0 else "no"
    return (
        ("martensite beneath all of more than 200 flats (Silinge 1996, abstract of Proc. IMechE F 213, read)", found),
        ("cracks beneath most of them (the same)", "not modelled"),
        ("length and depth of the flats over load, speed and time (the same)", "not found, not compared"),
        ("friction falls with speed and sliding time (Galton 1878, read)", "see the friction over time in the plot"),
    )


def left(slide, table):
    """What is left at the end, by name."""
    found = ((name, slide.column(table, name)) for name in LEFT)
    return {name: values[-1] for name, values in found if values is not None}


def repeated(fmu, options, changes, step):
    """What is left of the same slide with other parameters and another step [s]."""
    options = argparse.Namespace(**(vars(options) | {"step": step}))
    with start(fmu, options, changes) as wheel:
        slide = Slide(wheel, options)
        return left(slide, slide.run())


def convergence(fmu, options, usual):
    """Prints what is left with finer spots and shorter steps; returns the largest change, over the finer one."""
    cases = [("half the step", {}, 0.5 * options.step)]
    if "damage.resolution" in fmu.variables:
        cases.append(("spots twice as fine", {"damage.resolution": 0.5}, options.step))
    found = [("as above", usual)] + [(name, repeated(fmu, options, *case)) for name, *case in cases]
    print("\nConvergence (change against the finer one)")
    worst = 0.0
    for key in usual:
        line = f"  {key:<26}{usual[key]:>12.5g}"
        for name, values in found[1:]:
            change = abs(usual[key] / values[key] - 1.0) if values[key] else abs(usual[key])
            worst = max(worst, change)
            line += f"   {name} {values[key]:.5g} ({change:.2%})"
        print(line)
    print(f"  {'converged' if worst <= CONVERGED else 'NOT CONVERGED'} within {CONVERGED:.0%}: at most {worst:.2%}")
    return worst


def plot(path, slide, table, cooled, wheel):
    """Draws the slide, the temperatures in the depth and what is left."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    blue, orange, green, grey = "#0072B2", "#D55E00", "#009E73", "#777777"
    plt.rcParams.update({"font.size": 9, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False})
    plt.rcParams.update({"axes.spines.right": False, "legend.frameon": False, "lines.linewidth": 1.4})
    figure, axes = plt.subplots(2, 3, figsize=(13, 6.6), layout="constrained")
    column = lambda name: slide.column(table, name)
    t, released = column("time"), LOCK + slide.options.slide
    austenitisation = wheel.get("thermal.austenitisation") - KELVIN
    near = t < released + 0.6

    axis = axes[0, 0]
    axis.plot(t[near], 3.6 * column("wheel.velocity")[near], color=blue, label="travel")
    rim = wheel.get("wheel.radius") * column("wheel.omega")
    axis.plot(t[near], 3.6 * rim[near], "--", color=orange, label="rim")
    axis.set(title="Speed: locked, released", ylabel="km/h", xlabel="time [s]")
    axis.legend()

    axis = axes[0, 1]
    adhesion = -column("contact.force_x") / column("contact.force_y")
    axis.plot(t[near], adhesion[near], color=blue, label="force over load")
    axis.axhline(np.interp(slide.options.speed_kmh / 3.6 / MPH, *GALTON), color=grey, ls=":", label="Galton (from memory)")
    axis.set(title="Friction", xlabel="time [s]", ylim=(0, None))
    axis.legend()
    twin = axis.twinx()
    twin.plot(t[near], column("contact.pressure_max")[near] / 1e6, color=orange)
    twin.set_ylabel("peak pressure [MPa]", color=orange)
    twin.grid(False)

    axis = axes[0, 2]
    axis.plot(t, column("temperature.wheel_max") - KELVIN, color=orange, label="tread in the contact")
    if column("damage.peak_temperature") is not None:
        axis.plot(t, column("damage.peak_temperature") - KELVIN, color=blue, label="peak of the spot")
    axis.axhline(austenitisation, color=grey, ls=":")
    axis.set(title="Surface temperature", ylabel="°C", xlabel="time [s]")
    axis.legend()

    times, record, z, peak, rate = cooled
    axis = axes[1, 0]
    shades = plt.cm.plasma(np.linspace(0.0, 0.85, len(SHOWN)))
    for k, depth in enumerate(SHOWN):
        axis.plot(times, record[:, k] - KELVIN, color=shades[k], label=f"{depth * 1e3:g} mm")
    axis.axhline(austenitisation, color=grey, ls=":")
    start = steel(wheel, "damage.martensite_start") - KELVIN
    axis.axhline(start, color=grey, ls="--")
    axis.text(times[-1], austenitisation, "Ac1", color=grey, ha="right", va="bottom")
    axis.text(times[-1], start, "Ms", color=grey, ha="right", va="bottom")
    axis.set(title="Temperature in the depth (half-plane)", ylabel="°C", xlabel="time [s]")
    axis.legend()

    axis = axes[1, 1]
    axis.plot(peak - KELVIN, z * 1e3, color=orange, label="peak temperature [°C]")
    axis.axvline(austenitisation, color=grey, ls=":")
    axis.set(title="Peak temperature and cooling rate over depth", xlabel="°C", ylabel="depth [mm]", ylim=(8, 0))
    twin = axis.twiny()
    hot = rate > 0.0
    twin.plot(rate[hot], z[hot] * 1e3, color=blue)
    twin.set_xlabel("K/s, 800 to 500 °C", color=blue)
    twin.grid(False)
    axis.legend(loc="lower right")

    axis = axes[1, 2]
    for name, color in (("flattening", grey), ("ac1_depth", orange), ("martensite_depth", blue)):
        values = column(f"damage.{name}")
        if values is not None:
            axis.plot(t, values * 1e3, color=color, label=f"damage.{name}")
    depth = depth_of(z, peak, austenitisation + KELVIN)
    axis.axhline(depth * 1e3, color=orange, ls=":", label="Ac1 depth, half-plane")
    axis.set(title="What is left", ylabel="mm", xlabel="time [s]")
    axis.legend()
    figure.savefig(path, dpi=120)


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for CSV and plot")
    parser.add_argument("--step", type=float, default=1e-3, help="communication step [s], default %(default)s")
    parser.add_argument("--speed-kmh", type=float, default=60.0, help="speed [km/h], default %(default)s")
    parser.add_argument("--slide", type=float, default=2.0, help="time for which the wheel is locked [s]")
    parser.add_argument("--roll", type=float, default=10.0, help="time for which it rolls on [s]")
    parser.add_argument("--preset", default="railway", help="parameter set, default %(default)s")
    parser.add_argument("--once", action="store_true", help="leave out the runs that show convergence")
    return parser.parse_args()


def start(fmu, options, changes=None):
    """A wheel that rolls at the speed of the options."""
    parameters = {"preset": options.preset, "initial.velocity": options.speed_kmh / 3.6} | (changes or {})
    inputs = {"control.rotation": "velocity", "control.translation": "velocity"}
    return Wheel(fmu, parameters, inputs, name="flat")


def run(options):
    """The slide, its flat and their comparison."""
    with Fmu(options.fmu) as fmu, start(fmu, options) as wheel:
        slide = Slide(wheel, options)
        table = slide.run()
        cooled = conduct(slide, wheel, LOCK + options.slide + options.roll)
        print(f"\nSlide of {options.slide:g} s at {options.speed_kmh:g} km/h, rolled on for {options.roll:g} s\n")
        for name, value, unit, source in summary(slide, table, cooled, wheel):
            print(f"  {name:<52}{value:>10.4g} {unit:<5} ({source})")
        print("\nPublished observations")
        for text, answer in observations(slide, table, cooled, wheel):
            print(f"  {text}: {answer}")
        options.out.mkdir(parents=True, exist_ok=True)
        data, picture = options.out / "flat.csv", options.out / "flat.png"
        with open(data, "w", newline="") as file:
            writer = csv.writer(file)
            writer.writerow(("time", *slide.columns))
            writer.writerows([f"{value:.9g}" for value in row] for row in table)
        plot(picture, slide, table, cooled, wheel)
        if not options.once:
            convergence(fmu, options, left(slide, table))
        print(f"\nwritten: {data}, {picture}")


if __name__ == "__main__":
    try:
        run(arguments())
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
