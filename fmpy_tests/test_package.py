"""The archive as other tools see it."""

import math

import pytest
from fmpy.validation import validate_fmu

from conftest import ROOT
from wheel import Refused


def test_validation_finds_no_problem():
    assert validate_fmu(str(ROOT / "target" / "wheelrail.fmu")) == []


@pytest.mark.parametrize("preset", ["railway", "paper_a", "paper_c", "paper_d"])
def test_every_preset_carries_its_load_on_a_hertzian_patch(wheel, preset):
    w = wheel({"preset": preset})
    load, width, radius = w.get("drive.load", "model.contact_width", "wheel.radius")
    modulus = 0.5 * w.get("material.youngs_modulus") / (1 - w.get("material.poissons_ratio") ** 2)
    half_width = math.sqrt(4 * load / width * radius / (math.pi * modulus))
    assert w.get("contact.force_y") == pytest.approx(load, rel=1e-6)
    assert w.get("contact.half_width") == pytest.approx(half_width, rel=5e-3)
    w.step(1e-3)
    assert w.get("contact.force_y") == pytest.approx(load, rel=1e-3)


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("drive.load", math.nan, ["drive.load", "NaN"]),
        ("drive.load", -1.0, ["drive.load", "-1", "0 to"]),
        ("rail.friction", math.inf, ["rail.friction", "inf"]),
    ],
)
def test_a_bad_input_is_refused_by_name_and_the_run_goes_on(wheel, name, value, words):
    w = wheel()
    w.step(1e-3)
    speed = w.get("wheel.velocity")
    with pytest.raises(Refused) as refusal:
        w.set({name: value})
    assert all(word in str(refusal.value) for word in words), refusal.value
    assert w.get("wheel.velocity") == speed
    w.step(1e-3)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [({"wheel.radius": 0.0}, ["wheel.radius", "0.01"]), ({"preset": "monorail"}, ["monorail", "railway", "paper_d"])],
)
def test_bad_parameters_are_refused_with_the_choice_or_range(wheel, parameters, words):
    with pytest.raises(Refused) as refusal:
        wheel(parameters)
    assert all(word in str(refusal.value) for word in words), refusal.value


@pytest.mark.parametrize("step", [0.0, -1e-3, math.nan, 1e9])
def test_an_absurd_step_is_refused_and_the_run_goes_on(wheel, step):
    w = wheel()
    with pytest.raises(Refused, match="communicationStepSize"):
        w._call(w.slave.doStep, 0.0, step)
    w.step(1e-3)
    assert w.get("wheel.velocity") > 0


def test_a_load_beyond_the_contact_zone_names_the_parameter_to_raise(wheel):
    w = wheel()
    w.set({"control.vertical": "displacement"})
    height = -w.get("contact.approach")
    w.set({"drive.displacement": 6 * height})
    with pytest.raises(Refused, match="model.nominal_load"):
        w.step(1e-3)
    w.set({"drive.displacement": height})
    w.step(1e-3)
    assert w.get("contact.force_y") == pytest.approx(1e5, rel=0.05)
