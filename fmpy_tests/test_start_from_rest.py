"""Standstill, start, lift-off and reversal are ordinary states."""

import math

import pytest

LOAD = 1e5


def mass(wheel):
    """Translational mass including the inertia of the rolling wheel [kg]."""
    radius, hub, density, width = wheel.get(
        "wheel.radius", "wheel.hub_radius", "material.density", "model.contact_width"
    )
    disc = density * math.pi * (radius**2 - hub**2) * width
    inertia = wheel.get("wheel.hub_inertia") + 0.5 * disc * (radius**2 + hub**2)
    return disc + sum(wheel.get("wheel.hub_mass", "vehicle.mass")) + inertia / radius**2


def test_force_starts_a_resting_wheel(start):
    wheel = start({"initial.velocity": 0.0})
    assert wheel.get("contact.creepage") == 0.0
    wheel.set({"drive.force": 5000.0})
    for _ in range(500):
        wheel.step(1e-3)
    assert wheel.get("wheel.velocity") == pytest.approx(5000.0 / mass(wheel) * 0.5, rel=0.01)
    assert abs(wheel.get("contact.creepage")) < 1e-3


def test_moment_starts_a_resting_wheel_by_traction(start):
    wheel = start({"initial.velocity": 0.0})
    wheel.set({"drive.moment": 5000.0})
    for _ in range(500):
        wheel.step(1e-3)
    expected = 5000.0 / wheel.get("wheel.radius") / mass(wheel) * 0.5
    assert wheel.get("wheel.velocity") == pytest.approx(expected, rel=0.01)
    assert wheel.get("contact.force_x") > 0.0
    assert wheel.get("contact.creepage") < 0.0


def test_without_load_the_wheel_leaves_the_rail_and_comes_back(start):
    wheel = start({"initial.velocity": 20.0})
    for k in range(1, 101):
        wheel.set({"drive.load": LOAD * (1.0 - k / 100)})
        wheel.step(1e-3)
    for _ in range(20):
        wheel.step(1e-3)
    assert wheel.get("contact.force_y") == 0.0
    assert wheel.get("contact.half_width", "contact.adhesion") == [0.0, 0.0]
    for k in range(1, 101):
        wheel.set({"drive.load": LOAD * k / 100})
        wheel.step(1e-3)
    forces = []
    for _ in range(1000):
        wheel.step(1e-3)
        forces.append(wheel.get("contact.force_y"))
    # It lands softly and goes on bouncing, hardly damped, about its load: by less in the second half than in the first.
    first, second = forces[:500], forces[500:]
    assert sum(second) / 500 == pytest.approx(LOAD, rel=1e-3)
    assert max(second) - min(second) < 0.9 * (max(first) - min(first)) < 0.5 * LOAD


def test_raised_hub_carries_nothing(start):
    wheel = start({"initial.velocity": 20.0})
    wheel.set({"control.vertical": "displacement", "drive.displacement": 1e-4})
    for _ in range(20):
        wheel.step(1e-3)
    assert wheel.get("contact.force_y", "contact.half_width", "contact.pressure_max") == [0.0, 0.0, 0.0]


def test_force_against_travel_reverses_the_wheel(start):
    wheel = start({"initial.velocity": 1.0, "vehicle.mass": 1000.0})
    wheel.set({"drive.force": -4000.0})
    for _ in range(800):
        wheel.step(1e-3)
    velocity = wheel.get("wheel.velocity")
    assert velocity == pytest.approx(1.0 - 4000.0 / mass(wheel) * 0.8, rel=0.01)
    assert velocity < 0.0 and wheel.get("wheel.omega") < 0.0
    assert abs(wheel.get("contact.creepage")) < 1e-3
