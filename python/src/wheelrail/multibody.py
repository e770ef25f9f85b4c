"""The coach of a vehicle file in exudyn, a multi-body program: large rotations, gravity and preloaded springs.

It takes the place of `vehicle.Coach` in a stop and has the same methods: `Stop(scenario, fmu, coach=MultibodyCoach(values))`.
Needs `pip install exudyn`. Bodies are rigid in the plane, wheelsets masses that move along the track; springs and dampers
act along the track and upward. A stop calls for one step at a time, after which the wheelsets are put where they really are.
"""

from types import SimpleNamespace

import numpy as np

from .vehicle import AXLES, GRAVITY, Coach


class MultibodyCoach:
    """A coach in exudyn; `values` are those of a vehicle file."""

    def __init__(self, values):
        import exudyn
        from exudyn import itemInterface

        self.exudyn, self.items = exudyn, itemInterface
        self.values = values
        plain = Coach(values)
        self.axle_positions, self.count, self.axles = plain.axle_positions, 1, AXLES
        self.body_mass, self.mass, self.static_load = plain.body_mass, plain.mass, plain.static_load
        self.settings = exudyn.SimulationSettings()
        self.settings.solution.file.write = False
        self.settings.timeIntegration.verboseMode = 0
        self.settings.timeIntegration.numberOfSteps = 1
        self.settings.timeIntegration.generalizedAlpha.computeInitialAccelerations = True

    def start(self, speed):
        """All bodies move at a speed [m/s], springs as under their own weight."""
        exudyn, v = self.exudyn, self.values
        self.mbs = exudyn.SystemContainer().AddSystem()
        self.time, self.connectors = 0.0, []
        inertia = v.body.pitch_inertia * self.body_mass / v.body.mass
        self.body = self._rigid(self.body_mass, inertia, 0.0, v.body.height, speed)
        self.bogies = [
            self._rigid(v.bogie.mass, v.bogie.pitch_inertia, ahead, v.bogie.height, speed)
            for ahead in (v.bogie_half_distance, -v.bogie_half_distance)
        ]
        self.wheelsets = [self._mass(v.wheelset.mass, x, v.wheelset.radius, speed) for x in self.axle_positions]
        self._suspend()
        self.mbs.Assemble()

    def _rigid(self, mass, inertia, x, y, speed):
        """A body that pitches, with its loads: weight and slope, and a moment."""
        add, items = self.mbs, self.items
        node = add.AddNode(items.NodeRigidBody2D(referenceCoordinates=[x, y, 0.0], initialVelocities=[speed, 0.0, 0.0]))
        body = add.AddObject(items.ObjectRigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))
        centre = add.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=[0.0, 0.0, 0.0]))
        force = add.AddLoad(items.LoadForceVector(markerNumber=centre, loadVector=[0.0, -mass * GRAVITY, 0.0]))
        moment = add.AddLoad(items.LoadTorqueVector(markerNumber=centre, loadVector=[0.0, 0.0, 0.0]))
        return SimpleNamespace(body=body, node=node, x=x, y=y, mass=mass, force=force, moment=moment)

    def _mass(self, mass, x, y, speed):
        """A wheelset, which moves along the track."""
        add, items = self.mbs, self.items
        node = add.AddNode(items.Node1D(referenceCoordinates=[0.0], initialVelocities=[speed]))
        body = add.AddObject(items.ObjectMass1D(mass=mass, nodeNumber=node, referencePosition=[x, y, 0.0]))
        marker = add.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=[0.0, 0.0, 0.0]))
        force = add.AddLoad(items.LoadForceVector(markerNumber=marker, loadVector=[0.0, 0.0, 0.0]))
        return SimpleNamespace(body=body, node=node, marker=marker, force=force, x=x, y=y)

    def _marker(self, part, x, y):
        """A point of a pitching body, by its place at the start [m]."""
        place = [x - part.x, y - part.y, 0.0]
        return self.mbs.AddMarker(self.items.MarkerBodyPosition(bodyNumber=part.body, localPosition=place))

    def _connect(self, lower, upper, stiffness, damping, carried=0.0):
        """A spring and a damper between two markers that lie in one place; it carries a weight [N]."""
        offset = [0.0, carried / stiffness[1] if stiffness[1] else 0.0, 0.0]
        connector = self.items.ObjectConnectorCartesianSpringDamper(
            markerNumbers=[lower, upper], stiffness=[*stiffness, 0.0], damping=[*damping, 0.0], offset=offset
        )
        return self.mbs.AddObject(connector)

    def _suspend(self):
        """Secondary suspension and traction rods between body and bogies, primary suspension below them."""
        v = self.values
        s, rod, p = v.secondary, v.traction_rod, v.primary
        half = 0.5 * self.body_mass * GRAVITY
        for bogie in self.bogies:
            at = [(self._marker(part, bogie.x, s.height)) for part in (bogie, self.body)]
            self._connect(*at, (s.longitudinal_stiffness, s.vertical_stiffness),
                          (s.longitudinal_damping, s.vertical_damping), half)  # fmt: skip
            at = [(self._marker(part, bogie.x, rod.height)) for part in (bogie, self.body)]
            self._connect(*at, (rod.stiffness, 0.0), (rod.damping, 0.0))
        carried = 0.5 * (half + v.bogie.mass * GRAVITY)
        self.primary = []
        for axle, wheelset in enumerate(self.wheelsets):
            upper = self._marker(self.bogies[axle // 2], wheelset.x, v.wheelset.radius)
            self.primary.append(
                self._connect(wheelset.marker, upper, (p.longitudinal_stiffness, p.vertical_stiffness),
                              (p.longitudinal_damping, p.vertical_damping), carried)
            )  # fmt: skip

    def speed(self):
        """Of the car body [m/s]."""
        return self._node(self.body.node, self.exudyn.OutputVariableType.Velocity)[0]

    def travelled(self):
        """Way of the car body since the start [m]."""
        return self._node(self.body.node, self.exudyn.OutputVariableType.Displacement)[0]

    def _node(self, node, kind):
        """An output of a node now."""
        return self.mbs.GetNodeOutput(node, kind, self.exudyn.ConfigurationType.Initial)

    def forces(self):
        """What the primary suspension does to each wheelset: along the track [N], and load on the rail [N]."""
        p = self.values.primary
        kinds = (self.exudyn.OutputVariableType.Position, self.exudyn.OutputVariableType.Velocity)
        stiffness = np.array([p.longitudinal_stiffness, p.vertical_stiffness])
        damping = np.array([p.longitudinal_damping, p.vertical_damping])
        weight = self.values.wheelset.mass * GRAVITY
        carried = np.array([0.0, self.static_load - weight])
        found = []
        for axle, wheelset in enumerate(self.wheelsets):
            bogie = self.bogies[axle // 2]
            place = [wheelset.x - bogie.x, self.values.wheelset.radius - bogie.y, 0.0]
            ends = [
                [
                    np.array(self.mbs.GetObjectOutputBody(part.body, kind, local, self.exudyn.ConfigurationType.Initial)[:2])
                    for kind in kinds
                ]
                for part, local in ((bogie, place), (wheelset, [0.0, 0.0, 0.0]))
            ]
            elongation, rate = ends[0][0] - ends[1][0], ends[0][1] - ends[1][1]
            found.append(stiffness * elongation + damping * rate - carried)
        found = np.array(found)
        return found[:, 0], weight - found[:, 1]

    def coupler_forces(self):
        """There are no couplers: a single coach."""
        return np.zeros(0)

    def advance(self, h, torques, slope, wheel_masses, wheel_forces, lifted=None):
        """As `Coach.advance`, on smooth rails."""
        if lifted is not None and np.any(lifted):
            raise ValueError("the coach in exudyn runs on smooth rails: leave profile out of the track")
        slope = float(np.mean(slope))
        mbs, r = self.mbs, self.values.resistance
        speed = self.speed()
        resistance = (r.constant * np.tanh(speed / 0.01) + r.quadratic * speed * abs(speed)) * self.mass * GRAVITY
        for part in (self.body, *self.bogies):
            along = -part.mass * GRAVITY * slope - (resistance if part is self.body else 0.0)
            mbs.SetLoadParameter(part.force, "loadVector", [along, -part.mass * GRAVITY, 0.0])
        for bogie, pair in zip(self.bogies, (torques[:2], torques[2:])):
            mbs.SetLoadParameter(bogie.moment, "loadVector", [0.0, 0.0, float(sum(pair))])
        for wheelset, mass, force in zip(self.wheelsets, wheel_masses, wheel_forces):
            mbs.SetObjectParameter(wheelset.body, "mass", float(mass))
            mbs.SetLoadParameter(wheelset.force, "loadVector", [float(force), 0.0, 0.0])
        self.settings.timeIntegration.startTime, self.settings.timeIntegration.endTime = self.time, self.time + h
        self.exudyn.SolveDynamic(mbs, self.settings, updateInitialValues=True)
        self.time += h
        return self.forces()

    def correct(self, positions, velocities):
        """Wheelsets are where they are found [m, m/s]."""
        data, initial = self.mbs.systemData, self.exudyn.ConfigurationType.Initial
        place, rate = data.GetODE2Coordinates(initial), data.GetODE2Coordinates_t(initial)
        place[-AXLES:], rate[-AXLES:] = positions, velocities
        data.SetODE2Coordinates(place, initial)
        data.SetODE2Coordinates_t(rate, initial)
