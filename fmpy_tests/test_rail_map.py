"""The rail map: what axles leave is what axles behind them meet, by its law, whatever the cells and steps."""

import sys

import numpy as np
import pytest

from conftest import ROOT
from wheelrail.rail_map import RailLaw, RailMap

sys.path.append(str(ROOT / "examples"))
import ex18_next_wheel as example  # noqa: E402

LAW = RailLaw(cleaning_energy=2000.0, sand_friction=0.2, sand_mass=5e-4, width=0.014, effusivity=13580.0)
DEGRADED, RECOVERED = 0.08, 0.15


def rail(cell=0.25, length=100.0, axles=4):
    """A rail in one condition."""
    cells = round(length / cell)
    return RailMap(0.0, cell, [DEGRADED] * cells, [RECOVERED] * cells, LAW, axles)


def test_no_energy_heat_or_sand_is_lost_whatever_the_movements():
    some, rng = rail(), np.random.default_rng(1)
    place, spent = 1.0, 0.0
    for step in range(2000):
        end = place + rng.uniform(-0.01, 0.09)
        energy = rng.uniform(0.0, 500.0)
        some.leave(step % 4, place, end, 1e-3 * step, energy, 2.0 * energy)
        some.lay_sand(step % 4, place, end, 3.0 * energy)
        place, spent = end, spent + energy
    totals = np.array([some.energy.sum(), some.heat.sum() / 2.0, some.sand.sum() / 3.0])
    np.testing.assert_allclose(totals, spent, rtol=1e-12)


@pytest.mark.parametrize("cell", [0.1, 0.25, 1.0])
@pytest.mark.parametrize("step", [0.03, 0.19, 2.0])
def test_the_second_axle_meets_the_law_of_allotta_for_what_the_first_one_spent(cell, step):
    some, per_metre = rail(cell), 700.0
    for start in np.arange(0.0, 90.0, step):
        some.leave(0, start, start + step, 0.0, per_metre * step)
    for place in (10.0, 33.3, 71.9):
        expected = RECOVERED + (DEGRADED - RECOVERED) * np.exp(-per_metre / LAW.cleaning_energy)
        assert some.friction(place, 0) == pytest.approx(DEGRADED, rel=1e-15)
        assert some.friction(place, 1) == pytest.approx(expected, rel=1e-9)
        assert some.friction(place, 3) == pytest.approx(expected, rel=1e-9)


def test_energies_of_several_axles_add_up_and_no_axle_meets_its_own():
    some = rail()
    for axle in range(3):
        some.leave(axle, 0.0, 100.0, 0.0, 100.0 * 300.0)
        expected = RECOVERED + (DEGRADED - RECOVERED) * np.exp(-300.0 * axle / LAW.cleaning_energy)
        assert some.friction(50.0, axle) == pytest.approx(expected, rel=1e-12)


def test_sand_helps_the_axle_it_falls_in_front_of_and_never_lowers_friction():
    some = rail()
    some.lay_sand(1, 0.0, 50.0, 50.0 * LAW.sand_mass)
    assert some.friction(25.0, 0) == pytest.approx(DEGRADED, rel=1e-15)
    assert some.friction(25.0, 1) == pytest.approx(DEGRADED + (0.2 - DEGRADED) * (1.0 - np.exp(-1.0)), rel=1e-12)
    dry = RailMap(0.0, 1.0, [0.4] * 100, [0.4] * 100, LAW, 2)
    dry.lay_sand(0, 0.0, 100.0, 1.0)
    assert dry.friction(50.0, 0) == pytest.approx(0.4, rel=1e-12)


def test_temperature_left_behind_is_that_of_a_half_space_heated_for_an_instant():
    """Against finite differences of the heat equation, layers of 0.02 mm, heat put into the first one."""
    conductivity, capacity, spacing, time_step = 50.0, 7850.0 * 470.0, 2e-5, 5e-6
    some = rail(axles=2)
    heat, age = 400.0, 0.085
    some.leave(0, 0.0, 100.0, 1.0, 0.0, 100.0 * heat)
    temperature = np.zeros(600)
    temperature[0] = heat / LAW.width / (capacity * spacing)
    for _ in range(round(age / time_step)):
        flux = np.diff(temperature, prepend=temperature[0], append=temperature[-1])
        temperature += time_step * conductivity / capacity / spacing**2 * np.diff(flux)
    assert some.temperature(50.0, 0, 1.0 + age) == 0.0
    assert some.temperature(50.0, 1, 1.0 + age) == pytest.approx(temperature[0], rel=0.005)


def test_a_wheel_off_the_map_is_an_error_that_names_the_map():
    with pytest.raises(ValueError, match="100.5 m is off the rail map, 0 to 100 m"):
        rail().friction(100.5, 0)
    with pytest.raises(ValueError, match="leaves the rail map"):
        rail().leave(0, 99.9, 100.2, 0.0, 1.0)


def test_the_second_wheel_of_the_example_brakes_harder_on_what_the_first_one_has_cleaned(fmu):
    met, rail = example.wheels(fmu, 2)
    (wet, cold, first), (cleaned, warm, second) = met
    print(f"{-first:.0f} N, {-second:.0f} N on friction {cleaned:.3f}, {warm:.1f} K")
    assert (wet, cold) == (example.WET, 0.0) and wet < cleaned < example.CLEAN and warm > 1.0
    assert -first < 1.01 * wet * 1e5 and second < 2.0 * first
    assert rail.friction(3.0, 2) - rail.friction(3.0, 1) < 0.1 * (rail.friction(3.0, 1) - wet)
