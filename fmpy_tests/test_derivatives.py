"""Derivatives through fmpy: outputs by inputs of the last step, outputs by time."""

import pytest

from wheelrail import Refused

STEP = 1e-3
OUTPUTS = ("contact.force_x", "contact.force_y", "contact.moment", "wheel.velocity", "wheel.omega", "hub.moment")


def references(wheel, *names):
    return [wheel.fmu.variables[name].valueReference for name in names]


def derivatives(wheel, unknown, known, seed):
    return wheel._calls(
        wheel.slave.getDirectionalDerivative, references(wheel, *unknown), references(wheel, *known), seed
    )


def drive(wheel, **values):
    wheel.set({f"drive.{name}": value for name, value in values.items()})
    wheel.step(STEP)
    return wheel.get(*OUTPUTS)


@pytest.mark.parametrize(
    ("control", "known", "at", "by"),
    [
        ("moment", "moment", -5000.0, 5.0),
        ("moment", "load", 1.0e5, 10.0),
        ("velocity", "omega", 43.4, 1e-5),
        ("velocity", "velocity", 20.001, 1e-5),
    ],
)
def test_interface_jacobian_is_that_of_the_last_step(start, control, known, at, by):
    """What an iterative master needs: d(force, moment)/d(V, omega), here against the step repeated with other inputs."""
    force = "force" if control == "moment" else "velocity"
    inputs = {"control.rotation": control, "control.translation": force}
    wheel = start({"initial.velocity": 20.0}, inputs | {"drive.velocity": 20.0, "drive.omega": 43.45})
    for _ in range(20):
        drive(wheel, moment=-5000.0, omega=43.4)
    before = wheel.save()
    ends = []
    for value in (at - by, at + by):
        wheel.restore(before)
        ends.append(drive(wheel, **{known: value}))
    wheel.restore(before)
    drive(wheel, **{known: at})
    found = derivatives(wheel, OUTPUTS, [f"drive.{known}"], [1.0])
    for name, value, low, high in zip(OUTPUTS, found, *ends):
        expected = (high - low) / (2.0 * by)
        # Small cross couplings are measured against the size of the output.
        size = max(abs(expected), 1e-5 * abs(high) / by)
        assert abs(value - expected) < 1e-5 * size, f"{name}: {value}, differences {expected}"
    wheel.forget(before)


def test_creepage_slope_at_the_start_is_that_of_carter(start):
    """In Initialization Mode the derivative is that of stationary rolling: dF/dxi = 2 P R/a for small creepage."""
    inputs = {"control.rotation": "velocity", "control.translation": "velocity", "drive.velocity": 20.0}
    wheel = start({"initial.velocity": 20.0}, inputs)
    radius, load, half_width = wheel.get("wheel.radius", "contact.force_y", "contact.half_width")
    (slope,) = derivatives(wheel, ["contact.force_x"], ["drive.omega"], [1.0])
    # xi = 2 (V - R omega)/(V + R omega): d xi/d omega = -R/V at xi = 0; braking creepage gives a negative force.
    assert slope * 20.0 / radius == pytest.approx(2.0 * load * radius / half_width, rel=0.05)


def test_output_derivatives_are_rates(start):
    wheel = start({"initial.velocity": 20.0}, {"drive.force": -2e4})
    for _ in range(50):
        wheel.step(STEP)
    for name, rate in (("wheel.distance", "wheel.velocity"), ("wheel.velocity", "wheel.acceleration")):
        (found,) = wheel._calls(wheel.slave.getRealOutputDerivatives, references(wheel, name), [1])
        assert float(found) == pytest.approx(wheel.get(rate), rel=1e-3)


def test_derivatives_by_outputs_are_refused_by_name(start):
    wheel = start()
    with pytest.raises(Refused, match="contact.force_y is not an input"):
        derivatives(wheel, ["contact.force_x"], ["contact.force_y"], [1.0])


def test_what_is_computed_only_when_read_has_derivatives_by_inputs_and_in_time(start):
    wheel = start({"initial.velocity": 20.0}, {"control.rotation": "velocity", "drive.omega": 42.0})
    wheel.step(STEP)
    name = "profile.temperature_wheel_below[1]"
    slopes = derivatives(wheel, [name, "temperature.wheel_nominal"], ["drive.omega"], [1.0])
    assert slopes[0] == pytest.approx(slopes[1], rel=1e-6) and slopes[0] != 0.0
    before = wheel.get(name)
    wheel.set({"brake.torque": 5000.0, "rail.temperature": 320.0})
    wheel.step(STEP)
    (rate,) = wheel._calls(wheel.slave.getRealOutputDerivatives, references(wheel, name), [1])
    assert float(rate) == pytest.approx((wheel.get(name) - before) / STEP, rel=1e-9) and rate != 0.0
