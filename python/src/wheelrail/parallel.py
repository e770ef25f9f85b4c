"""The master that other people's programs have: everything steps at once, with inputs that hold what came out of the last step.

`train.py` lets forces ramp to what an implicit step of the vehicle has found; a system package (`ssp.py`) gives its FMUs to a
master that cannot. There the coach looks one step further ahead: the wheels hold the mean of the suspension's forces over the
step that comes. Forces of the beginning of a step, held, would swing up in a stiff primary suspension. In the first step wheels
roll at the initial speed without force.

`ParallelStop` has the coach in Python; its equations are those of the FMU in `coach/`, written independently of it.
`Parallel` is the bare algorithm, for any FMUs.
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


class ParallelStop:
    """A coach on a level track with one friction coefficient everywhere: that of the first section of the scenario's."""

    def __init__(self, scenario, fmu):
        self.scenario, self.coach = scenario, Coach(scenario.vehicle)
        self.coach.start(scenario.speed)
        self.brakes = Brakes(scenario.brake, [scenario.speed] * AXLES)
        self.wheelsets = [wheelset(scenario, fmu, self.coach.static_load) for _ in range(AXLES)]
        self.radius = scenario.vehicle.wheelset.radius
        self.seen, self.driven = None, [{} for _ in range(AXLES)]

    def step(self, h):
        """Coach and wheels take a step of `h` [s], each with what the others were at its beginning."""
        driven = self._coach(h)
        for wheelset, held in zip(self.wheelsets, self.driven):
            wheelset.wheel.set(held)
            wheelset.wheel.step(h)
        self.seen = [self._read(wheelset.wheel) for wheelset in self.wheelsets]
        self.driven = driven

    def _read(self, wheel):
        """What the coach knows of a wheelset."""
        return SimpleNamespace(**dict(zip(("position", "velocity", "omega", "force", "torque"), wheel.get(*READ))))

    def _coach(self, h):
        """Moves the coach; returns what its wheelsets get in the next step."""
        coach, seen, wheelset = self.coach, self.seen, self.scenario.vehicle.wheelset
        omegas, reaction = [self.scenario.speed / self.radius] * AXLES, [0.0] * AXLES
        masses, others = np.full(AXLES, float(wheelset.mass)), np.zeros(AXLES)
        if seen:
            coach.correct([w.position for w in seen], [w.velocity for w in seen])
            omegas, reaction = [w.omega for w in seen], [w.torque for w in seen]
            masses, others = predicted(h, wheelset, seen, coach.forces()[0], [w.force for w in seen])
        torques, _ = self.brakes.step(h, self.scenario.demand, [self.radius * omega for omega in omegas])
        now = coach.advance(h, reaction, 0.0, masses, others)
        present = coach.position, coach.velocity
        then = coach.advance(h, reaction, 0.0, masses, others)
        coach.position, coach.velocity = present
        pulls, loads = (0.5 * (a + b) for a, b in zip(now, then))
        names = ("drive.force", "drive.load_change", "brake.torque")
        return [dict(zip(names, values)) for values in zip(pulls, loads - coach.static_load, torques)]

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
