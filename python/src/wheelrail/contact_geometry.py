"""Where wheels touch rails: gaps, radii and angles of a wheelset on a track, and its equivalent conicity.

Lateral positions `u` are positive to the field side of a wheel, heights upwards; metres and radians. A wheelset has a `Pose` towards the
field side of the wheel that is meant: the right wheel of a wheelset that is shifted to the right by `y`, rolled so that this wheel
rises by `roll`, and turned by `yaw` (its right wheel backwards) has the pose (y, roll, yaw), the left one (-y, -roll, -yaw).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from .profile_files import Profile
from .smooth import Spline

STEP = 2e-5  # m, between places of a profile
BELOW_TOP = 0.014  # m, at which the gauge is measured (EN 13848-1)
CLOSE = 1e-9  # m, and share of an energy: motions that just fit
REACH = 0.045  # m, to either side of the place of contact, in which the gap is looked at


class EndOfProfile(ValueError):
    """A wheel beside its rail, or a patch that reaches over the end of a profile."""


class Pose(NamedTuple):
    """Place of a wheelset on the track, seen from one wheel."""

    shift: float = 0.0  # m, to the field side
    roll: float = 0.0  # rad, the wheel rises
    yaw: float = 0.0  # rad


class Gap(NamedTuple):
    """What lies between a wheel that touches a rail in one point and that rail, at places along the rail's head."""

    along: np.ndarray  # length of the head up to there [m]
    height: np.ndarray  # of the wheel above the rail, normal to it [m]
    ahead: np.ndarray  # where the wheel comes nearest, along the track [m]
    curvature: np.ndarray  # of the wheel there along the track [1/m]
    angle: np.ndarray  # of the rail, positive where it rises to the field side [rad]
    rail: np.ndarray  # lateral position on the rail from its origin [m]
    wheel: np.ndarray  # lateral position on the wheel from its taping circle [m]
    touch: int  # number of the place that touches


class Side:
    """One wheel over its rail. `half_spacing` [m] is the distance of the taping circle from the middle of the wheelset, `place` [m] that
    of the rail's origin from the middle of the track."""

    def __init__(self, wheel: Profile, rail: Profile, radius: float, half_spacing: float, place: float) -> None:
        self.radius, self.half_spacing, self.place = radius, half_spacing, place
        tip = int(np.argmin(wheel.z))
        self.u = np.arange(wheel.u[tip] + STEP, wheel.u[-1], STEP)
        self.z, self.slope = Spline(wheel.u, wheel.z).at(self.u)
        self.bend = np.gradient(self.slope, STEP) / (1.0 + self.slope**2) ** 1.5
        self.length = _length(self.u, self.z)
        self.length -= np.interp(0.0, self.u, self.length)
        spline, fine = Spline(rail.u, rail.z), np.arange(rail.u[0] + STEP, rail.u[-1], STEP)
        along = _length(fine, spline.at(fine)[0])
        self.along = np.arange(0.0, along[-1], STEP)
        self.rail = np.interp(self.along, along, fine)
        self.rail_z, slope = spline.at(self.rail)
        self.angle = np.arctan(slope)

    def locus(self, pose: Pose) -> tuple[np.ndarray, ...]:
        """Points of the wheel that can touch a straight rail, where its surface is parallel to the track: places along the track,
        lateral positions on the rail, heights over the rail's top, and curvatures along the track; numbers of the points."""
        sine, cosine = np.sin(pose.yaw), np.cos(pose.yaw)
        axle = np.array([-np.cos(pose.roll) * sine, np.cos(pose.roll) * cosine, np.sin(pose.roll)])
        across = np.hypot(axle[1], axle[2])
        ahead = (np.array([1.0, 0.0, 0.0]) - axle[0] * axle) / across
        down = np.cross(axle, ahead)
        down *= -np.sign(down[2])
        radius = self.radius - self.z
        turn = -self.slope * axle[0] / across  # sine of the angle of the wheel at which the point lies before or behind the lowest one
        use = np.flatnonzero(np.abs(turn) < 0.99)
        turn = turn[use, None]
        spoke = turn * ahead + np.sqrt(1.0 - turn**2) * down
        point = (self.half_spacing + self.u[use, None]) * axle + radius[use, None] * spoke
        # Euler: curvatures around the axle and along the profile, by the direction of the track between the two.
        share = np.cross(axle, spoke)[:, 0] ** 2
        curvature = share * np.cos(np.arctan(self.slope[use])) / radius[use] + (1.0 - share) * self.bend[use]
        return point[:, 0], point[:, 1] + pose.shift - self.place, point[:, 2] + self.radius, curvature, use

    def over(self, pose: Pose) -> tuple[float, int, tuple[np.ndarray, ...]]:
        """Least height of the wheel over the rail [m], the number of its point, and the locus above the rail."""
        locus = self.locus(pose)
        above = np.flatnonzero((locus[1] > self.rail[0]) & (locus[1] < self.rail[-1]))
        if not len(above):
            raise EndOfProfile("the wheel lies beside the rail")
        locus = tuple(values[above] for values in locus)
        height = locus[2] - np.interp(locus[1], self.rail, self.rail_z)
        least = int(np.argmin(height))
        return float(height[least]), least, locus

    def lowest(self, pose: Pose) -> tuple[float, float]:
        """Least height of the wheel over the rail, and its radius there [m]."""
        height, least, locus = self.over(pose)
        return height, self.radius - float(self.z[locus[4][least]])

    def gap(self, pose: Pose) -> Gap:
        """The gap of the wheel that is lowered until it touches."""
        lowest, least, locus = self.over(pose)
        touch, rising = locus[1][least], np.flatnonzero(locus[1] > np.maximum.accumulate(np.append(-1.0, locus[1][:-1])))
        ahead, u, z, curvature, use = (values[rising] for values in locus)
        z = z - lowest
        near = np.flatnonzero((self.rail > u[0]) & (self.rail < u[-1]))
        near = near[np.abs(self.along[near] - np.interp(touch, self.rail, self.along)) < REACH]
        rail, rail_z, angle = self.rail[near], self.rail_z[near], self.angle[near]
        height, at, surface = np.zeros(len(near)), rail, scipy.interpolate.CubicHermiteSpline(u, z, np.gradient(z, u))
        for _ in range(8):  # Newton: the wheel's slope is about that of the rail
            height += np.cos(angle) * (surface(at) - rail_z - height * np.cos(angle))
            at = np.clip(rail - height * np.sin(angle), u[0], u[-1])
        wheel = np.interp(at, u, self.u[use])
        return Gap(self.along[near], height, np.interp(at, u, ahead), np.interp(at, u, curvature), angle, rail, wheel, int(np.argmin(height)))


class Track:
    """A wheelset of two equal wheels on two equal rails; the gauge is that between the rails 14 mm below their tops."""

    def __init__(self, wheel: Profile, rail: Profile, gauge: float = 1.435, radius: float = 0.46, half_spacing: float = 0.75) -> None:
        inside = int(np.argmax(rail.z > -BELOW_TOP))
        near = slice(max(inside - 1, 0), inside + 1)
        face = np.interp(-BELOW_TOP, rail.z[near], rail.u[near])
        self.side = Side(wheel, rail, radius, half_spacing, 0.5 * gauge - float(face))

    def roll(self, shift: float, yaw: float = 0.0) -> float:
        """Roll [rad] of a wheelset that rests on both rails."""
        difference = lambda roll: self.side.lowest(Pose(shift, roll, yaw))[0] - self.side.lowest(Pose(-shift, -roll, -yaw))[0]
        return scipy.optimize.brentq(difference, -0.04, 0.04)

    def pose(self, shift: float, yaw: float = 0.0) -> Pose:
        """Pose, seen from the right wheel, of a wheelset that rests on both rails."""
        return Pose(shift, self.roll(shift, yaw), yaw)

    def rigid_difference(self, shifts: np.ndarray) -> np.ndarray:
        """Radius of the right wheel less that of the left one where rigid bodies touch, without roll [m], as EN 15302 has it."""
        radius = lambda shift: self.side.lowest(Pose(shift))[1]
        return np.array([radius(shift) - radius(-shift) for shift in shifts])


def _length(u, z):
    """Length of a curve up to its points."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(u), np.diff(z)))])


def conicity(
    shifts: np.ndarray, difference: np.ndarray, amplitudes: np.ndarray, radius: float = 0.46, half_spacing: float = 0.75
) -> np.ndarray:
    """Equivalent conicity [1] at amplitudes [m]: of the cone whose wheelset has the wavelength of `y'' + difference(y)/(2 half_spacing radius)
    = 0` (EN 15302). `difference` [m] is that of the radii at ascending shifts [m]. Not a number where a motion does not fit in between."""
    y = np.linspace(shifts[0], shifts[-1], 8001)
    force = np.interp(y, shifts, difference)
    energy = scipy.integrate.cumulative_trapezoid(force, y, initial=0.0)
    bottom = y[np.argmin(energy)]
    turn = np.pi * (np.arange(2000) + 0.5) / 2000
    found = []
    for amplitude in amplitudes:
        rise = lambda first: np.interp(first + 2.0 * amplitude, y, energy) - np.interp(first, y, energy)
        low, high = max(y[0], bottom - 2.0 * amplitude), min(bottom, y[-1] - 2.0 * amplitude)
        if high < low - CLOSE or rise(low) > CLOSE * np.ptp(energy) or rise(high) < -CLOSE * np.ptp(energy):
            found.append(np.nan)
            continue
        for _ in range(60):
            first = 0.5 * (low + high)
            low, high = (first, high) if rise(first) < 0.0 else (low, first)
        passed = first + amplitude * (1.0 - np.cos(turn))  # no singularity at the ends
        slope = np.sqrt(np.maximum(np.interp(first, y, energy) - np.interp(passed, y, energy), 1e-30) / (half_spacing * radius))
        wavelength = 2.0 * np.pi * np.mean(amplitude * np.sin(turn) / slope)
        found.append((2.0 * np.pi / wavelength) ** 2 * half_spacing * radius)
    return np.array(found)
