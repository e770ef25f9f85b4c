"""What a slide leaves in a wheel: found by itself, told as text, record, file and page, and still cooling until it is not."""

import csv

import numpy as np
import pytest

xarray = pytest.importorskip("xarray", reason="xarray is not installed (requirements/records.txt)")

import wheelrail
from wheelrail import damage, page
from wheelrail.__main__ import main

BELOW = ["peak_temperature", "martensite", "temperature_hottest_below"]
# A rail on a track: on a rigid base the wheel bounces for ever once its flat has struck.
TRACK = {"rail.support_stiffness": 81e6, "rail.support_damping": 120e3, "rail.support_mass": 400.0}


@pytest.fixture(scope="module")
def slid(fmu):
    """A wheel locked for 0.2 s at 54 km/h: its record to the end of the slide, that until all is cold, and what else was read."""
    parameters = {"initial.velocity": 15.0} | TRACK
    inputs = {"control.translation": "velocity", "control.rotation": "velocity", "drive.velocity": 15.0}
    with wheelrail.Wheel(fmu, parameters, inputs) as wheel:
        record, omega = wheel.record(depth=BELOW), wheel.get("wheel.omega")
        for k in range(220):
            wheel.set({"drive.omega": omega * max(0.0, 1.0 - (k + 1) / 20)})
            wheel.step(1e-3)
        hot = record.dataset()
        wheel.set({"control.rotation": "moment", "drive.moment": 0.0})
        for _ in range(200):
            wheel.step(1e-3)
        wheel.set({"thermal.tread_point": wheel.get("damage.hottest_point")})
        wheel.step(1e-3)
        both = [wheel.profile(f"temperature_{which}_below") for which in ("hottest", "tread")]
        took = damage.settle(wheel)
        return hot, record.dataset(), both, took


def test_steel_cools_until_it_does_not_any_more(slid):
    hot, cold, _, took = slid
    before, after = damage.report(hot), damage.report(cold)
    print("\n".join(after.lines()), f"\ncold {took:.2f} s after the release")
    assert not before.final and before.hot_places == 1 and "still cooling" in before.lines()[0]
    # Only at the edge, where the patch has moved on, steel is cold before the wheel is released.
    assert before.martensite_depth < 0.2 * after.martensite_depth and before.cooling_rate == 0.0
    # Of steel that was above Ac1 and is hot no hardness is told, and no martensite is compared with that of others.
    hidden = np.isnan(before.hardness)
    assert hidden.any() and (before.depth[hidden] <= before.ac1_depth).all() and not before.martensite[hidden].any()
    assert not np.isnan(after.hardness).any() and not any("HV" in here for _, here, _ in before.comparisons())
    assert dict(before.rows())["largest hardness"].endswith(("so far", "not known before it is cold"))
    assert after.final and took > 0.1 and "cold: the findings are final" in after.lines()[0]
    assert after.flats == 1 and after.hottest > 1000.0 and after.flat_depth > 1e-6 and after.flat_length > 1e-3


def test_the_hottest_place_is_found_without_a_second_run(slid):
    _, cold, (hottest, tread), _ = slid
    np.testing.assert_allclose(hottest, tread, rtol=1e-12)
    assert hottest[0] > float(cold["temperature.wheel_bulk"][-1]) + 20.0
    below = cold["profile.temperature_hottest_below"]
    # The highest temperatures so far are those of this place but for the edge of the flat at the surface.
    deep = (cold["depth"] > 3e-4) & (cold["depth"] < 3e-3)
    np.testing.assert_allclose(below.max("time")[deep], cold["profile.peak_temperature"][-1][deep], rtol=0.03)


def test_martensite_over_the_depth_ends_at_its_depth_and_is_as_hard_as_its_share(slid):
    found = damage.report(slid[1])
    assert found.martensite_depth > 1e-4 and found.ac1_depth >= found.martensite_depth
    spacing = np.gradient(found.depth)
    inside, beyond = found.depth < found.martensite_depth - spacing, found.depth > found.martensite_depth + spacing
    assert inside.sum() > 3 and (found.martensite[inside] >= 0.5).all() and (found.martensite[beyond] < 0.5).all()
    assert found.cooling_rate > 50.0
    carbon = 127.0 + 949.0 * 0.5 + 27.0 * 0.35 + 11.0 * 0.75 + 16.0 * 0.25 + 21.0 * np.log10(3600.0 * found.cooling_rate)
    np.testing.assert_allclose(found.hardness, 260.0 + found.martensite * (carbon - 260.0), rtol=1e-12)
    assert 700.0 < found.hardness.max() < 800.0 and found.hardness[-1] == 260.0
    assert damage.hardness(np.array([1.0]), found.cooling_rate, {"C": 0.8})[0] > found.hardness.max()


def test_hardness_has_the_terms_of_maynier_dollet_and_bastien_and_is_the_mean_of_a_mixture():
    steel = {"C": 0.4, "Si": 1.6, "Mn": 2.0, "Ni": 3.5, "Cr": 2.2}
    quenched = 127.0 + 949.0 * 0.4 + 27.0 * 1.6 + 11.0 * 2.0 + 8.0 * 3.5 + 16.0 * 2.2 + 21.0 * np.log10(200.0 * 3600.0)
    found = damage.hardness(np.array([1.0, 0.25, 0.0]), 200.0, steel, 250.0)
    np.testing.assert_allclose(found, [quenched, 0.25 * quenched + 0.75 * 250.0, 250.0], rtol=1e-12)
    assert damage.BASE == 260.0 and damage.STEEL == {"C": 0.50, "Mn": 0.75, "Cr": 0.25, "Si": 0.35, "Ni": 0.0}


def test_observations_of_others_stand_beside_what_was_found_with_their_sources(slid):
    sources = {source for *_, source in damage.report(slid[1]).comparisons()}
    assert sources == {damage.SILINGE, damage.RAIL, damage.GALTON}
    used = damage.report(slid[1]).used
    assert 0.0 < used < 1.0 / 3.0
    with pytest.raises(damage.NoDamage, match="no damage.peak_temperature: make it with depth=True"):
        damage.report(slid[1][["wheel.velocity"]])


def test_a_wheel_that_rolled_is_cold_and_has_nothing_to_compare(fmu):
    run = wheelrail.simulate({"initial.velocity": 20.0}, {"brake.torque": 4000.0}, stop=5e-3, depth=True, fmu=fmu, progress=False)
    found = damage.report(run)
    assert found.flats == 0 and found.final and found.comparisons() == [] and found.used is None
    assert "no place was heated in one piece" in found.lines()[0] and not found.martensite.any()


def test_the_report_is_a_command_a_file_and_a_section_of_the_page(slid, tmp_path, capsys):
    wheelrail.save(slid[1], tmp_path / "slide.nc")
    main(["damage", str(tmp_path / "slide.nc")])
    found, text = damage.report(slid[1]), capsys.readouterr().out
    assert f"{1e3 * found.martensite_depth:.3f} mm" in text and f"written: {tmp_path / 'slide_damage.csv'}" in text
    with open(tmp_path / "slide_damage.csv") as file:
        rows = list(csv.DictReader(file))
    np.testing.assert_allclose([float(row["hardness"]) for row in rows], found.hardness, rtol=1e-8)
    with open(tmp_path / "slide_damage_columns.csv") as file:
        assert [row["column"] for row in csv.DictReader(file)] == list(rows[0])
    if not page.drawable():
        pytest.skip("plotly is not installed")
    html = page.write(tmp_path / "slide.html", slid[0].isel(time=slice(None, None, 10))).read_text(encoding="utf-8")
    assert '<section id="damage">' in html and "Steel still cools" in html
    with pytest.raises(SystemExit):
        main(["damage", str(tmp_path / "slide_damage.csv")])
