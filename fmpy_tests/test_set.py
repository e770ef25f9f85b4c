"""Sets of coaches with couplers, and rails that are not smooth: conservation laws and closed forms, on rigid wheelsets."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from wheelrail import report, scenario
from wheelrail.files import BadFile
from wheelrail.train import AXLES, Stop
from wheelrail.vehicle import BODY, SIZE, Coach

LOW_ADHESION = Path(__file__).parent.parent / "examples" / "train" / "low_adhesion.json"


@pytest.fixture
def low_adhesion():
    """The scenario of `make train`."""
    return scenario.load(LOW_ADHESION)


def collision(vehicle, step, steps, damping):
    """Two coaches that roll freely; the second is 1 m/s faster. The set, its momentum [N s], its energy and what the dampers took [J], by step."""
    vehicle.coupler.damping = damping
    both = Coach(vehicle, 2)
    both.share_after[:] = 0.25  # the trapezoidal rule for wheelsets, too, which keeps energy exactly
    both.start(10.0)
    second = both.along[both.along >= SIZE]
    both.velocity[second] += 1.0
    along, rows = both.along, []
    lost, own = 0.0, both.masses[both.wheelsets]
    for _ in range(steps):
        before = both.velocity
        both.advance(step, np.zeros(2 * AXLES), 0.0, own, np.zeros(2 * AXLES))
        middle = 0.5 * (before + both.velocity)
        lost += step * middle @ both.C @ middle
        rows.append([both.masses[along] @ both.velocity[along], both.energy(), lost, both.coupler_forces()[0]])
    return both, np.array(rows)


@pytest.mark.parametrize("step", [1e-3, 1e-2])
def test_a_collision_keeps_momentum_and_energy(low_adhesion, step):
    both, rows = collision(low_adhesion.vehicle, step, round(1.0 / step), 250e3)
    momentum, energy, lost, force = rows.T
    expected = both.mass * (10.0 + 11.0)
    np.testing.assert_allclose(momentum, expected, rtol=1e-12)
    start = 0.5 * both.mass * (10.0**2 + 11.0**2)
    np.testing.assert_allclose(energy + lost, start, rtol=1e-12)
    # Of the energy of their motion against each other, 0.25 m v^2, the dampers take the larger part within a second.
    assert lost[-1] > 0.5 * 0.25 * both.mass and force.min() < -1e5


def test_the_force_of_a_collision_is_that_of_two_masses(low_adhesion):
    v = low_adhesion.vehicle
    for part in (v.secondary, v.traction_rod, v.primary):
        for name in vars(part):
            if name.endswith("stiffness"):
                setattr(part, name, 1e9)
    both, rows = collision(v, 2e-4, 1500, 0.0)
    # Two masses, one spring: F = v sqrt(k m/2).
    expected = np.sqrt(0.5 * v.coupler.stiffness * both.mass)
    print(f"push {-rows[:, 3].min():.0f} N, two masses {expected:.0f} N")
    assert -rows[:, 3].min() == pytest.approx(expected, rel=0.02)


def test_coaches_of_a_set_brake_as_one_and_push_where_the_brakes_differ(low_adhesion):
    low_adhesion.speed, low_adhesion.step, low_adhesion.hold = 4.0, 0.01, 0.0
    tables = []
    for coaches in (1, 2):
        low_adhesion.coaches = coaches
        run = Stop(low_adhesion, dry=0.3)
        tables.append(run.run())
    one, two = (report.figures(table) for table in tables)
    assert two["stopping distance"][0] == pytest.approx(one["stopping distance"][0], rel=1e-3)
    assert len(two["locked time"][0]) == 2 * AXLES and two["largest coupler push"][0][0] < 0.05
    assert "largest coupler push" not in one

    run = Stop(low_adhesion, dry=0.3)
    run.brakes[1].distributor.brake = SimpleNamespace(**vars(low_adhesion.brake) | {"pressure": 0.0})
    table = run.run()
    time, speed = report.column(table, "time"), report.column(table, "speed")
    steady = (time > 6.0) & (time < 7.0)
    deceleration = -np.polyfit(time[steady], speed[steady], 1)[0]
    w = low_adhesion.vehicle.wheelset
    expected = -(run.coach.mass + AXLES * w.inertia / w.radius**2) * deceleration
    found = report.column(table, "coupler_1")[steady].mean()
    print(f"coupler {found:.0f} N, inertia of the coach that does not brake {expected:.0f} N")
    assert found == pytest.approx(expected, rel=0.01) and found < -1e4


def quiet(low_adhesion, profile):
    """A stop that begins at 20 m/s on rails with a height profile."""
    low_adhesion.track.profile, low_adhesion.speed, low_adhesion.demand = profile, 20.0, 0.0
    low_adhesion.step = 0.005
    return Stop(low_adhesion, dry=0.3)


def test_a_wavy_rail_lifts_the_body_as_the_response_of_the_suspension_says(low_adhesion):
    wave, height = 20.0, 1e-3
    place = np.arange(-60.0, 260.0, 0.25)
    profile = SimpleNamespace(position=list(place), elevation=list(height * np.sin(2.0 * np.pi * place / wave)))
    run = quiet(low_adhesion, profile)
    rows = []
    for _ in range(1600):
        run.step(0.005)
        rows.append([run.contacts.time, run.coach.position[BODY + 1], *report.column(np.array(run.rows[-1:]), "load", 0)])
    time, body, load = np.array(rows)[800:].T
    # Frequency response of the same equations: (K + i w C - w^2 M) q = (k + i w c) times the lift of each axle.
    coach, p, w = run.coach, low_adhesion.vehicle.primary, 2.0 * np.pi * 20.0 / wave
    free = np.delete(np.arange(SIZE), coach.wheelsets)
    lift = height * np.exp(1j * 2.0 * np.pi * (coach.axle_positions - coach.axle_positions[0]) / wave)
    force = -((p.vertical_stiffness + 1j * w * p.vertical_damping) * lift) @ coach.lift_rows
    dynamic = coach.K + 1j * w * coach.C - w * w * np.diag(coach.masses)
    bounce = [1, 2, 4, 5, 7, 8]
    q = np.linalg.solve(dynamic[np.ix_(bounce, bounce)], force[bounce])
    assert set(bounce) <= set(free)
    basis = np.exp(1j * w * time)
    amplitude = 2.0 * abs(np.mean(body * np.conj(basis)))
    print(f"body {amplitude * 1e6:.2f} um, response {abs(q[0]) * 1e6:.2f} um; load swings by {np.ptp(load):.0f} N")
    assert amplitude == pytest.approx(abs(q[0]), rel=0.03) and np.ptp(load) > 100.0


def test_a_height_profile_is_read_and_its_mistakes_are_named(low_adhesion, tmp_path):
    for path in LOW_ADHESION.parent.glob("*.*"):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    track = (tmp_path / "leaves.json").read_text().replace('"length": 3000', '"profile": "rail.csv", "length": 3000')
    (tmp_path / "leaves.json").write_text(track)
    (tmp_path / "rail.csv").write_text("position,elevation\n0,0\n1,0.001\n3,0\n")
    read = scenario.load(tmp_path / "low_adhesion.json").track
    curve = scenario.heights(read)
    height, rate = scenario.elevation(curve, np.array([-5.0, 0.0, 1.0, 3.0, 9.0]), np.full(5, 10.0))
    np.testing.assert_allclose(height, [0.0, 0.0, 0.001, 0.0, 0.0], atol=1e-18)
    # Clamped spline through three points: 2 (1/h1 + 1/h2) s = 3 (d1/h1 + d2/h2) with the chords d.
    np.testing.assert_allclose(rate, [0.0, 0.0, 10.0 * 3.0 * (1e-3 - 0.25e-3) / 3.0, 0.0, 0.0], atol=1e-18)
    places = np.linspace(-0.5, 3.5, 401)
    difference = (scenario.elevation(curve, places + 1e-6, np.ones(401))[0] - scenario.elevation(curve, places - 1e-6, np.ones(401))[0]) / 2e-6
    np.testing.assert_allclose(scenario.elevation(curve, places, np.ones(401))[1], difference, atol=1e-8)
    for text, words in (
        ("position,elevation\n0,0\n0,0.001\n", "rail.csv:3: position 0 m is not beyond 0 m"),
        ("position,elevation\n0,0.5\n", "rail.csv:2: elevation = 0.5 m is outside"),
    ):
        (tmp_path / "rail.csv").write_text(text)
        with pytest.raises(BadFile, match=words):
            scenario.load(tmp_path / "low_adhesion.json")
