"""Wheel S1002 and rail 60E1 (UIC60) by their definitions, in millimetres: positions to the field side, heights upwards.

    .venv/bin/python fmpy_tests/standard_profiles.py

writes them as the files of `examples/profiles`, in the format of SIMPACK.
"""

from pathlib import Path

import numpy as np

FOLDER = Path(__file__).resolve().parent.parent / "examples/profiles"
# EN 13715 (UIC 510-2): sections by position, from the flange on, with heights of the wheel's surface, downwards positive where it lies
# farther from the axle. Polynomials by ascending powers.
TREAD = (0.0, -3.358537058e-2, 1.565681624e-3, -2.810427944e-5, 5.844240864e-8, -1.562379023e-8, 5.309217349e-15, -5.957839843e-12, 2.646656573e-13)
ROOT = (-4.320221063e3, -1.038384026e3, -1.065501873e2, -6.051367875, -2.054332446e-1, -4.169739389e-3, -4.687195829e-5, -2.252755540e-7)
SECTIONS = (
    (-70.0, lambda s: 9.519259302 + np.sqrt(20.5**2 - (s + 49.5) ** 2)),
    (-62.764705882, lambda s: 16.0 + np.sqrt(12.0**2 - (s + 55.0) ** 2)),
    (-49.662510381, lambda s: 8.834924130 + np.sqrt(20.0**2 - (s + 58.558326413) ** 2)),
    (-39.764473993, lambda s: -93.576667419 - 2.747477419 * s),
    (-38.426669071, lambda s: 16.446 - np.sqrt(13.0**2 - (s + 26.210665) ** 2)),
    (-35.0, lambda s: np.polyval(ROOT[::-1], s)),
    (-26.0, lambda s: np.polyval(TREAD[::-1], s)),
    (32.15796, lambda s: 1.364323640 - 6.666666667e-2 * s),
)
# EN 13674-1: radii of the head from its middle on, and where they end; then a side of 1:20.
ARCS, SIDE, LOWEST = ((300.0, 10.228), (80.0, 26.0265), (13.0, 36.0)), 1.0 / 20.0, -36.0


def s1002(step=0.5):
    """Points of the wheel, from the back of the flange to the field side."""
    s = np.unique(np.round(np.append(np.arange(-70.0, 60.01, step), np.arange(-50.0, -30.0, 0.25)), 6))
    k = np.searchsorted([begin for begin, _ in SECTIONS], s, side="right") - 1
    return np.stack([s, [-SECTIONS[i][1](u) for i, u in zip(k, s)]], axis=1)


def rail_60e1(step=0.004):
    """Points of the upright rail, along its head in steps of an angle [rad] or fractions of it."""
    points, angle, x, z = [], 0.0, 0.0, 0.0
    for radius, end in ARCS:
        centre = x - radius * np.sin(angle), z - radius * np.cos(angle)
        last = np.arctan(1.0 / SIDE) if radius == ARCS[-1][0] else np.arcsin((end - centre[0]) / radius)
        turn = np.linspace(angle, last, int(np.ceil((last - angle) * max(1.0, radius / 40.0) / (step * 5.0))) + 2)
        points += list(zip(centre[0] + radius * np.sin(turn), centre[1] + radius * np.cos(turn)))[:-1]
        angle, x, z = last, centre[0] + radius * np.sin(last), centre[1] + radius * np.cos(last)
    points += [(x + SIDE * (z - down), down) for down in np.linspace(z, LOWEST, 30)]
    right = np.array(points)
    return np.concatenate([right[:0:-1] * [-1.0, 1.0], right])


def written(points, about):
    """A file of SIMPACK, whose heights are downwards."""
    body = "\n".join(f"{u:11.6f} {-z + 0.0:11.6f}" for u, z in points)
    return f"! {about}\nspline.begin\n  units.len.f = 1000\n  mirror.y = 0\n  mirror.z = 0\n  point.begin\n{body}\n  point.end\nspline.end\n"


FILES = {
    "s1002.prw": lambda: written(s1002(), "Wheel S1002 by its definition (EN 13715), y to the field side, z downwards, mm"),
    "60e1.prr": lambda: written(rail_60e1(), "Rail 60E1 by its definition (EN 13674-1), upright, y to the field side, z downwards, mm"),
}

if __name__ == "__main__":
    for name, text in FILES.items():
        (FOLDER / name).write_text(text())
