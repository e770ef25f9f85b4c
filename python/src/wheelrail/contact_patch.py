"""Contact patch of a wheel that is pressed on a rail: strips along the rail with their loads, and the rows in which the table has them.

The wheel comes down on the rail, and each place of it by the cosine of its angle towards the surface. Lengths in the patch are those
along the head of the rail, and the gap is measured normal to it: two places of contact with two angles are one patch.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .contact_geometry import Gap, Pose, Side
from .half_space import Tiles
from .smooth import between

COARSE, FINE = (24, 96), (49, 160)  # tiles along the track and across
MARGIN = 1.12  # times the approach: gaps up to there are looked at, a second place included


class Strips(NamedTuple):
    """A patch in strips of one width along the track, from the gauge side to the field side."""

    edge: np.ndarray  # positions of their sides: lengths along the wheel's profile from the taping circle, to the field side positive [m]
    line_load: np.ndarray  # loads, normal to the surface, per width [N/m]
    peak: np.ndarray  # largest pressures [Pa]
    angle: np.ndarray  # of the contact, positive where it rises to the field side [rad]
    radius: np.ndarray  # of the wheel there [m]
    lateral: np.ndarray  # lateral positions on the wheel from the taping circle [m]
    rail: np.ndarray  # lateral positions on the rail from its origin [m]
    gap: np.ndarray  # before loading [m]
    approach: float  # of wheel and rail, downwards [m]

    def mean(self, values: np.ndarray) -> float:
        """Mean of values of the strips by their loads."""
        return float(np.average(values, weights=self.line_load * np.diff(self.edge)))


class Rows(NamedTuple):
    """A patch in few rows, from the gauge side to the field side."""

    position: np.ndarray  # m, of the middle of each: length along the wheel's profile from the taping circle
    half_length: np.ndarray  # m, of the half ellipse of pressure with the row's load and pressure
    load_share: np.ndarray  # 1
    width: np.ndarray  # m
    angle: np.ndarray  # rad
    radius: np.ndarray  # m
    lateral: np.ndarray  # m


def strips(side: Side, pose: Pose, load: float, modulus: float) -> Strips:
    """Strips of the patch of one wheel under a load [N] normal to the surfaces; `modulus` [Pa] as in `Tiles`."""
    gap = side.gap(pose)
    lean = np.cos(gap.angle)
    lead = float(gap.curvature[gap.touch])
    depth = 3.0 * (load / modulus) ** (2.0 / 3.0) * max(lead, 1.0) ** (1.0 / 3.0)  # an ample guess of the approach
    part = _within(gap.height < depth * lean)
    half = np.sqrt(2.0 * depth / lead)
    first = _pressed(gap, part, (-half, half), COARSE, load, modulus)
    while first.approach * MARGIN > depth:  # a gap that is nearly even
        depth = 1.5 * first.approach * MARGIN
        part, half = _within(gap.height < depth * lean), np.sqrt(2.0 * depth / lead)
        first = _pressed(gap, part, (-half, half), COARSE, load, modulus)
    part = _within(gap.height < MARGIN * first.approach * lean)
    loaded = first.pressure > 0.0
    across = np.flatnonzero(np.any(loaded, axis=0))
    ends = np.interp([first.along[max(across[0] - 1, 0)], first.along[min(across[-1] + 1, len(first.along) - 1)]], gap.along[part], part)
    part = np.arange(int(ends[0]), int(ends[1]) + 1)
    rows = np.flatnonzero(np.any(loaded, axis=1))
    size = first.ahead[1] - first.ahead[0]
    return _strips(side, gap, _pressed(gap, part, (first.ahead[rows[0]] - size, first.ahead[rows[-1]] + size), FINE, load, modulus))


class _Solved(NamedTuple):
    """Pressures on tiles."""

    pressure: np.ndarray
    approach: float
    ahead: np.ndarray  # middles of the tiles along the track, from where the wheel touches [m]
    along: np.ndarray  # and along the head of the rail [m]
    step: tuple


def _within(inside):
    """Numbers from the first true one to the last."""
    found = np.flatnonzero(inside)
    return np.arange(found[0], found[-1] + 1)


def _pressed(gap, part, ends, count, load, modulus):
    """Pressures on tiles over a part of the gap, between two ends along the track."""
    begin, end = gap.along[part[0]], gap.along[part[-1]]
    step = (ends[1] - ends[0]) / count[0], (end - begin) / count[1]
    ahead = ends[0] + step[0] * (np.arange(count[0]) + 0.5)
    along = begin + step[1] * (np.arange(count[1]) + 0.5)
    at = lambda values: np.interp(along, gap.along, values)
    away = ahead[:, None] - (at(gap.ahead) - gap.ahead[gap.touch])
    pressed = Tiles(count, step, modulus).press(between(along, gap.along, gap.height) + 0.5 * at(gap.curvature) * away**2, np.cos(at(gap.angle)), load)
    return _Solved(pressed.pressure, pressed.approach, ahead, along, step)


def _strips(side, gap, solved):
    """Strips of a patch on tiles."""
    at = lambda values, along=solved.along: np.interp(along, gap.along, values)
    sides = np.concatenate([solved.along - 0.5 * solved.step[1], solved.along[-1:] + 0.5 * solved.step[1]])
    wheel = at(gap.wheel)
    return Strips(
        edge=np.interp(at(gap.wheel, sides), side.u, side.length),
        line_load=solved.step[0] * np.sum(solved.pressure, axis=0),
        peak=np.max(solved.pressure, axis=0),
        angle=at(gap.angle),
        radius=side.radius - np.interp(wheel, side.u, side.z),
        lateral=wheel,
        rail=at(gap.rail),
        gap=at(gap.height),
        approach=solved.approach,
    )


def rows(patch: Strips, count: int) -> Rows:
    """The patch in `count` rows. Each has the same part of the integral of the root of the load per width, so that rows move smoothly
    with the patch, are wider where it carries less, and go over one by one from a place of contact that fades to another one that grows.
    A row on its way has a part of both, and its middle between them."""
    width = np.diff(patch.edge)
    measure = np.concatenate([[0.0], np.cumsum(np.sqrt(patch.line_load) * width)])
    cuts = np.linspace(0.0, measure[-1], count + 1)
    # Overlaps of rows with strips, as widths: a strip is cut in proportion to the measure in it.
    low, high = np.maximum(measure[:-1], cuts[:-1, None]), np.minimum(measure[1:], cuts[1:, None])
    share = np.maximum(high - low, 0.0) / np.where(np.diff(measure) > 0.0, np.diff(measure), np.inf)
    parts = share * width
    total = np.sum(parts, axis=1)
    before = (np.maximum(low - measure[:-1], 0.0) + np.maximum(high - measure[:-1], 0.0)) / np.where(np.diff(measure) > 0.0, np.diff(measure), np.inf)
    middle = patch.edge[:-1] + 0.5 * np.where(share > 0.0, before, 0.0) * width
    loads = parts * patch.line_load
    load = np.sum(loads, axis=1)
    by_load = lambda values: np.sum(loads * values, axis=1) / load
    line_load = load / total
    # A half ellipse of the line load P and the pressure p has the half-length 2 P/(pi p); pressures of a row count by its loads.
    half_length = 2.0 * line_load / (np.pi * np.sum(parts * patch.peak, axis=1) / total)
    position = np.sum(parts * middle, axis=1) / total
    return Rows(position, half_length, load / np.sum(load), total, by_load(patch.angle), by_load(patch.radius), by_load(patch.lateral))
