"""Warnings of this package: each points to the line of the user's program that led to it."""

from __future__ import annotations

import re
import sys
import sysconfig
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

PACKAGE = str(Path(__file__).resolve().parent)
STANDARD = tuple({sysconfig.get_path(name) for name in ("stdlib", "platstdlib")})
INSTALLED = ("site-packages", "dist-packages")  # folders of other packages within those of the standard library

_collecting = ContextVar("wheelrail warnings", default=None)


class WheelrailWarning(UserWarning):
    """A doubt of the FMU or of this package about what it was given: the run goes on."""


def warn(text: str) -> None:
    """Says a text as `WheelrailWarning` of the innermost line outside of this package, or hands it to who collects."""
    texts = _collecting.get()
    if texts is not None:
        texts.append(text)
        return
    frame = sys._getframe(1)
    while frame.f_back and _between(frame.f_code.co_filename):
        frame = frame.f_back
    # No registry: Python would say a text once for each line of a program, but every run says it.
    place = frame.f_code.co_filename, frame.f_lineno, frame.f_globals.get("__name__")
    warnings.warn_explicit(WheelrailWarning(text), None, *place)


@contextmanager
def collected() -> Iterator[list[str]]:
    """A list that gets the texts of the warnings of this thread meanwhile, in the place of being said."""
    texts = []
    token = _collecting.set(texts)
    try:
        yield texts
    finally:
        _collecting.reset(token)


@contextmanager
def in_lines() -> Iterator[None]:
    """Warnings of this package are lines `warning: …` meanwhile, unless filters of Python make errors of them or silence them."""
    with warnings.catch_warnings():
        usual = warnings.showwarning

        def show(message, category, *place, **named):
            if issubclass(category, WheelrailWarning):
                print(f"warning: {' '.join(str(message).split())}", file=sys.stderr, flush=True)
            else:
                usual(message, category, *place, **named)

        warnings.showwarning = show
        yield


class Once:
    """Says each kind of text once: texts of a kind differ in their numbers."""

    def __init__(self) -> None:
        self.known = set()

    def warn(self, text: str, of: str = "") -> None:
        """Says a text, `of` something, unless one of its kind was said before."""
        kind = re.sub(r"[-+]?\d[\d.,]*(e[-+]?\d+)?", "#", text)
        if kind not in self.known:
            self.known.add(kind)
            warn(f"{of}{text}")


def _between(path):
    """Whether a file lies between the user's program and a warning: of this package or of Python itself."""
    if path.startswith((PACKAGE, "<frozen")):
        return True
    return path.startswith(STANDARD) and not any(folder in path for folder in INSTALLED)
