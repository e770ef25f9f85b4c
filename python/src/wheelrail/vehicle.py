"""Four-axle coaches in the plane as linear equations: body, two bogies, four wheelsets, springs and dampers; couplers between
them.

Positions are counted from the static state: x along the track, y up, pitch counter-clockwise, so that a nose that dips
turns negatively. Wheelsets move in x only: they stay on the rail, and the FMU does the rest. Every spring and damper joins
two bodies at one point of each; with b, the row that maps all coordinates to its elongation,

    M q'' + C q' + K q = f,     K = sum k b^T b,     C = sum c b^T b                              [N], [N m]

which `Coach.advance` integrates implicitly (Newmark). Gravity acts through the slope and through the static loads. Rails that
are not smooth lift the wheelsets, whose height is that of the rail, and with them the lower ends of the primary suspension.

A set has as many coordinates per coach, coach after coach from the front. Couplers join the ends of neighbouring bodies by a
spring and a damper along the track (draft gear without slack); the coordinates of each coach count from its own place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
from numpy.typing import ArrayLike

GRAVITY = 9.81  # m/s2
AXLES = 4
# Of one coach: bodies that pitch, in order: car body, leading bogie, trailing bogie; three coordinates each, then x of
# the wheelsets.
BODY, LEADING, TRAILING = 0, 3, 6
SIZE = 9 + AXLES
# Newmark's beta: bodies move by the trapezoidal rule; accelerations of wheelsets change linearly, as under the ramping
# forces of the FMU, so that what is predicted is what they do.
SHARE_AFTER = np.array([0.25] * 9 + [1.0 / 6.0] * AXLES)
KEPT = 200  # inverted matrices, one for every pattern of rolling and sliding wheelsets


@dataclass(frozen=True)
class Link:
    """A spring and a damper along one direction between two points: elongation is the first less the second."""

    row: np.ndarray  # elongation per coordinate
    stiffness: float  # N/m
    damping: float  # N s/m

    def force(self, position: np.ndarray, velocity: np.ndarray) -> float:
        """On the point that counts positive in the row [N]."""
        return -self.stiffness * (self.row @ position) - self.damping * (self.row @ velocity)


def row_of(size: int, entries: dict[int, float]) -> np.ndarray:
    """A row of `size` coordinates that has these entries by their numbers."""
    row = np.zeros(size)
    row[list(entries)] = list(entries.values())
    return row


def along(size: int, body: int, height: float) -> np.ndarray:
    """Row of the x displacement of a point of a pitching body, `height` [m] above its centre of gravity."""
    return row_of(size, {body: 1.0, body + 2: -height})


def upward(size: int, body: int, ahead: float) -> np.ndarray:
    """Row of the y displacement of a point of a pitching body, `ahead` [m] of its centre of gravity."""
    return row_of(size, {body + 1: 1.0, body + 2: ahead})


class Coach:
    """Equations of a coach, or of a set of `count` equal ones; `v` are the values of a vehicle file."""

    def __init__(self, v: SimpleNamespace, count: int = 1) -> None:
        self.values, self.count, self.axles = v, count, count * AXLES
        self.body_mass = v.body.mass + v.body.payload
        inertia = v.body.pitch_inertia * self.body_mass / v.body.mass
        bogie = [v.bogie.mass, v.bogie.mass, v.bogie.pitch_inertia]
        one = [self.body_mass, self.body_mass, inertia, *bogie, *bogie, *AXLES * [v.wheelset.mass]]
        self.masses = np.array(count * one)
        self.mass = self.body_mass + 2 * v.bogie.mass + AXLES * v.wheelset.mass  # kg, of one coach
        front, wheel = v.bogie_half_distance, v.axle_half_distance
        axles = np.array([front + wheel, front - wheel, -front + wheel, -front - wheel])
        self.axle_positions = np.concatenate([axles - k * v.length for k in range(count)])
        self.static_load = self.mass * GRAVITY / AXLES  # N, of one wheelset
        self.places = SIZE * np.arange(count)  # of the coaches among the coordinates
        self.wheelsets = (self.places[:, None] + 9 + np.arange(AXLES)).ravel()
        bodies = (self.places[:, None] + [BODY, LEADING, TRAILING]).ravel()
        self.along = np.concatenate([bodies, self.wheelsets])  # coordinates along the track
        self.share_after = np.tile(SHARE_AFTER, count)
        self.secondary, self.pull, self.lift = [], [], []
        for place in self.places:
            self._build(v, front, wheel, place)
        self.pull_rows, self.lift_rows = (np.array([link.row for link in links]) for links in (self.pull, self.lift))
        self.couplers = [self._coupler(v, place) for place in self.places[:-1]]
        self.links = [*self.secondary, *self.pull, *self.lift, *self.couplers]
        rows = np.array([link.row for link in self.links])
        self.K = rows.T @ (np.array([link.stiffness for link in self.links])[:, None] * rows)
        self.C = rows.T @ (np.array([link.damping for link in self.links])[:, None] * rows)
        self._solvers = {}

    def _coupler(self, v, place):
        """Between the coach at a place among the coordinates and the next one; longer is positive."""
        ends = (along(len(self.masses), body + BODY, v.coupler.height - v.body.height) for body in (place, place + SIZE))
        return Link(next(ends) - next(ends), v.coupler.stiffness, v.coupler.damping)

    def _build(self, v, front, wheel, place):
        """One coach: secondary suspension and traction rods; per axle the primary suspension along (`pull`) and upward
        (`lift`)."""
        s, rod, p, n, body = v.secondary, v.traction_rod, v.primary, len(self.masses), place + BODY
        for bogie, ahead in ((place + LEADING, front), (place + TRAILING, -front)):
            lift = upward(n, bogie, 0.0) - upward(n, body, ahead)
            shear = along(n, bogie, s.height - v.bogie.height) - along(n, body, s.height - v.body.height)
            tow = along(n, bogie, rod.height - v.bogie.height) - along(n, body, rod.height - v.body.height)
            self.secondary += [
                Link(lift, s.vertical_stiffness, s.vertical_damping),
                Link(shear, s.longitudinal_stiffness, s.longitudinal_damping),
                Link(tow, rod.stiffness, rod.damping),
            ]
        for axle in range(AXLES):
            bogie, ahead = place + (LEADING if axle < 2 else TRAILING), (wheel if axle % 2 == 0 else -wheel)
            row = row_of(n, {place + 9 + axle: 1.0}) - along(n, bogie, v.wheelset.radius - v.bogie.height)
            self.pull.append(Link(row, p.longitudinal_stiffness, p.longitudinal_damping))
            self.lift.append(Link(-upward(n, bogie, ahead), p.vertical_stiffness, p.vertical_damping))

    def start(self, speed: float) -> None:
        """All bodies move at a speed [m/s], springs as under their own weight."""
        self.position, self.velocity = np.zeros(self.count * SIZE), np.zeros(self.count * SIZE)
        self.origin = 0.0
        self.velocity[self.along] = speed
        self.lifted = np.zeros((2, self.axles))

    def speed(self) -> float:
        """Of the car body, the leading one of a set [m/s]."""
        return self.velocity[BODY]

    def travelled(self) -> float:
        """Way of the car body, the leading one of a set, since the start [m]."""
        return self.origin + self.position[BODY]

    def forces(self) -> tuple[np.ndarray, np.ndarray]:
        """What the primary suspension does to each wheelset: along the track [N], and load on the rail [N]."""
        p = self.values.primary
        pulls = -p.longitudinal_stiffness * (self.pull_rows @ self.position)
        pulls -= p.longitudinal_damping * (self.pull_rows @ self.velocity)
        lifts = -p.vertical_stiffness * (self.lift_rows @ self.position)
        lifts -= p.vertical_damping * (self.lift_rows @ self.velocity)
        # The damper's share of a rail that lifts the wheelset is the wheelset's own (`vehicle.damping` of the FMU).
        return pulls, self.static_load - lifts + p.vertical_stiffness * self.lifted[0]

    def coupler_forces(self) -> np.ndarray:
        """Of the couplers from the front, tension positive [N]."""
        return np.array([-link.force(self.position, self.velocity) for link in self.couplers])

    def advance(
        self,
        h: float,
        torques: ArrayLike,
        slope: ArrayLike,
        wheel_masses: ArrayLike,
        wheel_forces: ArrayLike,
        lifted: np.ndarray | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Moves on by `h` [s] as if wheelsets were masses [kg] under the suspension and constant forces [N]; returns
        `forces()` then. `torques` [N m] are those of the brakes on the wheels, forward positive; `slope` that of the track, one
        or one per coach; `lifted` height [m] and its rate [m/s] of the rail below each wheelset at the end of the step."""
        masses, f = self.masses.copy(), self._external(torques, slope)
        masses[self.wheelsets], f[self.wheelsets] = wheel_masses, wheel_forces
        lifted = np.zeros((2, self.axles)) if lifted is None else lifted
        now, then = f + self._ground(self.lifted), f + self._ground(lifted)
        before = (now - self.C @ self.velocity - self.K @ self.position) / masses
        key = (h, *wheel_masses)
        if key not in self._solvers:
            if len(self._solvers) >= KEPT:
                self._solvers.clear()
            self._solvers[key] = np.linalg.inv(np.diag(masses) + 0.5 * h * self.C + h * h * self.K * self.share_after)
        half = self.velocity + 0.5 * h * before
        there = self.position + h * self.velocity + h * h * (0.5 - self.share_after) * before
        after = self._solvers[key] @ (then - self.C @ half - self.K @ there)
        self.position, self.velocity = there + h * h * self.share_after * after, half + 0.5 * h * after
        self.lifted = lifted
        return self.forces()

    def _ground(self, lifted):
        """Forces on the coordinates of wheelsets that are lifted: of the lower ends of the primary suspension."""
        if not np.any(lifted):
            return 0.0
        p = self.values.primary
        carried = p.vertical_stiffness * lifted[0] + p.vertical_damping * lifted[1]
        return -carried @ self.lift_rows

    def correct(self, positions: Sequence[float], velocities: Sequence[float]) -> None:
        """Wheelsets are where they are found [m, m/s]. Positions along the track count from the first of them: millimetres in place
        of kilometres, whose last digit times 63 MN/m would be felt."""
        self.position[self.along] -= positions[0] - self.origin
        self.origin = positions[0]
        self.position[self.wheelsets] = np.array(positions) - self.origin
        self.velocity[self.wheelsets] = velocities

    def _external(self, torques, slope):
        """Forces from outside on all but the wheelsets: slope, resistance, and the brakes' reaction on the frames."""
        f, slopes = np.zeros(self.count * SIZE), np.broadcast_to(slope, self.count)
        r = self.values.resistance
        for k, place in enumerate(self.places):
            bodies = place + np.array([BODY, LEADING, TRAILING])
            f[bodies] = -GRAVITY * slopes[k] * self.masses[bodies]
            speed = self.velocity[place + BODY]
            share = r.constant * np.tanh(speed / 0.01) + r.quadratic * speed * abs(speed)
            f[place + BODY] -= share * self.mass * GRAVITY
            of = torques[k * AXLES : (k + 1) * AXLES]
            f[place + LEADING + 2], f[place + TRAILING + 2] = of[0] + of[1], of[2] + of[3]
        return f

    def energy(self) -> float:
        """Kinetic and elastic energy without the wheelsets' rotation [J]."""
        return 0.5 * (self.masses @ self.velocity**2 + self.position @ self.K @ self.position)
