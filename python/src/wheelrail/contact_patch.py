"""Contact patch of a wheel that is pressed on a rail: strips along the rail with their loads, and the rows in which a table has them.

The wheel comes down on the rail, and towards each place of it by the cosine of its angle. Lengths in the patch are those along the head
of the rail, and the gap is normal to it: two places of contact with two angles are one patch.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy

from .contact_geometry import EndOfProfile, Gap, Pose, Side, Track, conicity
from .half_space import Pressed, Tiles

COARSE, FINE = (24, 96), (48, 240)  # tiles along the track and across
FADING = 1e-3  # m of shift within which the rows of a place of contact grow that is about to appear or has vanished
FAINT = 0.1  # pressure between two places of contact over the largest one of the smaller of them
LEAST_ROW = 0.02  # size of rows that wait for it, over that of others
MARGIN = 1.12  # times the approach: gaps up to there are looked at, a second place included


class Strips(NamedTuple):
    """A patch in strips of one width along the track, from the gauge side to the field side of a wheel."""

    edge: np.ndarray  # positions of their sides: lengths along the patch, that at the middle of the load along the wheel's profile from the taping circle, to the field side positive [m]
    line_load: np.ndarray  # loads normal to the surface, per width [N/m]
    peak: np.ndarray  # largest pressures [Pa]
    half_length: np.ndarray  # of half ellipses of pressure with that load and pressure [m]
    angle: np.ndarray  # between the contact and the axle, positive where it rises to the field side [rad]
    radius: np.ndarray  # of the wheel there [m]
    lateral: np.ndarray  # on the wheel from the taping circle [m]
    rail: np.ndarray  # lateral position on the rail from its origin [m]
    gap: np.ndarray  # before loading [m]
    approach: float  # of wheel and rail, downwards [m]

    def mean(self, values: np.ndarray) -> float:
        """Mean of values of the strips by their loads."""
        return float(np.average(values, weights=self.line_load * np.diff(self.edge)))


class Rows(NamedTuple):
    """A patch in few rows, from the gauge side to the field side of a wheel; lengths in metres, angles in radians."""

    position: np.ndarray  # of the middle of each row, as the sides of strips
    half_length: np.ndarray
    load_share: np.ndarray
    width: np.ndarray
    angle: np.ndarray
    radius: np.ndarray
    lateral: np.ndarray


def strips(side: Side, pose: Pose, load: float, modulus: float) -> Strips:
    """Strips of the patch of one wheel under a load [N] normal to the surfaces; `modulus` [Pa] as in `Tiles`."""
    gap = side.gap(pose)
    curvature = max(float(gap.curvature[gap.touch]), 0.1)
    reach = lambda depth: np.array([-1.0, 1.0]) * np.sqrt(2.0 * depth / curvature)
    depth = 3.0 * (load / modulus) ** (2.0 / 3.0) * curvature ** (1.0 / 3.0)  # an ample guess of the approach
    ahead, along, pressed = _pressed(gap, _part(gap, depth), reach(depth), COARSE, load, modulus)
    while pressed.approach * MARGIN > depth:  # on the flange
        depth = 1.5 * pressed.approach * MARGIN
        ahead, along, pressed = _pressed(gap, _part(gap, depth), reach(depth), COARSE, load, modulus)
    rows, columns = (np.flatnonzero(np.any(pressed.pressure > 0.0, axis=axis)) for axis in (1, 0))
    size = ahead[1] - ahead[0]
    part = np.searchsorted(gap.along, along[[columns[0], columns[-1]]] + (along[1] - along[0]) * np.array([-1.0, 1.0]))
    part = max(part[0], 0), min(part[1], len(gap.along) - 1)
    ahead, along, pressed = _pressed(gap, part, ahead[[rows[0], rows[-1]]] + [-size, size], FINE, load, modulus)
    return _strips(side, pose, gap, ahead, along, pressed)


def _part(gap, depth):
    """First and last place where surfaces lie nearer than `depth` [m] in the direction of approach."""
    found = np.flatnonzero(gap.height < depth * np.cos(gap.angle))
    if found[0] == 0 or found[-1] == len(gap.height) - 1:
        raise EndOfProfile("the patch reaches the end of a profile")
    return found[0], found[-1]


def _pressed(gap: Gap, part, ends, count, load, modulus) -> tuple[np.ndarray, np.ndarray, Pressed]:
    """Pressures on tiles over a part of the gap, between two ends along the track; middles of the tiles along the track and the head."""
    begin = np.array([ends[0], gap.along[part[0]]])
    step = (np.array([ends[1], gap.along[part[1]]]) - begin) / count
    ahead, along = (first + size * (np.arange(number) + 0.5) for first, size, number in zip(begin, step, count))
    at = lambda values: np.interp(along, gap.along, values)
    away = ahead[:, None] - at(gap.ahead) + gap.ahead[gap.touch]
    curve = scipy.interpolate.CubicHermiteSpline(gap.along, gap.height, np.gradient(gap.height, gap.along))
    height = curve(along) + 0.5 * at(gap.curvature) * away**2
    return ahead, along, Tiles(count, step, modulus).press(height, np.cos(at(gap.angle)), load)


def _strips(side, pose, gap, ahead, along, pressed):
    """Strips of the pressures on tiles."""
    step = along[1] - along[0]
    at = lambda values, along=along: np.interp(along, gap.along, values)
    sides = np.append(along - 0.5 * step, along[-1] + 0.5 * step)
    wheel, peak = at(gap.wheel), np.max(pressed.pressure, axis=0)
    line_load = (ahead[1] - ahead[0]) * np.sum(pressed.pressure, axis=0)
    half_length = np.divide(2.0 * line_load, np.pi * peak, out=np.zeros(len(peak)), where=peak > 0.0)
    # Of a turned wheel other points touch than those of one section: lengths are those of the patch, from the middle of the load on.
    middle = np.average(along, weights=line_load)
    edge = sides - middle + np.interp(at(gap.wheel, middle), side.u, side.length)
    radius = side.radius - np.interp(wheel, side.u, side.z)
    return Strips(edge, line_load, peak, half_length, at(gap.angle) - pose.roll, radius, wheel, at(gap.rail), at(gap.height), pressed.approach)


def measure(patch: Strips) -> np.ndarray:
    """Sum up to each edge of a measure by which rows are as large as each other: the integral of the squared largest pressure, which is
    that of the load on Hertz's ellipse, and half as much of its changes, so that peaks keep rows of their own."""
    width, square = np.diff(patch.edge), patch.peak**2
    change = np.where(square > 0.0, np.abs(np.gradient(square)), 0.0)
    return np.append(0.0, np.cumsum(square * width / np.sum(square * width) + 0.5 * change / np.sum(change)))


def second_place(patch: Strips) -> int | None:
    """Number of the edge at which a second place of contact begins: behind the strip that bears least of what both sides of it bear."""
    sides = np.minimum(np.maximum.accumulate(patch.peak), np.maximum.accumulate(patch.peak[::-1])[::-1])
    part = np.divide(patch.peak, sides, out=np.ones(len(sides)), where=sides > 0.0)
    return int(np.argmin(part)) if np.min(part) < FAINT else None


def cuts(shifts: np.ndarray, patches: list[Strips], count: int) -> list[np.ndarray]:
    """Limits of `count` rows in the measure of each patch: in one place all are as large as each other. In two places each row has one of
    them, half of the rows each. Beside the shifts with two places rows have sizes as their loads there, those of a place that comes or goes
    next to none, and become equal within `FADING`: they go over from place to place with nearly no load."""
    measures, begins = [measure(patch) for patch in patches], [second_place(patch) for patch in patches]
    two = np.array([begin is not None for begin in begins])
    runs = np.flatnonzero(np.diff(np.concatenate(([0], two.astype(int), [0])))).reshape(-1, 2)
    sizes, gauge = np.ones((len(patches), count)), count // 2
    if len(patches) == 1 and two[0]:  # as many rows as belong to each place
        gauge = int(np.clip(round(count * measures[0][begins[0]] / measures[0][-1]), 1, count - 1))
    of_places = lambda part: np.repeat([part / gauge, (1.0 - part) / (count - gauge)], [gauge, count - gauge])
    for first, last in runs:
        for k in range(first, last):
            sizes[k] = of_places(measures[k][begins[k]] / measures[k][-1])
        for end, beside, step in ((first, first - 1, -1), (last - 1, last, 1)):
            loads = of_places(patches[end].mean(np.arange(len(patches[end].peak)) < begins[end]))
            there = np.maximum(loads / np.max(loads), LEAST_ROW)
            while 0 <= beside < len(patches) and not two[beside]:
                away = min(abs(shifts[beside] - shifts[end]) / FADING, 1.0)
                sizes[beside] = np.minimum(sizes[beside], there + (1.0 - there) * away**2 * (3.0 - 2.0 * away))
                beside += step
    return [whole[-1] * np.append(0.0, np.cumsum(size) / np.sum(size)) for whole, size in zip(measures, sizes)]


def rows(patch: Strips, cuts: np.ndarray) -> Rows:
    """The patch in rows between limits of its measure, see `cuts`. Loads, areas, and by the loads the means of angle and radius are those
    of the patch."""
    width, sums = np.diff(patch.edge), measure(patch)
    # Widths of strips in rows, and middles of these parts: strips are cut in proportion to their measure.
    low, high = np.maximum(sums[:-1], cuts[:-1, None]), np.minimum(sums[1:], cuts[1:, None])
    scale = np.divide(width, np.diff(sums), out=np.zeros(len(width)), where=patch.peak > 0.0)
    part, middle = np.maximum(high - low, 0.0) * scale, patch.edge[:-1] + (0.5 * (low + high) - sums[:-1]) * scale
    wide, load = np.sum(part, axis=1), part @ patch.line_load
    by_load = lambda values: part @ (patch.line_load * values) / load
    position, half_length = np.sum(part * middle, axis=1) / wide, part @ patch.half_length / wide
    return Rows(position, half_length, load / np.sum(load), wide, by_load(patch.angle), by_load(patch.radius), by_load(patch.lateral))


class Over(NamedTuple):
    """Patches of the right wheel over the shift."""

    shifts: np.ndarray  # m
    patches: list[Strips]
    rigid: np.ndarray  # radius of the wheel where rigid bodies touch, with roll [m]

    @property
    def radius(self) -> np.ndarray:
        """Radius at the centre of load [m]."""
        return np.array([patch.mean(patch.radius) for patch in self.patches])

    def rows(self, count: int) -> list[Rows]:
        """All patches in `count` rows, which move smoothly with the shift where the contact does."""
        return [rows(patch, limits) for patch, limits in zip(self.patches, cuts(self.shifts, self.patches, count))]


def over(track: Track, shifts: np.ndarray, load: float, modulus: float, tell: Callable[[float], None] | None = None) -> Over:
    """Patches at shifts [m] under a load [N], `modulus` [Pa] as in `half_space.Tiles`; `tell` is called after each."""
    patches, rigid = [], []
    for shift in shifts:
        try:
            pose = track.pose(shift)
            patches.append(strips(track.side, pose, load, modulus))
        except EndOfProfile as error:
            raise EndOfProfile(f"at {1e3 * shift:g} mm {error}") from None
        rigid.append(track.side.lowest(pose)[1])
        if tell:
            tell(shift)
    return Over(np.asarray(shifts), patches, np.array(rigid))


def conicities(found: Over, track: Track, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Equivalent conicities [1] at amplitudes [m] of rigid wheels without roll (EN 15302), and of the centres of load."""
    side, end = track.side, min(-found.shifts[0], found.shifts[-1])
    y = np.linspace(-end - 2e-3, end + 2e-3, 401)
    rigid = conicity(y, track.rigid_difference(y), amplitudes, side.radius, side.half_spacing)
    shifts = found.shifts[np.abs(found.shifts) <= end + 1e-9]
    radius = np.interp(shifts, found.shifts, found.radius) - np.interp(-shifts, found.shifts, found.radius)
    return rigid, conicity(shifts, radius, amplitudes, side.radius, side.half_spacing)
