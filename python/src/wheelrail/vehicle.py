"""A four-axle coach in the plane as linear equations: body, two bogies, four wheelsets, springs and dampers.

Positions are counted from the static state: x along the track, y up, pitch counter-clockwise, so that a nose that dips
turns negatively. Wheelsets move in x only: they stay on the rail, and the FMU does the rest. Every spring and damper joins
two bodies at one point of each; with b, the row that maps all coordinates to its elongation,

    M q'' + C q' + K q = f,     K = sum k b^T b,     C = sum c b^T b                              [N], [N m]

which `Coach.advance` integrates implicitly (Newmark). Gravity acts through the slope and through the static loads.
"""

from dataclasses import dataclass

import numpy as np

GRAVITY = 9.81  # m/s2
AXLES = 4
# Bodies that pitch, in order: car body, leading bogie, trailing bogie; three coordinates each, then x of the wheelsets.
BODY, LEADING, TRAILING = 0, 3, 6
WHEELSETS = slice(9, 9 + AXLES)
SIZE = 9 + AXLES
# Newmark's beta: bodies move by the trapezoidal rule; accelerations of wheelsets change linearly, as under the ramping forces
# of the FMU, so that what is predicted is what they do.
SHARE_AFTER = np.array([0.25] * 9 + [1.0 / 6.0] * AXLES)


@dataclass(frozen=True)
class Link:
    """A spring and a damper along one direction between two points: elongation is the first less the second."""

    row: np.ndarray  # elongation per coordinate
    stiffness: float  # N/m
    damping: float  # N s/m

    def force(self, position, velocity):
        """On the point that counts positive in the row [N]."""
        return -self.stiffness * (self.row @ position) - self.damping * (self.row @ velocity)


def along(body, height):
    """Row of the x displacement of a point of a pitching body, `height` [m] above its centre of gravity."""
    row = np.zeros(SIZE)
    row[body], row[body + 2] = 1.0, -height
    return row


def upward(body, ahead):
    """Row of the y displacement of a point of a pitching body, `ahead` [m] of its centre of gravity."""
    row = np.zeros(SIZE)
    row[body + 1], row[body + 2] = 1.0, ahead
    return row


def wheelset(axle):
    """Row of the x displacement of a wheelset."""
    row = np.zeros(SIZE)
    row[9 + axle] = 1.0
    return row


class Coach:
    """Equations of a coach; `v` are the values of a vehicle file."""

    def __init__(self, v):
        self.values = v
        self.body_mass = v.body.mass + v.body.payload
        inertia = v.body.pitch_inertia * self.body_mass / v.body.mass
        bogie = [v.bogie.mass, v.bogie.mass, v.bogie.pitch_inertia]
        self.masses = np.array([self.body_mass, self.body_mass, inertia, *bogie, *bogie, *AXLES * [v.wheelset.mass]])
        self.mass = self.body_mass + 2 * v.bogie.mass + AXLES * v.wheelset.mass
        front, wheel = v.bogie_half_distance, v.axle_half_distance
        self.axle_positions = np.array([front + wheel, front - wheel, -front + wheel, -front - wheel])
        self.static_load = self.mass * GRAVITY / AXLES  # N, of one wheelset
        self._build(v, front, wheel)
        self.links = [*self.secondary, *self.pull, *self.lift]
        rows = np.array([link.row for link in self.links])
        self.K = rows.T @ (np.array([link.stiffness for link in self.links])[:, None] * rows)
        self.C = rows.T @ (np.array([link.damping for link in self.links])[:, None] * rows)
        self._solvers = {}

    def _build(self, v, front, wheel):
        """Secondary suspension and traction rods; per axle the primary suspension along (`pull`) and upward (`lift`)."""
        s, rod, p = v.secondary, v.traction_rod, v.primary
        self.secondary, self.pull, self.lift = [], [], []
        for bogie, ahead in ((LEADING, front), (TRAILING, -front)):
            lift = upward(bogie, 0.0) - upward(BODY, ahead)
            shear = along(bogie, s.height - v.bogie.height) - along(BODY, s.height - v.body.height)
            tow = along(bogie, rod.height - v.bogie.height) - along(BODY, rod.height - v.body.height)
            self.secondary += [
                Link(lift, s.vertical_stiffness, s.vertical_damping),
                Link(shear, s.longitudinal_stiffness, s.longitudinal_damping),
                Link(tow, rod.stiffness, rod.damping),
            ]
        for axle in range(AXLES):
            bogie, ahead = (LEADING if axle < 2 else TRAILING), (wheel if axle % 2 == 0 else -wheel)
            row = wheelset(axle) - along(bogie, v.wheelset.radius - v.bogie.height)
            self.pull.append(Link(row, p.longitudinal_stiffness, p.longitudinal_damping))
            self.lift.append(Link(-upward(bogie, ahead), p.vertical_stiffness, p.vertical_damping))

    def start(self, speed):
        """All bodies move at a speed [m/s], springs as under their own weight."""
        self.position, self.velocity = np.zeros(SIZE), np.zeros(SIZE)
        self.velocity[[BODY, LEADING, TRAILING]] = speed
        self.velocity[WHEELSETS] = speed

    def speed(self):
        """Of the car body [m/s]."""
        return self.velocity[BODY]

    def travelled(self):
        """Way of the car body since the start [m]."""
        return self.position[BODY]

    def forces(self):
        """What the primary suspension does to each wheelset: along the track [N], and load on the rail [N]."""
        pulls = np.array([link.force(self.position, self.velocity) for link in self.pull])
        lifts = np.array([link.force(self.position, self.velocity) for link in self.lift])
        return pulls, self.static_load - lifts

    def advance(self, h, torques, slope, wheel_masses, wheel_forces):
        """Moves on by `h` [s] as if wheelsets were masses [kg] under the suspension and constant forces [N]; returns
        `forces()` then. `torques` [N m] are those of the brakes on the wheels, forward positive."""
        masses, f = self.masses.copy(), self._external(torques, slope)
        masses[WHEELSETS] = wheel_masses
        before = (f - self.C @ self.velocity - self.K @ self.position) / self.masses
        f[WHEELSETS] = wheel_forces
        before[WHEELSETS] = ((f - self.C @ self.velocity - self.K @ self.position) / masses)[WHEELSETS]
        key = (h, *wheel_masses)
        if key not in self._solvers:
            self._solvers[key] = np.linalg.inv(np.diag(masses) + 0.5 * h * self.C + h * h * self.K * SHARE_AFTER)
        half = self.velocity + 0.5 * h * before
        there = self.position + h * self.velocity + h * h * (0.5 - SHARE_AFTER) * before
        after = self._solvers[key] @ (f - self.C @ half - self.K @ there)
        self.position, self.velocity = there + h * h * SHARE_AFTER * after, half + 0.5 * h * after
        return self.forces()

    def correct(self, positions, velocities):
        """Wheelsets are where they are found [m, m/s]."""
        self.position[WHEELSETS], self.velocity[WHEELSETS] = positions, velocities

    def _external(self, torques, slope):
        """Forces from outside on all but the wheelsets: slope, resistance, and the brakes' reaction on the frames."""
        f = np.zeros(SIZE)
        f[[BODY, LEADING, TRAILING]] = -GRAVITY * slope * self.masses[[BODY, LEADING, TRAILING]]
        r, speed = self.values.resistance, self.speed()
        share = r.constant * np.tanh(speed / 0.01) + r.quadratic * speed * abs(speed)
        f[BODY] -= share * self.mass * GRAVITY
        f[LEADING + 2], f[TRAILING + 2] = torques[0] + torques[1], torques[2] + torques[3]
        return f

    def energy(self):
        """Kinetic and elastic energy without the wheelsets' rotation [J]."""
        return 0.5 * (self.masses @ self.velocity**2 + self.position @ self.K @ self.position)
