"""Pictures of stops."""

from io import BytesIO

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from .brake import Valve
from .output import fresh
from .report import axles_of, celsius, column, slide

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9")
GREY = "#777777"


def _usually(method, **usual):
    """A method of matplotlib's with other defaults."""
    return lambda self, *arguments, **named: method(self, *arguments, **usual | named)


class Panel(Axes):
    """Axes in the style of this project."""

    plot, axhline, axvline = (_usually(method, linewidth=1.3) for method in (Axes.plot, Axes.axhline, Axes.axvline))
    text, annotate = (_usually(method, fontsize=9) for method in (Axes.text, Axes.annotate))
    set_title = _usually(Axes.set_title, loc="left", fontsize=10)
    legend = _usually(Axes.legend, frameon=False, fontsize=8.5)

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self.set_prop_cycle(color=COLOURS)
        self.grid(True, alpha=0.3)
        self.spines[["top", "right"]].set_visible(False)
        self.tick_params(labelsize=9)
        for axis in (self.xaxis, self.yaxis):
            axis.label.set_size(9)
            axis.offsetText.set_size(9)


class Picture(Figure):
    """A figure of `Panel`s, of up to 8 inch, which pages show 800 px wide: type of 8 pt is 11 px high. It has no window and no part in
    pyplot, whose backend, style and figures are those of the process."""

    add_subplot, add_axes = (_usually(method, axes_class=Panel) for method in (Figure.add_subplot, Figure.add_axes))
    legend = _usually(Figure.legend, frameon=False, fontsize=8.5)

    def __init__(self, **named):
        super().__init__(layout="constrained", **named)


def subplots(rows=1, columns=1, *, figsize, **named):
    """A picture and its panels."""
    figure = Picture(figsize=figsize)
    return figure, figure.subplots(rows, columns, **named)


def save(path, figure):
    """Writes a picture in 256 colours, which take a third of the room."""
    from PIL import Image

    drawn = BytesIO()
    figure.savefig(drawn, format="png", dpi=150)
    with Image.open(drawn) as image, fresh(path) as new:
        image.convert("RGB").quantize(256, dither=Image.Dither.NONE).save(new, optimize=True, dpi=image.info["dpi"])


WIDTH = 8.0  # inch, shown 800 px wide: 9 points are 12 px there
PLACES = 300  # of a curve along the track


def draw_stops(path, stops, title=""):
    """Draws stops side by side, one a column: `stops` is name to (table, rail map), `title` names the scenario."""
    over_time = (_speeds, _slides, _brakes, _adhesion, _temperatures)
    rows = len(over_time) + 1
    figure, axes = subplots(rows, len(stops), figsize=(WIDTH, 1.45 * rows + 0.5), squeeze=False, sharey="row")
    for k, (name, (table, rail)) in enumerate(stops.items()):
        for draw, axis in zip(over_time, axes[:, k]):
            draw(axis, table)
            axis.sharex(axes[0, k])
            axis.tick_params(labelbottom=draw is over_time[-1])
        axes[len(over_time) - 1, k].set_xlabel("time [s]")
        _rail(axes[-1, k], table, rail)
        axes[0, k].set_title(name, fontsize=10)
    for axis in axes[:, 1:].flat:
        axis.set_ylabel("")
    figure.align_ylabels(axes[:, 0])
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels), fontsize=9, title=title, title_fontsize=11)
    save(path, figure)


def _per_axle(axis, table, values, **style):
    """A thin curve over time for every axle."""
    for k in axles_of(table):
        axis.plot(column(table, "time"), values(k), color=COLOURS[k % len(COLOURS)], linewidth=0.8, **style)


def _speeds(axis, table):
    """Speed of travel and of the treads."""
    time = column(table, "time")
    for k in axles_of(table):
        label = f"axle {k + 1}" if k < len(COLOURS) else None
        axis.plot(time, 3.6 * column(table, "peripheral", k), color=COLOURS[k % len(COLOURS)], label=label, linewidth=0.8)
    axis.plot(time, 3.6 * column(table, "speed"), color="black", label="coach")
    axis.set(ylabel="speed\n[km/h]")


def _slides(axis, table):
    """Slide of every axle."""
    _per_axle(axis, table, lambda k: 100.0 * slide(table, k)[0])
    axis.set(ylabel="slide\n[%]")


def _brakes(axis, table):
    """Cylinder pressures; venting is marked."""
    time = column(table, "time")
    axis.plot(time, column(table, "control_pressure") / 1e5, ":", color=GREY)
    _per_axle(axis, table, lambda k: column(table, "pressure", k) / 1e5)
    for k in axles_of(table):
        venting = column(table, "valve", k) == Valve.VENT.value
        pressure = column(table, "pressure", k)[venting] / 1e5
        axis.plot(time[venting], pressure, ".", color=COLOURS[k % len(COLOURS)], markersize=2)
    axis.set(ylabel="pressure\n[bar]")


def _adhesion(axis, table):
    """Adhesion used by every axle."""
    _per_axle(axis, table, lambda k: -column(table, "force", k) / column(table, "load", k))
    axis.set(ylabel="adhesion\nused [1]")


def _temperatures(axis, table):
    """Hottest point of the contact; rigid wheelsets have none."""
    if any(np.any(column(table, "hottest", k) > 0.0) for k in axles_of(table)):
        _per_axle(axis, table, lambda k: celsius(column(table, "hottest", k)))
    else:
        axis.text(0.5, 0.5, "rigid: not known", ha="center", va="center", transform=axis.transAxes, color=GREY)
    axis.set(ylabel="contact\n[°C]")


def _rail(axis, table, rail):
    """Friction that each axle met along the track, and what another one would, as means of some metres; where sand lay."""
    place, axles = rail.centres(), len(axles_of(table))
    used = np.flatnonzero(rail.energy[0])
    end = used[-1] + 1 if len(used) else len(place)
    first = int(np.searchsorted(place, 0.0))
    size = max((end - first) // PLACES, 1)
    kept = slice(first, first + max((end - first) // size, 1) * size)
    means = lambda values: values[kept].reshape(-1, size).mean(axis=1)
    for axle in range(axles + 1):
        energy = rail.energy[:axle].sum(axis=0) / rail.cell
        sand = rail.sand[: axle + 1].sum(axis=0) / rail.cell
        met = rail.law.friction(rail.degraded, rail.recovered, energy, sand)
        colour = COLOURS[axle % len(COLOURS)] if axle < axles else "black"
        axis.plot(means(place), means(met), color=colour, linewidth=0.9, linestyle="-" if axle < axles else ":")
    sanded = rail.sand.sum(axis=0) > 0.0
    if np.any(sanded):
        axis.fill_between(place, 0.0, 0.04, where=sanded, transform=axis.get_xaxis_transform(), color="#B8860B", linewidth=0)
        axis.text(0.02, 0.08, "sand", ha="left", va="bottom", transform=axis.transAxes, color="#8A6508", fontsize=8)
    axis.set(ylabel="friction\nmet [1]", xlabel="position [m]", xlim=(0, place[end - 1]))
