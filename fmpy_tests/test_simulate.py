"""The commands `simulate` and `steady`: scenarios, what they write and refuse, and what is left when they are ended."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import wheelrail
from wheelrail.__main__ import main
from wheelrail.run_commands import scenario
from wheelrail.tables import BadFile

pandas = pytest.importorskip("pandas")
SMALL = ["--preset", "paper_d", "--set", "mesh.elements_per_half_width=8", "--set", "mesh.grid_elements_per_half_width=8"]
COARSE = {"mesh.elements_per_half_width": 4, "thermal.enabled": False}
COARSE = [word for name, value in COARSE.items() for word in ("--set", f"{name}={value}".lower())]


@pytest.fixture(autouse=True)
def chosen(packed, tmp_path, monkeypatch):
    """The packed FMU is the default one, and tests write into folders of their own."""
    monkeypatch.setenv("WHEELRAIL_FMU", str(packed.resolve()))
    monkeypatch.chdir(tmp_path)


def ended(capsys, *words):
    """Exit code and messages of a command."""
    try:
        main(list(words))
        code = 0
    except SystemExit as end:
        code = end.code
    return code, capsys.readouterr().err


def start(*words, head=("env", "--default-signal=INT,TERM,HUP")):
    """A command in a process of its own, which hears all signals."""
    command = [*head, sys.executable, "-m", "wheelrail", *words]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | {"PYTHONPATH": str(ROOT / "python/src")})


def test_a_scenario_is_the_run_of_its_inputs(fmu):
    rows = (
        "time,control.rotation,drive.moment,control.translation,drive.velocity,drive.force\n0,moment,0,velocity,10,0\n0.004,moment,-4000,velocity,10.02,0\n"
        "# a jump\n0.004,moment,-2000,velocity,10.02,0\n0.008,2,-2000,1,10,0\n0.01,moment,-2000,force,9.99,0\n"
    )
    Path("scenario.csv").write_text(rows)
    main(["simulate", *SMALL, "--set", "initial.velocity=10", "--scenario", "scenario.csv", "--stop", "0.0125", "--every", "2",
          "--outputs", "hub.moment,wheel.velocity,control.translation,thermal.enabled,profile.pressure,profile.x[31]",
          "--out", "new/run.csv", "--columns", "columns.csv"])  # fmt: skip
    found = pandas.read_csv("new/run.csv", index_col="time")
    assert list(found.index) == [0.0, 0.002, 0.004, 0.006, 0.008, 0.01, 0.012, 0.0125] and list(found.columns[[0, 4, -2, -1]]) == [
        "hub.moment", "profile.pressure[1]", "profile.pressure[61]", "profile.x[31]"]  # fmt: skip
    # Outputs after a step are those at its end, before a jump.
    np.testing.assert_allclose(found["hub.moment"], [0.0, -2000.0, -4000.0, *[-2000.0] * 5])
    np.testing.assert_allclose(found["wheel.velocity"][:5], [10.0, 10.01, 10.02, 10.01, 10.0])
    assert set(found["control.translation"]) == {"velocity", "force"} and set(found["thermal.enabled"]) == {True}
    inputs = scenario(fmu, Path("scenario.csv"))
    parameters = {"preset": "paper_d", "mesh.elements_per_half_width": 8, "mesh.grid_elements_per_half_width": 8, "initial.velocity": 10.0}
    run = wheelrail.simulate(parameters, inputs, stop=0.0125, every=2, outputs="wheel.velocity", fmu=fmu, progress=False)
    np.testing.assert_array_equal(found["wheel.velocity"], run["wheel.velocity"])
    told = pandas.read_csv("columns.csv")
    assert list(told["column"]) == ["time", *found.columns] and list(told["unit"][:3]) == ["s", "N.m", "m/s"] and told["description"].all()


def test_the_summary_is_on_the_error_stream_and_the_default_outputs_on_the_other(capsys):
    main(["simulate", "--stop", "0.003", *SMALL])
    out, said = capsys.readouterr()
    assert len(out.splitlines()) == 5 and out.startswith("time,wheel.velocity,") and out.splitlines()[0].count(",") == 17
    # 50 km/h for 3 ms.
    assert all(words in said for words in ("50.00 km/h", "0.04167 m", "peak creepage", "degC", "heat residual", "energy residual", "real-time")), said


@pytest.mark.parametrize(
    "text, words",
    [
        ("drive.load\n1\n", "column 'time' is missing"),
        ("time,drive.lod\n0,1\n", "did you mean drive.load?"),
        ("time,contact.force_x\n0,1\n", "unknown column 'contact.force_x'"),
        ("time,drive.load\n0,1\n2,1\n1,1\n", ":4: time = 1 s follows 2 s"),
        ("time,drive.load\n0,1e5\n1,-5\n", ":3: drive.load = -5 N is outside 0 to 1e+09 N"),
        ("time,drive.load\n0,\n", ":2: drive.load is '', not a number"),
        ("time,control.vertical\n0,up\n", ":2: control.vertical = 'up' is none of force, displacement, 1, 2"),
        ("time,drive.load\n0,1,5\n", "1.5, not 1,5"),
        ("time;drive.load\n0;1\n", "semicolons"),
        ("time,drive.load\n1700000000,1\n", "outside -1e+08 to 1e+08 s"),
        ("time,drive.load\n", "no line of values"),
        ("time,drive.load,drive.load\n0,1,1\n", "twice"),
    ],
)
def test_a_file_that_is_no_scenario_is_refused_by_line_and_name(text, words, fmu):
    Path("wrong.csv").write_text(text)
    with pytest.raises(BadFile) as refusal:
        scenario(fmu, Path("wrong.csv"))
    assert words in str(refusal.value)


def test_a_file_that_never_ends_is_no_scenario(fmu):
    os.mkfifo("pipe.csv")
    with pytest.raises(BadFile, match="pipe.csv: is no regular file"):
        scenario(fmu, Path("pipe.csv"))


@pytest.mark.parametrize(
    "line, words",
    [
        ("simulate --set drive.laod=1", "did you mean drive.load"),
        ("simulate --set drive.load", "NAME=VALUE"),
        ("simulate --set drive.load=-1", "0 to 1e9 N"),
        ("simulate --set drive.load=much", "not a number [N]"),
        ("simulate --set contact.force_x=1", "of causality output"),
        ("simulate --set control.rotation=torque", "none of velocity, moment"),
        ("simulate --set wheel.hub_radius=0.45", "0.0092 to 0.414 m with wheel.radius"),
        ("simulate --set solver.theta=0.5", "was retired in 0.2.0"),
        ("simulate --preset railway_elipse", 'did you mean "railway_ellipse"?'),
        ("simulate --step -1", "step = -1"),
        ("simulate --stop -1", "stop = -1"),
        ("simulate --every 0", "every = 0"),
        ("simulate --outputs contact.force_xx", "did you mean contact.force_x"),
        ("simulate --scenario absent.csv", "absent.csv: cannot be read"),
        ("simulate --out a.csv --wheel-profile ./a.csv", "--out and --wheel-profile are one file"),
        ("simulate --wheel-profile profile.txt", "must end in .csv"),
        ("simulate --fmu none.fmu", "none.fmu does not exist"),
        ("simulate --cache here", "the variable WHEELRAIL_CACHE"),
        ("steady --resources=here", "wheelrail-pack pack --resources"),
        ("steady --creepage 0:1", "FROM:TO:COUNT"),
        ("steady --creepage 3", "outside -2 to 2"),
        ("steady --velocity 300", "-200 to 200"),
        ("steady --set rail.friction=0", "name a creepage"),
        ("steady --set drive.omega=1", "drive.omega follows"),
        ("export --creepage 2e-3", "cargo run --release --example fields"),
        ("pack", "target/release/wheelrail-pack pack"),
        ("describe", "target/release/wheelrail-pack describe"),
    ],
)
def test_wrong_arguments_end_with_code_2_and_say_what_is_possible(line, words, capsys):
    code, said = ended(capsys, *line.split())
    assert code == 2 and words in said and not list(Path().iterdir()), said


def test_a_run_that_fails_ends_with_code_1_and_keeps_what_was_computed(capsys):
    Path("overload.csv").write_text("time,drive.load\n0,1e5\n0.002,1e5\n0.01,9e6\n")
    code, said = ended(capsys, "simulate", "--scenario", "overload.csv", "--out", "run.csv", *SMALL)
    found = pandas.read_csv("run.csv")
    assert code == 1 and "model.nominal_load" in said and f"run.csv holds what was computed up to {found['time'].iloc[-1]} s" in said, said
    assert 3 <= len(found) < 11 and (found["contact.force_y"] > 9e4).all()
    assert ended(capsys, "steady", "--creepage", "0", "--out", "run.csv/steady.csv", *SMALL)[0] == 2


def test_the_profile_of_the_wheel_at_the_end_is_written_and_read_again(capsys):
    run = ["simulate", "--stop", "0.002", "--outputs", "wheel.profile_height", *SMALL]
    squat = "wheel.profile=squat(position = 0, length = 0.01, depth = 1e-5)"
    main([*run, "--wheel-profile", "left.csv", "--set", squat, "--set", "damage.wear=t_gamma"])
    profile = pandas.read_csv("left.csv")
    assert list(profile) == ["position", "height"] and len(profile) > 2
    capsys.readouterr()
    main([*run, "--set", "wheel.profile=left.csv"])
    assert float(capsys.readouterr().out.splitlines()[1].split(",")[1]) == pytest.approx(-1e-5, rel=1e-3)


def test_a_stationary_curve_is_shown_in_everyday_units(capsys):
    point = ["steady", *SMALL, "--velocity", "13.9", "--creepage", "3e-4"]
    main(point)
    names, values = (line.split(",") for line in capsys.readouterr().out.splitlines())
    main([*point, "--table"])
    heads, units, cells = (line.split() for line in capsys.readouterr().out.splitlines())
    assert heads == [name.split(".")[1] for name in names] and units[1] == "[kN]" and units[2] == "[1]"
    assert float(cells[1]) == pytest.approx(1e-3 * float(values[1]), rel=1e-3)


SIMULATE = ("simulate", "--stop", "100000", "--out", "run.csv", "--wheel-profile", "wheel.csv")
STEADY = ("steady", "--creepage=-1e-3:1e-3:1000000", "--out", "run.csv")


@pytest.mark.parametrize("name, code, command", [("INT", 130, SIMULATE), ("TERM", 143, STEADY), ("HUP", 129, SIMULATE)])
def test_what_was_computed_until_a_signal_is_in_its_place(name, code, command):
    Path("run.csv").write_text("an earlier run\n")
    process = start(*command, *SMALL)
    time.sleep(8.0)
    process.send_signal(getattr(signal, f"SIG{name}"))
    said = process.communicate(timeout=120)[1]
    found = pandas.read_csv("run.csv")
    assert process.returncode == code and not found.isna().any().any(), said
    holds = f"what was computed up to {found['time'].iloc[-1]} s" if command == SIMULATE else f"the first {len(found)} of 1000000 creepages"
    assert f"run.csv holds {holds}" in said and said.splitlines()[-1].startswith("error: stopped"), said
    assert sorted(os.listdir()) == (["run.csv", "wheel.csv"] if command == SIMULATE else ["run.csv"])


def test_a_signal_that_the_process_was_started_to_ignore_is_ignored():
    process = start("simulate", "--stop", "0.5", "--out", "run.csv", *SMALL, head=("nohup",))
    time.sleep(1.0)
    process.send_signal(signal.SIGHUP)
    said = process.communicate(timeout=120)[1]
    assert process.returncode == 0 and len(pandas.read_csv("run.csv")) == 501, said


def test_relative_paths_begin_where_the_user_is_and_a_missing_file_is_told_with_both_places(capsys):
    Path("mine.csv").write_text("position,height\n0,0\n1,1\n")
    code, said = ended(capsys, "steady", "--set", "rail.profile=mine.csv")
    assert code == 2 and str(Path("mine.csv").absolute()) in said and "height = 1 m" in said, said
    for parameter in ("rail.profile", "wheel.profile", "contact.rows"):
        shape = "rows" if parameter == "contact.rows" else "line"
        _, said = ended(capsys, "steady", "--set", f"contact.shape={shape}", "--set", f"{parameter}=none.csv")
        assert all(word in said for word in (parameter, str(Path("none.csv").absolute()), "resources/none.csv", "working directory")), said


def test_a_cache_that_is_missing_is_made_or_said_to_be_out_of_reach():
    Path("file").write_text("")
    for place, said in (("new/cache", None), ("file/x", "cannot be kept"), ("", None)):
        os.environ["WHEELRAIL_CACHE"] = place and str(Path(place).absolute())
        try:
            process = start("steady", "--creepage", "0.001", *COARSE)
            told = [line for line in process.communicate(timeout=120)[1].splitlines() if "basis" in line]
        finally:
            del os.environ["WHEELRAIL_CACHE"]
        assert process.returncode == 0 and len(told) == bool(said) and all(said in line and "WHEELRAIL_CACHE" in line for line in told), told
    assert [path.suffix for path in Path("new/cache/basis").iterdir()] == [".bin"]


BESIDE = {
    "chainage": (12000.0, 20.0, ("from 12000 to 12000.4 m", "position = -12000)")),
    "ahead": (5.0, 20.0, ("from 5 to 5.39 m", "has been between 0 and 0.1", "= -5)")),
    "backwards": (-9.0, -20.0, ("from -9 to -8.61 m", "-0.1", "= 8.61)")),
    "behind": (-5.0, 20.0, ("passed the last sample", "-5.000 to -4.610 m")),
    "met": (-0.1, 20.0, ()),
    "gap": (-0.2, 20.0, ("no samples between 0 and 0.11 m", "0.01 m apart")),
    "hole": (None, 20.0, ("no effect", "0.1")),
    "section": (None, 20.0, ("differ by 8.1 mm in height on a length of 72 mm", "cross-section", "contact.rail_lateral_radius")),
}


@pytest.mark.parametrize("name", BESIDE)
def test_profiles_beside_the_way_gaps_in_them_and_cross_sections_are_told(name, capsys):
    begin, velocity, words = BESIDE[name]
    k = np.arange(40)
    places = k * 1e-3 - 0.036 if begin is None else begin + 0.01 * k + (0.1 * (k > 20) if name == "gap" else 0.0)
    profile = pandas.DataFrame({"position": places, "height": 1e-7 * (k % 3)})
    if name == "section":
        z = 1e-3 * np.arange(-36, 37)
        profile = pandas.DataFrame({"position": z, "height": -z * z / 0.16})
    profile.to_csv("profile.csv", index=False)
    text = "hole(position = 50, length = 0.005, depth = 0.0001)" if name == "hole" else "profile.csv"
    sets = [f"initial.velocity={velocity}", "thermal.enabled=false", f"rail.profile={text}"]
    stop = "0" if name == "section" else "0.005"
    code, said = ended(capsys, "simulate", "--stop", stop, "--step", "0.0002", *(word for each in sets for word in ("--set", each)))
    found = [line for line in said.splitlines() if line.startswith("warning: ")]
    assert code == 0 and bool(found) == bool(words) and all(word in found[0] for word in words), found


def test_a_width_that_is_that_of_the_wheel_is_told_and_that_of_a_wheelset_is_not(capsys):
    run = ["simulate", "--stop", "0.001", "--set", "thermal.enabled=false", "--set"]
    _, said = ended(capsys, *run, "model.contact_width=0.135")
    assert all(word in said for word in ("model.contact_width = 0.135 m", "0.32 times the pressure", "the width is 0.014 m", "thermal.rim_width")), said
    assert "warning" not in ended(capsys, *run, "model.contact_width=0.028", "--set", "model.nominal_load=200000")[1]
