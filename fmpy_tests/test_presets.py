"""Presets initialise to the stationary state; explicit parameters override them."""

import math

import pytest

from conftest import ROOT
from wheelrail import Refused

PRESETS = (
    "railway",
    "railway_damage",
    "railway_dry",
    "railway_wet",
    "railway_low_adhesion",
    "paper_a",
    "paper_b",
    "paper_c",
    "paper_d",
)


def hertz(wheel):
    """Half width and peak pressure of a cylinder on a plane of the same material."""
    names = ("wheel.radius", "material.youngs_modulus", "material.poissons_ratio")
    radius, youngs_modulus, poissons_ratio = wheel.get(*names)
    line_load = wheel.get("drive.load") / wheel.get("model.contact_width")
    effective_modulus = youngs_modulus / (2.0 * (1.0 - poissons_ratio**2))
    half_width = math.sqrt(4.0 * line_load * radius / (math.pi * effective_modulus))
    return half_width, 2.0 * line_load / (math.pi * half_width)


def test_all_presets_are_tested():
    assert {path.stem for path in (ROOT / "resources").glob("*.json")} == set(PRESETS)


@pytest.mark.parametrize("preset", PRESETS)
def test_preset_starts_in_equilibrium_with_the_hertzian_patch(start, preset):
    wheel = start({"preset": preset})
    half_width, pressure = hertz(wheel)
    assert wheel.get("contact.force_y") == pytest.approx(wheel.get("drive.load"), rel=1e-6)
    assert wheel.get("contact.half_width") == pytest.approx(half_width, rel=5e-3)
    assert wheel.get("contact.pressure_max") == pytest.approx(pressure, rel=5e-3)
    assert wheel.get("wheel.velocity") == wheel.get("initial.velocity")
    wheel.step(1e-3)
    assert wheel.get("contact.force_y") == pytest.approx(wheel.get("drive.load"), rel=1e-3)


@pytest.mark.parametrize("order", [("preset", "wheel.hub_mass"), ("wheel.hub_mass", "preset")])
def test_explicit_parameter_overrides_the_preset_in_any_order(start, order):
    values = {"preset": "paper_d", "wheel.hub_mass": 123.0}
    wheel = start({name: values[name] for name in order})
    assert wheel.get("preset") in ("paper_d", b"paper_d")
    assert wheel.get("wheel.hub_mass") == 123.0
    assert wheel.get("model.contact_width") == 1.0


def test_other_mesh_computes_its_own_basis(start):
    coarse, usual = (start({"mesh.elements_per_half_width": n}) for n in (10, 20))
    assert coarse.get("contact.half_width") == pytest.approx(usual.get("contact.half_width"), rel=5e-3)


def test_outputs_follow_the_inputs_in_initialization_mode(fmu, start):
    light, heavy = start(inputs={"drive.load": 5e4}), start(inputs={"drive.load": 1e5})
    ratio = heavy.get("contact.half_width") / light.get("contact.half_width")
    assert ratio == pytest.approx(math.sqrt(2.0), rel=5e-3)


def test_unknown_preset_is_refused_with_the_known_ones(start):
    with pytest.raises(Refused) as refused:
        start({"preset": "tram"})
    assert all(word in str(refused.value) for word in ("preset", "tram", *PRESETS))
