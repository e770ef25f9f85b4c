"""A vehicle of one's own on eight wheels (`examples/ex12_own_vehicle.py`): one impulse, refusals, change of control."""

import ex12_own_vehicle as example
import numpy as np
import pytest
from wheelrail import Refused

COARSE = {"thermal.enabled": False, "mesh.elements_per_half_width": 6}


@pytest.fixture
def coupled(fmu):
    """Makes wagons on their wheels."""
    made = []

    def make(**options):
        made.append(example.Coupled(fmu, parameters=COARSE, **options))
        return made[-1]

    yield make
    for each in made:
        each.close()


def test_steps_of_5_ms_miss_a_ten_thousandth_of_the_change_of_speed_at_most(fmu):
    """The reference has steps of 1 ms, whose own error is a tenth of what is left."""
    found = example.errors(fmu, 1.0, (5e-3,), 1e-3, parameters=COARSE)
    print(found)
    assert found[5e-3, True] < 1e-4
    assert found[5e-3, False] > 20.0 * found[5e-3, True]


def test_the_vehicle_loses_what_the_wheels_get(coupled):
    run = coupled()
    before = run.wagon.momentum()
    for _ in range(60):
        run.step(5e-3)
    lost = before - run.wagon.momentum()
    print(f"the vehicle lost {lost:.6f} N s, the wheels got {run.felt.sum():.6f} N s")
    assert lost > 500.0 and lost == pytest.approx(run.felt.sum(), rel=1e-9)


def test_all_momentum_goes_into_the_brakes(coupled):
    """That of bodies and wheels, with I ω/r of the wheels' rotation: contact forces are inside, the brakes' blocks outside."""
    run, radius = coupled(), example.WHEELSET["radius"]
    mass, inertia = np.array([wheel.get("wheel.mass", "wheel.inertia") for wheel in run.wheels]).T
    assert 2.0 * mass == pytest.approx(example.WHEELSET["mass"]) and 2.0 * inertia == pytest.approx(example.WHEELSET["inertia"])
    whole = lambda: run.wagon.momentum() + mass @ run.seen[1] + inertia @ run.seen[2] / radius
    before = whole()
    for _ in range(120):
        run.step(5e-3)
    expected = 8.0 * example.TORQUE / radius * run.time**2 / (2.0 * example.BUILD)
    print(f"lost {before - whole():.2f} N s of {before:.0f}, brakes {expected:.2f} N s")
    assert before - whole() == pytest.approx(expected, rel=2e-3)


def test_a_refused_step_is_taken_in_halves_by_all(coupled):
    refusing, halves = coupled(), coupled()
    plain = refusing.wheels[5].step

    def refuse(h):
        if h > 4e-3:
            raise Refused("too long")
        plain(h)

    refusing.wheels[5].step = refuse
    for _ in range(3):
        refusing.step(5e-3)
        halves.step(2.5e-3)
        halves.step(2.5e-3)
    assert refusing.rows == halves.rows


def test_a_wheel_that_refuses_for_good_is_named_and_all_stay_where_they_were(coupled):
    run = coupled()
    run.step(5e-3)
    before = run.wagon.v.copy(), [wheel.get(*example.SEEN) for wheel in run.wheels]
    run.wheels[2].set({"control.rotation": "velocity", "drive.omega": 40.0})

    def refuse(h):
        raise Refused("never")

    run.wheels[2].step = refuse
    with pytest.raises(Refused, match="wheel 3 at 0.005 s: never"):
        run.step(5e-3)
    assert [wheel.time for wheel in run.wheels] == 8 * [5e-3]
    np.testing.assert_array_equal(run.wagon.v, before[0])
    assert [wheel.get(*example.SEEN) for wheel in run.wheels] == before[1]


def test_an_axle_seizes_and_turns_again_without_a_jump(coupled):
    run = coupled()
    run.brake = lambda time: np.zeros(8)
    run.step(5e-3)
    omega, speed, moments, forces = run.seen[2][2], run.seen[1][2], [], []
    for k in range(40):
        share = max(1.0 - (k + 1) / 10.0, 0.0)
        run.turn((2, 3), share * omega)
        run.step(5e-3)
        assert run.seen[2][2:4] == pytest.approx([share * omega] * 2, abs=1e-9)
        # What friction of 0.3 and as much of the vehicle do to a wheel in a step, loads that swing included.
        assert abs(run.seen[1][2] - speed) < 5e-3 * 2.0 * 0.3 * 1.5e5 / 650.0
        speed = run.seen[1][2]
        moments.append(run.seen[4][2])
        forces.append(run.seen[3][2])
    # The moment at an instant swings with the rim on the held hub; on average it balances friction.
    held, friction = np.mean(moments[20:]), 0.46 * np.mean(forces[20:])
    print(f"held by {held:.0f} N m, friction {friction:.0f} N m")
    assert held == pytest.approx(friction, rel=0.1) and friction < -1e4
    run.release((2, 3))
    for _ in range(50):
        run.step(5e-3)
    print(f"{run.seen[2][2]:.2f} rad/s of {omega:.2f} 0.25 s after the release")
    assert run.seen[2][2] == pytest.approx(omega, rel=0.02)
