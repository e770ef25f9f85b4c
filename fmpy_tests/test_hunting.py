"""A wheelset of two FMU wheels by the tables of docs/coupling.md: it hunts as theory says, and all terms together make one balance."""

from dataclasses import dataclass

import ex16_wheelset as example
import numpy as np
import pytest

FREE = {"lateral_stiffness": 0.0, "yaw_stiffness": 0.0}


def test_a_free_wheelset_hunts_at_the_frequency_of_klingel(fmu):
    """At 20 m/s its mass counts little: creep forces hold it on the path that cones roll."""
    found, wheelset = example.coefficients(fmu, 20.0), example.Wheelset(20.0, **FREE)
    expected = example.klingel(wheelset, found[-1])
    rows = example.hunting(fmu, wheelset, 2.5)
    _, frequency = example.growth(rows[:, 0], rows[:, 1])
    print(f"figure: hunting.free [Hz] = {expected:.5f}, {frequency:.5f} ± 0.0005")
    assert frequency == pytest.approx(expected, rel=2e-3)


def test_a_wheelset_on_springs_has_frequency_and_growth_of_linear_theory(fmu):
    """Coefficients are those of steady contact, to which the transient one adds a little damping."""
    expected = example.mode(example.Wheelset(50.0), example.coefficients(fmu, 50.0))
    rows = example.hunting(fmu, example.Wheelset(50.0), 1.5)
    rate, frequency = example.growth(rows[:, 0], rows[:, 1])
    print(f"figure: hunting.springs [Hz] = {expected[1]:.4f}, {frequency:.4f} ± 0.001")
    print(f"figure: hunting.growth [1/s] = {expected[0]:.4f}, {rate:.4f} ± 0.01")
    assert frequency == pytest.approx(expected[1], rel=4e-3) and rate == pytest.approx(expected[0], abs=0.25)


def test_the_mirror_image_of_a_wheelset_is_its_mirror_image(fmu):
    """With the angle of the cones: left-hand wheels are mirror images of right-hand ones, not their negatives."""
    runs = [
        example.hunting(fmu, example.Wheelset(75.0, y=sign * 2e-3, yaw=sign * 2e-3, contact_angle=0.1), 0.1) for sign in (1.0, -1.0)
    ]
    apart = np.abs(runs[0][:, 1:] + runs[1][:, 1:]).max(axis=0) / np.abs(runs[0][:, 1:]).max(axis=0)
    print(f"figure: hunting.mirror = {apart.max():.1e} < 1e-10\napart by {apart} of y, yaw, force, of which {np.abs(runs[0]).max(axis=0)[1:]}")
    assert apart.max() < 1e-9


def test_a_wheel_turned_to_the_right_is_pushed_to_the_right(start):
    """CONTACT, Manchester benchmark A-2.2, yaw 4.8 mrad: 2,961 N to the right of the 3,012 N of friction."""
    parameters = {"preset": "railway_ellipse", "contact.lateral": True, "initial.velocity": 2.0, "thermal.enabled": False}
    inputs = example.Wheelset(2.0, yaw=4.8e-3).inputs(example.RIGHT, 0.46)
    inputs = {"drive.lateral_velocity": inputs["drive.lateral_velocity"], "drive.load": 1e4}
    wheel = start(parameters, example.CONTROL | inputs)
    wheel.step(1e-3)
    force, load = wheel.get("contact.force_z", "contact.force_y")
    print(f"{force / (0.3 * load):.3f} of friction, CONTACT {2961 / 3012:.3f}")
    assert force / (0.3 * load) == pytest.approx(2961 / 3012, abs=0.03)


@dataclass
class OnWheelset:
    """Force and moment of a wheel on its wheelset, about its middle, as the table of docs/coupling.md says."""

    ahead: float
    up: float
    right: float
    clockwise: float
    axle: float
    rolling: float  # lowers the right side


def on_wheelset(felt, moment, side, wheelset, radius):
    """The table, from forces and moment of the contact of a wheel at the angle of its side."""
    along, across, normal, about_normal = felt
    angle, yaw, lever = side * wheelset.contact_angle, wheelset.yaw, side * wheelset.half_spacing
    axle = across * np.cos(angle) - normal * np.sin(angle)
    up = normal * np.cos(angle) + across * np.sin(angle)
    return OnWheelset(
        along * np.cos(yaw) - axle * np.sin(yaw), up, axle * np.cos(yaw) + along * np.sin(yaw),
        -lever * along - about_normal * np.cos(angle), moment + about_normal * np.sin(angle), -radius * axle - lever * up,
    )  # fmt: skip


@pytest.mark.parametrize("side", [example.RIGHT, example.LEFT])
@pytest.mark.parametrize("speed", [20.0, -20.0])
def test_all_terms_together_do_the_work_that_friction_takes(start, side, speed):
    """Creepage along and across, yaw, its rate, contact angle and spin at once, forward and backward, right and left: a wrong sign,
    lever or factor of any term changes the power by percents. The wheel rises along its plane of contact."""
    wheelset = example.Wheelset(speed, y=4e-3, yaw=2e-3, y_rate=0.03, yaw_rate=2.0, half_spacing=0.015, contact_angle=0.3)
    radius = 0.46
    inputs = wheelset.inputs(side, radius)
    wheel = start(example.FIXED | {"initial.velocity": speed}, example.CONTROL | inputs)
    for _ in range(20):
        wheel.step(1e-3)
    felt = wheel.get(*example.FELT)
    angle, omega = inputs["drive.contact_angle"], inputs["drive.omega"]
    moment, friction = wheel.get("contact.moment", "heat.friction_power")
    found = on_wheelset(felt, moment, side, wheelset, radius)
    assert wheelset.forces(side, felt) == pytest.approx([found.right, found.clockwise], rel=1e-12)
    assert moment == pytest.approx(-radius * felt[0], rel=2e-3)
    rise = (wheelset.y_rate * np.cos(wheelset.yaw) - speed * np.sin(wheelset.yaw)) * np.tan(angle)
    powers = np.array([
        found.ahead * speed, found.up * rise, found.right * wheelset.y_rate, found.clockwise * wheelset.yaw_rate, found.axle * omega,
    ])  # fmt: skip
    spin, lateral, moment_y = wheel.get("contact.spin", "contact.lateral_creepage", "contact.moment_y")
    print(f"figure: hunting.power = {powers.sum() / -friction - 1.0:.2e}")
    print(f"powers {powers.round(1)} W, together {powers.sum():.2f} W, friction takes {friction:.2f} W; moment_y {moment_y:.1f} N m")
    assert powers.sum() == pytest.approx(-friction, rel=5e-4)
    assert spin == pytest.approx(inputs["drive.spin"] - np.sin(angle) * omega / speed, rel=3e-3)
    assert lateral == pytest.approx(inputs["drive.lateral_velocity"] / speed, rel=2e-3)
    # What guides the hub is the reaction to all of these, and puts in what friction takes.
    names = ("hub.force_x", "hub.force_z", "hub.moment", "hub.lateral_power", "hub.spin_power", "wheel.velocity", "wheel.omega")
    force_x, force_z, hub_moment, lateral_power, spin_power, velocity, rotation = wheel.get(*names)
    assert [force_x, force_z, hub_moment] == pytest.approx([-felt[0], -felt[1], -moment], rel=1e-3)
    assert force_x * velocity + hub_moment * rotation + lateral_power + spin_power == pytest.approx(friction, rel=2e-3)
    assert spin_power == pytest.approx(moment_y * (inputs["drive.spin"] * velocity - np.sin(angle) * rotation), rel=1e-6)
