"""Calls of an instance and what it says meanwhile.

Every instance has a logger of its own, which lives as long as fmpy's slave does. That of fmpy serves a whole process: whoever
asks for it last has the messages of all, and takes the others down with it. The FMUs of this project need no such go-between,
for their messages are plain text with doubled percent signs.
"""

import atexit
import logging
import os
import re
from contextlib import AbstractContextManager, ExitStack
from ctypes import cast
from threading import RLock
from time import monotonic
from weakref import WeakSet

import fmpy
from fmpy import fmi1, fmi2  # as modules, which stay when they are reloaded

from .values import Refused
from .warn import warn

log = logging.getLogger("wheelrail.fmu")
LEVELS = {0: logging.INFO, 1: logging.WARNING}  # of messages by their status; others are refusals
WARNING = 1  # status of messages about calls that worked
AT = re.compile(r"^t = \S+ s: ")  # with which the FMU begins warnings
PATIENCE = 10.0  # s, at the end of Python, for calls that other threads have not finished
C_FUNCTION = re.compile(r"^fmi[23]\w+: ")  # with which the FMU begins refusals


class Message(str):
    """A message of the FMU: its text, with the `status` that it was logged with (1: warning, 2: discarded step, 3: error)."""

    status = 0


def listener(log):
    """A logger for an instance of FMI 3.0, which fills the list `log` with `Message`s."""

    def receive(_environment, status, _category, message):
        text = Message(C_FUNCTION.sub("", (message or b"").decode(errors="replace")))
        text.status = status
        log.append(text)

    return receive


def callbacks(log):
    """What an instance of FMI 2.0 calls: a logger that fills the list `log` with `Message`s, and memory of the C library."""
    hear = listener(log)

    @fmi2.fmi2CallbackLoggerTYPE
    def receive(environment, _instance, status, category, message):
        hear(environment, status, category, (message or b"").replace(b"%%", b"%"))

    functions = fmi2.fmi2CallbackFunctions()
    functions.logger = functions.kept = receive
    functions.allocateMemory = cast(fmpy.calloc, fmi2.fmi2CallbackAllocateMemoryTYPE)
    functions.freeMemory = cast(fmpy.free, fmi2.fmi2CallbackFreeMemoryTYPE)
    return functions


class Calls(AbstractContextManager):
    """Calls functions of one instance, one at a time. What is refused is raised in the FMU's own words, of the list `log`.

    `with calls, calls.lock:` holds other threads off for several calls in a row. What the instance `name` says meanwhile is logged, and
    warned of once, when the lock has been let go, also where something is raised: who hears it may call the instance on any thread.
    """

    def __init__(self, name):
        self.name, self.lock, self.owner = name, RLock(), os.getpid()
        self.log: list[Message] = []
        self._heard, self._warned = 0, set()
        _living.add(self)

    def __call__(self, function, *arguments, **named):
        with self, self.lock:
            seen = len(self.log)
            try:
                return function(*arguments, **named)
            except fmi1.FMICallException as failure:
                said = "; ".join(message for message in self.log[seen:] if message.status == failure.status)
                raise Refused(said or f"the FMU refused the call without a word (status {failure.status})") from None

    def __exit__(self, *_):
        if self._heard == len(self.log) or self.lock._is_owned():  # as threading.Condition asks
            return
        with self.lock:
            unsaid, self._heard = self.log[self._heard :], len(self.log)
        with ExitStack() as one_by_one:  # also where a filter makes an error of a warning
            for message in reversed(unsaid):
                one_by_one.callback(self._say, message)

    def _say(self, message):
        """Logs a message, and warns of what has not been warned of."""
        log.log(LEVELS.get(message.status, logging.ERROR), "%s: %s", self.name, message)
        if message.status == WARNING and (text := AT.sub("", message)) not in self._warned:
            self._warned.add(text)
            warn(str(message))

    def foreign(self):
        """Whether this process was forked from that which has the instance."""
        return os.getpid() != self.owner


_living = WeakSet()


@atexit.register
def _wait():
    """Lets no call begin any more, and waits for those that run: a message to a Python that has ended would kill the process."""
    end = monotonic() + PATIENCE
    for calls in list(_living):
        calls.lock.acquire(timeout=max(end - monotonic(), 0.0))


opening = RLock()
"""Held while an FMU is opened or its library is loaded. A fork waits for it: the modules, folders and libraries that another thread had
locked at that moment would stay locked in the process that was forked."""


def _alone():
    """In a process that was forked there is no other thread which could hold a lock."""
    for calls in list(_living):
        calls.lock = RLock()
    opening.release()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=opening.acquire, after_in_parent=opening.release, after_in_child=_alone)
