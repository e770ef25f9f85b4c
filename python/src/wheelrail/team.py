"""Threads that share the wheels of a step."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from os import cpu_count
from queue import SimpleQueue
from threading import Thread
from time import perf_counter
from typing import Self, TypeVar
from weakref import finalize
from zlib import crc32

Item, Result = TypeVar("Item"), TypeVar("Result")
PATIENCE = 200e-6  # s
LEAST = 1 / 64  # share of the patience that is left to who has waited in vain, so that it can find out when it pays again
PASTIME = bytes(32768)  # its checksum takes some 10 µs, in which the lock of the interpreter is free


class Team:
    """Threads that share the wheels of a step: whoever is free takes the next one, the calling thread as well.

    While the FMU computes, its caller does not hold the lock of the interpreter. A thread that slept takes some hundredths of a millisecond
    to wake up, and a wheel without heat hardly more for a step of 1 ms. Threads therefore stay awake for a while between steps, as long as
    that has paid lately, and nobody has a fixed share for which all would wait. Use as a context manager, or call `close`.
    """

    def __init__(self, threads: int | None = None, patience: float = PATIENCE) -> None:
        """So many `threads`, with the calling one; by itself as many as the machine has. They stay awake for up to `patience` (s) when there
        is nothing to do, and hardly at all where longer waits have shown that other processes need the cores, or that more time than that
        lies between steps. With 0 they sleep at once."""
        self._orders, self._patience = SimpleQueue(), Patience(patience)
        count = (threads or cpu_count() or 1) - 1
        self._members = [Thread(target=_serve, args=(self._orders, patience), daemon=True) for _ in range(count)]
        self._dismiss = finalize(self, _dismiss, self._orders, count)
        for member in self._members:
            member.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def map(self, function: Callable[[Item], Result], items: Iterable[Item]) -> list[Result]:
        """Results of `function` for all items, in their order. A failure is raised when all are done: an interrupt before others, else that of
        the first item that failed."""
        order = _Order(function, items)
        if self._dismiss.alive:  # nobody would take orders after that
            for _ in self._members[: max(len(order.results) - 1, 0)]:
                self._orders.put(order)
        return order.finish(self._patience)

    def close(self) -> None:
        """Ends the threads."""
        self._dismiss()
        for member in self._members:
            member.join()


class _Order:
    """What is to be done for some items; every one is taken by one thread."""

    def __init__(self, function, items):
        self.function, self.results, self.failures = function, list(items), {}
        self.todo = list(range(len(self.results)))[::-1]
        self.done = SimpleQueue()

    def work(self):
        """Does what nobody has begun, and reports how many items that were. Who comes too late has nothing to report."""
        count = 0
        while self.todo:
            try:
                k = self.todo.pop()
            except IndexError:  # another thread was faster
                break
            try:
                self.results[k] = self.function(self.results[k])
            except BaseException as failure:
                self.failures[k] = failure
            count += 1
        if count:
            self.done.put(count)

    def finish(self, patience):
        """Works and waits until all is done. Interrupted, it leaves what nobody has begun."""
        try:
            self.work()
            missing = len(self.results)
            while missing:
                missing -= patience.wait(self.done)
        except BaseException:
            self.todo.clear()
            raise
        if self.failures:
            interrupts = [k for k, failure in self.failures.items() if not isinstance(failure, Exception)]
            raise self.failures[min(interrupts or self.failures)]
        return self.results


def _serve(orders, patience):
    """Works on orders until there is none to come."""
    patience = Patience(patience)
    while order := patience.wait(orders):
        order.work()
        order = None  # whoever waits keeps no wheel alive


def _dismiss(orders, count):
    """Sends so many threads home."""
    for _ in range(count):
        orders.put(None)


class Patience:
    """How long a thread stays awake that waits: up to `most` (s), by what its last waits have shown."""

    def __init__(self, most: float) -> None:
        self.most = self.now = most

    def wait(self, queue: SimpleQueue) -> object:
        """The next item of a queue. Who waits keeps the lock of the interpreter from nobody."""
        begin = perf_counter()
        while queue.empty() and perf_counter() < begin + self.now:
            crc32(PASTIME)
        item = queue.get()
        self.now = adapted(self.now, perf_counter() - begin, self.most)
        return item


def adapted(patience: float, waited: float, most: float) -> float:
    """Patience after a wait: twice as long where staying awake for `most` would have met what came, half as long where not.

    >>> adapted(50e-6, 120e-6, 200e-6), adapted(50e-6, 1e-3, 200e-6)
    (0.0001, 2.5e-05)
    """
    return min(2.0 * patience, most) if waited <= most else max(0.5 * patience, LEAST * most)
