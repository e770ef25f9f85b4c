"""A wheelset on the rail behind one interface: in the FMU, or rigid with a creep law for quick studies.

Both own the wheelset's mass and inertia and are driven by what the suspension does to them (`Drive`); `step` returns what
a vehicle, a brake and a rail want to know (`Seen`). Forces are those of both wheels.
"""

from typing import NamedTuple

import numpy as np

from .fmu import Refused, Wheel
from .warn import collected

WHEELS = 2


class Drive(NamedTuple):
    """Inputs of a step; pairs are values at its beginning and its end, between which they change linearly."""

    force: tuple  # N, along the track, with the wheelset's weight on a slope
    load: tuple  # N, pressing down
    torque: tuple  # N m, of the brake, at least 0
    friction: float  # 1
    rail_excess: float = 0.0  # K, of the arriving rail over the reference
    elevation: float = 0.0  # m, of the rail under the wheelset at the end of the step; rigid wheelsets feel it by the load only
    elevation_rate: float = 0.0  # m/s, of that at the end of the step


class Seen(NamedTuple):
    """A wheelset at the end of a step."""

    position: float  # m, since the start
    velocity: float  # m/s
    omega: float  # rad/s
    force: float  # N, of the contact on both wheels, along the track
    load: float  # N
    torque: float  # N m, of the brake on the wheelset, forward positive
    friction_energy: float  # J, since the start, both rails
    rail_heat: float  # J, since the start, both rails
    hottest: float  # K, of the contact now; 0 if unknown
    peak: float  # K, of the tread so far; 0 if unknown
    ac1_depth: float  # m


OUTPUTS = (
    "wheel.distance", "wheel.velocity", "wheel.omega", "contact.force_x", "contact.force_y", "brake.torque_actual",
    "energy.friction", "heat.to_rail", "temperature.wheel_max", "damage.peak_temperature", "damage.ac1_depth",
)  # fmt: skip


class FmuWheelset:
    """A whole wheelset as one instance: twice the width and the nominal load of one wheel."""

    def __init__(self, fmu, wheelset, load, speed, damping=0.0, parameters=None):
        """`wheelset` has mass [kg], inertia [kg m2] and radius [m]; `damping` [N s/m] resists its bounce; `parameters`
        of the FMU count for one wheel and go before everything else."""
        self.mass, self.inertia, self.radius = wheelset.mass, wheelset.inertia, wheelset.radius
        values = whole_wheelset(fmu, wheelset, parameters or {})
        values |= {"initial.velocity": speed, "vehicle.mass": 0.0, "vehicle.damping": damping}
        self.wheel = Wheel(fmu, values, {"drive.load": load}, name="wheelset")
        self.reference, *held = self.wheel.get("thermal.reference", "wheel.mass", "wheel.inertia")
        if not np.allclose(held, [self.mass, self.inertia], rtol=1e-6):
            self.close()
            raise Refused(f"the FMU holds {held[0]:g} kg, {held[1]:g} kg m2 in place of {wheelset}")
        self._heat = 0.0

    def step(self, h, drive):
        """Advances by `h` seconds."""
        ramped = {"drive.force": drive.force, "drive.load": drive.load, "brake.torque": drive.torque}
        held = {"rail.friction": drive.friction, "rail.temperature": self.reference + drive.rail_excess}
        held |= {"rail.elevation": drive.elevation, "rail.elevation_rate": drive.elevation_rate}
        self.wheel.set({name: begin for name, (begin, _) in ramped.items()} | held)
        self.wheel.set_rates({name: (end - begin) / h for name, (begin, end) in ramped.items()})
        self.wheel.step(h)
        seen = self.wheel.get(*OUTPUTS)
        self._heat += h * seen[7]
        return Seen(*seen[:7], self._heat, *seen[8:])

    def close(self):
        """Frees the instance."""
        self.wheel.close()


# Parameters that two wheels have twice.
DOUBLED = (
    "model.contact_width", "model.nominal_load", "rail.restraint_stiffness", "rail.restraint_damping",
    "rail.support_stiffness", "rail.support_damping", "rail.support_mass",
)  # fmt: skip


def runs_straight(parameters):
    """Refuses parameters of wheels with lateral creepage: the wheelsets of this module, in the FMU or rigid, run straight."""
    aside = [name for name in parameters if name == "contact.lateral" and parameters[name] or ".lateral_" in name]
    if aside:
        raise Refused(f"{aside[0]}: wheelsets of a train run straight; leave it out, or give each wheel an FMU of its own (example 14)")


def whole_wheelset(fmu, wheelset, parameters):
    """Parameters of one wheel made those of two on an axle that weigh and turn as given [kg, kg m2]."""
    runs_straight(parameters)
    rim = parameters | {"wheel.radius": wheelset.radius, "wheel.hub_mass": 0.0, "wheel.hub_inertia": 0.0}
    # What is to be said of the parameters is said of the wheelset.
    with collected(), Wheel(fmu, rim) as one:
        if not one.has_constant_width():
            raise Refused(
                "contact.shape = ellipse or rows is the patch of one wheel, but a wheelset is one FMU here: set contact.shape = line, or "
                "give each wheel an FMU of its own (example 12)"
            )
        mass, inertia = (WHEELS * value for value in one.get("wheel.mass", "wheel.inertia"))
        doubled = {name: WHEELS * value for name, value in zip(DOUBLED, one.get(*DOUBLED))}
    if mass > wheelset.mass or inertia > wheelset.inertia:
        raise Refused(f"a wheelset of {wheelset.mass:g} kg, {wheelset.inertia:g} kg m2 is lighter than its two rims")
    hub = {"wheel.hub_mass": wheelset.mass - mass, "wheel.hub_inertia": wheelset.inertia - inertia}
    return parameters | doubled | hub | {"wheel.radius": wheelset.radius}


class FrictionLaw(NamedTuple):
    """Friction of a rigid wheelset: mu = mu_0 (A + (1 - A) exp(-B |s|)), which is the law of the FMU for slip velocities s.

    Its other parameters have no effect here: nothing is hot, memory is shorter than a step, and the rail gives mu_0.
    """

    falling_ratio: float = 1.0  # A, 1
    falling_decay: float = 0.0  # B, s/m

    @classmethod
    def of(cls, parameters, fmu=None):
        """Law of the FMU under `parameters` by name, beside the start values of `fmu` if there is one. Parameters of friction
        that this law does not know are refused."""
        given = {name: value for name, value in parameters.items() if name.startswith("friction.")}
        unknown = [name for name in given if name not in (*LAW, *WITHOUT_EFFECT)]
        if unknown:
            raise Refused(f"rigid wheelsets do not know {', '.join(unknown)}, only the law of {' and '.join(LAW)}")
        start = {name: float(fmu.variable(name).start) for name in LAW} if fmu else {}
        values = start | given
        return cls(**{name.removeprefix("friction."): values[name] for name in LAW if name in values})

    def factor(self, slip):
        """Coefficient over that of the rail [1] at a slip velocity [m/s]."""
        return self.falling_ratio + (1.0 - self.falling_ratio) * np.exp(-self.falling_decay * abs(slip))


# Parameters of friction in the FMU: those of the law, and those without effect on a rigid wheelset. Others are refused.
LAW = tuple(f"friction.{name}" for name in FrictionLaw._fields)
WITHOUT_EFFECT = ("friction.coefficient", "friction.softening", "friction.softening_floor", "friction.memory_length")


class RigidWheelset:
    """A rigid wheelset under Carter's creep force, by backward Euler.

    With z = |s|/(V xi_full), F = mu N (2 z - z^2) below full slip, mu N beyond, with the friction of the slip s of the step
    before. The load is that of the suspension; nothing is hot.
    """

    def __init__(self, wheelset, speed, full_slip=4e-3, law=FrictionLaw()):
        self.mass, self.inertia, self.radius = wheelset.mass, wheelset.inertia, wheelset.radius
        self.full_slip, self.law = full_slip, law
        self.position, self.velocity, self.omega = 0.0, speed, speed / wheelset.radius
        self.slip, self.energy = 0.0, 0.0

    def step(self, h, drive):
        """Advances by `h` seconds."""
        r, m, inertia = self.radius, self.mass, self.inertia
        pull, torque, load = (0.5 * sum(pair) for pair in (drive.force, drive.torque, drive.load))
        grip = load * drive.friction * self.law.factor(self.slip)
        scale = max(abs(self.velocity), abs(r * self.omega), 0.01) * self.full_slip
        turning = np.sign(self.omega) or np.sign(self.velocity)
        free = self.velocity + h * pull / m
        spun = self.omega - h * turning * torque / inertia
        slip = _slip(free - r * spun, h * grip * (1.0 / m + r * r / inertia), scale)
        force = -grip * _share(slip, scale)
        omega = spun - h * r * force / inertia
        if omega * turning <= 0.0:
            omega = 0.0
            slip = _slip(free, h * grip / m, scale)
            force = -grip * _share(slip, scale)
        velocity = free + h * force / m
        acting = inertia * (omega - self.omega) / h + r * force
        self.position += 0.5 * h * (self.velocity + velocity)
        self.energy -= h * force * slip
        self.velocity, self.omega, self.slip = velocity, omega, slip
        return Seen(
            self.position, velocity, omega, force, drive.load[1], acting, self.energy, 0.5 * self.energy, 0.0, 0.0, 0.0
        )

    def close(self):
        """Nothing to free."""


def _share(slip, scale):
    """Carter's force over mu N, against positive slip [1]."""
    z = min(abs(slip) / scale, 1.0)
    return np.copysign(2.0 * z - z * z, slip)


def _slip(free, change, scale):
    """Slip s with s + change share(s/scale) = free: a quadratic equation below full slip."""
    if abs(free) >= scale + change:
        return free - np.copysign(change, free)
    b = scale + 2.0 * change
    return np.copysign(2.0 * abs(free) * scale / (b + np.sqrt(max(b * b - 4.0 * change * abs(free), 0.0))), free)
