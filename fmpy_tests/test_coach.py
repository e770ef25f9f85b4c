"""The coach as plain equations, on rigid wheelsets: load transfer, stops, slopes, standstill against closed forms."""

from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest

from wheelrail import report, scenario
from wheelrail.train import AXLES, Stop

GRAVITY = 9.81  # m/s2
LOW_ADHESION = Path(__file__).parent.parent / "examples" / "train" / "low_adhesion.json"


@pytest.fixture
def low_adhesion():
    """The scenario of `make train`."""
    return scenario.load(LOW_ADHESION)


def stopped(scenario, dry=0.3):
    """Table of a stop on rigid wheelsets."""
    run = Stop(scenario, dry=dry)
    try:
        return run.run()
    finally:
        run.close()


def distance(table):
    """Stopping distance [m]."""
    return report.figures(table)["stopping distance"][0]


def rolling_mass(v):
    """Mass of the coach with the rotation of its wheelsets [kg]."""
    mass = v.body.mass + v.body.payload + 2 * v.bogie.mass + AXLES * v.wheelset.mass
    return mass, mass + AXLES * v.wheelset.inertia / v.wheelset.radius**2


def closed_form(s):
    """Stopping distance [m] under a brake that waits, lags, builds up linearly and stays."""
    b = s.brake
    a = AXLES * b.torque / s.vehicle.wheelset.radius / rolling_mass(s.vehicle)[1]
    waits, builds = b.delay + b.wsp.fill_time, b.fill_time / 0.95
    left = s.speed - 0.5 * a * builds
    return s.speed * (waits + builds) - a * builds**2 / 6.0 + left**2 / (2.0 * a)


def transfer(v, deceleration):
    """Loads of the four axles of a rigid coach [N]: moments about the pivots and about the rail below each bogie."""
    body, r = v.body.mass + v.body.payload, v.wheelset.radius
    springs = v.secondary.longitudinal_stiffness, v.traction_rod.stiffness
    pull_height = np.dot(springs, [v.secondary.height, v.traction_rod.height]) / sum(springs)
    front = body * deceleration * (v.body.height - pull_height) / (2.0 * v.bogie_half_distance)
    about_rail = 0.5 * body * pull_height + v.bogie.mass * v.bogie.height
    about_rail += 2.0 * (v.wheelset.mass * r + v.wheelset.inertia / r)
    pair = deceleration * about_rail / (2.0 * v.axle_half_distance)
    return rolling_mass(v)[0] * GRAVITY / AXLES + np.array([1, 1, -1, -1]) * front / 2.0 + np.array([1, -1, 1, -1]) * pair


@pytest.mark.parametrize("payload", [0.0, 20000.0])
def test_load_transfer_is_that_of_a_rigid_coach(low_adhesion, payload):
    low_adhesion.vehicle.body.payload, low_adhesion.speed, low_adhesion.step = payload, 15.0, 0.01
    table = stopped(low_adhesion)
    time, speed = report.column(table, "time"), report.column(table, "speed")
    steady = (time > 9.0) & (time < 13.0)
    deceleration = -np.polyfit(time[steady], speed[steady], 1)[0]
    expected = transfer(low_adhesion.vehicle, deceleration)
    static = expected.mean()
    found = np.array([report.column(table, "load", k)[steady].mean() for k in range(AXLES)])
    print(f"figure: load.transfer = {np.abs((found - static) / (expected - static) - 1.0).max():.2e}")
    print(f"deceleration {deceleration:.4f} m/s2, transfer {found - static} N, rigid {expected - static} N")
    assert found.sum() == pytest.approx(AXLES * static, rel=1e-6)
    np.testing.assert_allclose(found - static, expected - static, rtol=0.02)


@pytest.mark.parametrize("speed", [10.0, 38.8889])
def test_a_dry_stop_is_as_long_as_the_closed_form_says(low_adhesion, speed):
    low_adhesion.speed, low_adhesion.step, low_adhesion.hold = speed, 0.01, 0.0
    found, expected = distance(stopped(low_adhesion)), closed_form(low_adhesion)
    print(f"figure: stop.rigid.{speed:.0f} [m] = {expected:.3f}, {found:.3f} ± 0.0005")
    print(f"{speed:g} m/s: {found:.3f} m, closed form {expected:.3f} m")
    assert found == pytest.approx(expected, rel=0.005)


def test_distances_converge_with_the_step(low_adhesion):
    low_adhesion.speed, low_adhesion.hold, low_adhesion.brake.delay, low_adhesion.brake.fill_time = 4.0, 0.0, 0.0, 1.0
    dry, wet = [], []
    for step in (0.01, 0.005, 0.002):
        low_adhesion.step = step
        dry.append(distance(stopped(low_adhesion)))
        wet.append(distance(stopped(low_adhesion, dry=0.09)))
    print(f"dry {dry}, low adhesion {wet}")
    assert dry[1] == pytest.approx(dry[2], rel=0.001)
    assert wet[1] == pytest.approx(wet[2], rel=0.002)
    assert dry[0] == pytest.approx(dry[2], rel=0.003)


def test_a_free_coach_on_a_slope_falls_with_its_rotating_mass(low_adhesion):
    low_adhesion.brake.torque, low_adhesion.track.sections.slope = 0.0, [-0.01, -0.01]
    run = Stop(low_adhesion, dry=0.3)
    for _ in range(1000):
        run.step(0.01)
    mass, rolling = rolling_mass(low_adhesion.vehicle)
    gained = run.coach.speed() - low_adhesion.speed
    run.close()
    assert gained == pytest.approx(10.0 * 0.01 * GRAVITY * mass / rolling, rel=2e-3)


def test_a_stopped_coach_comes_to_rest_and_stays_on_a_slope(low_adhesion):
    low_adhesion.speed, low_adhesion.step, low_adhesion.hold = 5.0, 0.01, 3.0
    low_adhesion.track.sections.slope = [-0.02, -0.02]
    table = stopped(low_adhesion)
    assert max(report.standing(table)) < 0.5
    late = report.column(table, "time") > report.column(table, "time")[-1] - 0.5
    holds = np.mean([report.column(table, "force", k)[late].mean() for k in range(AXLES)])
    assert holds == pytest.approx(-0.02 * GRAVITY * rolling_mass(low_adhesion.vehicle)[0] / AXLES, rel=0.02)


def test_energy_of_a_stop_goes_into_brakes_contacts_and_dampers(low_adhesion):
    v = low_adhesion.vehicle
    for part in (v.primary, v.secondary):
        part.longitudinal_damping = part.vertical_damping = 0.0
    v.traction_rod.damping = 0.0
    low_adhesion.step, low_adhesion.speed, low_adhesion.hold = 0.0025, 8.0, 0.0
    low_adhesion.brake.delay, low_adhesion.brake.fill_time = 0.0, 1.0
    table = stopped(low_adhesion)
    moving = report.column(table, "speed") > 5.0
    last = np.flatnonzero(moving)[-1]
    end = report.column(table, "speed")[last]
    _, rolling = rolling_mass(v)
    lost = 0.5 * rolling * (low_adhesion.speed**2 - end**2)
    spent = 0.0
    for k in range(AXLES):
        omega = report.column(table, "peripheral", k)[: last + 1] / v.wheelset.radius
        power = -report.column(table, "torque", k)[: last + 1] * omega
        spent += np.trapezoid(power, report.column(table, "time")[: last + 1]) + report.column(table, "energy", k)[last]
    print(f"kinetic energy lost {lost:.0f} J, brakes and contacts {spent:.0f} J")
    assert spent == pytest.approx(lost, rel=3e-3)


def test_slide_protection_keeps_wheels_turning_where_they_lock_without(low_adhesion):
    low_adhesion.speed, low_adhesion.step, low_adhesion.hold = 15.0, 0.01, 0.0
    unprotected = deepcopy(low_adhesion)
    unprotected.brake.wsp.active = False
    protected, unprotected = (report.figures(stopped(s, dry=None)) for s in (low_adhesion, unprotected))
    assert max(protected["longest lock"][0]) < 0.4
    assert min(unprotected["longest lock"][0]) > 2.0
    assert max(protected["slide while sliding, p95"][0]) < 40.0
    assert protected["air used"][0] > 1.2 * unprotected["air used"][0]
    assert protected["energy into rail and tread"][0][0] < 0.2 * unprotected["energy into rail and tread"][0][0]


def test_sand_shortens_the_stop(low_adhesion):
    low_adhesion.speed, low_adhesion.hold, low_adhesion.step = 12.0, 0.0, 0.01
    low_adhesion.track.sections.condition = ["contaminated", "contaminated"]
    without = distance(stopped(low_adhesion, dry=None))
    low_adhesion.brake.sander.active = True
    table = stopped(low_adhesion, dry=None)
    print(f"{without:.1f} m without, {distance(table):.1f} m with {report.column(table, 'sand')[-1]:.2f} kg of sand")
    assert distance(table) < 0.97 * without
    assert report.column(table, "sand")[-1] > 0.1
