"""Ctrl-C is for the process that a person started, not for those it starts."""

import signal
from concurrent.futures import ThreadPoolExecutor
from multiprocessing import resource_tracker


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
