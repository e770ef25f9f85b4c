"""Bad input is refused in words that name variable, value and range; nothing changes and the run goes on."""

import math

import pytest

from wheelrail import Refused, Wheel

NAN, INF = math.nan, math.inf


@pytest.fixture
def twins(start):
    """Two equal wheels in the middle of a run."""
    pair = [start({"initial.velocity": 20.0}) for _ in range(2)]
    for wheel in pair:
        wheel.set({"drive.moment": -4000.0})
        for _ in range(10):
            wheel.step(1e-3)
    return pair


def assert_still_equal(twins, outputs):
    """The wheel that was given nonsense still runs like its twin."""
    for _ in range(10):
        for wheel in twins:
            wheel.step(1e-3)
    assert twins[0].get(*outputs) == twins[1].get(*outputs)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("drive.moment", NAN, "NaN"),
        ("drive.velocity", INF, "inf"),
        ("drive.load", -1.0, "-1"),
        ("drive.load", NAN, "NaN"),
        ("drive.omega", 1e9, "1e9"),
        ("rail.friction", -0.1, "-0.1"),
        ("control.rotation", 3, "3"),
    ],
)
def test_bad_input_changes_nothing(twins, outputs, name, value, words):
    wheel = twins[0]
    before = wheel.get(name)
    with pytest.raises(Refused) as refused:
        wheel.set({name: value})
    assert name in str(refused.value) and words in str(refused.value)
    assert "range" in str(refused.value)
    assert wheel.get(name) == before
    assert_still_equal(twins, outputs)


@pytest.mark.parametrize("h", [0.0, -1e-3, NAN, INF, 1e9])
def test_absurd_step_changes_nothing(twins, outputs, h):
    wheel = twins[0]
    with pytest.raises(Refused) as refused:
        wheel.step(h)
    assert "communicationStepSize" in str(refused.value)
    assert_still_equal(twins, outputs)


def test_wrong_communication_point_changes_nothing(twins, outputs):
    wheel = twins[0]
    with pytest.raises(Refused, match="currentCommunicationPoint"):
        wheel._calls(wheel.slave.doStep, wheel.time + 0.5, 1e-3)
    assert_still_equal(twins, outputs)


def test_parameter_during_the_run_is_refused(twins, outputs):
    with pytest.raises(Refused, match="wheel.radius"):
        twins[0].set({"wheel.radius": 0.5})
    assert_still_equal(twins, outputs)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("wheel.radius", 0.0),
        ("wheel.radius", NAN),
        ("model.contact_width", -0.014),
        ("material.poissons_ratio", 0.5),
        ("mesh.elements_per_half_width", 1),
        ("initial.creepage", 3.0),
        ("wheel.hub_radius", 0.459),
    ],
)
def test_bad_parameter_is_refused(start, name, value):
    with pytest.raises(Refused) as refused:
        start({name: value})
    words = "NaN" if value != value else f"{value:g}"
    assert name in str(refused.value) and words in str(refused.value) and "range" in str(refused.value)


def test_load_beyond_the_contact_zone_names_load_and_remedy(twins, outputs):
    wheel = twins[0]
    wheel.set({"drive.load": 1e7})
    with pytest.raises(Refused) as refused:
        wheel.step(1e-3)
    assert "model.nominal_load" in str(refused.value)
    wheel.set({"drive.load": 1e5})
    twins[1].set({"drive.load": 1e5})
    assert_still_equal(twins, outputs)


def test_a_load_beyond_the_contact_zone_names_the_parameter_to_raise(start):
    wheel = start()
    height = -wheel.get("contact.approach")
    wheel.set({"control.vertical": "displacement", "drive.displacement": 60 * height})
    with pytest.raises(Refused, match="model.nominal_load"):
        wheel.step(1e-3)
    wheel.set({"drive.displacement": height})
    wheel.step(1e-3)
    assert wheel.get("contact.force_y") == pytest.approx(1e5, rel=0.05)


def test_retired_parameters_are_refused_by_name_with_the_version_that_had_them(fmu):
    with pytest.raises(Refused, match=r"solver.theta was retired in 0.2.0 \(last in 0.1.1\)"):
        Wheel(fmu, {"solver.theta": 0.5})
    with pytest.raises(Refused, match=r"damping.rayleigh_stiffness was retired in .*set their ratios, damping.wheel_torsion"):
        Wheel(fmu, {"damping.rayleigh_stiffness": 1e-5})
