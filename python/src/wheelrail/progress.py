"""Progress of long runs: a bar on a terminal, a line per 10 % anywhere else."""

import sys
import time

from tqdm import tqdm

FORM = "{desc}: {percentage:3.0f}% |{bar}| [{elapsed}<{remaining}{postfix}]"


class Progress:
    """How much of `total` is done; `initial` of it was known before. A context manager, on the stream `file`."""

    def __init__(self, total, about, initial=0.0, file=None):
        self.total, self.initial, self.done, self.about = total, initial, initial, about
        self.file = file or sys.stderr
        self.began, self.tenth = time.monotonic(), int(10.0 * initial / total) if total else 10
        self.bar = None
        if self.file.isatty():
            self.bar = tqdm(total=total, initial=initial, desc=about, bar_format=FORM, file=self.file)

    def __enter__(self):
        return self

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
        if tenth > self.tenth:
            self.tenth = tenth
            print(f"{self.about}: {10 * tenth:3d} %, {self._times()}{f'; {words}' if words else ''}", file=self.file, flush=True)

    def _times(self):
        """Time so far, and what is left at this pace."""
        spent = time.monotonic() - self.began
        left = spent * (self.total - self.done) / max(self.done - self.initial, 1e-12)
        return f"{clock(spent)} so far" + (f", {clock(left)} left" if self.done < self.total else "")


def clock(seconds):
    """Minutes and seconds."""
    return f"{int(seconds) // 60}:{int(seconds) % 60:02d}"
