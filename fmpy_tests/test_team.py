"""Threads that share wheels: every item once, results in order, failures told, the same numbers as one after the other."""

from threading import Barrier, Event
from time import sleep
from weakref import ref

import pytest
from wheelrail import Team
from wheelrail.team import LEAST, Patience, adapted


def test_every_item_is_done_once_and_results_are_in_their_order():
    with Team(3) as team:
        for count in (0, 1, 2, 50):
            seen = []
            assert team.map(lambda k: seen.append(k) or k * k, range(count)) == [k * k for k in range(count)]
            assert sorted(seen) == list(range(count))


def test_items_are_done_at_the_same_time():
    """Each of two items waits for the other, which on one thread would not end."""
    meeting = Barrier(2)
    with Team(2) as team:
        for _ in range(100):
            assert sorted(team.map(lambda _: meeting.wait(5.0), range(2))) == [0, 1]


def test_a_free_thread_takes_what_a_busy_one_has_not_begun():
    """The first item ends when all others have."""
    others, ended = [], Event()

    def work(k):
        if k == 0:
            return ended.wait(10.0)
        others.append(k)
        if len(others) == 7:
            ended.set()
        return True

    with Team(2) as team:
        assert all(team.map(work, range(8)))


def test_the_first_failure_is_raised_when_all_are_done_and_the_team_works_on():
    done = []

    def work(k):
        done.append(k)
        if k in (2, 5):
            raise ValueError(k)

    with Team(2) as team:
        for _ in range(20):
            done.clear()
            with pytest.raises(ValueError, match="2"):
                team.map(work, range(8))
            assert sorted(done) == list(range(8))
        assert team.map(str, range(3)) == ["0", "1", "2"]


def test_an_interrupt_is_raised_before_other_failures():
    def work(k):
        raise KeyboardInterrupt if k == 3 else ValueError(k)

    with Team(2) as team, pytest.raises(KeyboardInterrupt):
        team.map(work, range(8))


def test_a_team_without_orders_sleeps_in_the_end_and_without_patience_at_once(monkeypatch):
    """Who is awake passes the time with checksums."""
    taken = []
    monkeypatch.setattr("wheelrail.team.crc32", taken.append)
    with Team(3, patience=0.05) as team:
        team.map(str, range(8))
        sleep(0.3)
        count = len(taken)
        sleep(0.2)
        assert len(taken) == count > 0
    taken.clear()
    with Team(3, patience=0.0) as team:
        team.map(str, range(8))
        sleep(0.1)
    assert not taken


def test_patience_lasts_as_long_as_it_has_paid():
    """Ten waits in vain leave a small part of it; what then comes in time brings all of it back in a few more."""
    most = 1.0
    after = [most]
    for waited in [5.0] * 10 + [0.5] * 10:
        after.append(adapted(after[-1], waited, most))
    assert after[:4] == [1.0, 0.5, 0.25, 0.125] and after[10] == LEAST * most
    assert after[11:13] == [2 * LEAST, 4 * LEAST] and after[16:] == [most] * 5
    assert adapted(0.0, 0.5, 0.0) == adapted(0.0, 0.0, 0.0) == 0.0, "who has none gets none"


def test_who_has_waited_in_vain_passes_less_time_awake(monkeypatch):
    """A clock that goes on by 1 s with every checksum, and by an hour in the sleep that follows."""
    time, counts = [0.0], []

    class Late:
        def empty(self):
            return True

        def get(self):
            time[0] += 3600.0

    monkeypatch.setattr("wheelrail.team.perf_counter", lambda: time[0])
    monkeypatch.setattr("wheelrail.team.crc32", lambda _: time.__setitem__(0, time[0] + 1.0))
    patience = Patience(64.0)
    for _ in range(9):
        begin = time[0]
        patience.wait(Late())
        counts.append(time[0] - begin - 3600.0)
    assert counts == [64, 32, 16, 8, 4, 2, 1, 1, 1]


def test_a_team_that_is_dropped_or_waits_keeps_neither_threads_nor_wheels():
    class Item:
        pass

    team, item = Team(3), Item()
    members, seen = team._members, ref(item)
    team.map(id, [item, Item(), Item()])
    del item
    wait_until(lambda: seen() is None)
    del team
    wait_until(lambda: not any(member.is_alive() for member in members))


def test_a_closed_team_works_on_the_calling_thread_and_keeps_no_results():
    class Result:
        def __init__(self, _):
            pass

    team = Team(3)
    team.close()
    results = team.map(Result, range(4))
    seen = [ref(result) for result in results]
    assert len(results) == 4
    del results
    wait_until(lambda: not any(result() for result in seen))


def wait_until(condition):
    """Looks for up to ten seconds."""
    for _ in range(1000):
        if condition():
            return
        sleep(0.01)
    pytest.fail("it did not happen")


def test_wheels_of_a_team_have_the_forces_of_wheels_one_after_the_other(start, outputs):
    def histories(team):
        wheels = [start({"initial.velocity": 15.0}, {"drive.moment": -800.0 * k}) for k in range(4)]
        records = []
        for _ in range(40):
            team.map(lambda wheel: wheel.step(1e-3), wheels)
            records.append([wheel.get(*outputs) for wheel in wheels])
        return records

    with Team(1) as alone, Team(2) as together:
        assert histories(alone) == histories(together)
