"""Presets initialise to the stationary state; explicit parameters override them."""

import itertools
import math

import pytest

from conftest import ROOT
from wheelrail import Refused

REAL = ("railway_s1002_0mm", "railway_s1002_3mm")
HERTZIAN = (
    "railway",
    "railway_damage",
    "railway_ellipse",
    "railway_dry",
    "railway_wet",
    "railway_low_adhesion",
    "paper_a",
    "paper_b",
    "paper_c",
    "paper_d",
)

ELLIPSE = 2  # of contact.shape


def hertz(wheel):
    """Half width and peak pressure of a cylinder on a plane of the same material, or of two bodies with curvatures across, too."""
    names = ("wheel.radius", "material.youngs_modulus", "material.poissons_ratio")
    radius, youngs_modulus, poissons_ratio = wheel.get(*names)
    effective_modulus = youngs_modulus / (2.0 * (1.0 - poissons_ratio**2))
    if wheel.get("contact.shape") == ELLIPSE:
        curvatures = [1.0 / r for r in wheel.get("contact.wheel_lateral_radius", "contact.rail_lateral_radius") if r]
        half_axes = ellipse(wheel.get("drive.load"), radius, 1.0 / sum(curvatures), effective_modulus)
        return half_axes[0], 1.5 * wheel.get("drive.load") / (math.pi * math.prod(half_axes))
    line_load = wheel.get("drive.load") / wheel.get("model.contact_width")
    half_width = math.sqrt(4.0 * line_load * radius / (math.pi * effective_modulus))
    return half_width, 2.0 * line_load / (math.pi * half_width)


def ellipse(load, along, across, effective_modulus):
    """Half axes along and across the rail by the relative radii of curvature (Johnson, Contact Mechanics, 3.2 and 4.2).

    The curvatures are 1/R = p0 a b/E times integrals over the potential of the ellipse, which the trapezoidal rule has exactly.
    """
    angles = [math.pi * (k + 0.5) / 400 for k in range(200)]

    def integral(ratio, power):
        terms = (math.sin(p) ** 2 / (math.cos(p) ** 2 + (ratio * math.sin(p)) ** 2) ** power for p in angles)
        return sum(terms) * math.pi / 400

    low, high = 1e-2, 1e2
    while high / low > 1.0 + 1e-12:
        ratio = math.sqrt(low * high)
        wide = integral(ratio, 0.5) / integral(ratio, 1.5) > across / along
        low, high = (low, ratio) if wide else (ratio, high)
    half_axis = (3.0 * load * along * integral(ratio, 0.5) / (math.pi * effective_modulus)) ** (1.0 / 3.0)
    return half_axis, ratio * half_axis


def test_the_elliptical_patch_is_as_wide_as_hertz_says(start):
    wheel = start({"preset": "railway_ellipse"})
    names = ("drive.load", "wheel.radius", "contact.rail_lateral_radius", "material.youngs_modulus", "material.poissons_ratio")
    load, radius, rail, youngs_modulus, poissons_ratio = wheel.get(*names)
    half_axes = ellipse(load, radius, rail, youngs_modulus / (2.0 * (1.0 - poissons_ratio**2)))
    print(f"half axes {1e3 * half_axes[0]:.4f} and {1e3 * half_axes[1]:.4f} mm, width {1e3 * wheel.get('contact.width'):.4f} mm")
    assert wheel.get("contact.width") == pytest.approx(2.0 * half_axes[1], rel=1e-6)


def test_all_presets_are_tested():
    assert {path.stem for path in (ROOT / "resources").glob("*.json")} == {*HERTZIAN, *REAL}


@pytest.mark.parametrize("preset", REAL)
def test_real_patches_have_width_load_and_peak_of_the_rows_of_their_table(start, preset):
    wheel = start({"preset": preset})
    table = (ROOT / "resources" / wheel.get("contact.rows")).read_text().splitlines()
    position, half_length, share = zip(*(map(float, line.split(",")) for line in table[1:]), strict=True)
    gaps = [b - a for a, b in itertools.pairwise(position)]
    width = [0.5 * (left + right) for left, right in zip([gaps[0], *gaps], [*gaps, gaps[-1]], strict=True)]
    load = wheel.get("drive.load")
    pressure = [2.0 * load * s / sum(share) / (math.pi * a * w) for s, a, w in zip(share, half_length, width, strict=True)]
    print(f"{wheel.get('contact.pressure_max') / max(pressure) - 1.0:+.4f} of {1e-6 * max(pressure):.0f} MPa")
    assert wheel.get("contact.width") == pytest.approx(sum(width), rel=1e-6)
    assert wheel.get("contact.pressure_max") == pytest.approx(max(pressure), rel=0.012)
    lines = range(1, wheel.get("contact.lines") + 1)
    assert sum(wheel.get(f"line.force_y[{k}]") for k in lines) == pytest.approx(load, rel=1e-6)
    positions = [wheel.get(f"line.position[{k}]") for k in lines]
    assert positions == sorted(positions) and position[0] <= positions[0] and positions[-1] <= position[-1]
    with pytest.raises(Refused, match=r"contact\.rows: file .*missing\.csv cannot be read"):
        start({"preset": preset, "contact.rows": "missing.csv"})


@pytest.mark.parametrize("preset", HERTZIAN)
def test_preset_starts_in_equilibrium_with_the_hertzian_patch(start, preset):
    wheel = start({"preset": preset})
    half_width, pressure = hertz(wheel)
    assert wheel.get("contact.force_y") == pytest.approx(wheel.get("drive.load"), rel=1e-6)
    assert wheel.get("contact.half_width") == pytest.approx(half_width, rel=5e-3)
    assert wheel.get("contact.pressure_max") == pytest.approx(pressure, rel=5e-3)
    assert wheel.get("wheel.velocity") == wheel.get("initial.velocity")
    wheel.step(1e-3)
    assert wheel.get("contact.force_y") == pytest.approx(wheel.get("drive.load"), rel=1e-3)


def test_other_mesh_computes_its_own_basis(start):
    coarse, usual = (start({"mesh.elements_per_half_width": n}) for n in (10, 20))
    assert coarse.get("contact.half_width") == pytest.approx(usual.get("contact.half_width"), rel=5e-3)
