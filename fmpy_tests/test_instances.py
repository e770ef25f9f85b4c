"""Instances know nothing of each other."""

from concurrent.futures import ThreadPoolExecutor

LOADS = (6e4, 1.2e5)


def runs(wheels, outputs, steps=60):
    """Steps all wheels in turn; their outputs."""
    records = [[] for _ in wheels]
    for k in range(steps):
        for wheel, record in zip(wheels, records):
            wheel.set({"drive.moment": -80.0 * k})
            wheel.step(1e-3)
            record.append(wheel.get(*outputs))
    return records


def test_interleaved_instances_equal_separate_runs(start, outputs):
    separate = [runs([start({"initial.velocity": 15.0}, {"drive.load": load})], outputs)[0] for load in LOADS]
    together = runs([start({"initial.velocity": 15.0}, {"drive.load": load}) for load in LOADS], outputs)
    assert together == separate
    assert together[0] != together[1]


def test_instances_on_threads_equal_separate_runs(start, outputs):
    separate = [runs([start({"initial.velocity": 15.0}, {"drive.load": load})], outputs)[0] for load in LOADS]
    wheels = [start({"initial.velocity": 15.0}, {"drive.load": load}) for load in LOADS]
    with ThreadPoolExecutor(len(wheels)) as pool:
        threaded = list(pool.map(lambda wheel: runs([wheel], outputs)[0], wheels))
    assert threaded == separate


def test_presets_live_side_by_side(start, outputs):
    wheels = [start({"preset": preset, "initial.velocity": 10.0}) for preset in ("railway", "paper_d")]
    alone = start({"preset": "paper_d", "initial.velocity": 10.0})
    for _ in range(20):
        for wheel in (*wheels, alone):
            wheel.step(1e-3)
    assert wheels[1].get(*outputs) == alone.get(*outputs)
