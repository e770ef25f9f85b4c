"""Every choice of prescribed partners runs; partners are each other's reactions; switching makes no jump."""

import itertools

import pytest

from wheelrail import Wheel

V = 20.0  # m/s
CREEPAGE = 5e-4
RADIUS = 0.46
OMEGA = V * (2.0 - CREEPAGE) / (2.0 + CREEPAGE) / RADIUS
LOAD = 1e5
STATE = {"initial.velocity": V}  # the start finds the creepage that belongs to omega or to the moment
KINEMATIC = {"control.rotation": "velocity", "control.translation": "velocity"}


@pytest.fixture(scope="module")
def steady(fmu):
    """Steady braking with prescribed velocities: reactions and approach."""
    with Wheel(fmu, STATE, {**KINEMATIC, "drive.velocity": V, "drive.omega": OMEGA}) as wheel:
        names = ("hub.force_x", "hub.moment", "contact.approach", "contact.force_x")
        return dict(zip(names, wheel.get(*names)))


@pytest.mark.parametrize(
    ("rotation", "translation", "vertical"),
    list(itertools.product(("velocity", "moment"), ("velocity", "force"), ("force", "displacement"))),
)
def test_partner_of_a_reaction_gives_the_same_motion(start, steady, rotation, translation, vertical):
    inputs = {
        "control.rotation": rotation,
        "control.translation": translation,
        "control.vertical": vertical,
        "drive.velocity": V,
        "drive.omega": OMEGA,
        "drive.force": steady["hub.force_x"],
        "drive.moment": steady["hub.moment"],
        "drive.load": LOAD,
        "drive.displacement": -steady["contact.approach"],
    }
    wheel = start(STATE, inputs)
    for _ in range(100):
        wheel.step(1e-3)
    assert wheel.get("wheel.velocity") == pytest.approx(V, rel=1e-6)
    assert wheel.get("wheel.omega") == pytest.approx(OMEGA, rel=1e-6)
    assert wheel.get("hub.force_x") == pytest.approx(steady["hub.force_x"], abs=1e-4 * LOAD)
    assert wheel.get("hub.moment") == pytest.approx(steady["hub.moment"], abs=1e-4 * LOAD * RADIUS)
    assert wheel.get("hub.force_y") == pytest.approx(-LOAD, rel=1e-4)
    assert wheel.get("contact.approach") == pytest.approx(steady["contact.approach"], rel=1e-4)
    assert wheel.get("contact.force_x") == pytest.approx(steady["contact.force_x"], abs=1e-4 * LOAD)


def test_transient_reaction_moment_drives_the_same_transient(start):
    """A creepage ramp in 50 ms: its reaction moment, prescribed to a second wheel, turns it in the same way."""
    free = {"initial.velocity": V}
    leader = start(free, {**KINEMATIC, "drive.velocity": V, "drive.omega": V / RADIUS})
    follower = start(free, {"control.translation": "velocity", "drive.velocity": V})
    follower.set({"drive.moment": leader.get("hub.moment")})
    for k in range(1, 101):
        creepage = 1e-3 * min(1.0, k / 50)
        leader.set({"drive.omega": V * (2.0 - creepage) / (2.0 + creepage) / RADIUS})
        leader.step(1e-3)
        follower.set({"drive.moment": leader.get("hub.moment")})
        follower.step(1e-3)
    assert follower.get("contact.creepage") == pytest.approx(leader.get("contact.creepage"), rel=1e-2)
    assert follower.get("contact.force_x") == pytest.approx(leader.get("contact.force_x"), abs=1e-3 * LOAD)


@pytest.mark.parametrize("switched", ["control.rotation", "control.translation", "control.vertical"])
def test_switching_from_force_to_motion_makes_no_jump(start, switched):
    """A wheel that is being braked; one input goes over to the motion that it has anyway."""
    h = 1e-3
    wheel = start({"initial.velocity": V})
    for k in range(300):
        wheel.set({"drive.moment": -7000.0 * min(1.0, k / 100)})
        wheel.step(h)
    watched = ("contact.force_x", "contact.force_y", "wheel.velocity", "wheel.omega", "hub.moment", "hub.force_x")
    velocity, omega, height = wheel.get("wheel.velocity", "wheel.omega", "contact.approach")
    acceleration, turn = wheel.get("wheel.acceleration", "wheel.angular_acceleration")
    here = wheel.save()
    unswitched = []
    for _ in range(20):
        wheel.step(h)
        unswitched.append(wheel.get(*watched))
    wheel.restore(here)
    wheel.forget(here)
    item = {"control.vertical": "displacement"}.get(switched, "velocity")
    wheel.set({switched: item, "drive.displacement": -height})
    tolerances = (1e-3 * LOAD, 1e-3 * LOAD, 1e-4, 1e-4 / RADIUS, 1e-3 * LOAD * RADIUS, 1e-3 * LOAD)
    for k, expected in enumerate(unswitched, start=1):
        wheel.set({"drive.omega": omega + k * h * turn, "drive.velocity": velocity + k * h * acceleration})
        wheel.step(h)
        for name, value, reference, tolerance in zip(watched, wheel.get(*watched), expected, tolerances):
            assert value == pytest.approx(reference, abs=tolerance), f"{name}, step {k} after the switch"


@pytest.mark.parametrize("vertical", ["force", "displacement"])
def test_a_partner_that_was_never_set_starts_from_its_present_value(start, vertical):
    wheel = start(STATE, KINEMATIC)
    watched = ("contact.force_x", "wheel.velocity", "wheel.omega", "hub.moment")
    for _ in range(20):
        wheel.step(1e-3)
    before = wheel.get(*watched)
    wheel.set({"control.rotation": "moment", "control.translation": "force", "control.vertical": vertical})
    for _ in range(20):
        wheel.step(1e-3)
        assert wheel.get(*watched) == pytest.approx(before, rel=1e-4)
        assert wheel.get("contact.force_y") == pytest.approx(LOAD, rel=1e-4)


def test_every_switch_starts_from_the_present_value(start):
    """Held, braked, held again: the second hold must not return to the velocity of the first."""
    wheel = start({"initial.velocity": V})
    for moment in (-4000.0, -6000.0):
        wheel.set({"control.rotation": "velocity", "control.vertical": "displacement"})
        for _ in range(5):
            wheel.step(1e-3)
        wheel.set({"control.rotation": "moment", "control.vertical": "force", "drive.load": 0.9 * LOAD})
        for k in range(200):
            wheel.set({"drive.moment": moment * min(1.0, k / 100)})
            wheel.step(1e-3)
    before = wheel.get("contact.force_x", "contact.force_y", "wheel.omega")
    wheel.set({"control.rotation": "velocity", "control.vertical": "displacement"})
    wheel.step(1e-3)
    after = wheel.get("contact.force_x", "contact.force_y", "wheel.omega")
    assert after[:2] == pytest.approx(before[:2], abs=5e-3 * LOAD)
    assert after[2] == pytest.approx(before[2], rel=1e-12)
