"""Saved states and independent instances."""

from conftest import COARSE

NAMES = ("wheel.velocity", "wheel.omega", "contact.force_x", "contact.creepage", "solver.energy_residual")


def brake(wheel, steps, moment=-6000.0):
    """Outputs after each of some braking steps."""
    wheel.set({"drive.moment": moment})
    rows = []
    for k in range(steps):
        wheel.step(1e-3 * (1 + k % 3))
        rows.append(wheel.get(*NAMES))
    return rows


def test_a_run_from_a_restored_state_has_the_same_bits(wheel):
    w = wheel(COARSE)
    brake(w, 20)
    saved = w.save()
    first = brake(w, 30)
    w.restore(saved)
    assert brake(w, 30) == first
    w.forget(saved)


def test_a_serialized_state_continues_in_another_instance(wheel):
    one, two = wheel(COARSE), wheel(COARSE)
    brake(one, 20)
    saved = one.save()
    data = one._call(one.slave.serializeFMUstate, saved[0])
    other = two._call(two.slave.deSerializeFMUstate, data)
    two.restore((other, one.time))
    assert brake(two, 30) == brake(one, 30)
    one.forget(saved)
    two.forget((other, 0.0))


def test_interleaved_instances_do_not_influence_each_other(wheel):
    alone = [brake(wheel(COARSE), 30, moment) for moment in (-6000.0, 3000.0)]
    pair = [wheel(COARSE), wheel(COARSE)]
    together = [[], []]
    for w, moment in zip(pair, (-6000.0, 3000.0)):
        w.set({"drive.moment": moment})
    for k in range(30):
        for w, rows in zip(pair, together):
            w.step(1e-3 * (1 + k % 3))
            rows.append(w.get(*NAMES))
    assert together == alone
