"""Slide protection, sanding and driver of one's own: the example brakes with them, mistakes are said by name; sand in bursts."""

import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from wheelrail import report, scenario
from wheelrail.brake import Sander, Valve
from wheelrail.controllers import ControllerFailed
from wheelrail.files import BadFile
from wheelrail.train import Stop

TRAIN = Path(__file__).parent.parent / "examples" / "train"
QUICK = {"speed": 12.0, "step": 0.01, "hold": 0.0, "brake.fill_time": 1.0, "track": "soap.json"}


def stopped(of):
    """Table of a stop on rigid wheelsets."""
    run = Stop(of)
    try:
        return run.run()
    finally:
        run.close()


def test_the_controllers_of_the_example_brake_a_coach():
    example = scenario.load(TRAIN / "own_controllers.json", QUICK)
    table = stopped(example)
    time, speed, control = (report.column(table, name) for name in ("time", "speed", "control_pressure"))
    # The driver lets go below 3 m/s, and the distributor follows.
    assert control.max() == example.brake.pressure and control[speed < 2.9][0] < control.max() and np.any(speed > 3.0)
    valves = np.array([report.column(table, "valve", k) for k in range(4)])
    assert set(np.unique(valves)) == {0.0, 1.0, 2.0}
    assert max(report.figures(table)["longest lock"][0]) == 0.0
    venting = (valves == Valve.VENT.value).any(axis=0)
    # Sand by the metre, on both rails, capped by the sander.
    laid = np.diff(report.column(table, "sand"), prepend=0.0) / 0.01
    assert np.all(laid[~venting] == 0.0) and 0.0 < laid[venting].min() and laid.max() <= 2.0 * example.brake.sander.rate + 1e-9
    assert np.all(np.isfinite(report.column(table, "reference_speed")))
    # Its threshold is a parameter like any other, and the built-in protection is another one.
    loose = stopped(scenario.changed(example, {"brake.protection_parameters.threshold": 0.3}))
    usual = stopped(builtin(example))
    slide = lambda table: max(report.figures(table)["slide while sliding, p95"][0])
    print(f"slide {slide(table):.1f} %, with threshold 0.3 {slide(loose):.1f} %, built in {slide(usual):.1f} %")
    assert slide(loose) > 1.5 * slide(table) and slide(usual) != slide(table)


@pytest.fixture(scope="module")
def protection(tmp_path_factory):
    """A protection that is an FMU: file."""
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    folder = tmp_path_factory.mktemp("protection")
    library = folder / "protection.so"
    subprocess.run([compiler, "-shared", "-fPIC", "-o", library, Path(__file__).parent / "protection.c"], check=True)
    variables = "".join(
        f'<ScalarVariable name="{name}[{axle}]" valueReference="{first + axle - 1}" causality="{causality}" variability="continuous">'
        f"<Real{start}/></ScalarVariable>"
        for name, first, causality, start in (("speed", 0, "input", ' start="0"'), ("valve", 4, "output", ""))
        for axle in range(1, 5)
    )
    outputs = "".join(f'<Unknown index="{index}"/>' for index in range(5, 9))
    with zipfile.ZipFile(folder / "protection.fmu", "w") as packed:
        packed.write(library, "binaries/linux64/protection.so")
        packed.writestr(
            "modelDescription.xml",
            f'<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="2.0" modelName="protection" guid="{{1}}">'
            f'<CoSimulation modelIdentifier="protection"/><ModelVariables>{variables}</ModelVariables>'
            f"<ModelStructure><Outputs>{outputs}</Outputs></ModelStructure></fmiModelDescription>",
        )
    return folder / "protection.fmu"


class Nine:
    """What the FMU does, in Python."""

    def __init__(self, wsp, speeds):
        pass

    def step(self, h, speeds):
        """A valve per axle."""
        return ["vent" if max(speeds) > 1.0 and speed < 0.9 * max(speeds) else "apply" for speed in speeds]


@pytest.mark.skipif(sys.platform != "linux", reason="packs a library for Linux")
def test_the_class_of_the_example_brakes_by_a_protection_that_is_an_fmu(protection, monkeypatch):
    monkeypatch.syspath_prepend(TRAIN)
    from fmu_protection import FmuProtection

    tables = []
    for protector, parameters in ((FmuProtection, {"file": str(protection)}), (Nine, {})):
        example = builtin(scenario.load(TRAIN / "own_controllers.json", QUICK))
        example.brake.protection, example.brake.protection_parameters = protector, parameters
        tables.append(stopped(example))
    valves = [np.array([report.column(table, "valve", k) for k in range(4)]) for table in tables]
    assert (valves[0] == Valve.VENT.value).any() and (valves[0] == valves[1]).all()
    assert report.figures(tables[0])["stopping distance"] == report.figures(tables[1])["stopping distance"]


def builtin(example):
    """The example with the controllers of the package."""
    plain = scenario.changed(example, {})
    plain.brake.protection, plain.brake.sanding, plain.driver = "", "", ""
    plain.brake.protection_parameters, plain.brake.sanding_parameters, plain.driver_parameters = {}, {}, {}
    return plain


def test_classes_go_into_a_loaded_scenario_and_are_not_asked_when_protection_is_off():
    asked = []

    class Vents:
        def __init__(self, wsp, speeds):
            self.count = len(speeds)

        def step(self, h, speeds):
            asked.append(speeds)
            return (Valve.VENT,) * self.count

    loaded = builtin(scenario.load(TRAIN / "own_controllers.json", QUICK | {"longest": 3.0}))
    loaded.brake.protection = Vents
    with pytest.raises(TimeoutError, match="no standstill in 3 s: still 12 m/s"):
        stopped(loaded)
    assert len(asked) == 301 and len(asked[0]) == 4
    loaded.brake.wsp.active, loaded.longest = False, 100.0
    assert report.figures(stopped(loaded))["stopping distance"][0] < 300.0 and len(asked) == 301


# What an own protection says: body of `step`, words of the message.
RUNS = [
    ("return 1.0 / (speeds[0] - speeds[0])",
     r"mine:P at 0.000 s: step failed: ZeroDivisionError: float division by zero \(mine.py:5 in step: return 1.0"),
    ("return self.deeper(speeds)", r"step failed: KeyError: 'axle' \(mine.py:7 in deeper: return \{\}\['axle'\]"),
    ("return None", "step returned None, not a list of 4 valves, one per axle"),
    ("return 'vent'", "step returned 'vent', not a list of 4 valves"),
    ("return ['apply'] * 3", r"step returned \['apply', 'apply', 'apply'\], not a list of 4 valves"),
    ("return ['apply', 'apply', 'open', 'apply']", "axle 3: valve 'open' is none of apply, hold, vent"),
    ("return ['apply', 2, 'apply', 'apply']", "axle 2: valve 2 is none of apply, hold, vent"),
    ("raise SystemExit(3)", "step failed: SystemExit: 3"),
]


def own(tmp_path, text, name="mine:P", key="brake.protection"):
    """A quick scenario with a class of a module beside its files."""
    for path in TRAIN.glob("*.*"):
        shutil.copy(path, tmp_path)
    (tmp_path / "mine.py").write_text(text)
    return scenario.load(tmp_path / "low_adhesion.json", QUICK | {key: name})


@pytest.mark.parametrize("body, words", RUNS, ids=range(len(RUNS)))
def test_mistakes_of_a_protection_are_said_with_time_place_and_axle(tmp_path, body, words):
    text = "class P:\n    def __init__(self, wsp, speeds):\n        pass\n    def step(self, h, speeds):\n        " + body
    loaded = own(tmp_path, text + "\n    def deeper(self, speeds):\n        return {}['axle']\n")
    with pytest.raises(ControllerFailed, match=words):
        Stop(loaded).step(0.01)


@pytest.mark.parametrize("key, value, words", [
    ("driver", "1.5", "mine:P at 0.000 s: step returned demand = 1.5, outside 0 to 1"),
    ("driver", "float('nan')", "step returned nan for demand, not a number"),
    ("driver", "True", "step returned True for demand, not a number"),
    ("brake.sanding", "-0.1", r"step returned sand \[kg/s\] = -0.1, outside 0 to 1"),
    ("brake.sanding", "[1, 2]", r"step returned \[1, 2\] for sand"),
])  # fmt: skip
def test_mistakes_of_driver_and_sanding(tmp_path, key, value, words):
    text = f"class P:\n    def __init__(self, group):\n        pass\n    def step(self, *of):\n        return {value}\n"
    loaded = own(tmp_path, text, key=key)
    loaded.brake.sander.active = True
    with pytest.raises(ControllerFailed, match=words):
        Stop(loaded).step(0.01)


def test_a_mistake_in_the_second_coach_says_so_and_one_in_a_process_of_its_own_arrives(tmp_path):
    text = (
        "class P:\n    made = 0\n    def __init__(self, wsp, speeds):\n        P.made += 1\n        self.mine = P.made\n"
        "    def step(self, h, speeds):\n        return ['apply'] * (4 if self.mine == 1 else 5)\n"
    )
    loaded = own(tmp_path, text)
    loaded.coaches = 2
    with pytest.raises(ControllerFailed, match="mine:P, coach 2, at 0.000 s: step returned"):
        Stop(loaded).step(0.01)
    own(tmp_path, "class P:\n    def __init__(self, wsp, speeds, gain):\n        pass\n    def step(self, h, speeds):\n        pass\n")
    command = [sys.executable, "-m", "wheelrail", "train", str(tmp_path / "low_adhesion.json"), "--rigid", "--out", str(tmp_path)]
    text = (tmp_path / "disc_brake.json").read_text().replace('"torque"', '"protection": "mine:P", "torque"')
    (tmp_path / "disc_brake.json").write_text(text)
    ran = subprocess.run(command, capture_output=True, text=True)
    assert ran.returncode == 1 and ran.stdout == "" and "Traceback" not in ran.stderr
    last = ran.stderr.strip().splitlines()[-1]
    assert last.startswith("error: mine:P at 0.000 s: making it failed: TypeError: ") and "'gain'" in last


def test_modules_are_found_beside_the_file_in_the_working_directory_and_installed(tmp_path, monkeypatch):
    text = "class P:\n    def step(self, h, speeds):\n        pass\n"
    loaded = own(tmp_path, text)
    assert loaded.brake.protection.files[0][0] == str(tmp_path / "mine.py")
    there = tmp_path / "there"
    there.mkdir()
    shutil.move(tmp_path / "mine.py", there / "mine.py")
    with pytest.raises(BadFile, match="no module mine: there is no mine.py in"):
        scenario.changed(builtin(loaded), {"brake.protection": "mine:P"})
    monkeypatch.chdir(there)
    found = scenario.changed(builtin(loaded), {"brake.protection": "mine:P"}).brake.protection
    assert found.files[0][0] == str(there / "mine.py")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(there)
    found = scenario.changed(builtin(loaded), {"brake.protection": "mine:P"}).brake.protection
    assert found.files == () and found.load().__name__ == "P"


def laid(sander, vents, h=0.01, speed=20.0):
    """Flags of steps in which sand was laid."""
    made = Sander(sander)
    return np.array([made.step(h, [speed] * 4, [Valve.VENT if vent else Valve.APPLY]) > 0.0 for vent in vents]), made


def bursts(flags):
    """Begin and length of every run of flags [steps]."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(int)))
    return list(zip(edges[::2], edges[1::2] - edges[::2]))


def test_sand_has_a_delay_a_minimum_time_and_a_run_on():
    sander = SimpleNamespace(active=True, axles=[1, 3], rate=0.01, off_speed=2.0, delay=0.3, minimum_time=1.0, run_on=0.5)
    vents = np.zeros(1000, bool)
    vents[100:106] = True
    flags, made = laid(sander, vents)
    assert bursts(flags) == [(130, 100)] and made.used == pytest.approx(2.0 * 0.01 * 1.0 * 2)
    vents[200:400:7] = True  # a valve that flickers
    flags, _ = laid(sander, vents)
    [(begin, length)] = bursts(flags)
    assert begin == 130 and begin + length == pytest.approx(397 + 50, abs=1)
    assert not laid(sander, vents, speed=1.9)[0].any()
    plain = SimpleNamespace(**vars(sander) | {"delay": 0.0, "minimum_time": 0.0, "run_on": 0.0})
    assert np.array_equal(laid(plain, vents)[0], vents)


def test_a_stop_with_sand_has_few_long_bursts():
    loaded = scenario.load(TRAIN / "patches_and_sand.json", {"speed": 20.0, "step": 0.01, "hold": 0.0, "track": "soap.json"})
    found = {}
    for name, changes in (("as the file says", {}), ("without", dict.fromkeys(("delay", "minimum_time", "run_on"), 0.0))):
        table = stopped(scenario.changed(loaded, {f"brake.sander.{key}": value for key, value in changes.items()}))
        found[name] = bursts(np.diff(report.column(table, "sand"), prepend=0.0) > 0.0)
        print(f"{name}: {len(found[name])} bursts, median {10 * np.median([length for _, length in found[name]]):.0f} ms")
    usual, flickering = found.values()
    assert 3 * len(usual) < len(flickering) and min(length for _, length in usual) >= 100
