"""Lateral creepage and spin through the FMU: the example, mixed control, states, pages, and what is refused."""

import ex14_angle_of_attack as example
import numpy as np
import pytest
from wheelrail import Refused
from wheelrail.page import film, run
from wheelrail.wheelset import whole_wheelset

ELLIPSE = {"preset": "railway_ellipse", "contact.lateral": True, "contact.lines": 5, "thermal.enabled": False, "initial.velocity": 20.0}
DURATION = 0.3  # s
FORCE_X, FORCE_Z, CREEPAGE, DIRECTION, USED, POWER, HOTTEST = (
    example.SEEN.index(name) + 1
    for name in (
        "contact.force_x", "contact.force_z", "contact.creepage", "contact.slip_direction", "contact.utilisation",
        "heat.friction_power", "temperature.wheel_max",
    )
)  # fmt: skip


@pytest.fixture(scope="module")
def found(fmu):
    """Every angle of the example, up to a twentieth of a second after the wheel has been turned."""
    return {name: example.attacked(fmu, angle, DURATION) for name, angle in example.ATTACKS.items()}


def test_an_angle_of_attack_takes_more_creepage_and_heat_for_the_same_braking_force(found):
    straight, right, left = (rows[-1] for rows, _ in found.values())
    for turned in (right, left):
        print(turned[FORCE_X], straight[FORCE_X], turned[CREEPAGE] / straight[CREEPAGE], turned[HOTTEST] - straight[HOTTEST])
        assert turned[FORCE_X] == pytest.approx(straight[FORCE_X], rel=0.05)
        assert abs(turned[CREEPAGE]) > 1.1 * abs(straight[CREEPAGE]) and turned[POWER] > 2.0 * straight[POWER]
        assert turned[HOTTEST] > straight[HOTTEST] + 10.0 and turned[USED] <= 1.0 + 1e-6
    assert right[FORCE_Z] > 5e3 and left[FORCE_Z] < -5e3 and right[DIRECTION] < 0.0 < left[DIRECTION]


def test_the_example_tells_and_draws_what_it_found(found, tmp_path, capsys):
    example.report(found)
    text = capsys.readouterr().out
    assert all(word in text for word in (*example.ATTACKS, "lateral force [kN]", "direction of slip [deg]"))
    example.plot(tmp_path / "angle.png", found)
    assert (tmp_path / "angle.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("preset", ["railway_s1002_0mm", "railway_s1002_3mm", "railway_ellipse"])
def test_creepages_belong_to_the_centre_of_load_which_an_output_tells(start, preset):
    """It is that of the loads of the lines, in the coordinate of the table, and the same under every load."""
    for load in (1e5, 6e4):
        wheel = start({"preset": preset, "contact.lateral": True, "model.nominal_load": load, "thermal.enabled": False})
        place, loads = np.array(wheel.line("position")), np.array(wheel.line("force_y"))
        told = wheel.get("contact.load_position")
        print(f"{preset} under {load:.0f} N: {1e3 * told:.4f} mm, lines {1e3 * place @ loads / loads.sum():.4f} mm")
        assert told == pytest.approx(place @ loads / loads.sum(), abs=2e-7)
        assert (told == 0.0) == (preset == "railway_ellipse")


def test_lateral_control_changes_without_a_jump(start):
    """A velocity that becomes free under its own reaction stays."""
    wheel = start(ELLIPSE, {"drive.lateral_velocity": 0.02})
    for _ in range(50):
        wheel.step(1e-3)
    velocity, force = wheel.get("wheel.lateral_velocity", "hub.force_z")
    assert velocity == pytest.approx(0.02) and force > 0.0
    wheel.set({"control.lateral": "force"})
    for _ in range(50):
        wheel.step(1e-3)
    assert wheel.get("drive.lateral_force") == pytest.approx(force, rel=1e-12)
    assert wheel.get("wheel.lateral_velocity") == pytest.approx(velocity, rel=1e-2)
    wheel.set({"control.lateral": "velocity"})
    wheel.step(1e-3)
    assert wheel.get("hub.force_z") == pytest.approx(force, rel=1e-2)


def test_a_restored_state_repeats_every_bit(start, outputs):
    def go(wheel):
        record = []
        for k in range(20):
            wheel.set({"drive.lateral_velocity": 0.02 + 0.001 * k, "drive.spin": 0.01 * k, "drive.contact_angle": 0.002 * k})
            wheel.step(5e-4)
            record.append(wheel.get(*outputs))
        return record

    wheel, other = start(ELLIPSE, {"drive.lateral_velocity": 0.02}), start(ELLIPSE)
    go(wheel)
    saved = wheel.save()
    first = go(wheel)
    wheel.restore(saved)
    assert go(wheel) == first
    data = wheel.slave.serializeFMUstate(saved[0])
    other.restore((other.slave.deSerializeFMUstate(data), saved[1]))
    assert go(other) == first


def test_the_page_has_arrows_of_shear_and_slip_of_every_line(start):
    pytest.importorskip("xarray")
    wheel = start(ELLIPSE, {"drive.lateral_velocity": 0.04})
    recorder = wheel.record()
    for _ in range(5):
        wheel.step(1e-3)
    lines = film.of_run(run.of_dataset(recorder.dataset()))["lines"]
    along, across = (np.array(part, float) for part in lines["shear"])
    assert along.shape == across.shape == (6, 5) and (across[-1] < 0.0).all()
    assert np.array(lines["slip"], float).shape == (2, 6, 5) and lines["units"]["shear"] == "MPa"
    straight = start({"preset": "railway_ellipse", "contact.lines": 5, "thermal.enabled": False}).record()
    assert "shear" not in film.of_run(run.of_dataset(straight.dataset()))["lines"]


@pytest.mark.parametrize(
    ("parameters", "inputs", "words"),
    [
        ({"preset": "railway_ellipse"}, {"drive.lateral_velocity": 0.1}, r"drive.lateral_velocity = 0.1.*set contact.lateral = true"),
        ({}, {"drive.spin": 0.1}, r"drive.spin = 0.1.*set contact.lateral = true"),
        ({"contact.lateral": True}, {}, r"contact.shape = line.*set contact.shape = ellipse or rows"),
        (ELLIPSE, {"control.lateral": "force", "drive.lateral_force": 5e4}, r"drive.lateral_force.*adhesion"),
    ],
)
def test_what_is_not_computed_is_refused_with_what_to_set(start, parameters, inputs, words):
    with pytest.raises(Refused, match=words):
        start(parameters, inputs).get("contact.force_z")


def test_wheelsets_of_trains_run_straight(fmu):
    with pytest.raises(Refused, match="contact.lateral: wheelsets of a train run straight"):
        whole_wheelset(fmu, None, {"contact.lateral": True})


def test_a_mass_that_moves_sideways_without_lateral_forces_is_told(start):
    with pytest.warns(UserWarning, match=r"wheel.lateral_mass has no effect without lateral forces; set contact.lateral = true"):
        start({"wheel.lateral_mass": 500.0})
