"""A sweep over workers: nothing is lost when one is killed, nothing is computed twice when it goes on."""

import csv
import os
import signal
import threading
from collections import Counter
from pathlib import Path

import distributed
import pytest

from wheelrail import scenario, sweep
from wheelrail.files import BadFile

TRAIN = Path(__file__).parent.parent / "examples" / "train"


@pytest.fixture
def many():
    """64 short stops."""
    s = scenario.load(TRAIN / "low_adhesion.json")
    s.step, s.hold = 0.01, 0.0
    s.sweep.speed, s.sweep.adhesion = [0.5, 1.0, 1.5, 4.0], [0.05, 0.08, 0.12, 0.2]
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
    assert failed == [] and not sweep.unfinished(tmp_path / "sweep.csv").exists()
    assert killed.is_set() and len(rows) == len(sweep.points(many)) == 64
    keys = [tuple(row[key] for key in sweep.KEYS) for row in rows]
    assert len(set(keys)) == 64
    written = sweep.done(tmp_path / "sweep.csv", sweep.fingerprint(many, True))
    assert sorted(map(str, written)) == sorted(map(str, rows))
    # What the dead worker had finished is not computed again: every stop comes to its end once.
    log = list(client.cluster.scheduler.transition_log)
    ends = Counter(entry[0] for entry in log if tuple(entry[1:3]) == ("processing", "memory"))
    assert sum(ends.values()) == len(ends) == 64

    again = []
    assert len(sweep.sweep(client, many, None, tmp_path / "sweep.csv", again.append)[0]) == 64
    assert again == []
    distance = {key: row["stopping distance"] for key, row in zip(keys, rows)}
    assert distance[4.0, 0.05, 0.0, 0.15] > 1.05 * distance[4.0, 0.2, 0.0, 0.15]


def test_a_torn_file_goes_on_and_one_of_another_scenario_is_refused(many, client, tmp_path):
    many.sweep.speed, many.sweep.adhesion = [1.5], [0.05, 0.2]
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
    many.sweep.speed, many.sweep.adhesion, many.sweep.payload = [1.5, 4.0], [0.05], [0.0]
    many.sweep.slide_high, path = [0.15], tmp_path / "sweep.csv"
    many.longest = 6.0  # s: from 4 m/s it takes longer
    rows, failed = sweep.sweep(client, many, None, path)
    assert [row["speed"] for row in rows] == [1.5] and [row["speed"] for row in failed] == [4.0]
    [named] = csv.DictReader(sweep.unfinished(path).read_text().splitlines())
    assert named["speed"] == "4.0" and named["reason"].startswith("no standstill in 6 s: still ")
    assert sweep.described(failed[0]) == "speed 4, adhesion 0.05, payload 0, slide_high 0.15"

    again = []
    _, failed = sweep.sweep(client, many, None, path, again.append, limit=1e-9)
    assert [row["speed"] for row in again] == [4.0] and failed[0]["reason"].startswith("computed for more than 1e-09 s: at 0.01 s")
    many.longest = 240.0
    rows, failed = sweep.sweep(client, many, None, path)
    assert len(rows) == 2 and failed == [] and not sweep.unfinished(path).exists()
