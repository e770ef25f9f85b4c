"""Picture of contact patches over the lateral shift."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .contact_patch import Over
from .plots import COLOURS, GREY, WIDTH, save, subplots

SHOWN = 3  # patches in detail
HIGHEST = 200.0  # µm, of gaps


def draw(path: Path, found: Over, count: int, amplitudes: np.ndarray, known: tuple | None, title: str) -> None:
    """Gap, patch and pressures at some shifts; angle and radius over the shift; `known` conicities over their amplitudes [m]."""
    figure, axes = subplots(3, 2, figsize=(WIDTH, 7.5))
    _patches(axes[:, 0], found)
    _over_shift(axes[:2, 1], found, found.rows(count))
    for values, label, colour in zip(known or (), ("rigid", "centre of load"), (GREY, COLOURS[0])):
        axes[2, 1].plot(1e3 * amplitudes, values, ".-", label=label, color=colour)
    axes[2, 1].set(xlabel="amplitude [mm]", ylabel="equivalent\nconicity [1]")
    if known:
        axes[2, 1].legend()
    figure.suptitle(title, fontsize=9)
    save(path, figure)


def _patches(axes, found):
    """Gap, half-lengths and largest pressures across the patch at some shifts."""
    for k, colour in zip(sorted({*np.linspace(0, len(found.shifts) - 1, SHOWN).astype(int)}), COLOURS):
        patch, label = found.patches[k], f"{1e3 * found.shifts[k]:g} mm"
        axes[0].plot(1e3 * patch.rail, np.minimum(1e6 * patch.gap, HIGHEST), color=colour, label=label)
        axes[1].fill_between(1e3 * patch.rail, -1e3 * patch.half_length, 1e3 * patch.half_length, color=colour, alpha=0.5, linewidth=0)
        axes[2].plot(1e3 * patch.rail, 1e-6 * patch.peak, color=colour)
    axes[0].set(ylabel="gap unloaded\n[µm]")
    axes[0].legend(title="shift", title_fontsize=8.5)
    axes[1].set(ylabel="patch along\nthe track [mm]")
    axes[2].set(ylabel="largest pressure\n[MPa]", xlabel="lateral on the rail [mm]")


def _over_shift(axes, found, tables):
    """Angle and radius of every row and of the centre of load."""
    shifts, mark = 1e3 * found.shifts, "." if len(found.shifts) == 1 else ""
    for axis, name, scale in ((axes[0], "angle", 1.0), (axes[1], "radius", 1e3)):
        each = np.array([getattr(table, name) for table in tables])
        mean = [patch.mean(getattr(patch, name)) for patch in found.patches]
        axis.plot(shifts, scale * each, color=COLOURS[4], linewidth=0.6, marker=mark)
        axis.plot(shifts, scale * np.array(mean), color=COLOURS[0], marker=mark, label="centre of load")
    axes[1].plot(shifts, 1e3 * found.rigid, color=GREY, marker=mark, label="rigid")
    axes[1].legend()
    axes[0].set(ylabel="angle [rad]")
    axes[1].set(ylabel="radius [mm]", xlabel="shift [mm]")
