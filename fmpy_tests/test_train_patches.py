"""A train on any wheel: presets, shapes and choices in its scenario, patches of their own by symmetry, and one beside a line."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from wheelrail import scenario
from wheelrail.files import BadFile
from wheelrail.train import Stop, columns
from wheelrail.wheelset import patches_of

TRAIN = Path(__file__).parent.parent / "examples" / "train"
# Brakes that bite at once lock the wheels on a slippery rail.
SLOW, STEPS, SLIPPERY = {"speed": 3.0, "step": 0.01, "brake.fill_time": 0.2, "brake.delay": 0.0, "brake.wsp.active": False}, 60, 0.08
# Of one wheel under half of an axle's load; heat changes no friction, so that forces compare.
SMALL = {"mesh.elements_per_half_width": 6, "model.nominal_load": 54.5e3, "friction.softening": 0.0}
ELLIPSE = {"preset": "railway_ellipse", **SMALL}


def stop(fmu, wheel, temperatures=()):
    """Table of the beginning of a stop, how many wheels its FMUs are, and the wheelsets in words."""
    loaded = scenario.load(TRAIN / "low_adhesion.json", SLOW)
    loaded.wheel, loaded.temperatures = dict(wheel), dict(temperatures)
    run = Stop(loaded, fmu, dry=SLIPPERY)
    try:
        for _ in range(STEPS):
            run.step(loaded.step)
        return np.array(run.rows), run.contacts.wheelsets[0].wheels, patches_of(fmu, loaded.vehicle.wheelset, loaded.wheel, loaded.temperatures)
    finally:
        run.close()


@pytest.fixture(scope="module")
def stops(fmu):
    """The beginning of a stop on a line, on an ellipse, and on a line with an ellipse beside it."""
    return {"line": stop(fmu, SMALL), "ellipse": stop(fmu, ELLIPSE), "beside": stop(fmu, SMALL, ELLIPSE)}


def column(table, name):
    return table[:, columns().index(name)]


def test_one_wheel_stands_for_both_of_a_wheelset_on_a_patch_of_its_own(stops):
    (line, two, words), (ellipse, one, others) = stops["line"], stops["ellipse"]
    assert (two, one) == (2, 1)
    assert "both wheels as one line" in words and "one wheel with a patch of its own, which stands for both" in others
    way = [column(table, "travelled")[-1] for table in (line, ellipse)]
    assert way[0] > 1.5 and way[1] == pytest.approx(way[0], rel=1e-4)
    for axle in (1, 4):
        # Forces are those of both wheels: what brakes the coach does not depend on how they are computed.
        for name, share in ((f"load_{axle}", 1e-3), (f"force_{axle}", 0.02), (f"torque_{axle}", 1e-3)):
            a, b = (column(table, name) for table in (line, ellipse))
            assert np.abs(a - b).max() < share * np.abs(a).max() > 0.0, name
        assert column(ellipse, f"load_{axle}")[0] > 80e3
    spent = [column(table, "energy_1")[-1] for table in (line, ellipse)]
    print("friction energy of an axle:", spent, "J")
    assert spent[0] > 1.0 and spent[1] == pytest.approx(spent[0], rel=0.02)


def test_a_patch_beside_a_line_gives_its_temperatures_and_changes_no_force(stops):
    line, beside, ellipse = (stops[name][0] for name in ("line", "beside", "ellipse"))
    own = [k for k, name in enumerate(columns()) if name.rpartition("_")[0] not in ("hottest", "peak", "ac1_depth")]
    assert np.array_equal(line[:, own], beside[:, own])
    rise = [column(table, "hottest_1").max() - 293.0 for table in (line, beside, ellipse)]
    print("contact warmer by", rise, "K on the line, beside it, on the ellipse")
    assert abs(rise[1] / rise[2] - 1.0) < 0.5 * abs(rise[0] / rise[2] - 1.0)
    assert "temperatures of a wheel beside it (railway_ellipse" in stops["beside"][2]


def test_wheels_take_presets_choices_and_flags_from_files_and_sweeps(fmu, tmp_path):
    shutil.copytree(TRAIN, tmp_path, dirs_exist_ok=True)
    text = json.loads((TRAIN / "low_adhesion.json").read_text())
    text["wheel"] = {"preset": "railway_wet", "contact.shape": "ellipse", "thermal.enabled": False, "solver.tolerance": 0.02}
    text["sweep"] = {"wheel.preset": ["railway", "railway_ellipse"], "track.slope": [0.0, 0.012], "track.sections.1.temperature": [0.0, 20.0]}
    (tmp_path / "scenario.json").write_text(json.dumps(text))
    loaded = scenario.load(tmp_path / "scenario.json")
    assert loaded.wheel == text["wheel"]
    scenario.check_wheel(loaded, fmu.variables)
    for path, value, words in (
        ("temperatures.contact.shap", "ellipse", "wheel: contact.shap is no parameter of the FMU; did you mean contact.shape"),
        ("wheel.solver.tolerance", "fine", "wheel: solver.tolerance = 'fine' is not a number"),
        ("wheel.contact.shape", "circle", "wheel: contact.shape = 'circle' is none of line, ellipse, rows"),
        ("wheel.preset", 3.0, "wheel: preset = 3.0 is not a text"),
    ):
        with pytest.raises(BadFile, match=words):
            scenario.check_wheel(scenario.changed(loaded, {path: value}), fmu.variables)
    text["wheel"] = {"preset": ["a"]}
    (tmp_path / "scenario.json").write_text(json.dumps(text))
    with pytest.raises(BadFile, match="wheel.preset is"):
        scenario.load(tmp_path / "scenario.json")


def test_values_of_sections_are_numbers_of_a_sweep():
    loaded = scenario.load(TRAIN / "low_adhesion.json")
    count = len(loaded.track.sections.position)
    other = scenario.changed(loaded, {"track.sections.2.slope": -0.01, "track.sections.all.temperature": 12.0, "track.slope": 0.004})
    assert other.track.sections.slope == [*loaded.track.sections.slope[:1], -0.01, *loaded.track.sections.slope[2:]]
    assert other.track.sections.temperature == [12.0] * count and loaded.track.sections.temperature != [12.0] * count
    behind = other.track.sections.position[1] - other.track.begin
    assert scenario.slope(other.track, behind + 1.0) == pytest.approx(-0.006)
    for path, value, words in (
        (f"track.sections.{count + 1}.slope", 0.0, f"the track has {count} sections"),
        ("track.sections.2.slop", 0.0, "is no column of the sections; did you mean slope"),
        ("track.sections.0.slope", 0.0, "is no value of a section"),
        ("track.sections.2", 0.0, "is no value of a section"),
        ("track.sections.1.condition", "icy", "'icy' is none of"),
        ("track.sections.2.position", -5.0, "positions of the sections must ascend"),
        ("track.sections.all.slope", 12.0, "outside -0.2 to 0.2"),
    ):
        with pytest.raises(BadFile, match=words):
            scenario.changed(loaded, {path: value})
