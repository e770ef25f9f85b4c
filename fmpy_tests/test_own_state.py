"""A stop depends on its scenario alone: what a controller of one's own keeps beside its objects begins anew with each."""

import shutil

import numpy as np
import pytest

from test_own_controllers import TRAIN, stopped
from wheelrail import report, scenario, sweep
from wheelrail.train import Stop

# A protection that vents one step in five of those that were ever asked for; where it counts is the kind.
STEP = "    def step(self, h, speeds):\n        return ['vent' if {count} % 5 == 0 else 'apply'] * self.n\n"
INIT = "    def __init__(self, wsp, speeds):\n        self.n = len(speeds)\n"
KINDS = {
    "module": "COUNT = [0]\ndef count():\n    COUNT[0] += 1\n    return COUNT[0]\nclass P:\n" + INIT + STEP.format(count="count()"),
    "class": "class P:\n    made = 0\n" + INIT + "    def count(self):\n        P.made += 1\n        return P.made\n"
    + STEP.format(count="self.count()"),
    "default": "def count(seen=[0]):\n    seen[0] += 1\n    return seen[0]\nclass P:\n" + INIT + STEP.format(count="count()"),
    "beside": "import tally\nclass P:\n" + INIT + STEP.format(count="tally.count()"),
    "installed": None,
}  # fmt: skip
TALLY = "seen = 0\ndef count():\n    global seen\n    seen += 1\n    return seen\n"
PACKAGED = "from . import tally\nclass P:\n" + INIT + STEP.format(count="tally.count()")


def braked(folder, kind, monkeypatch):
    """A scenario whose protection keeps its count somewhere."""
    for path in TRAIN.glob("*.*"):
        shutil.copy(path, folder)
    package = folder / "elsewhere" / f"tallying_{kind}"
    package.mkdir(parents=True)
    for name, text in (("__init__", ""), ("tally", TALLY), ("brakes", PACKAGED)):
        (package / f"{name}.py").write_text(text)
    (folder / "tally.py").write_text(TALLY)
    name = f"{package.name}.brakes:P"
    monkeypatch.syspath_prepend(package.parent)
    monkeypatch.setenv("PYTHONPATH", str(package.parent))
    if KINDS[kind]:
        (folder / "mine.py").write_text(KINDS[kind])
        name = "mine:P"
    quick = {"speed": 2.0, "step": 0.01, "hold": 0.0, "brake.delay": 0.0, "brake.fill_time": 0.5, "brake.protection": name}
    return scenario.load(folder / "low_adhesion.json", quick)


@pytest.mark.parametrize("kind", KINDS)
def test_stops_of_one_process_do_not_hear_of_each_other(kind, tmp_path, monkeypatch):
    loaded = braked(tmp_path, kind, monkeypatch)
    alone = stopped(loaded)
    again = stopped(loaded)
    np.testing.assert_array_equal(again, alone)
    # Side by side, step by step.
    one, two = Stop(loaded), Stop(loaded)
    for _ in range(50):
        one.step(0.01)
        two.step(0.01)
    np.testing.assert_array_equal(one.rows, alone[:50])
    np.testing.assert_array_equal(two.rows, alone[:50])
    valves = report.column(alone, "valve", 0)
    assert 2 in valves and 0 in valves


def test_controllers_of_one_stop_share_their_module(tmp_path):
    text = KINDS["class"] + "    def __del__(self):\n        pass\nclass Drive:\n    def __init__(self, scenario):\n        pass\n"
    text += "    def step(self, h, time, speed, travelled):\n        return 1.0 if P.made < 3 else 0.5\n"
    for path in TRAIN.glob("*.*"):
        shutil.copy(path, tmp_path)
    (tmp_path / "mine.py").write_text(text)
    quick = {"speed": 2.0, "step": 0.01, "hold": 0.0, "brake.protection": "mine:P", "driver": "mine:Drive"}
    run = Stop(scenario.load(tmp_path / "low_adhesion.json", quick))
    demands = []
    for _ in range(5):
        demands.append(run.driver.made.step(0.01, 0.0, 2.0, 0.0))
        run.step(0.01)
    assert demands == [1.0, 1.0, 1.0, 0.5, 0.5]


@pytest.mark.parametrize("kind", ["module", "installed"])
def test_a_sweep_on_one_worker_is_that_on_two_to_the_bit(kind, tmp_path, monkeypatch):
    import distributed

    loaded = braked(tmp_path, kind, monkeypatch)
    loaded.sweep.speed, loaded.sweep.adhesion = [1.0, 1.5, 2.0], [0.05, 0.2]
    loaded.sweep.payload, loaded.sweep.slide_high = [0.0], [0.15]
    found = []
    for workers in (1, 2):
        cluster = distributed.LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=None)
        with cluster, distributed.Client(cluster) as client:
            rows, failed = sweep.sweep(client, loaded, None, tmp_path / f"{workers}.csv")
        assert len(rows) == 6 and not failed
        found.append(sorted(map(str, rows)))
    print("\n".join(found[0]))
    assert found[0] == found[1]
