"""The master that other people's programs have: everything steps at once, with inputs that hold what came out of the last step.

`train.py` lets forces ramp to what an implicit step of the vehicle has found; a system package (`ssp.py`) gives its FMUs to a
master that cannot. There the coach looks one step further ahead: the wheels hold the mean of the suspension's forces over the
step that comes. Forces of the beginning of a step, held, would swing up in a stiff primary suspension. In the first step wheels
roll at the initial speed without force.

`HeldCoach` is the coach in Python, `ParallelStop` a stop with it. `coach.fmu` has the same equations in Rust, because other
people's masters run it without Python; they stay in Python because scenarios need more of them than an FMU can offer: sets of
coaches with couplers, slopes, lifted rails, sand, and exudyn in the place of the vehicle. `fmpy_tests/test_coach_fmu.py` ties both
to rounding. `Parallel` is the bare algorithm, for any FMUs.
"""

from types import SimpleNamespace

import numpy as np

from .brake import Brakes
from .train import predicted
from .vehicle import AXLES, Coach
from .wheelset import FmuWheelset

# Outputs of a wheelset that its coach reads.
READ = ("wheel.distance", "wheel.velocity", "wheel.omega", "contact.force_x", "brake.torque_actual")


class Parallel:
    """FMUs by name that step at once; `connections` are pairs of (name, output), (name, input)."""

    def __init__(self, slaves, connections):
        self.slaves, self.connections = slaves, list(connections)
        self.held = {name: {} for name in slaves}

    def step(self, h):
        """All take a step of `h` [s] with what came out of the last one; in the first one with their start values."""
        for name, slave in self.slaves.items():
            slave.set(self.held[name])
            slave.step(h)
        for (source, output), (target, name) in self.connections:
            self.held[target][name] = self.slaves[source].get(output)


class HeldCoach:
    """The coach of a scenario for a master that holds forces: what `coach.fmu` computes."""

    def __init__(self, scenario):
        self.scenario, self.vehicle = scenario, Coach(scenario.vehicle)
        self.vehicle.start(scenario.speed)
        self.brakes = Brakes(scenario.brake, [scenario.speed] * AXLES)

    def step(self, h, seen, demand=None):
        """Moves on by `h` [s] under a demand, that of the scenario if none is given; returns what each wheelset gets in the next
        step, by name of the wheel's input. `seen` are the wheelsets at the beginning of the step, `None` in the first one."""
        vehicle, speed, wheelset = self.vehicle, self.scenario.speed, self.scenario.vehicle.wheelset
        omegas, reaction = [speed / wheelset.radius] * AXLES, [0.0] * AXLES
        masses, others = np.full(AXLES, float(wheelset.mass)), np.zeros(AXLES)
        if seen:
            vehicle.correct([w.position for w in seen], [w.velocity for w in seen])
            omegas, reaction = [w.omega for w in seen], [w.torque for w in seen]
            masses, others = predicted(h, wheelset, seen, vehicle.forces()[0], [w.force for w in seen])
        demand = self.scenario.demand if demand is None else demand
        torques, _ = self.brakes.step(h, demand, [wheelset.radius * omega for omega in omegas])
        now = vehicle.advance(h, reaction, 0.0, masses, others)
        present = vehicle.position, vehicle.velocity
        then = vehicle.advance(h, reaction, 0.0, masses, others)
        vehicle.position, vehicle.velocity = present
        pulls, loads = (0.5 * (a + b) for a, b in zip(now, then))
        names = ("drive.force", "drive.load_change", "brake.torque")
        return [dict(zip(names, values)) for values in zip(pulls, loads - vehicle.static_load, torques)]


class ParallelStop:
    """A coach on a level track with one friction coefficient everywhere: that of the first section of the scenario's."""

    def __init__(self, scenario, fmu):
        self.coach = HeldCoach(scenario)
        load = self.coach.vehicle.static_load
        self.wheelsets = [wheelset(scenario, fmu, load) for _ in range(AXLES)]
        self.seen, self.driven = None, [{} for _ in range(AXLES)]

    def step(self, h):
        """Coach and wheels take a step of `h` [s], each with what the others were at its beginning."""
        driven = self.coach.step(h, self.seen)
        for wheelset, held in zip(self.wheelsets, self.driven):
            wheelset.wheel.set(held)
            wheelset.wheel.step(h)
        self.seen = [self._read(wheelset.wheel) for wheelset in self.wheelsets]
        self.driven = driven

    def _read(self, wheel):
        """What the coach knows of a wheelset."""
        return SimpleNamespace(**dict(zip(("position", "velocity", "omega", "force", "torque"), wheel.get(*READ))))

    def close(self):
        """Frees the wheelsets."""
        for wheelset in self.wheelsets:
            wheelset.close()


def friction(scenario):
    """Friction of the first section of the track."""
    track = scenario.track
    return track.conditions[track.sections.condition[0]].friction


def wheelset(scenario, fmu, load):
    """A wheelset in the FMU at the friction of the first section."""
    parameters = scenario.wheel | {"rail.friction": friction(scenario)}
    damping = scenario.vehicle.primary.vertical_damping
    return FmuWheelset(fmu, scenario.vehicle.wheelset, load, scenario.speed, damping, parameters)
