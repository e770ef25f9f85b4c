"""A coach on wheelsets in the FMU, at low resolution: stops, slide protection, what the rail remembers, another vehicle."""

from copy import deepcopy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from test_coach import closed_form, distance, rolling_mass
from wheelrail import Refused, report, scenario
from wheelrail.train import AXLES, Stop

LOW_ADHESION = Path(__file__).parent.parent / "examples" / "train" / "low_adhesion.json"


@pytest.fixture
def coach():
    """A short stop with coarse steps."""
    s = scenario.load(LOW_ADHESION)
    s.speed, s.step = 8.0, 0.01
    s.wheel |= {"mesh.elements_per_half_width": 6}
    return s


def stopped(scenario, fmu, dry=None, coach=None):
    """Table and rail of a stop."""
    run = Stop(scenario, fmu, dry, coach)
    try:
        return run.run(), run.contacts.rail
    finally:
        run.close()


def test_a_dry_stop_is_as_long_as_the_closed_form_says_balances_its_energy_and_ends_quietly(coach, fmu):
    table, _ = stopped(coach, fmu, dry=0.3)
    found, expected = distance(table), closed_form(coach)
    print(f"figure: stop.fmu [m] = {expected:.2f}, {found:.2f} ± 0.001\nfigure: stop.standing [kN] = {max(report.standing(table)):.2f}")
    print(f"{found:.3f} m, closed form {expected:.3f} m; standing {report.standing(table)} kN")
    assert found == pytest.approx(expected, rel=0.005)
    assert max(report.standing(table)) < 0.5
    omega = [report.column(table, "peripheral", k) / coach.vehicle.wheelset.radius for k in range(AXLES)]
    brakes = sum(
        np.trapezoid(-report.column(table, "torque", k) * omega[k], report.column(table, "time")) for k in range(AXLES)
    )
    contacts = sum(report.column(table, "energy", k)[-1] for k in range(AXLES))
    kinetic = 0.5 * rolling_mass(coach.vehicle)[1] * coach.speed**2
    print(f"figure: stop.energy.missing = {1.0 - (brakes + contacts) / kinetic:.1e}")
    print(f"kinetic energy {kinetic:.0f} J, brakes {brakes:.0f} J, contacts {contacts:.0f} J")
    # What is missing swings out in the dampers of the vehicle once the wheels stand.
    assert 0.995 * kinetic < brakes + contacts < kinetic


def test_slide_protection_keeps_wheels_turning_where_they_lock_without(coach, fmu):
    coach.track.conditions["contaminated"].friction = 0.05
    coach.track.conditions["contaminated"].recovered = 0.1
    coach.hold, unprotected = 0.0, deepcopy(coach)
    unprotected.brake.wsp.active = False
    protected, rail = stopped(coach, fmu)
    found = report.figures(protected)
    for name in ("stopping distance", "longest lock", "slide while sliding, p95", "mean adhesion while sliding"):
        print(f"{name}: {found[name][0]}")
    assert max(found["longest lock"][0]) < 0.4

    run = Stop(unprotected, fmu)
    turning = True
    while turning and run.contacts.time < 8.0:
        run.step(unprotected.step)
        turning = max(wheelset.omega for wheelset in run.contacts.seen) > 1e-9
    print(f"without protection locked after {run.contacts.time:.2f} s at {run.coach.speed():.2f} m/s")
    assert not turning and run.coach.speed() > 3.0
    run.close()

    # The friction that axles met is the law of what the axles ahead had left there.
    time = report.column(protected, "time")
    ahead = np.array([0.0, -2.56, -19.0, -21.56])
    for axle in range(AXLES):
        met = report.column(protected, "friction", axle)
        chosen = np.flatnonzero((time > 4.0) & (time < 10.0))[::97]
        turned = np.concatenate([[0.0], np.cumsum(0.01 * report.column(protected, "velocity", axle))])
        places = ahead[axle] + turned[chosen]
        expected = [rail.friction(place, axle) for place in places]
        np.testing.assert_allclose(met[chosen], expected, rtol=0.02)
    means = [np.mean(report.column(protected, "friction", k)[(time > 6.0) & (time < 10.0)]) for k in range(AXLES)]
    print(f"mean friction met by axle: {means}")
    assert means[0] == pytest.approx(0.05) and means[1] > 0.052 and means[3] > means[1]


def test_the_coach_in_exudyn_stops_where_its_equations_say(coach, fmu):
    pytest.importorskip("exudyn", reason="pip install -r requirements/train.txt")
    from wheelrail.multibody import MultibodyCoach

    coach.hold = 0.0
    linear, _ = stopped(coach, fmu, dry=0.3)
    bodies, _ = stopped(coach, fmu, dry=0.3, coach=MultibodyCoach(coach.vehicle))
    print(f"{distance(linear):.4f} m, exudyn {distance(bodies):.4f} m")
    assert distance(bodies) == pytest.approx(distance(linear), rel=0.005)
    steady = slice(500, 600)
    for axle in range(AXLES):
        loads = [report.column(table, "load", axle)[steady].mean() for table in (linear, bodies)]
        assert loads[1] == pytest.approx(loads[0], rel=0.005)


def test_a_coach_in_the_fmu_stops_with_a_rigid_one_behind_it_as_both_rigid_ones_do(coach, fmu):
    coach.speed, coach.hold, coach.coaches, coach.fmu_coaches = 4.0, 0.0, 2, [1]
    mixed, _ = stopped(coach, fmu, dry=0.3)
    rigid, _ = stopped(coach, None, dry=0.3)
    hot = [float(report.column(mixed, "hottest", axle)[-1]) for axle in range(2 * AXLES)]
    print(f"figure: stop.mixed [m] = {distance(rigid):.3f}, {distance(mixed):.3f} ± 0.001")
    print(f"{distance(mixed):.3f} m, both rigid {distance(rigid):.3f} m")
    assert min(hot[:AXLES]) > 273.0 and max(hot[AXLES:]) == 0.0
    assert min(report.known(report.figures(mixed)["peak temperature"][0])) > 0.0
    assert distance(mixed) == pytest.approx(distance(rigid), rel=0.005)
    # Momentum of the set: what both coaches lose is what brakes and contacts take from it.
    force = sum(report.column(mixed, "force", axle) for axle in range(2 * AXLES))
    lost = 2.0 * rolling_mass(coach.vehicle)[0] * coach.speed
    assert -np.trapezoid(force, report.column(mixed, "time")) == pytest.approx(lost, rel=0.01)


def test_wheels_in_the_fmu_follow_the_height_profile_of_the_rail(coach, fmu):
    coach.speed, coach.demand, coach.step = 20.0, 0.0, 0.005
    coach.track.profile = SimpleNamespace(position=[0.0, 1.0, 2.0], elevation=[0.0, 1e-3, 1e-3])
    run = Stop(coach, fmu, dry=0.3)
    wheel = run.contacts.wheelsets[0].wheel
    before, heights, loads, pressed = wheel.get("hub.height"), [], [], []
    for _ in range(40):
        run.step(coach.step)
        heights.append(wheel.get("hub.height") - before)
        loads.append(wheel.get("contact.force_y"))
        pressed.append(run.coach.forces()[1][0])
    run.close()
    static, lift = run.coach.static_load, coach.vehicle.primary.vertical_stiffness * 1e-3
    print(f"{heights[-1] * 1e3:.4f} mm, {max(pressed) - static:.0f} N of {lift:.0f} N; {np.mean(loads[-20:]) - np.mean(pressed[-20:]):.0f} N")
    # It climbs 1 mm within 50 ms, squeezes the primary suspension before the bogie follows, and carries what that
    # presses with.
    assert heights[-1] == pytest.approx(1e-3, abs=5e-6) and heights[3] == pytest.approx(2.8e-4, rel=0.1)
    assert 0.3 * lift < max(pressed) - static < lift
    # The contact still rings by 20 kN from the kinks.
    assert np.mean(loads[-20:]) == pytest.approx(np.mean(pressed[-20:]), rel=0.01)


def test_wheelsets_of_a_train_do_not_save_to_one_file(coach, fmu, tmp_path):
    coach.wheel["wheel.profile_save"] = str(tmp_path / "worn.csv")
    with pytest.raises(Refused, match="wheel.profile_save = .*worn.csv': all wheelsets of a train would save to that file"):
        Stop(coach, fmu)
    assert list(tmp_path.iterdir()) == []
