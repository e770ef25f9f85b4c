"""One stop, step by step: the vehicle (a coach, or a set of them) moves, its brakes act, its wheelsets roll or slide, the rail remembers.

The wheelsets own their inertia (force and moment control); a step of `h` goes like this:

1. Brakes: pressures and torques at the end of the step.
2. Vehicle: one implicit step in which wheelsets are masses under the suspension and the last contact force. While a
   wheelset rolls, its mass counts with its rotation; when it stands, it does not move. This predicts the suspension's
   force at the end of the step, without which stiff primary suspensions do not converge.
3. Wheelsets: each takes its step, force, load and torque ramping to what was found, on threads.
4. Correction: the vehicle's wheelsets are put where they really are. What the wheelsets got over the step is what the
   vehicle lost, so that momentum is kept whatever the prediction was.
5. Rail: energy, heat and sand of the step are left on the map for the axles behind.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import scenario as scenarios
from .axle import TwoWheels
from .brake import Brakes
from .controllers import OwnDriver
from .fmu import Fmu
from .own import fresh_modules
from .rail_map import OffTheMap, RailMap
from .team import Team
from .times import after
from .values import Refused
from .vehicle import AXLES, GRAVITY, Coach
from .warn import Once, collected
from .wheelset import Drive, FmuWheelset, FrictionLaw, RigidWheelset, Seen, runs_straight

ROLLING = 0.01  # slide below which a wheelset counts as rolling in the prediction
STANDING = 0.02  # m/s, of a wheelset that does not turn: slower, or so slow that friction stops it soon, the rail holds it
IMMOBILE = 1e6  # times its mass counts a wheelset that is held
AT_REST = 2e-3  # m/s
WEAK = 0.05  # m/s2, of a stop whose brake is not one
SAVED = "wheel.profile_save"

# Columns of a result, of the vehicle and of every axle: name to unit and meaning.
OF_VEHICLE = {
    "time": ("s", "since the start, end of a step"),
    "speed": ("m/s", "of the car body, the leading one of a set"),
    "travelled": ("m", "way of the car body"),
    "control_pressure": ("Pa", "over ambient, of the leading coach"),
    "reference_speed": ("m/s", "which the slide protection of the leading coach takes for that of the train"),
    "air": ("m3", "let into all cylinders so far, at ambient pressure"),
    "sand": ("kg", "laid on both rails so far"),
}
OF_AXLE = {
    "velocity": ("m/s", "of the wheelset along the track"),
    "peripheral": ("m/s", "speed of the tread, radius times angular velocity"),
    "force": ("N", "of the contact on both wheels along the track, forward positive"),
    "load": ("N", "of both wheels on the rails"),
    "pull": ("N", "of the primary suspension on the wheelset along the track, forward positive"),
    "torque": ("N m", "of the brake on the wheelset, forward positive"),
    "pressure": ("Pa", "in the cylinder, over ambient"),
    "valve": ("1", "of the slide protection: 0 applies, 1 holds, 2 vents"),
    "friction": ("1", "coefficient of the rail that the axle meets"),
    "rail_excess": ("K", "temperature of the rail that the axle meets less the reference"),
    "energy": ("J", "of friction so far, both wheels"),
    "hottest": ("K", "highest temperature of the wheels in the contact now; 0 if unknown"),
    "peak": ("K", "highest temperature of the tread so far; 0 if unknown"),
    "ac1_depth": ("m", "of the tread that was hotter than Ac1"),
}
COUPLER = ("N", "force of the coupler behind this coach, tension positive")


def columns(coaches: int = 1) -> list[str]:
    """Names of all columns: of the vehicle, of every axle, and the force of every coupler, tension positive."""
    axles = [f"{name}_{axle + 1}" for axle in range(coaches * AXLES) for name in OF_AXLE]
    return [*OF_VEHICLE, *axles, *(f"coupler_{k + 1}" for k in range(coaches - 1))]


class TrackEnds(Exception):
    """A stop that is longer than the track; the text names the key and the file that say how long that is."""


class Contacts:
    """Wheelsets and the rail they share."""

    def __init__(
        self,
        wheelsets: Sequence[FmuWheelset | TwoWheels | RigidWheelset],
        positions: ArrayLike,
        rail: RailMap,
        track: SimpleNamespace,
    ) -> None:
        self.wheelsets, self.positions, self.rail, self.track = wheelsets, positions, rail, track
        self.time, self.curve = 0.0, scenarios.heights(track)
        self.places = np.array(positions, float)
        self.seen = None
        self.met = [(0.0, 0.0)] * len(wheelsets)
        self.told = []  # warnings that have not been said: axle, from 0, and text
        # The FMU works outside of Python's lock, so that threads pay; a rigid wheelset does not. Other stops may need
        # the cores meanwhile.
        self.team = Team(None if any(isinstance(wheelset, FmuWheelset | TwoWheels) for wheelset in wheelsets) else 1, patience=0.0)

    def step(
        self,
        h: float,
        forces: np.ndarray,
        loads: np.ndarray,
        torques: np.ndarray,
        sand: Sequence[float],
        lifted: np.ndarray,
    ) -> list[Seen]:
        """Steps all wheelsets; forces, loads and torques are pairs (beginning, end) of one value per axle, `lifted` is height
        and rate of the rail below each at the end."""
        self.met = [self._rail(axle) for axle in range(len(self.wheelsets))]
        drives = [
            Drive(tuple(forces[:, k]), tuple(loads[:, k]), tuple(torques[:, k]), *self.met[k], *lifted[:, k])
            for k in range(len(self.wheelsets))
        ]
        before = self.seen
        self.seen = self.team.map(lambda k: self._stepped(k, h, drives[k]), range(len(self.wheelsets)))
        self.time = after(self.time, h)
        for axle, seen in enumerate(self.seen):
            self._leave(axle, before[axle] if before else None, seen, sand[axle])
        return self.seen

    def _stepped(self, axle, h, drive):
        """A wheelset after its step, on any thread."""
        with collected() as texts:
            try:
                return self.wheelsets[axle].step(h, drive)
            finally:
                self.told += [(axle, text) for text in texts]

    def slope(self, axle: int) -> float:
        """Slope of the track below an axle."""
        return scenarios.slope(self.track, self.places[axle])

    def lifted(self, h: float, speed: float) -> np.ndarray:
        """Height [m] of the rail below the axles in `h` [s], and its rate [m/s]; `speed` [m/s] before the first step."""
        velocities = np.array([w.velocity for w in self.seen]) if self.seen else np.full(len(self.places), speed)
        return scenarios.elevation(self.curve, self.places + h * velocities, velocities)

    def _rail(self, axle):
        """Friction and excess temperature that an axle meets."""
        place = self.places[axle]
        warm = self.track.sections.temperature[scenarios.section(self.track, place)]
        return self.rail.friction(place, axle), warm + self.rail.temperature(place, axle, self.time)

    def _leave(self, axle, before, seen, sand):
        """What the axle left on each rail in the last step, half of that of both."""
        start, end = self.places[axle], self.positions[axle] + seen.position
        energy = seen.friction_energy - (before.friction_energy if before else 0.0)
        heat = seen.rail_heat - (before.rail_heat if before else 0.0)
        self.rail.leave(axle, start, end, self.time, 0.5 * max(energy, 0.0), 0.5 * max(heat, 0.0))
        if sand:
            self.rail.lay_sand(axle, start, end, sand)
        self.places[axle] = end

    def close(self) -> None:
        """Frees wheelsets and threads."""
        self.team.close()
        for wheelset in self.wheelsets:
            wheelset.close()


def wheelsets_of(
    fmu: Fmu | None,
    scenario: SimpleNamespace,
    coach: Coach,
) -> tuple[list[FmuWheelset | TwoWheels | RigidWheelset], list[tuple[int, str]]]:
    """Wheelsets of all coaches from the front, and the warnings of their start: in the FMU, if there is one, where the scenario
    has them there; the others are rigid, with the friction law of the scenario's wheels and of the FMU, or refused if they do
    not know it."""
    wheelset, parameters = scenario.vehicle.wheelset, scenario.wheel
    damping = scenario.vehicle.primary.vertical_damping
    inside = (scenario.fmu_coaches or range(1, coach.count + 1)) if fmu else ()
    if inside and (file := (parameters | scenario.right_wheel).get(SAVED)):
        raise Refused(f"{SAVED} = {file!r}: all wheelsets of a train would save to that file; leave it out here")
    runs_straight(parameters | scenario.right_wheel)
    if len(inside) < coach.count and scenarios.of_two_kinds(scenario):
        raise Refused("right_wheel, right_friction: both wheels of a rigid wheelset are equal; take wheelsets in the FMU")
    law = FrictionLaw.of(parameters, fmu) if len(inside) < coach.count else None
    found, told = [], []
    for axle in range(coach.count * AXLES):
        if axle // AXLES + 1 not in inside:
            found.append(RigidWheelset(wheelset, scenario.speed, law=law))
            continue
        with collected() as texts:
            about = fmu, wheelset, coach.static_load, scenario.speed, damping
            if scenarios.of_two_kinds(scenario):
                pair = parameters, parameters | scenario.right_wheel
                found.append(TwoWheels(*about, pair, scenario.right_friction))
            else:
                found.append(FmuWheelset(*about, dict(parameters), scenario.temperatures))
        told += [(axle, text) for text in texts]
    return found, told


class Stop:
    """A stop of a coach, or of a set: `run` gives the table of its steps, `close` frees the wheelsets.

    `scenario` is what `scenario.load` gives, and may be changed before. `fmu` None takes rigid wheelsets; `dry` is a friction in
    place of the track's; `coach` another vehicle with the methods of `Coach`. Between steps `coach`, `brakes` (one per coach) and
    `contacts.seen` (one `Seen` per axle) say how things are.
    """

    def __init__(self, scenario: SimpleNamespace, fmu: Fmu | None = None, dry: float | None = None, coach: Any = None) -> None:
        self.scenario = scenario
        self.coach = coach or Coach(scenario.vehicle, scenario.coaches)
        self.axles = self.coach.axles
        self.coach.start(scenario.speed)
        of = lambda k: f", coach {k + 1}," if self.coach.count > 1 else ""
        with fresh_modules():
            self.brakes = [Brakes(scenario.brake, [scenario.speed] * AXLES, of(k)) for k in range(self.coach.count)]
            self.driver = OwnDriver(scenario.driver, (scenario,), scenario.driver_parameters) if scenario.driver else None
        ahead = self.coach.axle_positions - self.coach.axle_positions[0]
        rail = scenarios.rail_map(scenario.track, -ahead[-1], self.axles, dry)
        wheelsets, told = wheelsets_of(fmu, scenario, self.coach)
        self.contacts = Contacts(wheelsets, ahead, rail, scenario.track)
        self.torques = np.zeros(self.axles)
        self.radius = scenario.vehicle.wheelset.radius
        self.rows, self.once = [], Once()
        self.contacts.told += told
        self._say()

    def run(self, progress: Callable[[Stop], None] = lambda stop: None) -> np.ndarray:
        """Brakes to rest, watches it for a while; returns the table of `columns()`."""
        s, rest = self.scenario, None
        while rest is None or self.contacts.time < rest + s.hold:
            self.step(s.step)
            progress(self)
            if rest is None and self.at_rest():
                rest = self.contacts.time
            if self.contacts.time > s.longest:
                raise TimeoutError(f"no standstill in {s.longest:g} s: still {self.coach.speed():.3g} m/s{self._weak()}")
        return np.array(self.rows)

    def _weak(self):
        """Words about a brake that is none."""
        vehicle, brake = self.scenario.vehicle, self.scenario.brake
        mass = vehicle.body.mass + vehicle.body.payload + 2 * vehicle.bogie.mass + AXLES * vehicle.wheelset.mass
        slows = AXLES * brake.torque / (self.radius * mass)
        weak = f"; the brake slows it by {slows:.2g} m/s2 at most: is torque = {brake.torque:g} N m in {self.scenario.paths['brake']} meant?"
        return weak if slows < WEAK else ""

    def at_rest(self) -> bool:
        """Whether the coach has stopped."""
        return self.coach.speed() < AT_REST

    def step(self, h: float) -> None:
        """One step of all parts, of `h` [s]."""
        try:
            self._step(h)
        except OffTheMap as error:
            s, seen = self.scenario, self.contacts
            raise TrackEnds(
                f"the stop is longer than the track: after {seen.time:.1f} s and {self.coach.travelled():.0f} m still "
                f"{self.coach.speed():.3g} m/s; raise length = {s.track.length:g} m in {s.paths['track']}{self._weak()}"
            ) from error
        finally:
            self._say()

    def _say(self):
        """Says warnings of the wheelsets, each kind once in a stop."""
        told, self.contacts.told = sorted(self.contacts.told, key=lambda entry: entry[0]), []
        for axle, text in told:
            self.once.warn(text, f"axle {axle + 1}: ")

    def _step(self, h):
        """One step; positions beyond the map of the rail are refused by the map."""
        seen, mass = self.contacts.seen, self.scenario.vehicle.wheelset.mass
        omegas = [w.omega for w in seen] if seen else [self.scenario.speed / self.radius] * self.axles
        torques, sand = self._brake(h, [self.radius * omega for omega in omegas])
        pulls, loads = self.coach.forces()
        slopes = np.array([self.contacts.slope(k) for k in range(self.axles)])
        weight = -mass * GRAVITY * slopes
        masses, others = np.full(self.axles, mass), np.zeros(self.axles)
        if seen:
            contact = np.array([w.force for w in seen])
            masses, others = predicted(h, self.scenario.vehicle.wheelset, seen, pulls, contact + weight)
        reaction = [w.torque for w in seen] if seen else [0.0] * self.axles
        lifted = self.contacts.lifted(h, self.scenario.speed)
        new_pulls, new_loads = self.coach.advance(h, reaction, slopes[::AXLES], masses, others, lifted)
        forces, torques = np.array([pulls, new_pulls]) + weight, np.array(torques)
        loads, torques_of = np.array([loads, new_loads]), np.array([self.torques, torques])
        seen = self.contacts.step(h, forces, loads, torques_of, sand, lifted)
        self.coach.correct([w.position for w in seen], [w.velocity for w in seen])
        self.torques = torques
        self.rows.append(self.row(new_pulls))

    def _brake(self, h, speeds):
        """Torques and sand of all axles; every coach has brakes of its own, which know the speeds of its axles only."""
        torques, sand, demand = [], [], self.scenario.demand
        if self.driver:
            demand = self.driver.step(h, self.contacts.time, self.coach.speed(), self.coach.travelled())
        for k, brakes in enumerate(self.brakes):
            of = brakes.step(h, demand, speeds[k * AXLES : (k + 1) * AXLES])
            torques += of[0]
            sand += of[1]
        return torques, sand

    def row(self, pulls: np.ndarray) -> list[float]:
        """Values of `columns()` now: pressure and reference speed are those of the leading coach, air and sand of all."""
        leading, contacts = self.brakes[0], self.contacts
        row = [contacts.time, self.coach.speed(), self.coach.travelled(), leading.distributor.pressure]
        row += [leading.protection.reference, sum(b.air() for b in self.brakes), sum(b.sander.used for b in self.brakes)]
        for k, w in enumerate(contacts.seen):
            brakes, own = self.brakes[k // AXLES], k % AXLES
            row += [w.velocity, self.radius * w.omega, w.force, w.load, pulls[k], w.torque]
            row += [brakes.cylinders[own].pressure, brakes.valves[own].value, *contacts.met[k], w.friction_energy]
            row += [w.hottest, w.peak, w.ac1_depth]
        return [*row, *self.coach.coupler_forces()]

    def close(self) -> None:
        """Frees the wheelsets."""
        self.contacts.close()


def predicted(
    h: float,
    wheelset: SimpleNamespace,
    seen: Sequence[Seen],
    pulls: np.ndarray,
    others: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Masses [kg] of the wheelsets in the vehicle's step, and the forces [N] on them beside the suspension's."""
    masses, forces = np.full(len(seen), float(wheelset.mass)), np.array(others, float)
    for k, w in enumerate(seen):
        peripheral = wheelset.radius * w.omega
        if abs(w.omega) < 1e-9 and abs(w.velocity) < STANDING + 2.0 * h * abs(w.force) / wheelset.mass:
            masses[k], forces[k] = IMMOBILE * wheelset.mass, -pulls[k]
        elif abs(w.velocity - peripheral) < ROLLING * max(abs(w.velocity), abs(peripheral)):
            masses[k] = wheelset.mass + wheelset.inertia / wheelset.radius**2
            forces[k] = masses[k] / wheelset.mass * (pulls[k] + others[k]) - pulls[k]
    return masses, forces
