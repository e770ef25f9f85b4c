"""The coach in Rust (`coach.fmu`) against the coach in Python, output by output: the same equations, to rounding.

No wheel is computed. Both coaches see the same wheelsets, whose motion is prescribed: they roll, slide, lock, come back and
stand, so that every branch of brake, slide protection and prediction is passed.
"""

import functools
import os
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from fmpy.validation import validate_fmu

from conftest import ROOT
from wheelrail import Fmu, Wheel, scenario, ssp
from wheelrail.brake import Brakes, Valve
from wheelrail.train import predicted
from wheelrail.vehicle import AXLES, Coach

STEP, END = 5e-3, 24.0  # s
TIMES = STEP * np.arange(round(END / STEP))
TOLERANCE = 1e-11  # over the largest value of an output
# Outputs of the coach by axle, and the names of the wheel's inputs they drive.
DRIVEN = {f"axle{k}.{name}": (k - 1, target) for k in range(1, AXLES + 1) for name, target in ssp.TO_WHEEL.items()}


@pytest.fixture(scope="module", params=["2", "3"])
def opened(request, tmp_path_factory):
    """`coach.fmu` of FMI 2.0 and of FMI 3.0, extracted."""
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"
    packed = tmp_path_factory.mktemp("coach") / "coach.fmu"
    ssp.pack_coach(built / "coach", built / "libcoach.so", packed, fmi=request.param)
    assert validate_fmu(str(packed)) == []
    with Fmu(packed) as opened:
        yield opened


def resisted(resistance):
    """The scenario of `make ssp`, with a resistance to motion or without."""
    stop = scenario.load(ROOT / "examples" / "train" / "low_adhesion.json")
    stop.vehicle.resistance.constant, stop.vehicle.resistance.quadratic = 0.002 * resistance, 1e-6 * resistance
    return stop


@pytest.fixture
def stop():
    """The scenario of `make ssp` as it is."""
    return scenario.load(ROOT / "examples" / "train" / "low_adhesion.json")


def demand(time):
    """Share of the full brake: on, released for a while, half on."""
    return 1.0 if time < 9.0 else 0.0 if time < 13.0 else 0.5


def slide(axle, time):
    """Slide of an axle: bursts of their own length per axle, a lock of the last one, all at once for a while."""
    burst = max(0.0, np.sin(0.9 * time + 1.7 * axle)) ** 3
    if axle == 3 and 15.0 < time < 16.0:
        return 1.0
    return 0.002 + 0.3 * burst + (0.25 if 17.0 < time < 21.0 else 0.0) * np.sin(0.25 * np.pi * (time - 17.0)) ** 2


def wheelsets(stop, time):
    """Wheelsets of a coach that brakes evenly and stands two seconds before the end."""
    seen, rate = [], stop.speed / (END - 2.0)
    moving = min(time, END - 2.0)
    velocity = stop.speed - rate * moving
    for axle in range(AXLES):
        omega = velocity * (1.0 - min(1.0, slide(axle, time))) / stop.vehicle.wheelset.radius
        position = stop.speed * moving - 0.5 * rate * moving**2 + 1e-4 * np.sin(3.0 * time + axle)
        force = -1.0e4 * (1.0 + 0.3 * np.sin(2.0 * time + axle)) if velocity > 0.0 else 0.0
        torque = -3.0e3 * (1.0 + 0.1 * np.cos(time + axle)) if velocity > 0.0 else 0.0
        seen.append(SimpleNamespace(position=position, velocity=velocity, omega=omega, force=force, torque=torque))
    return seen


class HeldCoach:
    """The coach of a scenario for a master that holds forces, made of the parts of the package: what `coach.fmu` computes."""

    def __init__(self, scenario):
        self.scenario, self.vehicle = scenario, Coach(scenario.vehicle)
        self.vehicle.start(scenario.speed)
        self.brakes = Brakes(scenario.brake, [scenario.speed] * AXLES)

    def step(self, h, seen, demand):
        """Moves on by `h` [s]; returns what each wheelset gets in the next step, by name of the wheel's input. `seen` are the
        wheelsets at the beginning of the step, `None` in the first one."""
        vehicle, speed, wheelset = self.vehicle, self.scenario.speed, self.scenario.vehicle.wheelset
        omegas, reaction = [speed / wheelset.radius] * AXLES, [0.0] * AXLES
        masses, others = np.full(AXLES, float(wheelset.mass)), np.zeros(AXLES)
        if seen:
            vehicle.correct([w.position for w in seen], [w.velocity for w in seen])
            omegas, reaction = [w.omega for w in seen], [w.torque for w in seen]
            masses, others = predicted(h, wheelset, seen, vehicle.forces()[0], [w.force for w in seen])
        torques, _ = self.brakes.step(h, demand, [wheelset.radius * omega for omega in omegas])
        now = vehicle.advance(h, reaction, 0.0, masses, others)
        present = vehicle.position, vehicle.velocity
        then = vehicle.advance(h, reaction, 0.0, masses, others)
        vehicle.position, vehicle.velocity = present
        pulls, loads = (0.5 * (a + b) for a, b in zip(now, then))
        names = ("drive.force", "drive.load_change", "brake.torque")
        return [dict(zip(names, values)) for values in zip(pulls, loads - vehicle.static_load, torques)]


@functools.cache
def in_python(resistance):
    """Outputs of the coach in Python with a resistance, one row per step: the same for both versions of FMI."""
    stop = resisted(resistance)
    coach, rows, seen = HeldCoach(stop), [], None
    for time in TIMES:
        driven = coach.step(STEP, seen, demand(time))
        brakes, vehicle = coach.brakes, coach.vehicle
        row = {name: driven[axle][target] for name, (axle, target) in DRIVEN.items()}
        row |= {f"axle{k + 1}.pressure": cylinder.pressure for k, cylinder in enumerate(brakes.cylinders)}
        row |= {f"axle{k + 1}.valve": valve.value for k, valve in enumerate(brakes.valves)}
        row |= {"coach.speed": vehicle.speed(), "coach.distance": vehicle.travelled(), "brake.air": brakes.air()}
        row |= {"brake.control_pressure": brakes.distributor.pressure}
        row |= {"brake.reference_speed": brakes.protection.reference}
        rows.append(row)
        seen = wheelsets(stop, time + STEP)
    return rows


def in_rust(stop, times, opened, names):
    """The same of `coach.fmu`."""
    fields = {"distance": "position", "velocity": "velocity", "omega": "omega", "contact_force": "force", "brake_torque": "torque"}
    groups = [[n for n in names if n.endswith(".valve") == whole] for whole in (True, False)]  # whole numbers, real ones
    rows = []
    with Wheel(opened, ssp.coach_values(stop), name="coach") as coach:
        for time in times:
            coach.set({"demand": demand(time)})
            coach.step(STEP)
            rows.append({name: value for group in groups for name, value in zip(group, coach.get(*group))})
            for k, seen in enumerate(wheelsets(stop, time + STEP)):
                coach.set({f"axle{k + 1}.{name}": float(getattr(seen, field)) for name, field in fields.items()})
    return rows


@pytest.mark.parametrize("resistance", [0.0, 1.0])
def test_both_coaches_have_the_same_outputs_to_rounding(opened, resistance):
    stop, expected = resisted(resistance), in_python(resistance)
    names = list(expected[0])
    assert set(names) == {v.name for v in opened.variables.values() if v.causality == "output"}
    found = in_rust(stop, TIMES, opened, names)
    # Every branch has been passed: each valve, a release, an axle that stands and one that is held.
    valves = {row[f"axle{k}.valve"] for row in expected for k in range(1, AXLES + 1)}
    assert valves == {valve.value for valve in Valve}
    control = np.array([row["brake.control_pressure"] for row in expected])
    assert control.max() == stop.brake.pressure and control.min() < 0.8 * control.max() and np.any(np.diff(control) < 0.0)
    worst = {}
    for name in names:
        a, b = (np.array([row[name] for row in rows], float) for rows in (expected, found))
        worst[name] = np.max(np.abs(a - b)) / np.max(np.abs(a))
    largest = max(worst, key=worst.get)
    print(f"largest difference {worst[largest]:.2e} ({largest})")
    assert worst[largest] <= TOLERANCE


def test_parameters_of_the_fmu_are_those_of_the_example_files(stop, opened):
    declared = {v.name: v for v in opened.variables.values() if v.causality == "parameter"}
    written = {name: value for name, value in ssp.coach_values(stop).items() if name != "demand"}
    assert written.keys() == declared.keys()
    different = {n: (float(declared[n].start), v) for n, v in written.items() if float(declared[n].start) != float(v)}
    assert not different
