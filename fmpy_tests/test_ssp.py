"""System packages: fmpy runs the SSP, libcosim the SSP and the OSP system structure, with the same numbers."""

import os
import subprocess
import zipfile
from pathlib import Path

import numpy as np
import pytest
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssd, read_ssv
from fmpy.validation import validate_fmu

from conftest import ROOT
from wheelrail import Fmu, Refused, Wheel, scenario, ssp
from wheelrail.files import BadFile

STEPS, STEP = 150, ssp.STEP
COACH = ("coach.speed", "coach.distance", "brake.control_pressure", "brake.reference_speed")
AXLE = ("force", "load_change", "torque")
WHEELSET = tuple(ssp.TO_COACH)
TOLERANCE = 1e-9


@pytest.fixture(scope="module")
def braking():
    """The scenario of `make ssp` with a brake that acts at once, on rail on which wheels slide."""
    s = scenario.load(ROOT / "examples" / "train" / "low_adhesion.json")
    s.brake.delay, s.brake.fill_time, s.brake.wsp.fill_time = 0.0, 0.05, 0.02
    s.track.conditions["contaminated"].friction = 0.02
    return s


@pytest.fixture(scope="module")
def packages(packed, fmu, braking, tmp_path_factory):
    """Paths of the coach, of the SSP and of the OSP structure."""
    out = tmp_path_factory.mktemp("ssp")
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"
    coach = out / "coach.fmu"
    ssp.pack_coach(built / "coach", built / "libcoach.so", coach)
    with Fmu(coach) as opened:
        return coach, *ssp.write(braking, fmu, opened, (packed, coach), out, STEPS * STEP)


def names():
    """Component and variable of everything that is compared."""
    yield from (("coach", name) for name in COACH)
    yield from (("coach", f"axle{k}.{name}") for k in range(1, 5) for name in AXLE)
    yield from ((f"wheelset{k}", name) for k in range(1, 5) for name in WHEELSET)


@pytest.fixture(scope="module")
def expected(packages):
    """Rows of the SSP in fmpy, one after each step."""
    package = str(packages[1])
    values = read_ssv(package, resource="resources/train.ssv")
    table = simulate_ssp(package, stop_time=(STEPS - 0.5) * STEP, step_size=STEP, parameter_set=values)
    return np.array([table[f"{component}.{name}"] for component, name in names()]).T


def scales(braking):
    """Size of every column: forces are compared with the load of an axle, whose stiff springs they come from."""
    load = ssp.Coach(braking.vehicle).static_load
    sizes = {"speed": 38.9, "velocity": 38.9, "distance": 5.8, "pressure": 3.8e5, "omega": 84.5, "torque": 6450.0}
    size = lambda name: next((sizes[key] for key in sizes if name.endswith(key) or key in name.split(".")[-1]), load)
    return np.array([size(name) for _, name in names()])


def test_fmpy_simulates_the_ssp_whose_wheels_slide_while_the_coach_pitches(expected):
    column = dict(zip(names(), expected.T))
    slide = 1.0 - column["wheelset1", "wheel.omega"] * 0.46 / column["wheelset1", "wheel.velocity"]
    assert slide[-1] > 0.01 and np.ptp(column["coach", "axle4.load_change"]) > 100.0
    assert column["coach", "axle1.force"].max() > 500.0


def test_a_package_of_fmi_3_has_the_same_system_and_no_osp(packages, packed3, fmu3, braking, tmp_path):
    coach, built = tmp_path / "coach.fmu", Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"
    ssp.pack_coach(built / "coach", built / "libcoach.so", coach, fmi="3")
    with Fmu(coach) as opened:
        package, osp = ssp.write(braking, fmu3, opened, (packed3, coach), tmp_path, STEPS * STEP)
    assert osp is None and not (tmp_path / "osp").exists()
    with zipfile.ZipFile(packages[1]) as two, zipfile.ZipFile(package) as three:
        assert two.namelist() == three.namelist()
        same = [name for name in two.namelist() if not name.endswith(".fmu")]
        assert [two.read(name) for name in same] == [three.read(name) for name in same]


@pytest.mark.parametrize("kind", ["ssp", "osp"])
def test_libcosim_runs_the_ssp_and_the_osp_structure(packages, braking, expected, kind, fmu):
    pytest.importorskip("libcosimpy", reason="libcosimpy has no wheel for this platform")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.WARNING)
    coach, package, structure = packages
    make = CosimExecution.from_ssp_file if kind == "ssp" else CosimExecution.from_osp_config_file
    execution = make(str(package if kind == "ssp" else structure))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    with Fmu(coach) as opened:
        units = {component: (opened if component == "coach" else fmu) for component, _ in ssp.components()}
        place = lambda component: execution.slave_index_from_instance_name(component)
        asked = [(place(component), units[component].variable(name).valueReference) for component, name in names()]
    rows = []
    for _ in range(STEPS):
        assert execution.step()
        rows.append([observer.last_real_values(slave, [reference])[0] for slave, reference in asked])
    worst = np.max(np.abs(np.array(rows) - expected), axis=0) / scales(braking)
    print("largest difference", worst.max(), list(names())[int(worst.argmax())])
    assert worst.max() <= TOLERANCE


def test_packages_follow_their_schemas_and_hold_every_preset(packages, fmu):
    coach, package, _ = packages
    assert validate_fmu(str(coach)) == []
    structure = read_ssd(str(package))
    assert [c.name for c in structure.system.elements] == [name for name, _ in ssp.components()]
    with zipfile.ZipFile(package) as archive:
        inside = archive.namelist()
        sets = {Path(name).stem: name for name in inside if name.startswith("resources/presets/")}
    assert sets.keys() == {p.stem for p in (ROOT / "resources").glob("*.json")} - {"railway"}
    wet = {p.name: (p.type, p.value) for p in read_ssv(str(package), resource=sets["railway_wet"]).parameters}
    assert wet["friction.falling_ratio"] == ("Real", "0.4") and "wheel.radius" not in wet
    paper = {p.name: (p.type, p.value) for p in read_ssv(str(package), resource=sets["paper_d"]).parameters}
    assert paper["wheel.radius"] == ("Real", "0.5") and paper["thermal.cross_section"] == ("Enumeration", "contact")


def test_the_coach_exports_the_functions_of_the_standard_and_no_others():
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"
    both = [
        subprocess.run(["nm", "-D", "--defined-only", built / library], check=True, capture_output=True, text=True).stdout
        for library in ("libcoach.so", "libwheelrail.so")
    ]
    coach, wheel = ({line.split()[-1] for line in text.splitlines()} for text in both)
    assert coach == wheel and len(coach) == 34 + 75


def test_the_coach_keeps_the_rules_of_the_standard(packages):
    with Fmu(packages[0]) as opened, Wheel(opened, {"initial.speed": 20.0}, name="coach") as coach:
        coach.step(0.001)
        saved = coach.save()
        ahead = []
        for _ in range(2):
            coach.restore(saved)
            coach.set({"axle1.velocity": 20.0, "axle1.omega": 43.0, "axle1.contact_force": -1000.0})
            coach.step(0.001)
            ahead.append(coach.get("coach.speed", "axle1.force", "axle1.load_change"))
        assert ahead[0] == ahead[1]
        coach.forget(saved)
        for values, words in (
            ({"demand": 1.5}, "demand = 1.5 is outside its range: 0.0 to 1.0 1"),
            ({"demand": float("nan")}, "demand = NaN"),
            ({"body.mass": 3e4}, "body.mass is a fixed parameter"),
            ({"coach.speed": 1.0}, "coach.speed is an output"),
        ):
            with pytest.raises(Refused, match=words):
                coach.set(values)
        with pytest.raises(Refused, match="communicationStepSize = 0.5 s is outside its range: more than 0, at most 0.01 s"):
            coach.step(0.5)
        assert coach.get("coach.speed") == ahead[0][0]


def test_a_set_of_coaches_is_refused_by_name(braking, monkeypatch):
    monkeypatch.setattr(braking, "coaches", 2)
    with pytest.raises(BadFile, match="coaches = 2 is outside its range, 1"):
        ssp.coach_values(braking)


def test_a_sander_is_refused_by_name(braking):
    braking.brake.sander.active = True
    with pytest.raises(BadFile, match="sander.active"):
        ssp.coach_values(braking)
    braking.brake.sander.active = False
