"""Progress of long runs: a bar on a terminal, a line per 10 % anywhere else."""

import sys
import time
from contextlib import AbstractContextManager
from threading import RLock

from tqdm import tqdm

FORM = "{desc}: {percentage:3.0f}% |{bar}| [{elapsed}<{remaining}{postfix}]"


class Bar(tqdm):
    """A bar of tqdm without what else it leaves in the process: a thread, and a lock that settles how other processes begin."""

    monitor_interval, _lock = 0, RLock()


def is_terminal(file):
    """Whether a stream is a terminal. Programs with windows have no stream."""
    try:
        return file.isatty()
    except (AttributeError, ValueError):  # none, one of the user's own, or a closed one
        return False


class Progress(AbstractContextManager):
    """How much of `total` is done; `initial` of it was known before. A context manager, on the stream `file`."""

    def __init__(self, total, about, initial=0.0, file=None):
        self.total, self.initial, self.done, self.about = total, initial, initial, about
        self.file = file or sys.stderr
        self.began, self.tenth = time.monotonic(), int(10.0 * initial / total) if total else 10
        self.bar = None
        if is_terminal(self.file):
            self.bar = Bar(total=total, initial=initial, desc=about, bar_format=FORM, file=self.file)

    def __exit__(self, *_):
        if self.bar:
            self.bar.close()

    def advance(self, amount, words=""):
        """So much more is done; `words` say what."""
        self.done = min(self.done + amount, self.total)
        if self.bar:
            self.bar.set_postfix_str(words, refresh=False)
            self.bar.update(self.done - self.bar.n)
            return
        tenth = int(10.0 * self.done / self.total + 1e-9)
        if tenth > self.tenth and self.file:
            self.tenth = tenth
            print(f"{self.about}: {10 * tenth:3d} %, {self._times()}{f'; {words}' if words else ''}", file=self.file, flush=True)

    def _times(self):
        """Time so far, and what is left at this pace."""
        spent = time.monotonic() - self.began
        left = spent * (self.total - self.done) / max(self.done - self.initial, 1e-12)
        return f"{tqdm.format_interval(spent)} so far" + (f", {tqdm.format_interval(left)} left" if self.done < self.total else "")
