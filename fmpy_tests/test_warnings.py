"""What the FMU doubts is said in Python: once each, of the user's own line, and an error where the user wants one."""

import json
import re
import shutil
import subprocess
import sys
import warnings
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import wheelrail
from test_own_controllers import TRAIN
from wheelrail import WheelrailWarning, compare, scenario, sweep, team, warn
from wheelrail.__main__ import main
from wheelrail.train import Stop

COLD, LIGHT = "rail.temperature = 20 K", "drive.load = 100 N"
DOUBT = "friction.coefficient = 3 is a ratio"
DOUBTED = {"friction.coefficient": 3.0, "mesh.elements_per_half_width": 6}
DOUBTFUL = {"rail.temperature": 20.0, "drive.load": 100.0}
pytest.importorskip("xarray", reason="xarray is not installed (requirements/records.txt)")


def line_of(text):
    """Number of the only line of this file that ends with a mark."""
    (number,) = (k for k, line in enumerate(Path(__file__).read_text().splitlines(), 1) if line.endswith(f"# {text}"))
    return number


def heard(function):
    """What a function says of ours."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("default")
        function()
    return [warning for warning in said if warning.category is WheelrailWarning]


def test_a_run_says_each_doubt_once_of_the_line_that_called_it_and_says_it_again_in_the_next_run(fmu):
    def run():
        for _ in range(2):
            runs.append(wheelrail.simulate(inputs=DOUBTFUL, stop=5e-3, outputs="wheel.omega", fmu=fmu))  # the run

    runs = []
    said = heard(run)
    texts = [str(warning.message) for warning in said]
    print("\n".join(f"{warning.filename}:{warning.lineno}: {warning.message}" for warning in said))
    assert {(warning.filename, warning.lineno) for warning in said} == {(__file__, line_of("the run"))}
    assert set(Counter(texts).values()) == {2}
    assert [sum(words in text for text in texts) for words in (COLD, LIGHT)] == [2, 2]
    assert [entry["text"] for entry in json.loads(runs[0].attrs["warnings"])] == texts[: len(texts) // 2]


def test_a_wheel_says_a_doubt_in_the_line_of_the_call_on_any_thread(fmu):
    def step(wheel):
        wheel.step(1e-3)  # the step

    def on_threads():
        with team.Team(2) as both, wheelrail.Wheel(fmu) as one, wheelrail.Wheel(fmu) as two:
            for wheel in (one, two):
                wheel.set({"rail.temperature": 20.0})
            for _ in range(3):
                both.map(step, [one, two])
            logs.extend([one.log, two.log])

    logs = []
    said = heard(on_threads)
    assert [warning.lineno for warning in said] == [line_of("the step")] * 2
    assert [[(message.status, COLD in message) for message in log] for log in logs] == [[(1, True)]] * 2


def test_as_errors_they_end_a_run_and_leave_nothing_open(fmu):
    with warnings.catch_warnings():
        warnings.simplefilter("error", WheelrailWarning)
        with pytest.raises(WheelrailWarning, match="load 100 N"):
            wheelrail.simulate(inputs={"drive.load": 100.0}, stop=5e-3, fmu=fmu)
        with pytest.raises(WheelrailWarning, match=COLD) as ended:
            wheelrail.simulate(inputs={"rail.temperature": ([0.0, 3e-3, 3e-3], [293.0, 293.0, 20.0])}, stop=9e-3, fmu=fmu)
        # The step that led to it is done and recorded.
        np.testing.assert_allclose(ended.value.run.time, [0.0, 1e-3, 2e-3, 3e-3, 4e-3])
        wheel = wheelrail.Wheel(fmu)
        wheel.set({"rail.temperature": 20.0})
        with pytest.raises(WheelrailWarning, match=COLD):
            wheel.step(1e-3)
        assert wheel.time == 1e-3
        wheel.step(1e-3)
        assert wheel.time == 2e-3 and wheel.get("wheel.distance") > 0.0
        wheel.close()


def test_silence_is_a_filter(fmu):
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("ignore", WheelrailWarning)
        wheelrail.simulate(inputs=DOUBTFUL, stop=2e-3, outputs="wheel.omega", fmu=fmu)
    assert said == []


@pytest.fixture
def doubtful():
    """A stop of half a second whose wheels start with a doubt: they lose what a preset says to what is written."""
    s = scenario.load(TRAIN / "low_adhesion.json")
    s.speed, s.step, s.hold, s.brake.delay, s.brake.fill_time = 0.5, 0.01, 0.0, 0.0, 0.2
    s.wheel |= DOUBTED
    return s


def test_a_stop_says_what_its_wheelsets_doubt_once_with_the_first_axle_that_does(doubtful, fmu):
    def brake():
        run = Stop(doubtful, fmu, dry=0.3)  # the stop
        run.step(0.01)
        run.close()

    said = heard(brake)
    print("\n".join(str(warning.message) for warning in said))
    assert said and all(str(warning.message).startswith("axle 1: ") for warning in said)
    assert said[0].lineno == line_of("the stop") and len({str(w.message) for w in said}) == len(said)
    assert sum(DOUBT in str(warning.message) for warning in said) == 1


def test_stops_in_processes_of_their_own_are_heard_in_the_one_that_asked(doubtful, packed):
    def brake():
        compare.side_by_side(doubtful, packed.resolve())  # three stops

    said = heard(brake)
    assert sum(DOUBT in str(warning.message) for warning in said) == 1
    assert {warning.lineno for warning in said} == {line_of("three stops")}
    assert re.match("(dry|WSP on|WSP off), axle 1: ", str(said[0].message))


def test_a_sweep_says_what_its_workers_doubt(doubtful, packed, tmp_path):
    import distributed

    doubtful.sweep.speed, doubtful.sweep.adhesion = [0.5], [0.1, 0.2]
    doubtful.sweep.payload, doubtful.sweep.slide_high = [0.0], [0.15]
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    rows = []
    with cluster, distributed.Client(cluster) as client:
        said = heard(lambda: rows.extend(sweep.sweep(client, doubtful, packed.resolve(), tmp_path / "a.csv")[0]))
    assert len(rows) == 2
    assert sum(DOUBT in str(warning.message) for warning in said) == 1
    assert "adhesion" in str(said[0].message) or str(said[0].message).startswith("dry"), said[0].message


def test_the_command_line_says_them_in_one_line_each(packed, tmp_path):
    shutil.copytree(TRAIN, tmp_path / "train")
    brake = json.loads((TRAIN / "disc_brake.json").read_text()) | {"delay": 0.0, "fill_time": 0.2}
    (tmp_path / "train" / "disc_brake.json").write_text(json.dumps(brake))
    values = json.loads((TRAIN / "low_adhesion.json").read_text()) | {"speed": 0.5, "step": 0.01, "hold": 0.0}
    values["wheel"] |= DOUBTED
    (tmp_path / "train" / "mine.json").write_text(json.dumps(values))
    command = [sys.executable, "-m", "wheelrail", "train", "train/mine.json", "--fmu", packed.resolve()]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    lines = [line for line in done.stderr.splitlines() if DOUBT in line]
    print(done.stderr)
    assert done.returncode == 0 and len(lines) == 1 and lines[0].startswith("warning: ") and "Traceback" not in done.stderr


def test_a_warning_that_is_an_error_ends_a_command_with_one_line(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(compare, "side_by_side", lambda *_: warn.warn("a doubt"))
    with warnings.catch_warnings(), pytest.raises(SystemExit) as ended:
        warnings.simplefilter("error", WheelrailWarning)
        main(["train", str(TRAIN / "low_adhesion.json"), "--rigid", "--out", str(tmp_path)])
    assert ended.value.code == 1 and capsys.readouterr().err.endswith("without effect: solver.tolerance, mesh.elements_per_half_width\nerror: a doubt\n")
