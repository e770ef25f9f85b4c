"""Picture of a sweep of any keys: one key as a curve, two as a map, more as panels of maps."""

import math
from itertools import product

import numpy as np

from .plots import COLOURS, WIDTH, save, subplots
from .scenario import field_of
from .sweep_table import DRY, EXTENSION, cell
from .sweep_table import shown as readable

DISTANCE = "stopping distance"
FIRST = ("speed", "adhesion")  # along the axes of a map, if they are swept
MOST_PANELS, MOST_NUMBERS = 30, 12  # panels of a picture; columns of a map with numbers in it
LONGEST = 24  # letters of a label in one line
NAMES = {"slide_high": "slide threshold", "brake.wsp.slide_high": "slide threshold"}


def draw_sweep(path, rows, keys, title):
    """Draws stopping distances; colours say by how much a stop is longer than the dry one. Returns why there is no picture, if
    there is none."""
    values = {key: _values(rows, key) for key in keys}
    rank = lambda key: (*(key != name for name in FIRST), keys.index(key))
    varied = sorted((key for key in keys if len(values[key]) > 1), key=rank)
    if not varied:
        return f"one stop only, {rows[0][DISTANCE]:.1f} m; a list in sweep with two values or more of a key gives a curve"
    panels = math.prod(len(values[key]) for key in varied[2:])
    if panels > MOST_PANELS:
        return f"{len(varied)} keys would make {panels} panels, more than {MOST_PANELS}; sweep.csv has all rows"
    figure = _curve(rows, varied[0], values) if len(varied) == 1 else _maps(rows, varied, values)
    fixed = [f"{label(key)} {shown(key, values[key][0])}" for key in keys if key not in varied]
    figure.suptitle(title + (f" ({', '.join(fixed)})" if fixed else ""), fontsize=11)
    save(path, figure)
    return None


def _values(rows, key):
    """Values of a key: numbers in order, others as they come."""
    found = list({cell(row[key]): row[key] for row in rows}.values())
    return sorted(found) if all(isinstance(value, int | float) for value in found) else found


def label(key):
    """Name and unit of a key, for an axis."""
    if key == "speed":
        return "speed [km/h]"
    unit = getattr(field_of(key), "unit", "")
    return _broken(NAMES.get(key, key)) + (f" [{unit}]" if unit else "")


def _broken(key):
    """A long dotted path in two lines."""
    dots = [k for k, sign in enumerate(key) if sign == "."]
    if len(key) <= LONGEST or not dots:
        return key
    middle = min(dots, key=lambda k: abs(k - len(key) / 2)) + 1
    return f"{key[:middle]}\n{key[middle:]}"


def shown(key, value):
    """A value of a key, for an axis."""
    if key == "speed":
        return f"{3.6 * value:.0f}"
    return readable(value)


def _curve(rows, key, values):
    """Distance, and that of the dry stop, over one key; values that are no numbers side by side."""
    figure, axis = subplots(figsize=(WIDTH, 4.2))
    of = {cell(row[key]): row for row in rows}
    found = [of[cell(value)] for value in values[key]]
    place = range(len(found))
    if _numbers(values[key]):
        place = np.array(values[key], float) * (3.6 if key == "speed" else 1.0)
    for name, colour, style in ((DISTANCE, COLOURS[0], "o-"), (DRY, COLOURS[1], "s--")):
        if any(math.isfinite(row[name]) for row in found):
            axis.plot(place, [row[name] for row in found], style, color=colour, label="dry" if name == DRY else "stop")
    for x, row in zip(place, found):
        if math.isfinite(row[EXTENSION]):
            axis.annotate(f"{row[EXTENSION]:+.0f} %", (x, row[DISTANCE]), (0, 7), textcoords="offset points", ha="center")
    if not _numbers(values[key]):
        axis.set_xticks(range(len(found)), [shown(key, value) for value in values[key]])
    axis.margins(x=0.08, y=0.15)
    axis.set(xlabel=label(key), ylabel="stopping distance [m]")
    axis.legend()
    return figure


def _numbers(values):
    return all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)


def _maps(rows, varied, values):
    """Maps over the first two keys, one for every combination of the others: the third in columns, the rest in rows."""
    x, y, *others = varied
    across, down = others[:1], others[1:]
    columns, lines = ([dict(zip(keys, point)) for point in product(*(values[key] for key in keys))] for keys in (across, down))
    figure, axes = subplots(
        len(lines), len(columns), figsize=(WIDTH, 0.8 + len(lines) * (0.9 + 0.5 * min(len(values[y]), 12))), squeeze=False,
    )  # fmt: skip
    of = {tuple(cell(row[key]) for key in varied): row for row in rows}
    known = [row[EXTENSION] for row in rows if math.isfinite(row[EXTENSION])]
    shade = EXTENSION if known else DISTANCE
    least, most = (min(0.0, *known), max(1.0, *known)) if known else (0.0, max(row[DISTANCE] for row in rows))
    for (i, line), (j, column) in product(enumerate(lines), enumerate(columns)):
        fixed, axis = column | line, axes[i, j]
        find = lambda a, b: of.get(tuple(cell((fixed | {x: a, y: b})[key]) for key in varied), {})
        table = np.array([[find(a, b).get(DISTANCE, np.nan) for a in values[x]] for b in values[y]])
        colours = np.array([[find(a, b).get(shade, np.nan) for a in values[x]] for b in values[y]])
        image = axis.imshow(colours, origin="lower", aspect="auto", cmap="viridis", vmin=least, vmax=most)
        _numbers_in(axis, table, colours, least + 0.6 * (most - least))
        axis.grid(False)
        axis.set_xticks(range(len(values[x])), [shown(x, value) for value in values[x]])
        axis.set_yticks(range(len(values[y])), [shown(y, value) for value in values[y]])
        axis.set_title("\n".join(f"{label(key)}: {shown(key, value)}" for key, value in fixed.items()), fontsize=9)
        axis.set(xlabel=label(x) if i == len(lines) - 1 else "", ylabel=label(y) if j == 0 else "")
    words = "longer than dry [%]" if known else "stopping distance [m]"
    figure.colorbar(image, ax=axes, label=f"numbers: stopping distance [m]\ncolours: {words}")
    return figure


def _numbers_in(axis, table, colours, bright):
    """Writes values into a map, if they are legible."""
    if table.shape[1] > MOST_NUMBERS:
        return
    for (y, x), value in np.ndenumerate(table):
        text = f"{value:.0f}" if np.isfinite(value) else "none"
        dark = not np.isfinite(colours[y, x]) or colours[y, x] > bright
        axis.text(x, y, text, ha="center", va="center", color="black" if dark else "white", fontsize=8)
