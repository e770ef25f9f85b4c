"""Tables of contact patches from profiles: reading, geometry, pressures, rows. References: closed forms; the Manchester contact benchmark
A-2.2 as CONTACT computes it (data/a22.json); equivalent conicities of S1002 on UIC60."""

import csv
import json
import time
from pathlib import Path

import numpy as np
import pytest
import standard_profiles as standard

from wheelrail import Wheel, contact_patch, profile_files
from wheelrail.__main__ import main
from wheelrail.contact_geometry import Pose, Side, Track, conicity
from wheelrail.files import BadFile
from wheelrail.half_space import Tiles
from wheelrail.profile_files import Profile

A22 = json.loads((Path(__file__).parent / "data/a22.json").read_text())
STEEL = 210e9 / (2.0 * (1.0 - 0.3**2))
OF_CONTACT = 82e9 / (1.0 - 0.28)  # the same of the steel of
AMPLITUDES = 1e-3 * np.arange(1, 7)


def simpack(points, **keys):
    """A file of SIMPACK."""
    body = "".join(f"{a:.6f} {b:.6f}\n" for a, b in points)
    return "header.begin\nheader.end\nspline.begin\n" + "".join(f"{k.replace('_', '.')} = {v}\n" for k, v in keys.items()) + f"point.begin\n{body}point.end\nspline.end\n"


@pytest.fixture(scope="session")
def manchester(tmp_path_factory):
    """Wheel S1002 and rail UIC60, inclined 1:40, of the Manchester benchmark."""
    folder = tmp_path_factory.mktemp("manchester")
    (folder / "s1002.prw").write_text(simpack(A22["wheel_S1002_prw"], mirror_y=1))
    (folder / "uic60.prr").write_text(simpack(A22["rail_UIC60_prr"], units_len_f=1000))
    return folder


@pytest.fixture(scope="session")
def profiles(manchester):
    return profile_files.read(manchester / "s1002.prw", "wheel"), profile_files.read(manchester / "uic60.prr", "rail")


@pytest.fixture(scope="session")
def track(profiles):
    return Track(*profiles)


@pytest.fixture(scope="session")
def table(manchester, tmp_path_factory):
    """Rows of the table of 71 shifts, blocks by columns, and what the command printed."""
    folder = tmp_path_factory.mktemp("table")
    began = time.perf_counter()
    main(["patch", str(manchester / "s1002.prw"), str(manchester / "uic60.prr"), "--gauge", "1435", "--load", "100e3", "--shift", "-7:7:0.2", "--out", str(folder / "p.csv")])
    print(f"71 shifts with files: {time.perf_counter() - began:.1f} s")
    return folder


def one_patch(patch):
    """The patch as the only one of its table."""
    return contact_patch.Over(np.zeros(1), [patch], np.zeros(1))


def columns(path):
    """Columns of a table by name, blocks by rows."""
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    read = list(csv.DictReader(lines))
    count = sum(row["shift"] == read[0]["shift"] for row in read)
    return {name: np.array([float(row[name]) for row in read]).reshape(-1, count) for name in read[0]}


def hertz(along, across, load, modulus):
    """Semi-axes, largest pressure and approach of Hertz for curvatures [1/m]; complete elliptic integrals by means."""

    def integrals(m):
        a, b, c, s, power = 1.0, np.sqrt(1.0 - m), np.sqrt(m), 0.0, 0.5
        while c > 1e-15:
            s, power, a, b, c = s + power * c * c, 2.0 * power, 0.5 * (a + b), np.sqrt(a * b), 0.5 * (a - b)
        return np.pi / 2.0 / a, np.pi / 2.0 / a * (1.0 - s)

    small, large = sorted((along / 2.0, across / 2.0))
    low, high = 1e-9, 1.0 - 1e-12
    for _ in range(100):
        m = 0.5 * (low + high)
        k, e = integrals(m)
        low, high = (m, high) if (e / (1.0 - m) - k) / (k - e) < large / small else (low, m)
    longer = (3.0 * load * (k - e) / (2.0 * np.pi * 2.0 * modulus * m * small) * 2.0) ** (1.0 / 3.0)
    shorter = longer * np.sqrt(1.0 - m)
    peak = 1.5 * load / (np.pi * longer * shorter)
    axes = (longer, shorter) if along < across else (shorter, longer)
    return *axes, peak, peak * shorter * k / modulus


@pytest.mark.parametrize("crown", [0.3, 0.08, 0.013])
def test_a_cylinder_on_a_crowned_rail_has_the_ellipse_of_hertz(crown):
    a, b, peak, approach = hertz(1.0 / 0.46, 1.0 / crown, 1e5, STEEL)
    size, count = np.array([1.1 * a, 1.1 * b]), (48, 64)
    x, y = (2.0 * s / n * (np.arange(n) + 0.5) - s for s, n in zip(size, count))
    tiles = Tiles(count, tuple(2.0 * size / count), STEEL)
    found = tiles.press(x[:, None] ** 2 / 0.92 + y**2 / (2.0 * crown), np.ones(count[1]), 1e5)
    spread = lambda at, load: np.sqrt(5.0 * np.average(at**2, weights=load))  # semi-axis of an ellipsoid of pressure
    assert found.pressure.max() == pytest.approx(peak, rel=0.01) and found.approach == pytest.approx(approach, rel=0.01)
    assert spread(x, found.pressure.sum(axis=1)) == pytest.approx(a, rel=0.01)
    assert spread(y, found.pressure.sum(axis=0)) == pytest.approx(b, rel=0.01)
    # The same through profiles: a cylinder on an arc, in strips and in rows.
    flat, arc = np.linspace(-0.06, 0.06, 200), np.linspace(-0.9 * min(crown, 0.035), 0.9 * min(crown, 0.035), 400)
    side = Side(Profile(flat, 0.0 * flat, ""), Profile(arc, np.sqrt(crown**2 - arc**2) - crown, ""), 0.46, 0.75, 0.75)
    patch = contact_patch.strips(side, Pose(), 1e5, STEEL)
    assert patch.peak.max() == pytest.approx(peak, rel=0.01) and patch.approach == pytest.approx(approach, rel=0.01)
    assert np.max(patch.half_length) == pytest.approx(a, rel=0.01) and abs(patch.mean(patch.angle)) < 1e-4
    [rows] = one_patch(patch).rows(9)
    assert np.max(2e5 * rows.load_share / (np.pi * rows.half_length * rows.width)) == pytest.approx(peak, rel=0.015)
    assert np.sum(2.0 * rows.half_length * rows.width) == pytest.approx(np.pi * a * b, rel=0.01)


@pytest.mark.parametrize("gauge, expected", [(1.435, [0.367, 0.227, 0.181, 0.161, 0.156, 0.279]), (1.437, [0.047, 0.169, 0.148, 0.133, 0.127, 0.127])])
def test_rigid_equivalent_conicity(profiles, gauge, expected):
    y = np.arange(-180, 181) * 5e-5
    found = conicity(y, Track(*profiles, gauge=gauge).rigid_difference(y), AMPLITUDES)
    print(f"gauge {gauge} m: {np.round(found, 4)}")
    assert found == pytest.approx(expected, rel=0.03)


def test_conicity_of_a_cone_is_its_slope_and_a_motion_that_does_not_fit_has_none():
    y = np.linspace(-8e-3, 8e-3, 17)
    found = conicity(y, 2.0 * 0.05 * y, np.array([1e-3, 6e-3, 9e-3]))
    assert found[:2] == pytest.approx([0.05, 0.05], rel=1e-4) and np.isnan(found[2])


def test_elastic_conicity_and_radius_at_the_centre_of_load(track, table):
    found = columns(table / "p.csv")
    shifts, radius = found["shift"][:, 0], np.sum(found["load_share"] * found["radius"], axis=1)
    elastic = conicity(shifts, radius - radius[::-1], AMPLITUDES)
    rigid = conicity(shifts, track.rigid_difference(shifts), AMPLITUDES)
    print(f"elastic conicity {np.round(elastic, 4)}")
    assert elastic == pytest.approx([0.196, 0.188, 0.172, 0.162, 0.200, 0.297], rel=0.03)
    assert rigid[0] > 1.8 * elastic[0]  # at small amplitudes that of rigid wheels is of no use
    for first, expected in ((0.0, [0.048, 0.068, 0.088, 0.110, 0.133, 0.156]), (4.4, [1.20, 1.32, 1.50, 1.69, 1.91, 2.20, 2.51, 2.82, 3.14])):
        fine = 1e-3 * (first + 0.05 * np.arange(2 * len(expected) - 1))
        radius = 1e3 * (contact_patch.over(track, fine, 1e5, OF_CONTACT).radius - 0.46)
        print(f"radius at the centre of load from {first} mm on [mm]: {np.round(radius[::2], 3)}")
        assert radius[::2] == pytest.approx(expected, rel=0.03, abs=1.5e-3)
        assert np.all(np.diff(radius) > 0.0) and np.max(np.diff(radius)) < 0.2


def test_benchmark_a22_has_the_places_angles_and_pressures_of_contact(track):
    worst = {}
    for wheel in A22["wheels"]:
        sign = 1.0 if wheel["side"] == "right" else -1.0
        shift, roll, yaw = 1e-3 * wheel["ws"][1], -wheel["ws"][3], wheel["ws"][4]
        pose, theirs = Pose(sign * shift, sign * roll, sign * yaw), wheel["patches"][0]
        patch, gap = contact_patch.strips(track.side, pose, theirs["FN"], OF_CONTACT), track.side.gap(pose)
        angle, place = -sign * theirs["cp_track"][3], 1e-3 * sign * theirs["cp_track"][4]
        flange = "flange" if angle > 0.25 else "tread"
        two = sign > 0.0 and wheel["ws"][1] in (0.5, 1.0, 5.0) or shift == 0.0  # wide or two places, of which CONTACT's point is a mean of its own
        # CONTACT's point lies inside the wheel by the approach, and ahead of the axle.
        x, _, z = (1e-3 * value for value in theirs["cp_wheel"])
        radius = np.hypot(0.46 + z, x) + 1e-3 * theirs["approach"]
        errors = {
            f"pressure, {flange}": patch.peak.max() / (1e6 * theirs["pmax"]) - 1.0,
            f"angle{', wide' if two else ''} [rad]": patch.mean(patch.angle) + pose.roll - angle,
            f"place{', wide' if two else ''} [m]": patch.mean(patch.rail) - place,
            f"radius{', wide' if two else ''} [m]": patch.mean(patch.radius) - radius,
            "ahead [m]": float(gap.ahead[gap.touch]) - 1e-3 * theirs["cp_track"][0],
            "approach": patch.approach * np.cos(angle) / (1e-3 * theirs["approach"]) - 1.0 if not two else 0.0,
            "own roll [rad]": track.roll(sign * shift, sign * yaw) - sign * roll if abs(shift - 6.5e-3) > 1e-6 else 0.0,
        }
        for name, error in errors.items():
            worst[name] = max(worst.get(name, 0.0), abs(error))
    print("\n".join(f"A-2.2, largest difference, {name}: {error:.2g}" for name, error in worst.items()))
    limits = {"pressure, tread": 0.01, "pressure, flange": 0.03, "angle [rad]": 5e-3, "angle, wide [rad]": 0.013, "place [m]": 1e-4, "place, wide [m]": 8e-4}
    limits |= {"radius [m]": 6e-5, "radius, wide [m]": 1e-4, "ahead [m]": 1e-4, "approach": 0.01, "own roll [rad]": 1e-4}
    assert all(worst[name] < limit for name, limit in limits.items()) and worst.keys() == limits.keys(), worst


# Where CONTACT's force depends on which point of a wide or double patch it refers to: 10 µm of the radius are 0.06 of friction.
OF_ITS_POINT = {("left", 0.0): 0.07, ("right", 0.0): 0.07, ("left", 0.5): 0.01, ("right", 0.5): 0.035, ("right", 5.0): 0.04}


def test_benchmark_a22_from_profiles_through_the_fmu_has_the_forces_of_contact(track, fmu):
    """All 42 wheels, the flange included: shift, yaw and roll, speeds and vertical load are given, forces along the axes of the track are
    compared, over the friction that the load allows. Nothing is fitted. The plane in which CONTACT's forces act is that of one point, ours
    that of the load: on the flange CONTACT's plane is given, too."""
    worst = {}
    for wheel in A22["wheels"]:
        sign, shift, theirs = 1.0 if wheel["side"] == "right" else -1.0, 1e-3 * wheel["ws"][1], wheel["patches"][0]
        roll, yaw, load, expected = wheel["ws"][3], wheel["ws"][4], theirs["FN"], np.array(wheel["F_track"])
        pose = Pose(sign * shift, -sign * roll, sign * yaw)
        patch = contact_patch.strips(track.side, pose, load, OF_CONTACT)
        missed = -sign * theirs["cp_track"][3] - pose.roll - patch.mean(patch.angle)
        errors = []
        for turned in (0.0, missed):
            [rows] = one_patch(patch._replace(angle=patch.angle + turned)).rows(9)
            text = ";".join([",".join(rows._fields), *(",".join(f"{value:.9g}" for value in row) for row in zip(*rows))])
            parameters = {
                "preset": "railway_ellipse", "contact.lateral": True, "contact.lines": 9, "thermal.enabled": False, "physics.yielding": False,
                "friction.softening": 0.0, "friction.coefficient": 0.3, "material.youngs_modulus": 2.0 * 82e9 * 1.28,
                "material.poissons_ratio": 0.28, "model.nominal_load": load, "contact.rows_load": load, "initial.velocity": 2.0,
                "contact.shape": "rows", "contact.rows": text, "wheelset.side": wheel["side"],
            }  # fmt: skip
            inputs = {
                "control.rotation": "velocity", "control.translation": "velocity", "drive.velocity": 2.0, "drive.omega": -wheel["vws"][5],
                "drive.load": expected[2], "wheelset.lateral": shift, "wheelset.roll": roll, "wheelset.yaw": yaw,
            }  # fmt: skip
            with Wheel(fmu, parameters, inputs) as ours:
                for _ in range(5):
                    ours.step(1e-3)
                force, peak = np.array(ours.get("wheelset.force_x", "wheelset.force_z", "wheelset.force_y")), ours.get("contact.pressure_max")
            errors.append((force - expected * [-1.0, -1.0, 1.0])[:2] / (0.3 * load))
        told = " ".join(f"{error:+.4f}" for error in np.ravel(errors))
        print(f"{wheel['side']:5} {1e3 * shift:4.1f} mm: along, across; in CONTACT's plane: {told}; pressure {1e-6 * peak / theirs['pmax'] - 1.0:+.3f}")
        place = "point" if (wheel["side"], 1e3 * shift) in OF_ITS_POINT else "flange" if sign * shift > 5.2e-3 else "tread"
        found = [np.max(np.abs(errors[0])), np.max(np.abs(errors[1])), abs(1e-6 * peak / theirs["pmax"] - 1.0)]
        worst[place] = np.maximum(worst.get(place, 0.0), found)
        assert np.max(np.abs(errors[0])) < OF_ITS_POINT.get((wheel["side"], 1e3 * shift), 1.0)
    for place, found in worst.items():
        print(f"figure: a22.{place} = {', '.join(f'{value:.4f}' for value in found)}")
    assert np.all(worst["tread"] < [4e-3, 3e-3, 0.01]) and np.all(worst["flange"] < [0.022, 3e-3, 0.03]) and np.all(worst["point"] < [0.07, 0.07, 0.01])


def test_a_table_has_blocks_of_touching_rows_that_move_smoothly(table):
    found = columns(table / "p.csv")
    assert list(found) == ["shift", "position", "half_length", "load_share", "width", "angle", "radius", "lateral"]
    assert found["shift"].shape == (71, 9) and np.allclose(found["shift"][:, 0], np.linspace(-7e-3, 7e-3, 71)) and found["shift"][35, 0] == 0.0
    assert np.allclose(found["load_share"].sum(axis=1), 1.0) and all(np.all(found[name] > 0.0) for name in ("half_length", "load_share", "width"))
    assert np.all(np.diff(found["position"], axis=1) > 0.0) and np.all(np.diff(found["angle"], axis=1) < 0.0)
    between = np.diff(found["position"], axis=1) - 0.5 * (found["width"][:, 1:] + found["width"][:, :-1])
    assert np.min(between / found["width"][:, 1:]) > -1e-5  # no overlap; apart only between two places
    apart = np.any(between > 1e-5, axis=1)
    assert np.all(np.sum(between > 1e-5, axis=1) <= 1) and {*np.round(1e3 * found["shift"][apart, 0], 1)} == {4.4, 4.6, 4.8, 5.2, 5.4}
    # Rows that bear move to the flange with the shift, and never back; those that jump from place to place carry next to nothing.
    tread = found["shift"][:, 0] < 5.9e-3
    moved = np.diff(found["position"][tread], axis=0)
    carried = np.maximum(found["load_share"][tread][1:], found["load_share"][tread][:-1])
    jumps = np.abs(moved) > 5e-3
    print(f"rows that jump: {np.sum(jumps)}, with {np.max(carried[jumps]):.3f} of the load at most")
    assert np.all(moved[carried > 0.06] < 4e-4) and np.max(carried[jumps]) < 0.03 and np.sum(jumps) == 9
    assert (table / "p.png").stat().st_size > 10_000
    told = list(csv.DictReader((table / "p_columns.csv").open()))
    assert [row["column"] for row in told] == list(found)


def test_rows_in_two_places_keep_the_centre_of_load_and_each_its_angle(track):
    found = contact_patch.over(track, 1e-3 * np.arange(3.0, 6.5, 0.1), 1e5, STEEL)
    for shift, patch, rows in zip(found.shifts, found.patches, found.rows(9)):
        assert np.sum(rows.load_share * rows.radius) == pytest.approx(patch.mean(patch.radius), abs=1e-9)
        assert np.sum(rows.load_share * rows.angle) == pytest.approx(patch.mean(patch.angle), abs=1e-9)
        assert np.sum(rows.half_length * rows.width) == pytest.approx(np.sum(patch.half_length * np.diff(patch.edge)), rel=1e-9)
        begin = contact_patch.second_place(patch)
        assert (begin is not None) == (4.35e-3 < shift < 5.45e-3)
        if begin is not None:  # each row has one of the two places: four of them the flange, in whose angle none of the others shares
            flange = rows.position + 0.5 * rows.width <= patch.edge[begin] + 1e-9
            assert np.sum(flange) == 4 and np.all(flange[:4]) and min(rows.angle[:4]) > 0.25 > 0.22 > max(rows.angle[4:])
            assert np.sum(rows.load_share[:4]) == pytest.approx(patch.mean(np.arange(len(patch.peak)) < begin), abs=1e-9)


def test_the_fmu_takes_one_block_as_it_takes_rows_today(manchester, fmu, tmp_path, capsys):
    out = tmp_path / "one.csv"
    main(["patch", str(manchester / "s1002.prw"), str(manchester / "uic60.prr"), "--shift", "3", "--out", str(out)])
    assert "1 shifts" in capsys.readouterr().out
    with Wheel(fmu, {"preset": "railway_s1002_3mm", "contact.rows": str(out), "contact.lines": 9}, {}) as wheel:
        peak, lines = wheel.get("contact.pressure_max", "contact.line_count")
    assert lines == 9 and peak == pytest.approx(1549e6, rel=0.01)  # CONTACT's, docs/patches.md


def test_formats_units_and_orientations_give_one_profile(tmp_path, manchester):
    wheel, rail = standard.s1002(), standard.rail_60e1()
    text = lambda points, scale=(1.0, 1.0), mark=" ": "".join(f"{scale[0] * u:.9f}{mark}{scale[1] * z:.9f}\n" for u, z in points)
    written = {
        "mm.txt": text(wheel), "m.csv": "u,z\n" + text(wheel, (1e-3, 1e-3), ","), "down.txt": text(wheel, (1.0, -1.0)),
        "mirrored.txt": text(wheel, (-1.0, 1.0), "\t"), "back.txt": text(wheel[::-1], mark="; "),
        "miniprof.whl": "ProgramName=Profile\nXYPoints=300\nColumnDef=X,Y,A,C\n\n" + "".join(f"{u + 70:.6f}\t{z:.6f}\t0.1\t0.2\n" for u, z in wheel),
        "a.prw": simpack(wheel * [1.0, -1.0]), "b.prw": simpack(wheel * [-1e-3, -1e-3], mirror_y=1, units_len_f=1), "c.prw": simpack(wheel, mirror_z=1),
    }  # fmt: skip
    found = {}
    for name, content in written.items():
        (tmp_path / name).write_text(content)
        found[name] = profile_files.read(tmp_path / name, "wheel")
        assert np.interp([-0.045, -0.03, 0.0, 0.05], found[name].u, found[name].z) == pytest.approx(
            1e-3 * (np.interp([-45.0, -30.0, 0.0, 50.0], *wheel.T) - np.interp(0.0, *wheel.T)), abs=1e-6 if name != "miniprof.whl" else 2e-5
        ), name
    words = {name: profile.words for name, profile in found.items()}
    assert "millimetres" in words["mm.txt"] and "; metres" in words["m.csv"] and "downwards: turned" in words["down.txt"]
    assert "mirrored" in words["mirrored.txt"] and "taping circle 70 mm" in words["miniprof.whl"] and "units per metre" in words["a.prw"]
    (tmp_path / "rail.txt").write_text(text(rail))
    upright = profile_files.inclined(profile_files.read(tmp_path / "rail.txt", "rail"), 0.0)
    assert "upright" in upright.words and "leans to the track" in profile_files.inclined(upright, 1 / 40).words


def test_shipped_profiles_are_those_of_the_standards_and_near_those_of_manchester(profiles):
    for name, written in standard.FILES.items():
        assert (standard.FOLDER / name).read_text() == written(), name
    wheel = standard.s1002()
    inside = (wheel[:, 0] > -60.0) & (wheel[:, 0] < 50.0)
    theirs = 1e3 * np.interp(1e-3 * wheel[inside, 0], *profiles[0][:2])
    assert np.max(np.abs(theirs - wheel[inside, 1])) < 0.012
    read = profile_files.read(standard.FOLDER / "60e1.prr", "rail")
    rail = profile_files.inclined(read, 1 / 40)
    assert np.ptp(read.u[read.z > -0.0142]) == pytest.approx(0.072, abs=1e-4)
    y = np.arange(-180, 181) * 5e-5
    found = conicity(y, Track(profile_files.read(standard.FOLDER / "s1002.prw", "wheel"), rail).rigid_difference(y), AMPLITUDES)
    print(f"S1002 on 60E1 of the standards: {np.round(found, 4)}")
    assert found == pytest.approx([0.367, 0.227, 0.181, 0.161, 0.156, 0.279], rel=0.05)


WHEEL, RAIL = standard.s1002(), standard.rail_60e1()
PLAIN = [f"{u:.6f} {z:.6f}" for u, z in WHEEL]
AT = 150  # a point of the tread


def changed(line, text):
    """Two columns of the wheel with another line."""
    return "\n".join([*PLAIN[: line - 1], text, *PLAIN[line:]])


def swapped(line):
    return "\n".join([*PLAIN[: line - 1], PLAIN[line], PLAIN[line - 1], *PLAIN[line + 1 :]])


def outwards():
    """A rail that leans away from the track."""
    u, z = RAIL.T
    return "\n".join(f"{a:.6f} {b:.6f}" for a, b in zip(u + z / 40.0, z - u / 40.0))


@pytest.mark.parametrize(
    "name, content, kind, words",
    [
        ("w.txt", "\n".join(f"{u / 25.4} {z / 25.4}" for u, z in WHEEL), "wheel", ("mm wide", "inches", "millimetres")),
        ("w.txt", "\n".join(f"{10 * u} {10 * z}" for u, z in WHEEL), "wheel", ("1300", "60 to 200 mm", "write them in millimetres")),
        ("w.prw", simpack(WHEEL * [1e-3, -1e-3], units_len_f=1000), "wheel", ("metres", "set units.len.f to 1")),
        ("w.prw", simpack(WHEEL * [1.0, -1.0] / 25.4), "wheel", ("inches", "set units.len.f to 39.37")),
        ("w.prw", simpack(WHEEL), "wheel", ("upside down", "mirror.z")),
        ("w.prw", simpack(WHEEL * [-1.0, -1.0]), "wheel", ("flange on the field side", "mirror.y")),
        ("r.txt", "\n".join(f"{u} {z}" for u, z in RAIL), "wheel", ("no wheel", "shape of a rail", "wheel first")),
        ("w.txt", "\n".join(PLAIN), "rail", ("no rail", "shape of a wheel", "wheel first")),
        ("r.txt", outwards(), "rail", ("mirrored", "1:", "signs")),
        ("w.txt", swapped(AT), "wheel", (f"w.txt:{AT + 1}:", "turn back", "sort")),
        ("w.txt", changed(AT, "nan 0.1"), "wheel", (f"w.txt:{AT}:", "'nan' is not a finite number", "leave the point out")),
        ("w.txt", changed(AT, "1.5 abc"), "wheel", (f"w.txt:{AT}:", "'abc'", "correct")),
        ("w.txt", changed(AT, "12,5 3,25"), "wheel", (f"w.txt:{AT}:", "decimal point")),
        ("w.txt", changed(AT, "7.5"), "wheel", (f"w.txt:{AT}:", "two numbers")),
        ("w.txt", "\n".join(PLAIN[:12]), "wheel", ("w.txt:12:", "12 points", "20 or more")),
        ("w.txt", "", "wheel", ("0 points",)),
        ("w.prw", simpack([]), "wheel", ("w.prw:4:", "0 points", "export")),
        ("w.prw", "\n".join(PLAIN), "wheel", ("no line point.begin", "export")),
        ("w.prw", simpack(WHEEL * [1.0, -1.0], units_len_f="mm"), "wheel", ("w.prw:4:", "units.len.f = 'mm'", "1000")),
        ("w.prw", simpack(WHEEL * [1.0, -1.0], units_len_f=0), "wheel", ("w.prw:4:", "above 0", "1000")),
        ("w.txt", "\n".join(PLAIN[90:]), "wheel", ("no flange", "whole wheel")),
    ],
)  # fmt: skip
def test_a_bad_profile_is_refused_in_one_line_with_place_and_remedy(tmp_path, name, content, kind, words):
    (tmp_path / name).write_text(content)
    with pytest.raises(BadFile) as refused:
        profile_files.inclined(profile_files.read(tmp_path / name, kind), 0.0, tmp_path / name)
    said = str(refused.value)
    print(said)
    assert all(word in said for word in (name, *words)) and "\n" not in said, said


@pytest.mark.parametrize(
    "options, words",
    [
        (["missing.prw", "60e1.prr"], ("missing.prw", "cannot be read")),
        (["60e1.prr", "s1002.prw"], ("60e1.prr", "shape of a rail")),
        (["s1002.prw", "60e1.prr", "--gauge", "1.435"], ("--gauge = 1.435", "600 to 1700")),
        (["s1002.prw", "60e1.prr", "--shift", "7:-7:0.1"], ("7:-7:0.1", "FIRST:LAST:STEP")),
        (["s1002.prw", "60e1.prr", "--inclination", "40"], ("'40' is no inclination",)),
        (["s1002.prw", "60e1.prr", "--out", "p.png"], ("--out p.png", "ends with .csv")),
        (["s1002.prw", "60e1.prr", "--rows", "1"], ("--rows = 1", "2 to 13")),
        (["s1002.prw", "60e1.prr", "--inclination", "1:40", "--shift", "-49"], ("-49 mm", "end of a profile")),
    ],
)
def test_the_command_refuses_in_one_line(options, words, monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(standard.FOLDER)
    with pytest.raises(SystemExit) as ended:
        main(["patch", "--out", str(tmp_path / "p.csv"), *options])
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert ended.value.code == 2 and all(word in said for word in words), said
    assert not (tmp_path / "p.csv").exists()


def test_nine_rows_keep_the_largest_pressure_at_every_shift(track):
    kept = []
    for shift in [*np.arange(-0.4e-3, 0.41e-3, 1e-4), *np.arange(4.3e-3, 5.5e-3, 1e-4)]:
        patch = contact_patch.strips(track.side, track.pose(shift), 1e5, STEEL)
        [rows] = one_patch(patch).rows(9)
        assert np.min(rows.width) > 3.0 * np.diff(patch.edge)[0]  # tiles in every row
        kept.append(np.max(2e5 * rows.load_share / (np.pi * rows.half_length * rows.width)) / patch.peak.max())
    print(f"largest pressure of nine rows over that of the patch: {min(kept):.3f} to {max(kept):.3f}")
    assert min(kept) > 0.94 and max(kept) <= 1.0
