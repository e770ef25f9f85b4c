"""A wheelset on the rail behind one interface: in the FMU, or rigid with a creep law for quick studies.

Both own the wheelset's mass and inertia and are driven by what the suspension does to them (`Drive`); `step` returns what
a vehicle, a brake and a rail want to know (`Seen`). Forces are those of both wheels.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np

from .fmu import Fmu, Refused, Wheel
from .warn import collected

WHEELS = 2
FULL_SLIP = 4e-3  # creepage of a rigid wheelset from which on it slides


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


# What the wheel beside a wheelset gives in the place of the wheelset's own.
OF_HEAT = ("temperature.wheel_max", "damage.peak_temperature", "damage.ac1_depth")


class FmuWheelset:
    """A wheelset as one instance: where the patch is a line of constant width, both wheels as one of twice the width and load; where it
    has a width of its own, one wheel with half of everything, which stands for both. `wheels` says how many it is.

    With `beside`, parameters of one wheel, a wheel more moves as this one does; temperatures and damage are its own then. It changes
    nothing in the forces.
    """

    def __init__(
        self,
        fmu: Fmu,
        wheelset: SimpleNamespace,
        load: float,
        speed: float,
        damping: float = 0.0,
        parameters: Mapping[str, object] | None = None,
        beside: Mapping[str, object] | None = None,
        alone: bool = False,
    ) -> None:
        """`wheelset` has mass [kg], inertia [kg m2] and radius [m]; `damping` [N s/m] resists its bounce; `parameters`
        of the FMU count for one wheel and go before everything else. `alone` makes one wheel of a line, too."""
        self.radius = wheelset.radius
        values, self.wheels = parameters_of(fmu, wheelset, parameters or {}, alone)
        self.share = self.wheels / WHEELS  # of the wheelset that the FMU is
        values |= {"initial.velocity": speed, "vehicle.mass": 0.0, "vehicle.damping": self.share * damping}
        self.wheel, self.beside = Wheel(fmu, values, {"drive.load": self.share * load}, name="wheelset"), None
        self.reference = self.wheel.get("thermal.reference")
        if beside:
            self.beside = self._follower(fmu, beside, load, speed)
        self._heat = 0.0

    def _follower(self, fmu, parameters, load, speed):
        """The wheel beside this one, whose speeds are prescribed."""
        values = dict(parameters) | {"initial.velocity": speed, "wheel.radius": self.radius}
        omega = self.wheel.get("wheel.omega")
        moves = {"control.rotation": "velocity", "control.translation": "velocity", "drive.velocity": speed, "drive.omega": omega}
        return Wheel(fmu, values, moves | {"drive.load": load / WHEELS}, name="beside")

    def step(self, h: float, drive: Drive, held: tuple[float, float] = (0.0, 0.0)) -> Seen:
        """Advances by `h` seconds; `held` are force [N] and moment [N m] on the FMU besides."""
        share, before = self.share, self.wheel.get("wheel.velocity", "wheel.omega")
        ramped = {"drive.force": drive.force, "drive.load": drive.load, "brake.torque": drive.torque}
        rail = {"rail.friction": drive.friction, "rail.temperature": self.reference + drive.rail_excess}
        rail |= {"rail.elevation": drive.elevation, "rail.elevation_rate": drive.elevation_rate}
        begins = {name: share * begin for name, (begin, _) in ramped.items()}
        begins |= {"drive.force": begins["drive.force"] + held[0], "drive.moment": held[1]}
        self.wheel.set(begins | rail)
        self.wheel.set_rates({name: share * (end - begin) / h for name, (begin, end) in ramped.items()})
        self.wheel.step(h)
        seen = self.wheel.get(*OUTPUTS)
        self._heat += h * seen[7] / share
        hot = self._follow(h, drive, rail, list(zip(before, seen[1:3]))) if self.beside else seen[8:]
        position, velocity, omega, force, load, torque, energy = seen[:7]
        return Seen(position, velocity, omega, force / share, load / share, torque / share, energy / share, self._heat, *hot)

    def _follow(self, h, drive, rail, motion):
        """Temperatures of the wheel beside this one after a step from speeds to others."""
        ramped = {"drive.velocity": motion[0], "drive.omega": motion[1], "drive.load": [load / WHEELS for load in drive.load]}
        self.beside.set({name: begin for name, (begin, _) in ramped.items()} | rail)
        self.beside.set_rates({name: (end - begin) / h for name, (begin, end) in ramped.items()})
        self.beside.step(h)
        return self.beside.get(*OF_HEAT)

    def answers(self) -> np.ndarray:
        """What speed [m/s] and peripheral speed [m/s] of the FMU gain in the last step per newton and per newton metre that act
        on it: columns."""
        known = ("drive.force", "drive.moment")
        found = [self.wheel.derivatives(("wheel.velocity", "wheel.omega"), {name: 1.0}) for name in known]
        return np.array(found).T * [[1.0], [self.radius]]

    def save(self) -> tuple:
        """A state for `restore`, without the wheel beside; free it with `forget`."""
        return self.wheel.save(), self._heat

    def restore(self, saved: tuple) -> None:
        """Returns to a saved state."""
        state, self._heat = saved
        self.wheel.restore(state)

    def forget(self, saved: tuple) -> None:
        """Frees a saved state."""
        self.wheel.forget(saved[0])

    def close(self) -> None:
        """Frees the instances."""
        self.wheel.close()
        if self.beside:
            self.beside.close()


# Parameters that two wheels have twice.
DOUBLED = (
    "model.contact_width", "model.nominal_load", "rail.restraint_stiffness", "rail.restraint_damping",
    "rail.support_stiffness", "rail.support_damping", "rail.support_mass",
    "thermal.rim_width", "thermal.web_width", "thermal.head_width", "thermal.block_width",
)  # fmt: skip


def runs_straight(parameters: Mapping[str, object]) -> None:
    """Refuses parameters of wheels with lateral creepage: the wheelsets of this module, in the FMU or rigid, run straight."""
    aside = [name for name in parameters if name == "contact.lateral" and parameters[name] or ".lateral_" in name]
    if aside:
        raise Refused(f"{aside[0]}: wheelsets of a train run straight; leave it out, or give each wheel an FMU of its own (example 14)")


def parameters_of(
    fmu: Fmu, wheelset: SimpleNamespace, parameters: Mapping[str, object], alone: bool = False
) -> tuple[dict[str, object], int]:
    """Parameters of an FMU that is the two wheels of an axle, which weigh and turn as given [kg, kg m2], and how many of them it is:
    two as one of twice the width, or one for both where the patch has a width of its own, or where it is to be `alone`."""
    runs_straight(parameters)
    rim = dict(parameters) | {"wheel.radius": wheelset.radius, "wheel.hub_mass": 0.0, "wheel.hub_inertia": 0.0}
    # What is to be said of the parameters is said of the wheelset.
    with collected(), Wheel(fmu, rim) as one:
        wheels = WHEELS if one.has_constant_width() and not alone else 1
        mass, inertia = (wheels * value for value in one.get("wheel.mass", "wheel.inertia"))
        doubled = {name: wheels * value for name, value in zip(DOUBLED, one.get(*DOUBLED))} if wheels > 1 else {}
    share = wheels / WHEELS
    if mass > share * wheelset.mass or inertia > share * wheelset.inertia:
        raise Refused(f"a wheelset of {wheelset.mass:g} kg, {wheelset.inertia:g} kg m2 is lighter than its two rims")
    hub = {"wheel.hub_mass": share * wheelset.mass - mass, "wheel.hub_inertia": share * wheelset.inertia - inertia}
    return dict(parameters) | doubled | hub | {"wheel.radius": wheelset.radius}, wheels


def whole_wheelset(fmu: Fmu, wheelset: SimpleNamespace, parameters: Mapping[str, object]) -> dict[str, object]:
    """Parameters of one FMU that is both wheels of an axle; patches with a width of their own are refused."""
    values, wheels = parameters_of(fmu, wheelset, parameters)
    if wheels < WHEELS:
        raise Refused(
            "contact.shape = ellipse or rows is the patch of one wheel, but a wheelset is one FMU here: set contact.shape = line, or "
            "give each wheel an FMU of its own (example 12)"
        )
    return values


def patches_of(fmu: Fmu, wheelset: SimpleNamespace, parameters: Mapping[str, object], beside: Mapping[str, object]) -> str:
    """Words on the patches of a wheelset: which shape, how many wheels an FMU is, and what is computed beside it."""
    _, wheels = parameters_of(fmu, wheelset, parameters)
    words = "both wheels as one line of twice the width" if wheels > 1 else "one wheel with a patch of its own, which stands for both"
    return words + (f"; temperatures of a wheel beside it ({', '.join(map(str, beside.values()))})" if beside else "")


class FrictionLaw(NamedTuple):
    """Friction of a rigid wheelset: mu = mu_0 (A + (1 - A) exp(-B |s|)), which is the law of the FMU for slip velocities s.

    Its other parameters have no effect here: nothing is hot, memory is shorter than a step, and the rail gives mu_0.
    """

    falling_ratio: float = 1.0  # A, 1
    falling_decay: float = 0.0  # B, s/m

    @classmethod
    def of(cls, parameters: Mapping[str, object], fmu: Fmu | None = None) -> FrictionLaw:
        """Law of the FMU under `parameters` by name, beside the start values of `fmu` if there is one. Parameters of friction
        that this law does not know are refused."""
        given = {name: value for name, value in parameters.items() if name.startswith("friction.")}
        unknown = [name for name in given if name not in (*LAW, *WITHOUT_EFFECT)]
        texts = [name for name in LAW if isinstance(given.get(name), (str, bool))]
        if texts:
            raise Refused(f"{texts[0]} = {given[texts[0]]!r} is not a number")
        if unknown:
            raise Refused(f"rigid wheelsets do not know {', '.join(unknown)}, only the law of {' and '.join(LAW)}")
        start = {name: float(fmu.variable(name).start) for name in LAW} if fmu else {}
        values = start | given
        return cls(**{name.removeprefix("friction."): values[name] for name in LAW if name in values})

    def factor(self, slip: float) -> float:
        """Coefficient over that of the rail [1] at a slip velocity [m/s]."""
        return self.falling_ratio + (1.0 - self.falling_ratio) * np.exp(-self.falling_decay * abs(slip))


# Parameters of friction in the FMU: those of the law, and those without effect on a rigid wheelset. Others are refused.
LAW = tuple(f"friction.{name}" for name in FrictionLaw._fields)
WITHOUT_EFFECT = ("friction.coefficient", "friction.softening", "friction.softening_floor", "friction.memory_length")


class RigidWheelset:
    """A rigid wheelset under Carter's creep force, by backward Euler.

    With z = |s|/(V FULL_SLIP), F = mu N (2 z - z^2) below full slip, mu N beyond, with the friction of the slip s of the step
    before. The load is that of the suspension; nothing is hot.
    """

    def __init__(self, wheelset: SimpleNamespace, speed: float, law: FrictionLaw = FrictionLaw()) -> None:
        self.mass, self.inertia, self.radius = wheelset.mass, wheelset.inertia, wheelset.radius
        self.law = law
        self.position, self.velocity, self.omega = 0.0, speed, speed / wheelset.radius
        self.slip, self.energy = 0.0, 0.0

    def step(self, h: float, drive: Drive) -> Seen:
        """Advances by `h` seconds."""
        r, m, inertia = self.radius, self.mass, self.inertia
        pull, torque, load = (0.5 * sum(pair) for pair in (drive.force, drive.torque, drive.load))
        grip = load * drive.friction * self.law.factor(self.slip)
        scale = max(abs(self.velocity), abs(r * self.omega), 0.01) * FULL_SLIP
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

    def close(self) -> None:
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
