"""Ctrl-C is for the process that a person started, not for those it starts; other signals that ask for the end do as Ctrl-C does."""

import signal
import threading
from concurrent.futures import ThreadPoolExecutor
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
    ours = threading.current_thread() is threading.main_thread()
    known = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if ours and hasattr(signal, name)]
    numbers = [number for number in known if signal.getsignal(number) == signal.SIG_DFL]

    def tell(number, _):
        raise Told(number)

    for number in numbers:
        signal.signal(number, tell)
    try:
        yield
    finally:
        for number in numbers:
            signal.signal(number, signal.SIG_DFL)


def kept_from_children(start):
    """What `start` returns, called on a thread of its own: processes and threads that it begins never get Ctrl-C, and signals of
    this thread stay as they are. Ctrl-C meanwhile is felt when `start` is done. Windows knows no such thing: there everyone gets
    it."""

    def apart():
        if hasattr(signal, "pthread_sigmask"):
            resource_tracker.ensure_running()  # or the first process that begins starts it, which lets Ctrl-C through again
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        return start()

    with ThreadPoolExecutor(1) as alone:
        return alone.submit(apart).result()
