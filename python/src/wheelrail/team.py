"""Threads that share the wheels of a step."""

from os import cpu_count
from queue import SimpleQueue
from threading import Thread
from time import perf_counter
from zlib import crc32

PATIENCE = 200e-6  # s, how long a thread stays awake for the next order
PASTIME = bytes(32768)  # its checksum takes some 10 µs, in which the lock of the interpreter is free


class Team:
    """Threads that share the wheels of a step: whoever is free takes the next one, the calling thread as well.

    While the FMU computes, its caller does not hold the lock of the interpreter. A thread that slept needs about as long to wake up as a
    wheel without heat needs for a step of 1 ms. Threads therefore stay awake for a fifth of a millisecond between steps, and nobody has a
    fixed share for which all would wait. Use as a context manager, or call `close`.
    """

    def __init__(self, threads=None):
        """So many `threads`, with the calling one; by itself as many as the machine has."""
        self._orders = SimpleQueue()
        self._members = [Thread(target=self._serve, daemon=True) for _ in range((threads or cpu_count() or 1) - 1)]
        for member in self._members:
            member.start()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def map(self, function, items):
        """Results of `function` for all items, in their order. A failure is raised when all are done, that of the first item that failed."""
        order = _Order(function, items)
        for _ in self._members[: len(order.results) - 1]:
            self._orders.put(order)
        return order.finish()

    def close(self):
        """Ends the threads."""
        for _ in self._members:
            self._orders.put(None)
        for member in self._members:
            member.join()

    def _serve(self):
        while order := _await(self._orders):
            order.work()


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

    def finish(self):
        """Works and waits until all is done."""
        self.work()
        missing = len(self.results)
        while missing:
            missing -= _await(self.done)
        if self.failures:
            raise self.failures[min(self.failures)]
        return self.results


def _await(queue):
    """The next item of a queue. Who waits sleeps only after a while, and until then keeps the lock of the interpreter from nobody."""
    end = perf_counter() + PATIENCE
    while queue.empty() and perf_counter() < end:
        crc32(PASTIME)
    return queue.get()
