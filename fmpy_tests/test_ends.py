"""How commands and example 5 end that are interrupted, whose reader has gone, or whose files cannot be written: a line and an exit code."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

import wheelrail
from test_own_controllers import TRAIN
from wheelrail.__main__ import main

COMMAND = [sys.executable, "-m", "wheelrail"]
LOCKED = [sys.executable, str(Path(__file__).resolve().parent.parent / "examples" / "ex05_locked_wheels.py"), "--speeds", "60", "--meshes", "10"]
pytest.importorskip("pandas", reason="pandas is not installed (requirements/records.txt)")


@pytest.mark.parametrize("command", [["schema", "scenario"], ["completion", "bash"], ["filter"]])
def test_a_reader_that_has_gone_leaves_no_traceback(command, tmp_path):
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run([*COMMAND, *command], cwd=tmp_path, stdout=writing, stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert done.returncode == 1 and done.stderr == "", done.stderr


def test_what_was_computed_is_written_although_nobody_reads_what_is_printed(tmp_path):
    shutil.copytree(TRAIN, tmp_path / "train")
    values = json.loads((TRAIN / "low_adhesion.json").read_text()) | {"speed": 0.5, "step": 0.01, "hold": 0.0}
    (tmp_path / "train" / "mine.json").write_text(json.dumps(values))
    reading, writing = os.pipe()
    os.close(reading)
    line = ["train", "train/mine.json", "--rigid"]
    done = subprocess.run([*COMMAND, *line], cwd=tmp_path, stdout=writing, stderr=subprocess.PIPE, text=True, env=os.environ | {"PYTHONUNBUFFERED": "1"})
    os.close(writing)
    assert done.returncode == 1 and (tmp_path / "results" / "mine" / "train_dry.csv").is_file(), done.stderr


def test_standard_output_by_its_name_is_a_place_for_results(packed, tmp_path):
    line = [*COMMAND, "simulate", "--stop", "0.002", "--outputs", "wheel.distance", "--out", "/dev/stdout", "--fmu", packed.resolve()]
    done = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.splitlines()[0] == "time,wheel.distance" and len(done.stdout.splitlines()) == 4, done.stderr


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="signals of Unix")
@pytest.mark.parametrize("number, code, words", [(signal.SIGINT, 130, "stopped"), (signal.SIGTERM, 143, "stopped by SIGTERM")])
def test_a_study_of_locked_wheels_ends_within_a_step_of_its_runs(number, code, words, packed, tmp_path):
    running = subprocess.Popen([*LOCKED, "--stop", "600", "--fmu", packed.resolve()], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert running.stdout.readline().startswith("3 runs of 600 s")
    time.sleep(1.0)  # the runs are under way; what they compute takes minutes
    running.send_signal(number)
    _, said = running.communicate(timeout=60)
    assert running.returncode == code and said == f"error: {words}\n", said


def test_a_place_without_room_for_a_file_is_refused_before_anything_is_computed(packed, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(wheelrail.runs, "simulate", lambda *_, **__: pytest.fail("was computed"))
    monkeypatch.setattr(wheelrail.operating, "steady", lambda *_, **__: pytest.fail("was computed"))
    (tmp_path / "file").write_text("")
    for command, option, path in (("simulate", "--out", "."), ("simulate", "--columns", "file/a.csv"), ("steady", "--out", "."), ("steady", "--out", "file/a.csv")):
        with pytest.raises(SystemExit) as ended:
            main([command, option, path, "--fmu", str(packed.resolve())])
        said = capsys.readouterr().err
        assert ended.value.code == 2 and said.startswith(f"error: {option}: {path} cannot be written: ") and said.count("\n") == 1, said
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize(
    "line, words",
    [
        (["steady", "--creepage", "0:1:1000000000000"], "2 to 1000000 points for a range"),
        (["steady", "--creepage", "0:1"], "FROM:TO:COUNT (2 parts)"),
        (["steady", "--creepage", "5"], "creepage = 5.0 is outside -2 to 2"),
        (["simulate", "--set", "=3"], "'=3': expected NAME=VALUE"),
        (["simulate", "--outputs", ""], "the FMU has no variable ''"),
    ],
)
def test_what_is_wrong_in_an_option_is_said_with_its_value(line, words, packed, capsys):
    with pytest.raises(SystemExit) as ended:
        main([*line, "--fmu", str(packed.resolve())])
    said = capsys.readouterr().err
    assert ended.value.code == 2 and words in said.splitlines()[-1], said
