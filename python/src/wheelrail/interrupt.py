"""Ctrl-C is for the process that a person started, not for those it starts; other signals that ask for the end do as Ctrl-C does."""

import signal
import threading
from contextlib import contextmanager
from multiprocessing import resource_tracker


class Told(KeyboardInterrupt):
    """The end that a signal asked for; `code` is the exit code by which shells know it."""

    def __init__(self, number):
        super().__init__(f"stopped by {signal.Signals(number).name}")
        self.code = 128 + number


@contextmanager
def told_to_end():
    """Meanwhile SIGTERM and SIGHUP end a command as Ctrl-C does, but for those that its process was started to ignore."""
    names = [name for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
    numbers = [number for number in map(signal.Signals.__getitem__, names) if signal.getsignal(number) == signal.SIG_DFL]
    if threading.current_thread() is not threading.main_thread():
        numbers = []

    def tell(number, _):
        raise Told(number)

    for number in numbers:
        signal.signal(number, tell)
    try:
        yield
    finally:
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)


@contextmanager
def kept_from_children():
    """Processes and threads that begin meanwhile never get Ctrl-C; one that comes meanwhile is felt afterwards. Windows knows no
    such thing: there everyone gets it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # or the first process that begins starts it, which lets Ctrl-C through again
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
