"""Threads that share wheels: every item once, results in order, failures told, the same numbers as one after the other."""

from threading import Barrier, Event
from time import process_time, sleep

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


def test_a_team_without_orders_sleeps():
    """All threads together compute for less than a tenth of the time in which there is nothing to do."""
    with Team(3) as team:
        team.map(str, range(8))
        begin = process_time()
        sleep(0.5)
        assert process_time() - begin < 0.05


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
