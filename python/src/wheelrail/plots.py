"""Pictures of stops and of parameter studies."""

import numpy as np

from .brake import Valve
from .report import CELSIUS, axles_of, column, slide

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7")
GREY = "#777777"


def pyplot():
    """matplotlib without a window, in the style of this project: for pictures of up to 8 inch, which pages show 800 px wide, type
    of 8 pt is 11 px high."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"font.size": 9, "axes.titlesize": 10, "legend.fontsize": 8.5, "axes.titlelocation": "left"})
    plt.rcParams.update({"axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False, "axes.spines.right": False})
    plt.rcParams.update({"legend.frameon": False, "lines.linewidth": 1.3, "savefig.dpi": 150})
    plt.rcParams["axes.prop_cycle"] = matplotlib.cycler(color=COLOURS)
    return plt


def save(path, figure):
    """Writes a picture in 256 colours, which take a third of the room, and closes it."""
    import matplotlib.pyplot as plt
    from PIL import Image

    figure.savefig(path)
    plt.close(figure)
    with Image.open(path) as image:
        image.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(path, optimize=True, dpi=image.info["dpi"])


def draw_stops(path, stops):
    """Draws stops side by side, one a column: `stops` is name to (table, rail map)."""
    plt = pyplot()
    rows = (_speeds, _slides, _brakes, _adhesion, _temperatures, _rail)
    figure, axes = plt.subplots(
        len(rows), len(stops), figsize=(4.6 * len(stops), 2.1 * len(rows)), layout="constrained", squeeze=False
    )
    for k, (name, (table, rail)) in enumerate(stops.items()):
        for draw, axis in zip(rows, axes[:, k]):
            draw(axis, table, rail)
        axes[0, k].set_title(name)
    for row in axes:
        low, high = min(a.get_ylim()[0] for a in row), max(a.get_ylim()[1] for a in row)
        for axis in row:
            axis.set_ylim(low, high)
    axes[0, 0].legend(fontsize=7)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def _speeds(axis, table, _rail):
    """Speed of travel and of the four treads."""
    time = column(table, "time")
    for k in axles_of(table):
        axis.plot(time, 3.6 * column(table, "peripheral", k), color=COLOURS[k % len(COLOURS)], label=f"axle {k + 1}" if k < len(COLOURS) else None, linewidth=0.7)
    axis.plot(time, 3.6 * column(table, "speed"), color="black", label="coach")
    axis.set(ylabel="speed [km/h]", xlabel="time [s]")


def _slides(axis, table, _rail):
    """Slide of every axle."""
    for k in axles_of(table):
        axis.plot(column(table, "time"), 100.0 * slide(table, k)[0], color=COLOURS[k % len(COLOURS)], linewidth=0.7)
    axis.set(ylabel="slide [%]", xlabel="time [s]")


def _brakes(axis, table, _rail):
    """Cylinder pressures; venting is marked."""
    time = column(table, "time")
    axis.plot(time, column(table, "control_pressure") / 1e5, ":", color=GREY)
    for k in axles_of(table):
        pressure = column(table, "pressure", k) / 1e5
        venting = column(table, "valve", k) == Valve.VENT.value
        axis.plot(time, pressure, color=COLOURS[k % len(COLOURS)], linewidth=0.7)
        axis.plot(time[venting], pressure[venting], ".", color=COLOURS[k % len(COLOURS)], markersize=1.5)
    axis.set(ylabel="pressure [bar]", xlabel="time [s]")


def _adhesion(axis, table, _rail):
    """Adhesion used by every axle."""
    for k in axles_of(table):
        used = -column(table, "force", k) / column(table, "load", k)
        axis.plot(column(table, "time"), used, color=COLOURS[k % len(COLOURS)], linewidth=0.7)
    axis.set(ylabel="adhesion used [1]", xlabel="time [s]")


def _temperatures(axis, table, _rail):
    """Hottest point of the contact."""
    for k in axles_of(table):
        hottest = column(table, "hottest", k)
        if np.any(hottest > 0.0):
            axis.plot(column(table, "time"), hottest - CELSIUS, color=COLOURS[k % len(COLOURS)], linewidth=0.7)
    axis.set(ylabel="contact [°C]", xlabel="time [s]")


def _rail(axis, table, rail):
    """Friction that each axle met along the track, and what another one would."""
    place = rail.centres()
    axles = len(axles_of(table))
    for axle in range(axles + 1):
        energy = rail.energy[:axle].sum(axis=0) / rail.cell
        sand = rail.sand[: axle + 1].sum(axis=0) / rail.cell
        met = rail.law.friction(rail.degraded, rail.recovered, energy, sand)
        colour = COLOURS[axle % len(COLOURS)] if axle < axles else "black"
        axis.plot(place, met, color=colour, linewidth=0.8, linestyle="-" if axle < axles else ":")
    used = np.flatnonzero(rail.energy[0])
    axis.set(ylabel="friction met [1]", xlabel="position [m]", xlim=(0, place[used[-1]] if len(used) else place[-1]))


def draw_sweep(path, rows):
    """Draws stopping distances over speed and adhesion, one map for every payload and threshold. Colours say by how much a stop is
    longer than the shortest one from its speed with its payload: over speed itself distances differ too much."""
    plt = pyplot()
    axis_of = lambda key: sorted({row[key] for row in rows})
    speeds, adhesions, payloads, thresholds = map(axis_of, ("speed", "adhesion", "payload", "slide_high"))
    figure, axes = plt.subplots(
        len(payloads), len(thresholds), figsize=(3.4 * len(thresholds) + 1.2, 2.8 * len(payloads)),
        layout="constrained", squeeze=False,
    )  # fmt: skip
    distances = {tuple(row[k] for k in ("payload", "slide_high", "adhesion", "speed")): row["stopping distance"] for row in rows}
    shortest = {}
    for (payload, _, _, speed), distance in distances.items():
        shortest[payload, speed] = min(distance, shortest.get((payload, speed), distance))
    longer = lambda payload, speed, distance: 100.0 * (distance / shortest.get((payload, speed), np.nan) - 1.0)
    most = max(longer(key[0], key[3], distance) for key, distance in distances.items())
    for i, payload in enumerate(payloads):
        for j, threshold in enumerate(thresholds):
            axis = axes[i, j]
            table = [[distances.get((payload, threshold, a, v), np.nan) for v in speeds] for a in adhesions]
            share = [[longer(payload, v, value) for v, value in zip(speeds, row)] for row in table]
            image = axis.imshow(share, origin="lower", aspect="auto", cmap="viridis", vmin=0.0, vmax=max(most, 1.0))
            for (y, x), value in np.ndenumerate(np.array(table)):
                text = f"{value:.0f}" if np.isfinite(value) else "none"
                bright = share[y][x] > 0.6 * most
                axis.text(x, y, text, ha="center", va="center", color="black" if bright else "white", fontsize=8)
            axis.grid(False)
            axis.set_xticks(range(len(speeds)), [f"{3.6 * v:.0f}" for v in speeds])
            axis.set_yticks(range(len(adhesions)), [f"{a:g}" for a in adhesions])
            axis.set(title=f"{payload / 1e3:g} t, slide {100 * threshold:g} %", xlabel="speed [km/h]", ylabel="adhesion [1]")
    figure.suptitle("stopping distance [m]", fontsize=9)
    figure.colorbar(image, ax=axes, label="longer than the shortest from this speed with this load [%]")
    figure.savefig(path, dpi=110)
    plt.close(figure)
