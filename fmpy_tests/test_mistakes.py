"""Mistakes with the package: one line that says what is wrong with which value, and what to do."""

import math
import os
import zipfile

import numpy as np
import pytest

import wheelrail
from wheelrail import Fmu, Refused, Wheel

MISSING = "target/no_such.fmu"


@pytest.fixture(scope="module")
def wheel(fmu):
    """A wheel for all mistakes: none of them may change it."""
    with Wheel(fmu, {"initial.velocity": 20.0}) as wheel:
        yield wheel


def opened(tmp_path, content, name="a.fmu"):
    """An attempt to open a file of that content."""
    path = tmp_path / name
    path.write_bytes(content)
    return Fmu(path)


def zipped(tmp_path, name="other.txt", text="x"):
    """An attempt to open an archive with one file."""
    with zipfile.ZipFile(tmp_path / "b.fmu", "w") as archive:
        archive.writestr(name, text)
    return Fmu(tmp_path / "b.fmu")


def damaged(tmp_path):
    """The bytes of an archive whose compressed content is changed."""
    with zipfile.ZipFile(tmp_path / "c.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("modelDescription.xml", "<fmiModelDescription/>" * 100)
    content = bytearray((tmp_path / "c.zip").read_bytes())
    content[55:65] = bytes(10)
    return bytes(content)


OPENING = {
    "no such file": (lambda t: Fmu(MISSING), FileNotFoundError, "no_such.fmu does not exist: build it"),
    "a directory": (lambda t: Fmu(t), FileNotFoundError, "is a folder and no FMU: name the file, such as "),
    "a damaged archive": (lambda t: opened(t, damaged(t)), Refused, "is no FMU"),
    "a number": (lambda t: Fmu(3), ValueError, "expected the path of an FMU"),
    "a text": (lambda t: opened(t, b"a,b\n1,2\n"), Refused, "a.fmu is no FMU: File is not a zip file"),
    "an empty file": (lambda t: opened(t, b""), Refused, "is no FMU"),
    "another archive": (lambda t: zipped(t), Refused, "is no FMU"),
    "a broken description": (lambda t: zipped(t, "modelDescription.xml", "<fmi"), Refused, "is no FMU"),
    "a path in place of an FMU": (lambda t: Wheel("target/wheelrail.fmu"), ValueError, "expected an opened FMU"),
}


@pytest.mark.parametrize("name", OPENING)
def test_what_is_no_fmu_is_named(name, tmp_path):
    refused(*[OPENING[name][0], *OPENING[name][1:]], tmp_path)


def refused(call, error, words, *arguments):
    """The mistake is refused in one line with these words."""
    with pytest.raises(error) as failure:
        call(*arguments)
    text = str(failure.value)
    print(text)
    assert words in text and "\n" not in text and len(text) < 400


STARTING = {
    "parameters that are no names": (lambda f: Wheel(f, [("drive.load", 1e5)]), ValueError, "expected names and values"),
    "a misspelt parameter": (lambda f: Wheel(f, {"wheel.radios": 0.5}), Refused, "did you mean wheel.radius?"),
    "a preset that is not there": (lambda f: Wheel(f, {"preset": "tram"}), Refused, "available presets: paper_a"),
    "a preset that is no text": (lambda f: Wheel(f, {"preset": 3}), Refused, "preset = 3 is not a text"),
    "a text for a number": (lambda f: Wheel(f, {"wheel.radius": "large"}), Refused, "wheel.radius = 'large' is not a number [m]"),
    "half an element": (lambda f: Wheel(f, {"mesh.elements_per_half_width": 10.5}), Refused, "10.5 is not a whole number"),
    "another switch": (lambda f: Wheel(f, {"thermal.enabled": "yes"}), Refused, "'yes' is not True or False"),
    "a choice that is none": (lambda f: Wheel(f, {"rail.ends": "fast"}), Refused, "is none of free"),
    "an input out of range": (lambda f: Wheel(f, {}, {"drive.load": -1.0}), Refused, "drive.load"),
    "an output among inputs": (lambda f: Wheel(f, {}, {"wheel.omega": 0.5}), Refused, "wheel.omega is an output"),
    "a profile that cannot be": (lambda f: Wheel(f, {"rail.profile": "sine(1)"}), Refused, "rail.profile"),
}


@pytest.mark.parametrize("name", STARTING)
def test_a_wheel_that_cannot_start_says_why(name, fmu):
    refused(*STARTING[name], fmu)


STEPPING = {
    "no name": (lambda w: w.get(), ValueError, "needs the name of a variable"),
    "a number for a name": (lambda w: w.get(3), ValueError, "3 is not the name of a variable"),
    "a misspelt output": (lambda w: w.get("wheel.omga"), Refused, "did you mean wheel.omega?"),
    "a misspelt profile": (lambda w: w.profile("presure"), Refused, "it has x, pressure"),
    "a misspelt quantity of lines": (lambda w: w.line("presure"), Refused, "they have line.position, line.half_length"),
    "a number for one": (lambda w: w.line(3), Refused, "lines have no 'line.3'"),
    "a text for a force": (lambda w: w.set({"drive.load": "heavy"}), Refused, "drive.load = 'heavy' is not a number [N]"),
    "nothing for a force": (lambda w: w.set({"drive.load": None}), Refused, "drive.load = None is not a number [N]"),
    "an array for a force": (lambda w: w.set({"drive.load": np.ones(99)}), Refused, "drive.load = array("),
    "an output set": (lambda w: w.set({"contact.force_x": 1.0}), Refused, "contact.force_x is an output"),
    "a pair for names": (lambda w: w.set(("drive.load", 1e5)), ValueError, "expected names and values"),
    "a rate of a choice": (lambda w: w.set_rates({"control.rotation": 1.0}), Refused, "control.rotation is a choice"),
    "a text for a step": (lambda w: w.step("1 ms"), ValueError, "step('1 ms'): expected a number of seconds"),
    "no step": (lambda w: w.step(None), ValueError, "expected a number of seconds"),
    "a step back": (lambda w: w.step(-1e-3), Refused, "communicationStepSize"),
    "a time for a state": (lambda w: w.restore(0.0), ValueError, "0.0 is not what save() returned"),
}


@pytest.mark.parametrize("name", STEPPING)
def test_a_wrong_call_changes_nothing(name, wheel):
    before = wheel.get("drive.load", "contact.force_x", "control.rotation")
    refused(*STEPPING[name], wheel)
    assert wheel.get("drive.load", "contact.force_x", "control.rotation") == before and wheel.time == 0.0


def test_a_wheel_that_is_closed_says_so(fmu):
    wheel = Wheel(fmu)
    wheel.close()
    wheel.close()
    for call in (lambda: wheel.step(1e-3), lambda: wheel.get("contact.force_x"), lambda: wheel.set({"drive.load": 1e5})):
        refused(call, Refused, "the wheel is closed")


def test_a_wheel_of_an_fmu_that_is_closed_says_so(packed):
    with Fmu(packed) as closed:
        pass
    refused(lambda: Wheel(closed), Refused, "the FMU is closed")


RECORDING = {
    "a misspelt output": (lambda w: w.record("contact.froce_x"), Refused, "did you mean contact.force_x?"),
    "a pattern of nothing": (lambda w: w.record("contct.*"), Refused, "outputs are brake.*, contact.*"),
    "a number for a name": (lambda w: w.record(3), ValueError, "3 is not the name of a variable or a pattern"),
    "a text": (lambda w: w.record("preset"), Refused, "preset is a text"),
    "a misspelt profile": (lambda w: w.record(profiles=["presure"]), Refused, "it has x, pressure"),
    "a depth among profiles": (lambda w: w.record(profiles=["depth"]), Refused, "profiles has no 'depth'"),
    "a number of profiles": (lambda w: w.record(profiles=3), ValueError, "profiles = 3 is neither True nor False"),
    "every no step": (lambda w: w.record(every=0), ValueError, "every = 0 is no number of steps, 1 or more"),
    "every half step": (lambda w: w.record(every=0.5), ValueError, "every = 0.5 is no number of steps"),
}


@pytest.mark.parametrize("name", RECORDING)
def test_a_record_that_cannot_be_says_why(name, wheel):
    pytest.importorskip("xarray")
    refused(*RECORDING[name], wheel)


def run(fmu, parameters=None, inputs=None, **how):
    """An attempt to simulate a step."""
    return wheelrail.simulate(parameters, inputs, fmu=fmu, **{"stop": 1e-3} | how)


RUNNING = {
    "no FMU": (lambda f: run(MISSING), FileNotFoundError, "does not exist: build it"),
    "a stop of nothing": (lambda f: run(f, stop="1 s"), ValueError, "stop = '1 s' is not a number of seconds"),
    "an endless run": (lambda f: run(f, stop=math.inf), ValueError, "stop = inf is not a number of seconds"),
    "a run back": (lambda f: run(f, stop=-1.0), ValueError, "stop = -1.0 is not a number of seconds, at least 0"),
    "no step": (lambda f: run(f, step=0.0), ValueError, "step = 0.0 is not a number of seconds, more than 0"),
    "steps too long": (lambda f: run(f, step=1e9, stop=1e9), Refused, "communicationStepSize"),
    "inputs that are no names": (lambda f: run(f, {}, ["drive.load"]), ValueError, "expected names and values"),
    "a misspelt input": (lambda f: run(f, {}, {"drive.laod": 1e5}), Refused, "did you mean drive.load?"),
    "a parameter for an input": (lambda f: run(f, {}, {"wheel.radius": 0.5}), Refused, "give it in parameters"),
    "an output for an input": (lambda f: run(f, {}, {"wheel.omega": 1.0}), Refused, "wheel.omega is no input but an output"),
    "values without times": (lambda f: run(f, {}, {"drive.load": [1e5] * 3}), ValueError, "no pair of times and values"),
    "a time too many": (lambda f: run(f, {}, {"drive.load": ([0.0, 1.0, 2.0], [1e5] * 2)}), ValueError, "3 times and 2 values"),
    "no times": (lambda f: run(f, {}, {"drive.load": ([], [])}), ValueError, "drive.load is empty"),
    "times that fall": (lambda f: run(f, {}, {"drive.load": ([0.0, 2.0, 1.0], [1e5] * 3)}), ValueError, "1 s follows 2 s"),
    "times that are none": (lambda f: run(f, {}, {"drive.load": (["a"], [1e5])}), ValueError, "times are ['a'], neither seconds"),
    "a hole in the times": (lambda f: run(f, {}, {"drive.load": ([0.0, math.nan], [1e5, 1e5])}), ValueError, "time 2 is missing"),
    "a text among values": (lambda f: run(f, {}, {"drive.load": ([0.0, 1.0], [1e5, "x"])}), Refused, "'x' is not a number [N]"),
    "a function of texts": (lambda f: run(f, {}, {"drive.load": lambda t: "x"}), Refused, "at 0 s drive.load"),
    "a choice that is none": (lambda f: run(f, {}, {"control.rotation": "omega"}), Refused, "is none of velocity, moment"),
    "a misspelt output": (lambda f: run(f, outputs="wheel.omga"), Refused, "did you mean wheel.omega?"),
}


@pytest.mark.parametrize("name", RUNNING)
def test_a_run_that_cannot_be_says_why(name, fmu):
    pytest.importorskip("xarray")
    refused(*RUNNING[name], fmu)


def test_files_that_are_no_records_are_named(fmu, tmp_path):
    pytest.importorskip("h5netcdf")
    record = run(fmu, outputs="wheel.omega")
    refused(wheelrail.save, ValueError, "records are .nc (NetCDF) or .parquet files", record, tmp_path / "run.xlsx")
    refused(wheelrail.save, ValueError, "save(DataFrame): expected the Dataset", wheelrail.table(record), tmp_path / "a.nc")
    refused(wheelrail.save, ValueError, "3 is not the path of a file", record, 3)
    refused(wheelrail.load, FileNotFoundError, "no.nc does not exist", tmp_path / "no.nc")
    (tmp_path / "text.nc").write_text("time,wheel.omega\n0,1\n")
    refused(wheelrail.load, ValueError, "text.nc is no nc file that can be read", tmp_path / "text.nc")
    if os.geteuid():
        (tmp_path / "shut").mkdir(mode=0o500)
        refused(wheelrail.save, OSError, "cannot be written", record, tmp_path / "shut" / "run.nc")
    (tmp_path / "file").write_text("")
    refused(wheelrail.save, OSError, "cannot be written", record, tmp_path / "file" / "run.nc")


def test_parquet_files_of_others_are_named(tmp_path):
    pandas, _ = pytest.importorskip("pandas"), pytest.importorskip("pyarrow")
    pandas.DataFrame({"a": [1.0]}).to_parquet(tmp_path / "a.parquet")
    refused(wheelrail.load, ValueError, "none that wheelrail.save has written", tmp_path / "a.parquet")


def test_what_is_not_installed_is_named(wheel, monkeypatch):
    import importlib

    def missing(name):
        raise ImportError(name)

    monkeypatch.setattr(importlib, "import_module", missing)
    refused(wheel.record, ImportError, "records need xarray, which is not installed: pip install wheelrail[records]")
