"""Ctrl-C is for the process that a person started, not for those it starts."""

import signal
from contextlib import contextmanager


@contextmanager
def kept_from_children():
    """Processes and threads that begin meanwhile never get Ctrl-C; one that comes meanwhile is felt afterwards. Windows knows no
    such thing: there everyone gets it."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
