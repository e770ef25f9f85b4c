"""A saved state continues bit by bit as before, in the same instance and in another."""

import pytest

from wheelrail import Refused

COARSE = {"mesh.elements_per_half_width": 10}


def drive(wheel, outputs, first, count):
    """Steps with inputs that change every time, control switches included; all outputs of all steps."""
    record = []
    for k in range(first, first + count):
        wheel.set({"drive.moment": -3000.0 - 40.0 * k, "drive.load": 1e5 + 4e3 * (k % 7)})
        if k % 20 == 10:
            velocity = (k // 20) % 2 == 0
            wheel.set({"control.rotation": "velocity" if velocity else "moment"})
        wheel.set({"drive.omega": 43.0 - 0.01 * k})
        wheel.step(1e-3 if k % 3 else 2.5e-4)
        record.append(wheel.get(*outputs))
    return record


def test_restored_state_repeats_every_bit(start, outputs):
    wheel = start(COARSE | {"initial.velocity": 20.0})
    drive(wheel, outputs, 0, 25)
    saved = wheel.save()
    before = wheel.get(*outputs)
    first = drive(wheel, outputs, 25, 60)
    wheel.restore(saved)
    assert wheel.get(*outputs) == before
    assert drive(wheel, outputs, 25, 60) == first
    wheel.restore(saved)
    assert drive(wheel, outputs, 25, 60) == first
    wheel.forget(saved)


def test_serialized_state_continues_in_another_instance(start, outputs):
    one, other = start(COARSE | {"initial.velocity": 20.0}), start(COARSE | {"initial.velocity": 5.0, "vehicle.mass": 500.0})
    drive(one, outputs, 0, 25)
    saved = one.save()
    data = one.slave.serializeFMUstate(saved[0])
    expected = drive(one, outputs, 25, 40)
    state = other.slave.deSerializeFMUstate(data)
    other.restore((state, saved[1]))
    assert other.get("vehicle.mass") == one.get("vehicle.mass")
    assert drive(other, outputs, 25, 40) == expected
    other.forget((state, None))
    one.forget(saved)


@pytest.mark.parametrize("damage", [lambda data: data[: len(data) // 2], lambda data: b"\0" * len(data), lambda _: b""])
def test_damaged_bytes_are_refused_and_the_run_goes_on(start, outputs, damage):
    wheel, twin = start(COARSE | {"initial.velocity": 20.0}), start(COARSE | {"initial.velocity": 20.0})
    saved = wheel.save()
    data = wheel.slave.serializeFMUstate(saved[0])
    with pytest.raises(Refused):
        wheel._calls(wheel.slave.deSerializeFMUstate, damage(data))
    wheel.forget(saved)
    assert drive(wheel, outputs, 0, 5) == drive(twin, outputs, 0, 5)


def test_reset_repeats_the_run_bit_by_bit(start, outputs):
    wheel, fresh = start(COARSE | {"initial.velocity": 20.0}), start(COARSE | {"initial.velocity": 20.0})
    drive(wheel, outputs, 0, 30)
    wheel.slave.reset()
    wheel.time = 0.0
    wheel.slave.setupExperiment(startTime=0.0)
    wheel.set(COARSE | {"initial.velocity": 20.0})
    wheel.slave.enterInitializationMode()
    wheel.slave.exitInitializationMode()
    assert drive(wheel, outputs, 0, 30) == drive(fresh, outputs, 0, 30)
