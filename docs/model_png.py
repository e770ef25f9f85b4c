"""Draws docs/model.png, the picture of the FMU (wheel, rail and contact patch with pressure and temperature), docs/icon.png,
the same without details, and docs/terminal.png, the mark of a terminal.

    .venv/bin/python docs/model_png.py
"""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Circle, FancyArrowPatch, Rectangle

STEEL, RIM, EDGE, INK = "#c9d1d9", "#aab4be", "#39434d", "#1f2933"


def wheel(axis):
    """Tyre, disc, hub and the arrows of rotation and travel."""
    centre = (0.0, 1.0)
    axis.add_patch(Circle(centre, 1.0, facecolor=RIM, edgecolor=EDGE, linewidth=1.4, zorder=2))
    axis.add_patch(Circle(centre, 0.86, facecolor=STEEL, edgecolor=EDGE, linewidth=0.6, zorder=2))
    axis.add_patch(Circle(centre, 0.16, facecolor=EDGE, edgecolor=EDGE, zorder=3))
    arrow = {"mutation_scale": 14, "color": "#0072B2", "linewidth": 2.2, "zorder": 4}
    turn, travel = ((-0.5, 1.25), (0.5, 1.25)), ((0.16, 1.0), (0.72, 1.0))
    axis.add_patch(FancyArrowPatch(*turn, connectionstyle="arc3,rad=-0.55", arrowstyle="-|>", **arrow))
    axis.add_patch(FancyArrowPatch(*travel, arrowstyle="-|>", **arrow))
    axis.text(0.0, 1.66, r"$\omega$", ha="center", va="center", fontsize=13, color="#0072B2", zorder=5)
    axis.text(0.5, 0.88, "$V$", ha="center", va="center", fontsize=12, color="#0072B2", zorder=5)


def rail(axis):
    """Head, web and foot, seen from the side."""
    for low, high, colour in ((-0.22, 0.0, RIM), (-0.5, -0.22, STEEL), (-0.6, -0.5, RIM)):
        axis.add_patch(Rectangle((-3.0, low), 6.0, high - low, facecolor=colour, edgecolor=EDGE, linewidth=0.8))


def heat(axis):
    """Temperature below and above the patch: rail behind the contact stays warm, so does the tread leaving it."""
    x, y = np.meshgrid(np.linspace(-1.1, 0.25, 500), np.linspace(-0.2, 0.5, 350))
    behind = np.clip(0.12 - x, 1e-3, None)
    strength = 1.0 / (1.0 + np.exp((x - 0.1) / 0.02)) * np.exp(-behind / 0.35)
    surface = np.where(y < 0.0, 0.0, 1.0 - np.sqrt(np.clip(1.0 - x**2, 0.0, 1.0)))
    depth = np.abs(y - surface) / (0.03 + 0.11 * np.sqrt(behind))
    temperature = strength * np.exp(-(depth**2))
    inside = (y <= 0.0) | (y >= surface)
    colours = plt.get_cmap("hot_r")(0.1 + 0.7 * temperature)
    colours[..., 3] = np.where(inside, np.clip(2.5 * temperature, 0.0, 1.0), 0.0)
    axis.imshow(colours, extent=(x.min(), x.max(), y.min(), y.max()), origin="lower", aspect="auto", zorder=3)


def magnifier(axis):
    """The contact patch: Hertzian pressure, shear up to the friction limit, temperature as colour."""
    box = axis.inset_axes([0.655, 0.49, 0.325, 0.46], zorder=6)
    x = np.linspace(-1.0, 1.0, 400)
    pressure = np.sqrt(1.0 - x**2)
    stick = 0.55  # half of the stick zone, at the leading edge
    inner = np.clip(1.0 - ((x - (1.0 - stick)) / stick) ** 2, 0.0, None)
    shear = 0.5 * (pressure - stick * np.sqrt(inner))
    temperature = np.cumsum((shear * (x < 1.0 - 2.0 * stick))[::-1])[::-1]
    colours = plt.get_cmap("hot_r")(0.15 + 0.6 * temperature / temperature.max())
    for left, right, p, colour in zip(x[:-1], x[1:], pressure, colours):
        box.fill_between([left, right], 0.0, [p, p], color=colour, linewidth=0)
    box.plot(x, pressure, color=INK, linewidth=1.6)
    box.plot(x, shear, color="#0072B2", linewidth=1.6)
    box.text(0.62, 0.93, "$p$", fontsize=11, color=INK)
    box.text(-0.1, 0.5, "$q$", fontsize=11, color="#0072B2", ha="center")
    box.axhline(0.0, color=INK, linewidth=0.8)
    box.set(xlim=(-1.25, 1.25), ylim=(-0.12, 1.2), xticks=[], yticks=[])
    box.patch.set(facecolor="white", alpha=0.95)
    for spine in box.spines.values():
        spine.set(color=EDGE, linewidth=1.0)
    patch = Rectangle((-0.13, -0.06), 0.26, 0.12, facecolor="none", edgecolor=EDGE, linewidth=1.0, zorder=5)
    axis.add_patch(patch)
    for start, corner in (((0.13, 0.06), (0.0, 1.0)), ((0.13, -0.06), (0.0, 0.0))):
        end = axis.transData.inverted().transform(box.transAxes.transform(corner))
        axis.plot([start[0], end[0]], [start[1], end[1]], color=EDGE, linewidth=0.7, zorder=5)


def canvas(width, height):
    """A figure of a size [inch] without frame."""
    figure = plt.figure(figsize=(width, height), dpi=100)
    axis = figure.add_axes([0.0, 0.0, 1.0, 1.0])
    axis.set_axis_off()
    return figure, axis


def save(figure, name):
    """Writes a picture beside this file, without a date."""
    figure.savefig(Path(__file__).parent / name, metadata={"Software": None}, transparent=name == "terminal.png")


def main():
    figure, axis = canvas(4.0, 3.0)
    rail(axis)
    wheel(axis)
    heat(axis)
    axis.set(xlim=(-1.1, 2.4), ylim=(-0.6, 2.025))
    magnifier(axis)
    save(figure, "model.png")

    figure, axis = canvas(1.28, 1.28)
    rail(axis)
    wheel(axis)
    axis.set(xlim=(-1.32, 1.32), ylim=(-0.6, 2.04))
    save(figure, "icon.png")

    figure, axis = canvas(0.32, 0.32)
    axis.add_patch(Circle((0.0, 0.0), 0.8, facecolor="#0072B2", edgecolor=EDGE))
    axis.set(xlim=(-1.0, 1.0), ylim=(-1.0, 1.0))
    save(figure, "terminal.png")


if __name__ == "__main__":
    main()
