"""Temperatures and heat through the FMU: balances, plausible slides, bad input."""

import math

import numpy as np
import pytest

from wheelrail import Refused

REFERENCE = 293.0


def test_all_friction_power_becomes_heat(start):
    """Heat flows add up to heat_ratio times friction power. That is traction times slip over the patch, and the work of the
    pressure on the slope of the deformed rail (0.15 % here), less that of expanding material (0.4 %); a sum over the points
    of the profile misses 0.3 % in the cells where slip begins and ends.
    """
    wheel = start({"initial.velocity": 15.0, "thermal.heat_ratio": 0.9})
    friction = heat = 0.0
    for k in range(500):
        wheel.set({"drive.moment": -9000.0 * min(1.0, k / 200)})
        wheel.step(1e-3)
        power, to_wheel, to_rail = wheel.get("heat.friction_power", "heat.to_wheel", "heat.to_rail")
        friction += 1e-3 * power
        heat += 1e-3 * (to_wheel + to_rail)
    print(f"figure: heat.of.friction = {heat / (0.9 * friction) - 1.0:.1e} < 1e-12")
    assert friction > 50.0
    assert heat == pytest.approx(0.9 * friction, rel=1e-6)
    assert abs(wheel.get("solver.heat_residual")) < 1e-6
    x, shear, slip = (np.array(wheel.profile(name)) for name in ("x", "shear", "slip"))
    width = wheel.get("model.contact_width")
    power = -np.sum(shear * slip) * (x[1] - x[0]) * width
    print(f"figure: friction.of.profile = {power / wheel.get('heat.friction_power') - 1.0:.1e}")
    assert power == pytest.approx(wheel.get("heat.friction_power"), rel=1e-2)


def test_rolling_contact_is_hardly_warm_and_a_slide_is_hot(start):
    wheel = start()
    assert wheel.get("temperature.wheel_max") == pytest.approx(REFERENCE, abs=1.0)
    wheel.set({"control.rotation": "velocity", "drive.omega": 0.0})
    wheel.step(0.02)
    for _ in range(200):
        wheel.step(1e-3)
    names = ("wheel_max", "rail_max", "wheel_mean", "rail_mean", "wheel_nominal", "rail_nominal", "wheel_bulk")
    values = dict(zip(names, wheel.get(*(f"temperature.{name}" for name in names))))
    assert all(math.isfinite(value) for value in values.values())
    assert 600.0 < values["wheel_max"] < 3000.0
    assert 600.0 < values["rail_max"] < 3000.0
    assert values["wheel_max"] >= values["wheel_mean"] > values["wheel_bulk"] > REFERENCE
    assert wheel.get("damage.time_above_ac1") > 0.05
    profile = np.array(wheel.profile("temperature_wheel"))
    assert profile.max() == pytest.approx(values["wheel_max"], rel=0.02)


def test_brake_heat_warms_the_tread_and_the_wheel_grows(start):
    wheel = start({"initial.velocity": 20.0})
    cold, bulk = wheel.get("thermal.growth", "temperature.wheel_bulk")
    wheel.set({"drive.tread_heat": 50e3})
    for _ in range(50):
        wheel.step(0.1)
    # 250 kJ in 311 kg of steel with 470 J/(kg K), rim, web and boss, less what the rail takes. A free wheel grows.
    rise = wheel.get("temperature.wheel_bulk") - bulk
    assert 1.5 < rise < 250e3 / 311.0 / 470.0
    growth = wheel.get("thermal.growth") - cold
    assert growth == pytest.approx(1.2e-5 * rise * 0.46, rel=0.01)
    assert abs(wheel.get("solver.heat_residual")) < 1e-6


def test_without_heat_the_mechanics_are_those_of_cold_bodies(start):
    wheel = start({"thermal.enabled": False})
    for _ in range(10):
        wheel.step(1e-3)
    assert wheel.get("temperature.wheel_max") == 0.0
    assert wheel.get("heat.to_wheel") == 0.0
    assert wheel.get("contact.force_y") == pytest.approx(1e5, rel=1e-3)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"thermal.reference": -1.0}, ["thermal.reference", "-1"]),
        ({"thermal.conductance": -1e7}, ["thermal.conductance", "-1e7"]),
        ({"thermal.wheel_excess": -400.0}, ["thermal.wheel_excess", "-400"]),
        ({"material.specific_heat": math.nan}, ["material.specific_heat", "NaN"]),
    ],
)
def test_bad_thermal_parameters_are_refused_by_name(start, parameters, words):
    with pytest.raises(Refused) as refusal:
        start(parameters)
    assert all(word in str(refusal.value) for word in words), refusal.value


def test_heat_that_is_not_a_number_is_refused_and_the_run_goes_on(start):
    wheel = start()
    with pytest.raises(Refused, match="drive.tread_heat"):
        wheel.set({"drive.tread_heat": math.nan})
    wheel.step(1e-3)
    assert wheel.get("temperature.wheel_max") > 0.0


def test_a_temperature_that_is_computed_only_when_read_has_derivatives_by_inputs_and_in_time(start):
    wheel = start({"initial.velocity": 20.0}, {"control.rotation": "velocity", "drive.omega": 42.0})
    wheel.step(1e-3)
    name = "profile.temperature_wheel_below[1]"
    slopes = wheel.derivatives([name, "temperature.wheel_nominal"], {"drive.omega": 1.0})
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-6) and slopes[0] != 0.0
    before = wheel.get(name)
    wheel.set({"brake.torque": 5000.0, "rail.temperature": 320.0})
    wheel.step(1e-3)
    (rate,) = wheel._calls(wheel.slave.getRealOutputDerivatives, [wheel.fmu.variable(name).valueReference], [1])
    assert float(rate) == pytest.approx((wheel.get(name) - before) / 1e-3, rel=1e-9) and rate != 0.0
