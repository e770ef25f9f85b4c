"""An axle with two different wheels: one speed, one angular velocity, forces that add up, and each wheel what it is alone."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from wheelrail import Refused, Wheel, scenario
from wheelrail.axle import SAME, TwoWheels
from wheelrail.files import BadFile
from wheelrail.train import Stop, columns
from wheelrail.wheelset import WHEELS, Drive, FmuWheelset, parameters_of

TRAIN = Path(__file__).parent.parent / "examples" / "train"
AXLE = SimpleNamespace(mass=1500.0, inertia=120.0, radius=0.46)
LOAD, SPEED, STEP = 109e3, 15.0, 0.005
SMALL = {"mesh.elements_per_half_width": 6, "model.nominal_load": 54.5e3}
# Internal steps that do not depend on what is between the wheels: speeds are smooth functions of it.
COLD = SMALL | {"thermal.enabled": False, "solver.tolerance": 0.0}


def drive(friction, torque=0.0, force=0.0, before=None):
    return Drive((force, force), (LOAD, LOAD), (torque if before is None else before, torque), friction)


def apart(axle, seen):
    """Difference of the speeds of both wheels over the speed, along the track and of the treads."""
    (a, b) = (side.wheel.get("wheel.velocity", "wheel.omega") for side in axle.sides)
    return max(abs(a[0] - b[0]), AXLE.radius * abs(a[1] - b[1])) / max(seen.velocity, 0.1)


@pytest.fixture
def axle(fmu):
    """A maker of axles with two wheels, which are closed in the end."""
    made = []

    def make(left, right, right_friction=1.0):
        made.append(TwoWheels(fmu, AXLE, LOAD, SPEED, 0.0, (left, right), right_friction))
        return made[-1]

    yield make
    for one in made:
        one.close()


def test_two_equal_wheels_are_the_one_that_stands_for_both(fmu, axle):
    ellipse = SMALL | {"preset": "railway_ellipse"}
    pair, one = axle(ellipse, ellipse), FmuWheelset(fmu, AXLE, LOAD, SPEED, 0.0, ellipse)
    torques = np.concatenate([[0.0], np.linspace(400.0, 12000.0, 12), [12000.0] * 60])
    for before, torque in zip(torques, torques[1:]):
        seen, alone = (wheels.step(STEP, drive(0.15, torque, before=before)) for wheels in (pair, one))
        assert pair.attempts == 1 and np.all(pair.between == 0.0)
        assert seen == pytest.approx(alone, rel=1e-12)
    assert seen.omega * AXLE.radius < 0.9 * seen.velocity, "it slides"
    one.close()


def test_speeds_are_one_and_momentum_is_that_of_the_axle_when_one_rail_is_slippery(axle):
    pair, friction, ratio = axle(COLD, COLD | {"preset": "railway_ellipse"}, 0.2), 0.3, 0.2
    torque, force = 8000.0, 2000.0
    before = SPEED, SPEED / AXLE.radius
    gained, given, most = np.zeros(2), np.zeros(2), 0
    last = None
    for k in range(80):
        seen = pair.step(STEP, drive(friction, torque * min(1.0, (k + 1) / 20), force, torque * min(1.0, k / 20)))
        assert apart(pair, seen) < 1.01 * SAME
        most = max(most, pair.attempts)
        if last:
            given += STEP * np.array([force + 0.5 * (seen.force + last.force), 0.5 * (seen.torque + last.torque) - AXLE.radius * 0.5 * (seen.force + last.force)])
            gained += np.array([AXLE.mass * (seen.velocity - last.velocity), AXLE.inertia * (seen.omega - last.omega)])
        last = seen
    halves = [side.wheel.get("contact.force_x") for side in pair.sides]
    print("steps at most", most, "forces", halves, "between", pair.between, "momentum", gained, given)
    assert most <= 4, "a step is repeated a few times"
    assert gained == pytest.approx(given, rel=3e-3)
    # The slippery rail gives all it has, the other one the rest of what the brake takes.
    assert halves[1] == pytest.approx(-ratio * friction * LOAD / WHEELS, rel=0.02)
    assert halves[0] < 3.0 * halves[1] and sum(halves) == pytest.approx(seen.force, rel=1e-12)
    assert seen.velocity < before[0] and AXLE.radius * seen.omega > 0.97 * seen.velocity, "it rolls"


def test_each_wheel_has_the_force_of_the_common_creepage(fmu, axle):
    """Steady braking: both wheels creep alike, and each has the force that it has alone at that creepage."""
    kinds = COLD | {"friction.coefficient": 0.25}, COLD | {"preset": "railway_ellipse", "friction.coefficient": 0.25}
    pair, torque, pull = axle(*kinds), 5000.0, 5000.0 / AXLE.radius
    for k in range(300):
        shares = [min(1.0, at / 40) for at in (k, k + 1)]
        load = Drive(tuple(pull * s for s in shares), (LOAD, LOAD), tuple(torque * s for s in shares), 0.25)
        seen = pair.step(STEP, load)
    creeps = [side.wheel.get("contact.creepage") for side in pair.sides]
    assert creeps[0] == pytest.approx(creeps[1], abs=1e-6)
    forces = [side.wheel.get("contact.force_x") for side in pair.sides]
    assert abs(forces[0] / forces[1] - 1.0) > 0.02, "the wheels differ"
    for kind, force in zip(kinds, forces):
        motion = {"control.rotation": "velocity", "control.translation": "velocity", "drive.velocity": seen.velocity}
        motion |= {"drive.omega": seen.omega, "drive.load": LOAD / WHEELS, "rail.friction": 0.25}
        start = {"initial.velocity": seen.velocity, "initial.creepage": creeps[0], "wheel.radius": AXLE.radius}
        with Wheel(fmu, kind | start, motion) as alone:
            print(f"figure: axle.steady = {force / alone.get('contact.force_x') - 1.0:.1e}")
            print(f"force {force:.1f}, alone {alone.get('contact.force_x'):.1f} N at creepage {creeps[0]:.3e}")
            assert force == pytest.approx(alone.get("contact.force_x"), rel=5e-3)


def test_both_wheels_lock_and_roll_again_together(axle):
    pair = axle(COLD, COLD | {"preset": "railway_ellipse"}, 0.3)
    torques = [*np.linspace(0.0, 30e3, 21), *[30e3] * 20, *np.linspace(30e3, 0.0, 11), *[0.0] * 300]
    turning, most = [], 0
    for before, torque in zip(torques, torques[1:]):
        seen = pair.step(STEP, drive(0.1, torque, before=before))
        turning.append(seen.omega)
        most = max(most, pair.attempts)
        assert apart(pair, seen) < 1.01 * SAME
    print("steps at most", most)
    assert min(turning) == pytest.approx(0.0, abs=1e-9) and max(turning) > 30.0
    assert turning[-1] * AXLE.radius == pytest.approx(seen.velocity, rel=2e-3)


def test_a_train_takes_two_wheels_from_its_scenario(fmu):
    changes = {"speed": 3.0, "step": 0.01, "brake.fill_time": 0.2, "brake.delay": 0.0, "right_friction": 0.5}
    changes |= {"wheel.mesh.elements_per_half_width": 6, "right_wheel.preset": "railway_ellipse"}
    loaded = scenario.load(TRAIN / "low_adhesion.json", changes)
    loaded.wheel["model.nominal_load"] = 54.5e3
    run = Stop(loaded, fmu, dry=0.1)
    try:
        for _ in range(40):
            run.step(loaded.step)
        table, names = np.array(run.rows), columns()
        masses = loaded.vehicle
        total = masses.body.mass + masses.body.payload + 2 * masses.bogie.mass + 4 * masses.wheelset.mass
        force = sum(table[:, names.index(f"force_{axle}")] for axle in range(1, 5))
        speed = table[:, names.index("speed")]
        print("speed", speed[-1], "impulse", loaded.step * force.sum(), "momentum", total * (speed[-1] - 3.0))
        assert speed[-1] < 2.95
        # Loads swing by half a percent about the weight.
        assert force.min() > -0.1 * 0.75 * total * 9.86
    finally:
        run.close()


def test_a_wheelset_as_one_fmu_is_as_warm_as_each_of_its_wheels(fmu):
    """Block brakes heat the tread of two wheels: as one FMU they have rim, web, rail heads and blocks of both. Heat spreads sideways over
    twice the depth from a contact of twice the width, so that it leaves the tread somewhat otherwise."""
    rises = []
    for alone in (False, True):
        parameters, wheels = parameters_of(fmu, AXLE, SMALL | {"brake.tread_share": 0.9, "initial.velocity": SPEED}, alone)
        inputs = {"control.translation": "velocity", "drive.load": LOAD * wheels / WHEELS}
        with Wheel(fmu, parameters, inputs) as wheel:
            for k in range(100):
                wheel.set({"brake.torque": 4e3 * wheels / WHEELS * min(1.0, k / 50)})
                wheel.step(0.05)
            rises.append(np.subtract(wheel.get("temperature.wheel_bulk", "temperature.wheel_max"), wheel.get("rail.temperature")))
    (bulk, tread), (bulk_of_one, tread_of_one) = rises
    assert bulk_of_one > 1.0 and bulk == pytest.approx(bulk_of_one, rel=0.05) and tread == pytest.approx(tread_of_one, rel=0.12)


def test_what_two_wheels_cannot_be_is_refused(fmu):
    load = lambda **changes: scenario.load(TRAIN / "low_adhesion.json", {key.replace("__", "."): value for key, value in changes.items()})
    with pytest.raises(BadFile, match="each wheel has its own"):
        load(right_friction=0.5, temperatures__preset="railway_ellipse")
    with pytest.raises(Refused, match="both wheels of a rigid wheelset are equal"):
        Stop(load(right_friction=0.5))
    with pytest.raises(Refused, match="run straight"):
        Stop(load(right_wheel__contact__lateral=True), fmu)
    with pytest.raises(BadFile, match="did you mean contact.shape"):
        scenario.check_wheel(load(right_wheel__contact__shap="line"), fmu.variables)
