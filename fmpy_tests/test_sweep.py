"""A sweep over workers: nothing is lost when one is killed, nothing is computed twice when it goes on."""

import csv
import json
import math
import os
import re
import shutil
import signal
import subprocess
import sys
import threading
from collections import Counter
from pathlib import Path

import distributed
import pytest

from wheelrail import scenario, sweep, sweep_table
from wheelrail.files import BadFile
from wheelrail.output import beside
from wheelrail.plots_sweep import draw_sweep

TRAIN = Path(__file__).parent.parent / "examples" / "train"


@pytest.fixture
def many():
    """64 short stops."""
    s = scenario.load(TRAIN / "low_adhesion.json")
    s.step, s.hold, s.brake.delay, s.brake.fill_time = 0.01, 0.0, 0.0, 0.5
    s.sweep.speed, s.sweep.adhesion = [0.5, 0.6, 0.8, 3.0], [0.05, 0.08, 0.12, 0.2]
    s.sweep.payload, s.sweep.slide_high = [0.0, 10000.0], [0.15, 0.25]
    return s


@pytest.fixture(scope="module")
def client():
    """Two workers on this machine."""
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None)
    with cluster, distributed.Client(cluster) as connected:
        yield connected


def test_64_stops_survive_the_death_of_a_worker_and_are_not_computed_again(many, client, tmp_path):
    victim, rows_seen, killed = client.run(os.getpid), [], threading.Event()

    def kill(row):
        rows_seen.append(row)
        if len(rows_seen) == 10:
            os.kill(next(iter(victim.values())), signal.SIGKILL)
            killed.set()

    rows, failed = sweep.sweep(client, many, None, tmp_path / "sweep.csv", kill)
    assert failed == [] and not beside(tmp_path / "sweep.csv", "unfinished").exists()
    assert killed.is_set() and len(rows) == len(sweep.points(many)) == 64 and len(sweep.references(many)) == 8
    keys = [tuple(row[key] for key in sweep.lists(many)) for row in rows]
    assert len(set(keys)) == 64
    written = sweep.Files(many, True, tmp_path / "sweep.csv")
    assert sorted(map(str, written.stops.rows)) == sorted(map(str, rows)) and len(written.dry.rows) == 8
    # What the dead worker had finished is not computed again: every stop comes to its end once.
    log = list(client.cluster.scheduler.transition_log)
    ends = Counter(entry[0] for entry in log if tuple(entry[1:3]) == ("processing", "memory"))
    assert sum(ends.values()) == len(ends) == 72

    again = []
    assert len(sweep.sweep(client, many, None, tmp_path / "sweep.csv", again.append)[0]) == 64
    assert again == []
    distance = {key: row["stopping distance"] for key, row in zip(keys, rows)}
    assert distance[3.0, 0.05, 0.0, 0.15] > 1.05 * distance[3.0, 0.2, 0.0, 0.15]
    # Each is compared with the dry stop of its speed and load, whose adhesion and thresholds do not matter.
    dry = {(row["speed"], row["payload"]): row["stopping distance"] for row in written.dry.rows}
    for row in rows:
        assert row["dry distance"] == dry[row["speed"], row["payload"]]
        assert row["extension over dry"] == pytest.approx(100.0 * (row["stopping distance"] / row["dry distance"] - 1.0))
    assert max(row["extension over dry"] for row in rows) > 15.0


def test_a_torn_file_goes_on_and_one_of_another_scenario_is_refused(many, client, tmp_path):
    many.sweep.speed, many.sweep.adhesion, many.sweep.payload, many.sweep.slide_high = [1.5], [0.05, 0.2], [0.0], [0.15]
    path = tmp_path / "sweep.csv"
    whole, _ = sweep.sweep(client, many, None, path)
    text = path.read_text()
    path.write_text(text[: len(text) - 25])
    again = []
    rows, _ = sweep.sweep(client, many, None, path, again.append)
    assert len(again) == 1 and sorted(map(str, rows)) == sorted(map(str, whole))
    many.brake.torque *= 1.1
    with pytest.raises(BadFile, match="sweep.csv:2: a row of another scenario"):
        sweep.sweep(client, many, None, path)


def test_stops_without_an_end_are_named_and_tried_again(many, client, tmp_path):
    many.sweep.speed, many.sweep.adhesion, many.sweep.payload = [1.0, 4.0], [0.05], [0.0]
    many.sweep.slide_high, path = [0.15], tmp_path / "sweep.csv"
    many.longest = 3.5  # s: from 4 m/s it takes longer, on dry rail, too
    rows, failed = sweep.sweep(client, many, None, path)
    assert [row["speed"] for row in rows] == [1.0] and [row["speed"] for row in failed] == [4.0, 4.0]
    dry, named = csv.DictReader(beside(path, "unfinished").read_text().splitlines())
    assert named["speed"] == "4.0" and named["reason"].startswith("no standstill in 3.5 s: still ")
    assert dry["dry distance"] == "true" and dry["adhesion"] == ""
    assert {sweep.described(row) for row in failed} == {
        "speed 4, adhesion 0.05, payload 0, slide_high 0.15", "dry, speed 4, payload 0",
    }  # fmt: skip

    again = []
    _, failed = sweep.sweep(client, many, None, path, again.append, limit=1e-9)
    assert [row["speed"] for row in again] == [4.0, 4.0]
    assert failed[0]["reason"].startswith("computed for more than 1e-09 s: at 0.01 s")
    many.longest = 240.0
    rows, failed = sweep.sweep(client, many, None, path)
    assert len(rows) == 2 and failed == [] and not beside(path, "unfinished").exists()


def test_an_extension_that_was_not_known_is_written_when_the_dry_stop_is_there(many, client, tmp_path):
    many.sweep = scenario.changed(many, {}).sweep
    for key in ("payload", "slide_high", "adhesion"):
        delattr(many.sweep, key)
    many.sweep.speed, path = [1.0], tmp_path / "sweep.csv"
    [row], _ = sweep.sweep(client, many, None, path)
    # Found at all, and no more than leaves can do to a stop from walking pace.
    assert 0.0 < row["extension over dry"] < 20.0
    header, line = path.read_text().splitlines()
    path.write_text("\n".join([header, ",".join([*line.split(",")[:-2], "nan", "nan"])]) + "\n")
    beside(path, "dry").unlink()
    again = []
    [filled], _ = sweep.sweep(client, many, None, path, again.append)
    assert len(again) == 1 and again[0]["dry distance"] is True and str(filled) == str(row)
    assert path.read_text().splitlines()[1] == line


def test_any_key_of_any_file_is_swept_and_own_classes_reach_workers_that_have_no_copy(client, tmp_path):
    """Numbers, flags, files and classes; module and what it imports are gone before the workers begin."""
    folder = shutil.copytree(TRAIN, tmp_path / "mine")
    (folder / "beside.py").write_text("LIMIT = 0.3\n")
    (folder / "mine.py").write_text(
        "from beside import LIMIT\n\nclass Never:\n    def __init__(self, wsp, speeds, gain=0.0):\n        self.n = len(speeds)\n"
        "    def step(self, h, speeds):\n        return ['vent' if LIMIT > 1.0 else 'apply'] * self.n\n"
        "class Always(Never):\n    def step(self, h, speeds):\n        return ['vent'] * self.n\n"
    )
    text = (folder / "low_adhesion.json").read_text()
    keys = '{ "speed": [1.0], "track": ["leaves.json", "soap.json"], "brake.wsp.active": [true, false], '
    keys += '"brake.protection": ["", "mine:Never", "mine:Always"], "vehicle.body.mass": [4e4] }'
    begin = text.index('"sweep": ') + len('"sweep": ')
    (folder / "low_adhesion.json").write_text(text[:begin] + keys + "}")
    loaded = scenario.load(folder / "low_adhesion.json", {"step": 0.01, "longest": 4.0, "brake.delay": 0.0, "brake.fill_time": 1.0})
    names = list(sweep.lists(loaded))
    of = scenario.load(folder / "low_adhesion.json", {"brake.protection": "mine:Always"}).brake.protection
    assert of.digest() and [Path(path).name for path, _ in of.files] == ["mine.py", "beside.py"]

    class Emptied:
        """A client whose workers find the folder empty."""

        loop = client.loop

        def submit(self, *arguments, **named):
            (folder / "mine.py").unlink(missing_ok=True)
            (folder / "beside.py").unlink(missing_ok=True)
            return client.submit(*arguments, **named)

    rows, failed = sweep.sweep(Emptied(), loaded, None, tmp_path / "sweep.csv")
    assert {row["brake.protection"] for row in failed} == {"mine:Always"} and "no standstill in 4 s" in failed[0]["reason"]
    assert len(rows) == 10 and len(failed) == 4 and all(math.isfinite(row["extension over dry"]) for row in rows)
    with open(tmp_path / "sweep_columns.csv", encoding="utf-8") as file:
        units = {row["column"]: row["unit"] for row in csv.DictReader(file)}
    header = (tmp_path / "sweep.csv").read_text().splitlines()[0]
    assert list(csv.reader([header]))[0] == list(units)
    assert units["vehicle.body.mass"] == "kg" and units["peak temperature"] == "°C" and units["extension over dry"] == "%"

    assert draw_sweep(tmp_path / "many.png", rows, names, "four keys") is None and (tmp_path / "many.png").stat().st_size > 20000


@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C of a terminal is a signal to a group of processes")
@pytest.mark.parametrize("told, code, word", [("SIGINT", 130, "stopped"), ("SIGTERM", 143, "stopped by SIGTERM")])
def test_ctrl_c_is_one_line_and_the_same_command_goes_on(tmp_path, told, code, word):
    for path in TRAIN.glob("*.*"):
        shutil.copy(path, tmp_path)
    text = (tmp_path / "low_adhesion.json").read_text().replace('"step": 0.005', '"step": 0.01')
    speeds = ", ".join(f"{0.5 + 0.1 * k:.1f}" for k in range(40))
    begin = text.index('"sweep": ') + len('"sweep": ')
    (tmp_path / "low_adhesion.json").write_text(text[:begin] + '{ "speed": [' + speeds + "] } }")
    command = [sys.executable, "-m", "wheelrail", "sweep", "low_adhesion.json", "--rigid", "--out", "."]
    pipe = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "cwd": tmp_path, "start_new_session": True}
    with subprocess.Popen(command, **pipe) as running:
        lines = [running.stderr.readline()]
        while not lines[-1].startswith("stops:"):
            assert lines[-1], lines
            lines.append(running.stderr.readline())
        if told == "SIGINT":
            os.killpg(running.pid, signal.SIGINT)  # as a terminal does: to the workers, too
        else:
            running.send_signal(getattr(signal, told))
        out, rest = running.communicate(timeout=120)
    assert running.returncode == code and "Traceback" not in rest and out.startswith("a coach brakes"), rest
    last = rest.strip().splitlines()[-1]
    count = int(re.fullmatch(rf"error: {word} after (\d+) of 80 stops; results are in low_adhesion, and the same .*", last).group(1))
    loaded = scenario.load(tmp_path / "low_adhesion.json")
    missing = sweep.Files(loaded, True, tmp_path / "low_adhesion" / "sweep.csv").missing(loaded)
    # One may be written and not yet counted.
    assert 0 < count and len(missing) in (80 - count, 79 - count)


def test_a_file_that_is_swept_and_edited_makes_another_sweep(tmp_path):
    """Rows of the file as it was are not taken for those of the file as it is; numbers that are swept do not count."""
    folder = shutil.copytree(TRAIN, tmp_path / "train")
    text = json.loads((folder / "low_adhesion.json").read_text()) | {"sweep": {"track": ["leaves.json", "soap.json"]}}
    (folder / "mine.json").write_text(json.dumps(text))
    name = lambda: sweep.fingerprint(scenario.load(folder / "mine.json"), True)
    before = name()
    assert name() == before
    soap = (folder / "soap.json").read_text()
    (folder / "soap.json").write_text(soap.replace('"cleaning_energy": ', '"cleaning_energy": 1'))
    assert name() != before


def test_pictures_of_one_key_and_of_none():
    row = {"speed": 10.0, "brake.protection": "a:B", "stopping distance": 50.0, "dry distance": 40.0}
    row |= {"extension over dry": 25.0}
    assert draw_sweep("none.png", [row], ["speed"], "").startswith("one stop only, 50.0 m; a list in sweep with two values")
    rows = [row | {"step": 0.001 * k, "adhesion": 0.01 * n, "speed": k + n + 1.0} for k in range(9) for n in range(9)]
    rows = [row | {"hold": float(h), "payload": float(p)} for row in rows for h in range(6) for p in range(6)]
    assert "36 panels, more than 30" in draw_sweep("none.png", rows, ["step", "adhesion", "hold", "payload"], "")


@pytest.mark.parametrize("swept, apart", [
    ("track.conditions.contaminated.friction", True), ("brake.wsp.slide_high", True), ("slide_high", True), ("adhesion", True),
    ("brake.wsp.fill_time", False), ("vehicle.body.mass", False), ("speed", False), ("brake.torque", False), ("dry", False),
])  # fmt: skip
def test_a_dry_stop_does_not_depend_on_what_only_slides(many, swept, apart):
    assert (sweep.reference(many, {swept: 1.0}) == {}) == apart
    many.brake.protection = object
    assert (sweep.reference(many, {swept: 1.0}) == {}) == (apart and not swept.endswith("slide_high"))


def test_all_rows_that_came_before_their_dry_stops_are_filled(tmp_path):
    loaded = scenario.load(TRAIN / "low_adhesion.json")
    loaded.sweep.speed, loaded.sweep.adhesion, loaded.sweep.payload, loaded.sweep.slide_high = [1.0], [0.1, 0.15, 0.2], [0.0], [0.15]
    files = sweep.Files(loaded, True, tmp_path / "sweep.csv")
    for point in sweep.points(loaded):
        files.stops.add(files.over_dry(point | dict.fromkeys(sweep_table.RESULTS, 2.0)))
    assert all(math.isnan(row["dry distance"]) for row in files.stops.rows)
    files.dry.add(sweep.references(loaded)[0] | dict.fromkeys(sweep_table.OF_DRY, 1.0))
    files.fill()
    again = sweep.Files(loaded, True, tmp_path / "sweep.csv").stops.rows
    assert [row["extension over dry"] for row in again] == [100.0] * 3
