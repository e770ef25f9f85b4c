"""Ctrl-C is for the process that a person started, not for those it starts."""

import signal
from contextlib import contextmanager
from multiprocessing import resource_tracker


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
