"""What three kinds of users do on the first day (`examples/trials`): every step works, in few lines of code."""

import importlib
from pathlib import Path

import pytest

TRIALS = Path(__file__).parent.parent / "examples" / "trials"
# Most lines of code that a task may take.
MOST = {
    "damage": {"a run as a DataFrame": 2, "temperature over patch and time, as a picture": 6, "the patch as a film": 2,
        "what the slide left, until it is cold": 8, "the patch over x and z, for ParaView": 3,
    },
    "vehicle": {"a record of one's own loop": 5, "one's own vehicle on eight wheels, 5 ms": 2, "a curve of forces over creepage": 1,
        "the same on a rail that is not clean": 2,
    },
    "brakes": {
        "a slide protection of one's own (and a class of six lines)": 4, "a sweep of a key of one's own": 7,
        "a page of stops to send around": 2, "a train whose wheels have patches of ellipses, in the FMU": 5,
        "an axle whose wheels differ, on rails that differ, in the FMU": 5,
    },
}  # fmt: skip


@pytest.mark.parametrize("who", MOST)
def test_the_tasks_of_the_first_day_work_in_few_lines(who, packed, tmp_path, monkeypatch):
    pytest.importorskip("xarray")
    monkeypatch.setenv("WHEELRAIL_FMU", str(packed))
    monkeypatch.syspath_prepend(TRIALS)
    lines = importlib.import_module(who).trial.run(tmp_path)
    assert all(0 < lines[task] <= most for task, most in MOST[who].items()), lines
