"""Threads that share wheels: every item once, results in order, failures told, the same numbers as one after the other."""

from threading import Barrier, Event
from time import sleep
from weakref import ref

import pytest
from wheelrail import Team


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
