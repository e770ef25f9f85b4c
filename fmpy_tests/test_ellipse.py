"""An elliptical patch beside patches of constant width (`examples/ex13_ellipse.py`): what its lines have, and between which it lies."""

from types import SimpleNamespace

import ex13_ellipse as example
import numpy as np
import pytest
from wheelrail.fmu import Refused
from wheelrail.wheelset import whole_wheelset

BRIEF = 0.4  # s


@pytest.fixture(scope="module")
def found(fmu):
    """Every preset of the example under the first part of the brake application."""
    return {preset: example.braked(fmu, preset, BRIEF) for preset in example.PRESETS}


def test_all_presets_carry_the_same_load_and_the_same_brake(found):
    """But for what the wheels' inertia takes."""
    forces = [figures["contact.force_x"] for _, figures, _ in found.values()]
    print(forces)
    expected = -example.TORQUE * BRIEF / example.RAMP / 0.46
    assert forces == pytest.approx([expected] * len(found), rel=0.03)


def test_the_ellipse_lies_between_the_width_for_forces_and_that_for_pressures(found):
    wide, narrow, ellipse = (found[preset][1] for preset in ("railway", "railway_damage", "railway_ellipse"))
    for name in ("contact.creepage", "contact.half_width", "temperature.wheel_max", "heat.friction_power"):
        assert wide[name] < ellipse[name] < narrow[name], name
    # The narrow patch is made for this pressure.
    assert ellipse["contact.pressure_max"] == pytest.approx(narrow["contact.pressure_max"], rel=0.02)


def test_lines_are_longer_hotter_and_more_loaded_towards_the_middle_where_they_stick_most(found):
    _, figures, lines = found["railway_ellipse"]
    assert all(len(values) == 7 for values in lines.values())
    assert sum(lines["force_x"]) == pytest.approx(figures["contact.force_x"], rel=1e-9)
    for name in ("half_length", "pressure_max", "temperature_wheel_max", "stick_fraction"):
        inwards = np.diff(lines[name][:4])
        assert np.all(inwards > 0.0) or (name == "stick_fraction" and np.all(inwards >= 0.0)), name
    # Half an ellipse over the width: both lengths and pressures are those of the middle times sqrt(1 - (2 z/width)^2).
    shape = np.sqrt(1.0 - (2.0 * np.array(lines["position"]) / figures["contact.width"]) ** 2)
    assert np.array(lines["pressure_max"]) == pytest.approx(shape * lines["pressure_max"][3], rel=0.01)
    assert np.array(lines["half_length"]) == pytest.approx(shape * lines["half_length"][3], rel=0.01)


def test_a_wheel_that_runs_towards_its_flange_presses_and_heats_more_than_a_centred_one(found):
    """CONTACT has 1549 MPa and 989 MPa."""
    centred, flange = (found[f"railway_s1002_{offset}"] for offset in ("0mm", "3mm"))
    for name in ("contact.pressure_max", "contact.creepage", "temperature.wheel_max"):
        assert flange[1][name] > centred[1][name], name
    positions, pressures = centred[2]["position"], centred[2]["pressure_max"]
    assert positions == sorted(positions) and max(pressures) == pytest.approx(centred[1]["contact.pressure_max"])
    # Two humps: the throat of the flange presses on its own.
    middle = pressures[positions.index(min(positions, key=abs))]
    assert middle < pressures[-2] < max(pressures)


def test_a_line_of_constant_width_is_the_whole_patch(found):
    for preset in ("railway", "railway_damage"):
        _, figures, lines = found[preset]
        assert lines["pressure_max"] == [figures["contact.pressure_max"]] and lines["position"] == [0.0]


def test_the_example_prints_its_table_and_draws_its_picture(found, tmp_path, capsys):
    example.report(found)
    text = capsys.readouterr().out
    assert all(word in text for word in (*example.PRESETS, "largest pressure [MPa]", "lines of railway_ellipse"))
    example.plot(tmp_path / "ellipse.png", found)
    assert (tmp_path / "ellipse.png").read_bytes().startswith(b"\x89PNG")


def test_a_wheelset_of_two_wheels_in_one_fmu_refuses_an_ellipse(fmu):
    """Twice the width and the load of an ellipse are not two ellipses."""
    wheelset = SimpleNamespace(mass=1800.0, inertia=112.0, radius=0.46)
    assert whole_wheelset(fmu, wheelset, {})["model.contact_width"] == pytest.approx(0.028)
    with pytest.raises(Refused, match="contact.shape = ellipse or rows is the patch of one wheel"):
        whole_wheelset(fmu, wheelset, {"preset": "railway_ellipse"})
    with pytest.raises(Refused, match="contact.shape = ellipse or rows is the patch of one wheel"):
        whole_wheelset(fmu, wheelset, {"preset": "railway_s1002_0mm"})
