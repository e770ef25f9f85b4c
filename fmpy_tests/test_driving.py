"""Driving, braking and control switches through the FMU."""

import itertools

import pytest

from conftest import COARSE
from braking_stop import brake_to_standstill, column


def stop(wheel, step, parameters=None):
    """Braking stop from 10 m/s at 60 % of the adhesion limit."""
    w = wheel({"initial.velocity": 10.0, **(parameters or {})})
    moment = 0.6 * w.get("rail.friction") * w.get("drive.load") * w.get("wheel.radius")
    return brake_to_standstill(w, moment, step)


def test_a_braking_stop_balances_energy_and_does_not_depend_on_the_step(wheel):
    coarse, fine = stop(wheel, 2e-3), stop(wheel, 1e-3)
    distance = [column(table, "wheel.distance")[-1] for table in (coarse, fine)]
    assert distance[0] == pytest.approx(distance[1], rel=1e-3)
    assert abs(column(fine, "solver.energy_residual")[-1]) < 0.01
    assert abs(column(fine, "wheel.velocity")[-1]) < 0.03
    assert column(fine, "contact.utilisation").max() < 0.7


def test_a_wheel_that_is_braked_too_hard_locks_and_slides(wheel):
    w = wheel({"initial.velocity": 10.0, **COARSE})
    w.set({"drive.moment": -2.0 * 0.3 * 1e5 * 0.46})
    while w.get("wheel.omega") > 0.5:
        w.step(1e-3)
        assert w.time < 1.0
    w.set({"control.rotation": "velocity", "drive.omega": 0.0})
    for _ in range(50):
        w.step(1e-3)
    assert w.get("wheel.velocity") > 5.0
    assert w.get("contact.creepage") == 2.0
    assert w.get("contact.utilisation") == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    ("rotation", "translation", "vertical"),
    list(itertools.product(["moment", "velocity"], ["force", "velocity"], ["force", "displacement"])),
)
def test_every_control_continues_the_present_motion_when_switched_to(wheel, rotation, translation, vertical):
    w = wheel({"initial.creepage": 5e-4, **COARSE}, {"control.rotation": "velocity", "control.translation": "velocity"})
    names = ("contact.force_x", "contact.force_y", "wheel.velocity", "wheel.omega", "hub.moment", "hub.force_x")
    for _ in range(50):
        w.step(1e-3)
    before = w.get(*names)
    w.set({"control.rotation": rotation, "control.translation": translation, "control.vertical": vertical})
    for _ in range(20):
        w.step(1e-3)
        now = w.get(*names)
        assert now[0] == pytest.approx(before[0], abs=1e-4 * before[1])
        assert now[1] == pytest.approx(before[1], rel=1e-4)
        assert now[2:4] == pytest.approx(before[2:4], rel=1e-6)
        assert now[4] == pytest.approx(before[4], abs=1e-3 * before[1])
        assert now[5] == pytest.approx(before[5], abs=1e-3 * before[1])


def test_a_wheel_starts_from_rest_and_reverses(wheel):
    w = wheel({"initial.velocity": 0.0, **COARSE})
    assert w.get("contact.creepage") == 0.0
    for force in (5000.0, -5000.0):
        w.set({"drive.force": force})
        for _ in range(600):
            w.step(1e-3)
            assert abs(w.get("contact.utilisation")) < 0.5
    assert w.get("wheel.velocity") == pytest.approx(0.0, abs=0.01)
    for _ in range(200):
        w.step(1e-3)
    velocity, omega = w.get("wheel.velocity", "wheel.omega")
    assert velocity < -0.05
    assert w.get("wheel.radius") * omega == pytest.approx(velocity, rel=1e-3, abs=1e-3)


def test_without_load_the_contact_opens(wheel):
    w = wheel(COARSE)
    w.set({"drive.load": 0.0})
    lowest = 1e9
    for _ in range(100):
        w.step(1e-4)
        lowest = min(lowest, w.get("contact.force_y"))
    assert lowest == 0.0
