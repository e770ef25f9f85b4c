"""What results and profiles say: signals of known content, closed forms, and the commands that print them."""

import re

import numpy as np
import pytest

from wheelrail import Wheel, analysis, signals, surfaces
from wheelrail.__main__ import main
from wheelrail.files import BadFile

SECOND = np.arange(20000) / 2000.0  # 10 s at 2 kHz


def normal(count, seed=1):
    """Deviates of mean 3 and standard deviation 2."""
    return 3.0 + 2.0 * np.random.default_rng(seed).standard_normal(count)


@pytest.mark.parametrize("frequency", [100.0, 100.03, 312.557])
def test_a_sine_of_known_amplitude_gives_its_level(frequency):
    values = 7.0 + 2.5 * np.sin(2 * np.pi * frequency * SECOND + 0.3)
    frequencies, amplitude = signals.amplitudes(SECOND, values)
    top = int(np.argmax(amplitude))
    assert abs(frequencies[top] - frequency) <= 0.05 + 1e-9
    assert amplitude[top] == pytest.approx(2.5, rel=1.5e-3)
    assert signals.harmonic(SECOND, values, frequency) == pytest.approx((2.5, 0.3 - np.pi / 2), rel=1e-9)
    centres, levels = signals.octaves(SECOND, values)
    band = int(np.argmin(np.abs(np.log(centres / frequency))))
    assert levels[band] == pytest.approx(20 * np.log10(2.5 / np.sqrt(2)), abs=0.01)


def test_bands_are_those_of_base_ten_and_their_energy_is_all_of_it():
    values = normal(len(SECOND))
    centres, levels = signals.octaves(SECOND, values, window="boxcar")
    assert np.any(np.isclose(centres, 10.0 ** (1 / 10) * 100)) and np.allclose(np.diff(np.log10(centres)), 0.1)
    assert centres[0] * (10**0.05 - 10**-0.05) >= 0.2 and centres[-1] * 10**0.05 <= 1000.0
    # White noise of variance 4 up to 1 kHz: every band has its share of the width, within the scatter of its lines.
    widths = centres * (10**0.05 - 10**-0.05)
    expected = 10 * np.log10(4.0 * widths / 1000.0)
    lines = widths / 0.1
    wide = lines > 100
    assert np.all(np.abs(levels - expected)[wide] < 4.0 * 4.34 / np.sqrt(lines[wide])) and np.count_nonzero(wide) > 10
    total = np.sum(10 ** (levels / 10)) / np.var(values)
    share = (centres[-1] * 10**0.05 - centres[0] * 10**-0.05) / 1000.0
    assert total == pytest.approx(share, rel=0.02)


def test_normal_deviates_have_their_density_moments_and_exceedance():
    count = 200000
    time, values = np.arange(count) * 1e-3, normal(count)
    found = signals.statistics(time, values)
    assert found.mean == pytest.approx(3.0, abs=4 * 2 / count**0.5)
    assert found.deviation == pytest.approx(2.0, rel=4 / (2 * count) ** 0.5)
    assert found.skewness == pytest.approx(0.0, abs=4 * (6 / count) ** 0.5)
    assert found.kurtosis == pytest.approx(3.0, abs=4 * (24 / count) ** 0.5)
    edges, density = signals.density(time, values, classes=40, limits=(-3.0, 9.0))
    middle = 0.5 * (edges[1:] + edges[:-1])
    exact = np.exp(-0.5 * ((middle - 3) / 2) ** 2) / (2 * np.sqrt(2 * np.pi))
    assert np.max(np.abs(density - exact)) < 5 * np.sqrt(exact.max() / (0.3 * count))
    levels, above = signals.exceedance(time, values)
    for deviations, share in ((0, 0.5), (1, 0.158655), (2, 0.0227501), (3, 0.0013499)):
        assert np.interp(3 + 2 * deviations, levels, above) == pytest.approx(share, abs=4 * (share / count) ** 0.5)
    assert found.at_zero == pytest.approx(0.0668072, abs=4 * (0.0668 / count) ** 0.5)


def test_samples_weigh_as_long_as_they_last():
    time, values = np.array([0.0, 1.0, 1.5, 2.0, 4.0]), np.array([1.0, 1.0, 5.0, 1.0, 1.0])
    found = signals.statistics(time, values)
    assert found.mean == pytest.approx((3.5 * 1 + 0.5 * 5) / 4)
    edges, density = signals.density(time, values, classes=2)
    assert np.sum(density * np.diff(edges)) == pytest.approx(1.0) and density[1] * 2 == pytest.approx(0.125)
    assert signals.exceedance(time, values)[1][-2:] == pytest.approx([0.125, 0.0])


@pytest.mark.parametrize(
    "positions, values, words",
    [
        ([0, 1, 1, 2], [1, 2, 3, 4], "row 3: 1 follows 1"),
        ([0, 1, 2, 3], [1, np.nan, 3, 4], "row 2: 1.0, nan"),
        ([0], [1], "2 or more"),
        ([0, 1, 2, 4], [1, 2, 3, 4], "2 apart behind 2"),
    ],
)
def test_signals_without_meaning_are_refused(positions, values, words):
    with pytest.raises(signals.BadSignal, match=words):
        signals.amplitudes(positions, values)


def test_contact_filter_and_corrugation_are_those_of_paper_a():
    assert surfaces.contact_filter(5e-3, 5e-3 / surfaces.FIRST_NULL) == pytest.approx(0.0, abs=1e-14)
    assert 1 / surfaces.FIRST_NULL == pytest.approx(2.613, abs=5e-4)
    # CNOSSOS-EU: the half-width of 100 kN on 920 mm lies within 1 dB of the table down to 25 mm.
    lengths, levels = np.array(surfaces.CNOSSOS[:-1]).T
    assert np.max(np.abs(surfaces.contact_filter_level(7.16e-3, lengths) - levels)) < 1.0
    assert surfaces.cnossos_filter([0.05, 0.3])[0] == -1.8 and np.isnan(surfaces.cnossos_filter([0.05, 0.3])[1])
    # Paper A: 5 um, 5 cm, half-width 5 mm, first natural frequency 2922 rad/s: see design, forces in N/m.
    case = dict(amplitude=5e-6, wavelength=0.05, half_width=5.0e-3, mass=5265.0, stiffness=5265 * 2922.0**2, retardation=1e-4)
    omega = np.linspace(2000, 4000, 4001)
    force = surfaces.corrugation_force(omega * 0.05 / (2 * np.pi), **case)
    assert omega[np.argmax(force)] == pytest.approx(2992, abs=10) and force.max() == pytest.approx(0.733e6, rel=0.03)
    speeds = np.array([50, 75, 100, 150]) / 3.6
    expected = np.array([0.110, 0.514, 0.556, 0.324]) * 1e6
    assert surfaces.corrugation_force(speeds, **case) == pytest.approx(expected, rel=0.03)


def test_flats_have_their_depths_and_kinks_their_force():
    assert surfaces.flat_depth(np.array([0.02, 0.04, 0.06]), 0.46) == pytest.approx([1.1e-4, 4.3e-4, 9.8e-4], rel=0.02)
    assert surfaces.flat_depth(0.04, 0.46, "rounded") == pytest.approx(0.04**2 / 16 / 0.46)
    assert surfaces.kink_force(20.0, 0.01, 1e9, 1000.0) == pytest.approx(2e5)


def test_turns_of_a_wheel_have_their_own_peaks():
    time = np.arange(0.0, 4.0, 1e-4)
    omega = 20.0 + 5.0 * time
    angle = 20.0 * time + 2.5 * time**2
    force = 1e5 * (1.0 + 0.02 * omega * np.exp(-(((angle % (2 * np.pi)) - 3) / 0.05) ** 2))
    rows = signals.of_turns(time, omega, 0.46 * omega, force)
    assert len(rows) == int(angle[-1] / (2 * np.pi))
    assert rows[:, 1] == pytest.approx(1e5 * (1 + 0.02 * rows[:, 0] / 0.46), rel=0.02)
    assert np.all(rows[:, 3] == 0.0)


def command(capsys, *arguments):
    """What `python -m wheelrail` prints."""
    main([str(argument) for argument in arguments])
    return capsys.readouterr().out


def test_commands_write_table_and_picture(tmp_path, capsys):
    time = np.arange(0.0, 4.0, 1e-3)
    columns = {"time": time, "wheel.omega": 40 + 0 * time, "wheel.velocity": 18.4 + 0 * time}
    columns["contact.force_y"] = 1e5 + 2e4 * np.sin(2 * np.pi * 50 * time)
    file, profile = tmp_path / "run.csv", tmp_path / "rail.csv"
    np.savetxt(file, np.stack(list(columns.values()), axis=1), delimiter=",", header=",".join(columns), comments="")
    x = np.arange(0.0, 10.0, 0.005)
    heights = 1e-5 * np.sqrt(2) * np.sin(2 * np.pi * x / 0.1)
    np.savetxt(profile, np.stack([x, heights], axis=1), delimiter=",", header="position,height", comments="")
    for name, source, words in (
        ("force", file, ["mean", "100000", "120000", "not exceeded 99 %"]),
        ("spectrum", file, ["50", "20000"]),
        ("octaves", profile, ["EN ISO 3095", "0.1", "20.0", "4.90"]),
        ("flat", file, ["66.24", "120000", "80000"]),
    ):
        printed = command(capsys, name, source, "--out", tmp_path)
        assert all(word in printed for word in words), (name, printed)
        assert (tmp_path / f"{name}.png").stat().st_size > 5000 and (tmp_path / f"{name}.csv").stat().st_size > 100
    printed = command(capsys, "filter", "--out", tmp_path)
    assert "CNOSSOS" in printed and "-1.80" in printed
    with pytest.raises(SystemExit, match="^2$"):
        command(capsys, "force", file, "--column", "contact.force_z", "--out", tmp_path)
    assert "contact.force_z is missing; nearest: contact.force_y" in capsys.readouterr().err


def test_bad_files_are_refused_by_line_and_name(tmp_path):
    file = tmp_path / "run.csv"
    file.write_text("time,contact.force_y\n0,1\n1,high\n")
    with pytest.raises(BadFile, match="run.csv:3: contact.force_y is 'high', not a number"):
        analysis.read_columns(file, ("time", "contact.force_y"))
    with pytest.raises(BadFile, match="cannot be read"):
        analysis.read_columns(tmp_path / "other.csv", ("time",))
    file.write_text("time,contact.force_y\n0,1\n\n1,high\n")
    with pytest.raises(BadFile, match="run.csv:4: contact.force_y is 'high'"):
        analysis.read_columns(file, ("time", "contact.force_y"))
    file.write_bytes(bytes(range(256)))
    with pytest.raises(BadFile, match="run.csv: cannot be read: it has zero bytes"):
        analysis.read_columns(file, ("time",))


@pytest.mark.parametrize("step", [0.0, -1.0, 1e-12, 9.0, np.nan])
def test_steps_that_resample_nothing_are_refused(step):
    with pytest.raises(signals.BadSignal, match="step = .* is outside .*, the length of the signal"):
        signals.resampled([0.0, 1.0, 3.0], [1.0, 2.0, 3.0], step)


@pytest.mark.parametrize("reference", ["0", "-1e-6", "nan"])
def test_levels_need_a_reference_above_zero(tmp_path, capsys, reference):
    file = tmp_path / "run.csv"
    file.write_text("time,contact.force_y\n0,1\n1,2\n2,1\n3,2\n")
    with pytest.raises(SystemExit, match="^2$"):
        command(capsys, "octaves", file, f"--reference={reference}", "--out", tmp_path)
    assert re.search("--reference = .* is not above zero", capsys.readouterr().err)


def test_a_wheel_leaves_its_profile_for_another_one(fmu, tmp_path):
    """Locked for 0.3 m it wears a flat; the file has it, and a wheel that loads the file is as deep there."""
    file = tmp_path / "left.csv"
    settings = {"thermal.enabled": False, "mesh.elements_per_half_width": 6, "initial.velocity": 10.0}
    locked = {"control.rotation": "velocity", "control.translation": "velocity", "drive.velocity": 10.0, "drive.omega": 0.0}
    with Wheel(fmu, settings | {"damage.wear": "t_gamma", "wheel.profile_save": str(file), "initial.creepage": 2.0 - 1e-9}, locked) as wheel:
        for _ in range(30):
            wheel.step(1e-3)
        depth, worn = wheel.get("damage.worn_depth", "damage.worn_mass")
    position, height = np.loadtxt(file, delimiter=",", skiprows=1).T
    around = 2 * np.pi * 0.46
    missing = -np.trapezoid(np.append(height, height[0]), np.append(position, around)) * 7850 * 0.014
    assert depth > 5e-6 and -height.min() == pytest.approx(depth, rel=0.1) and missing == pytest.approx(worn, rel=0.01)
    place = position[np.argmin(height)]
    with Wheel(fmu, settings | {"wheel.profile": f'file("{file}", position = {-place})'}) as wheel:
        assert wheel.get("wheel.profile_height") == pytest.approx(height.min(), rel=1e-4)
