"""Example 6: a wheel flat. A wheel is locked, slides for two seconds, is released and rolls on for ten.

    make study NAME=flat

1. The wheel rolls; its rotation is stopped within 20 ms while the vehicle keeps its speed. It slides.
2. After two seconds the brake lets go: the rail turns the wheel again, and the hot spot leaves the contact.
3. It rolls for ten seconds. The spot cools into the cold steel below it, faster than steel can transform back.
4. Beside the outputs of the FMU stands an independent computation: conduction in a half-plane whose surface has had the
   temperatures of the contact for as long as it lay there (`conduct`), with its own depth above Ac1, cooling rate and
   martensite.
5. A table compares with what was published. Every number has its source, and says what is judgement.
6. Results become a CSV and a plot.

7. The run is repeated with half the step, with twice the elements in the contact, and with spots of half the elements and
   steps: what is found must not change by more than 5 %, else the example ends with 1.

Outputs that the FMU does not have (those of an older one) are left out.
"""

import argparse
import csv
import sys
from pathlib import Path

import numpy as np
from tqdm import tqdm

from wheelrail import Fmu, Refused, Wheel
from wheelrail.plots import GREY, Picture, save

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
    "damage.peak_temperature", "damage.flattening", "wheel.flat_length", "damage.yielded", "damage.melted", "damage.ac1_depth",
    "damage.cooling_rate", "damage.martensite_depth", "damage.time_above_ac1", "damage.rail_peak", "damage.rail_heat",
)  # fmt: skip
# What is left of the slide, which must be independent of step and mesh.
LEFT = (
    "damage.peak_temperature", "damage.ac1_depth", "damage.cooling_rate", "damage.martensite_depth",
    "damage.time_above_ac1", "damage.flattening",
)  # fmt: skip
CONVERGED = 0.05  # change of these
FINE = {"mesh.elements_per_half_width": 20}  # twice the usual number

# The rail lies on a track: stiffness and damping below a wheel, mass that moves with the rail (one rail of Zhai, Wang
# and Lin, J. Sound Vib. 270 (2004), put together). On a rigid base the wheel would bounce for ever once its flat has
# struck.
TRACK = {"rail.support_stiffness": 81e6, "rail.support_damping": 120e3, "rail.support_mass": 400.0}

# Steel of the independent computation, if the FMU has no parameters for it: start of the martensite transformation [K]
# by Andrews' formula 539 - 423 C - 30.4 Mn - 17.7 Ni - 12.1 Cr - 7.5 Mo [°C] (read in a second source) for an ASSUMED
# wheel steel 0.50 C 0.75 Mn 0.25 Cr 0.35 Si; cooling from 800 to 500 °C [K/s] from which no pearlite forms: JUDGEMENT,
# no value was found for wheel steel.
STEEL = {"damage.martensite_start": 302.0 + KELVIN, "damage.critical_cooling": 50.0}
# Coefficient of Koistinen and Marburger, 1 - exp(-b (Ms - T)) [1/K]: the form was read, the value is from memory.
KOISTINEN = 0.011
# Galton 1878, steel on steel, mph and friction coefficient: FROM MEMORY.
GALTON = ((7, 14, 27, 34, 41, 55, 60), (0.088, 0.072, 0.070, 0.065, 0.057, 0.038, 0.027))
MPH = 1.609344 / 3.6  # m/s

BLUE, ORANGE = "#0072B2", "#D55E00"

# Half-plane of the independent computation: along the tread, forward of the contact point of the locked wheel.
SPACING = 2e-4  # m
AROUND = (-0.020, 0.035)  # m
DEPTH = 0.015  # m
TURNED = 0.020  # m, by which the wheel turns before the spot has left the contact
FROM, TO = 800.0 + KELVIN, 500.0 + KELVIN  # K, between which cooling is measured
PLANE = "conduction in a half-plane"
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
    that the contact has there, then it is insulated. Heat spreads sideways by the law of the FMU, `spread`. The chill by the
    rail, once in a turn, is left out, as is latent heat.

    Explicit differences. Returns a dictionary: `time` [s]; `record`, temperatures [K] over time at the depths SHOWN below the
    place where steel was above Ac1 to the greatest depth; over the depths `z` [m] the highest temperature of all places, `peak` [K], and the cooling rate
    [K/s] there, `rate`, with the rule of `damage.cooling_rate`, 0 where it was not above Ac1; `longest`, that of the point
    which was longest above Ac1.
    """
    conductivity, density, heat = wheel.get("material.conductivity", "material.density", "material.specific_heat")
    diffusivity = conductivity / (density * heat)
    reference, ac1 = wheel.get("thermal.reference"), wheel.get("thermal.austenitisation")
    s, z = np.arange(*AROUND, SPACING), np.arange(0.0, DEPTH + 0.5 * SPACING, SPACING)
    field = np.full((len(z), len(s)), reference)
    number = 0.2
    step = number * SPACING**2 / diffusivity
    times, turned, surfaces = surface_of(slide)
    width = spread(z / wheel.get("model.contact_width"))[:, None]
    between_rows = 0.5 * (width[1:] + width[:-1])
    peak = field.copy()
    upper, lower, above = (np.zeros(field.shape) for _ in range(3))
    kept, record, time = [], [], 0.0
    while time < end:
        # The first row is half as thick as the others; far away nothing happens.
        flow = between_rows * np.diff(field, axis=0)
        change = np.zeros(field.shape)
        change[0] = 2.0 * flow[0] / width[0]
        change[1:-1] = np.diff(flow, axis=0) / width[1:-1]
        change[:-1, 1:-1] += np.diff(field[:-1], 2, axis=1)
        change[:, 0] = change[:, -1] = 0.0
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
        above += step * (field > ac1)
        start = np.where(peak > FROM, FROM, ac1)
        upper = np.where((old >= start) & (field < start) & (peak > ac1), time, upper)
        lower = np.where((old >= TO) & (field < TO), time, lower)
        if not kept or time - kept[-1] > 2e-3:
            kept.append(time)
            record.append(field[[round(depth / SPACING) for depth in SHOWN]])
    cooled = (upper > 0.0) & (lower > upper)
    rate = np.divide(np.where(peak > FROM, FROM, ac1) - TO, lower - upper, out=np.zeros(field.shape), where=cooled)
    place = int(np.argmax(peak[np.flatnonzero((peak > ac1).any(axis=1))[-1:]], axis=1)[0]) if (peak > ac1).any() else 0
    deepest = np.argmax(peak, axis=1)
    return {
        "time": np.array(kept), "record": np.array(record)[:, :, place], "z": z,
        "peak": peak.max(axis=1), "rate": rate[np.arange(len(z)), deepest],
        "longest": rate.flat[np.argmax(above)],
    }  # fmt: skip


def spread(zeta):
    """Width of the heat at the depth over the width of the contact `zeta`, over that width (docs/theory/width-of-conduction.md)."""
    return 1.0 + np.pi * zeta - (np.pi - 4.0 / np.pi) * zeta / (1.0 + 2.0 * zeta)


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
    start = steel(wheel, "damage.martensite_start")
    radius = wheel.get("wheel.radius")
    mph = options.speed_kmh / 3.6 / MPH
    rows = [
        ("friction coefficient while sliding, mean", friction, "", "model"),
        ("Galton's at this speed", np.interp(mph, *GALTON), "", "from memory"),
        ("force of the slide over the friction limit at rest", friction / wheel.get("rail.friction"), "", "model"),
        ("the same, measured: less than", 1 / 3, "", "Galton, read in a biography of Westinghouse"),
        ("highest tread temperature", slide.column(table, "temperature.wheel_max").max() - KELVIN, "°C", "model"),
        ("highest peak pressure", slide.column(table, "contact.pressure_max").max() / 1e6, "MPa", "model"),
        ("depth above Ac1", depth_of(cooled["z"], cooled["peak"], austenitisation) * 1e3, "mm", PLANE),
        ("cooling rate of the point longest above Ac1", cooled["longest"], "K/s", PLANE),
        ("the same 0.4 mm below it", cooled["rate"][round(0.4e-3 / SPACING)], "K/s", PLANE),
        ("critical cooling rate", steel(wheel, "damage.critical_cooling"), "K/s", "judgement"),
        ("depth of martensite", hardened(cooled, wheel) * 1e3, "mm", PLANE),
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


def hardened(cooled, wheel):
    """Depth [m] of what the half-plane cools from above Ac1 at the critical rate at least."""
    austenitisation = wheel.get("thermal.austenitisation")
    fast = cooled["rate"] >= steel(wheel, "damage.critical_cooling")
    return depth_of(cooled["z"], np.where(fast, cooled["peak"], np.minimum(cooled["peak"], austenitisation)), austenitisation)


def observations(slide, table, cooled, wheel):
    """What was published, and whether the run agrees."""
    depth = slide.column(table, "damage.martensite_depth")
    hard = depth.max() if depth is not None else 0.0
    found = "yes" if max(hard, hardened(cooled, wheel)) > 0.0 else "no"
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
    """Prints what is left with finer spots, shorter steps and a finer mesh; returns the largest change."""
    cases = [("half the step", {}, 0.5 * options.step), ("twice the elements", FINE, options.step)]
    if "damage.resolution" in fmu.variables:
        cases.append(("spots twice as fine", {"damage.resolution": 0.5}, options.step))
    found = [("as above", usual)] + [(name, repeated(fmu, options, *case)) for name, *case in cases]
    print("\nConvergence (change against the other run)")
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
    figure = Picture(figsize=(8, 7.6))
    grid = figure.add_gridspec(3, 6, height_ratios=(1.0, 1.15, 1.15))
    panel = lambda row, column, width: figure.add_subplot(grid[row, column : column + width])
    slides = [panel(0, k, 2) for k in (0, 2, 4)]
    (surface, remains), (depth, rate) = ([panel(row, k, 3) for k in (0, 3)] for row in (1, 2))
    released = LOCK + slide.options.slide
    near = slide.column(table, "time") < released + 0.4
    draw_slide(slide, table[near], *slides)
    draw_heat(cooled, wheel, surface)
    draw_depth(cooled, wheel, depth, rate)
    draw_remains(slide, table, cooled, wheel, remains)
    for axis in (*slides, surface, remains):
        axis.set_xlabel("time [s]")
        axis.axvspan(LOCK, released, color=GREY, alpha=0.10, lw=0.0)
    save(path, figure)


def draw_slide(slide, table, speed, friction, pressure):
    """Speeds, friction and pressure while it slides and shortly after."""
    column = lambda name: slide.column(table, name)
    t = column("time")
    speed.plot(t, 3.6 * column("wheel.velocity"), color=BLUE, label="travel")
    speed.plot(t, 3.6 * slide.wheel.get("wheel.radius") * column("wheel.omega"), "--", color=ORANGE, label="tread")
    speed.set(title="Speed; locked: grey", ylabel="km/h")
    speed.legend(loc="center")
    friction.plot(t, -column("contact.force_x") / column("contact.force_y"), color=BLUE, label="force over load")
    mph = slide.options.speed_kmh / 3.6 / MPH
    friction.axhline(np.interp(mph, *GALTON), color=GREY, ls=":", label="Galton 1878")
    friction.set(title="Friction", ylabel="1", ylim=(0, None))
    friction.legend(loc="center", bbox_to_anchor=(0.43, 0.6), handlelength=1.3)
    pressure.plot(t, column("contact.pressure_max") / 1e6, color=ORANGE)
    pressure.set(title="Peak pressure", ylabel="MPa", ylim=(0, None))


def limits(wheel):
    """Temperatures [°C] at which austenite and martensite begin to form, by their names."""
    return {"Ac1": wheel.get("thermal.austenitisation") - KELVIN, "Ms": steel(wheel, "damage.martensite_start") - KELVIN}


def draw_heat(cooled, wheel, axis):
    """Temperatures in some depths over time."""
    shades = ["#000004", "#51127C", "#B73779", "#FC8961", "#FEC287"]
    for k, place in enumerate(SHOWN):
        axis.plot(cooled["time"], cooled["record"][:, k] - KELVIN, color=shades[k], label=f"{place * 1e3:g} mm")
    for name, limit in limits(wheel).items():
        axis.axhline(limit, color=GREY, ls=":")
        axis.text(1.01, limit, name, color=GREY, ha="left", va="center", transform=axis.get_yaxis_transform())
    axis.set(title="Temperature below one place (half-plane)", ylabel="°C", xlim=(0.0, 6.0), ylim=(0.0, None))
    axis.legend(title="depth", loc="upper right", frameon=True, facecolor="white", edgecolor="none", framealpha=1.0)


def draw_depth(cooled, wheel, temperature, rate):
    """The highest temperature and the cooling rate over the depth."""
    z, ac1 = 1e3 * np.array(cooled["z"]), limits(wheel)["Ac1"]
    temperature.plot(cooled["peak"] - KELVIN, z, "--", color=ORANGE, label="half-plane")
    if "profile.depth[1]" in wheel.fmu.variables:
        known, peak = np.array(wheel.profile("depth")), np.array(wheel.profile("peak_temperature"))
        temperature.plot(peak - KELVIN, 1e3 * known, color=BLUE, label="FMU")
    temperature.axvline(ac1, color=GREY, ls=":")
    temperature.text(ac1, 3.95, " Ac1", color=GREY, va="bottom")
    temperature.set(title="Highest temperature", xlabel="°C", ylabel="depth [mm]", ylim=(4, 0), xlim=(0, None))
    temperature.legend(loc="lower right")
    hot = (cooled["rate"] > 0.0) & (z > 0.0)
    rate.plot(cooled["rate"][hot], z[hot], "o--", color=ORANGE, markersize=3, label="half-plane")
    rate.axvline(steel(wheel, "damage.critical_cooling"), color=GREY, ls=":", label="critical")
    rate.set(title="Cooling rate of the hottest places", xlabel="K/s", ylabel="depth [mm]", ylim=(4, 0), xlim=(0, None))
    rate.legend(loc="lower right")


def draw_remains(slide, table, cooled, wheel, axis):
    """Depths of flattening, austenite and martensite."""
    for name, label, color in (
        ("ac1_depth", "steel above Ac1", ORANGE), ("martensite_depth", "martensite", BLUE), ("flattening", "flattening", GREY),
    ):  # fmt: skip
        values = slide.column(table, f"damage.{name}")
        if values is not None:
            axis.plot(slide.column(table, "time"), values * 1e3, color=color, label=label)
    depth = depth_of(cooled["z"], cooled["peak"], wheel.get("thermal.austenitisation"))
    axis.axhline(depth * 1e3, color=ORANGE, ls=":", label="above Ac1, half-plane")
    axis.set(title="Depth of what is left", ylabel="mm", xlim=(0.0, 6.0), ylim=(-0.05, 2.4))
    axis.legend(loc="upper right")


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
    track = {name: value for name, value in TRACK.items() if name in fmu.variables}
    parameters = {"preset": options.preset, "initial.velocity": options.speed_kmh / 3.6} | track | (changes or {})
    inputs = {"control.rotation": "velocity", "control.translation": "velocity"}
    return Wheel(fmu, parameters, inputs, name="flat")


def run(options):
    """The slide, its flat and their comparison; true if what is left is converged, or that is not looked at."""
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
        worst = 0.0 if options.once else convergence(fmu, options, left(slide, table))
        print(f"\nwritten: {data}, {picture}")
        return worst <= CONVERGED


if __name__ == "__main__":
    try:
        sys.exit(0 if run(arguments()) else 1)
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
