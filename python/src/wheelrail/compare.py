"""Stops side by side: dry, on the track with slide protection, on the track without. Each in a process of its own."""

from __future__ import annotations

import multiprocessing
import queue
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, closing, nullcontext
from copy import deepcopy
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from .fmu import Fmu
from .interrupt import kept_from_children
from .rail_map import RailMap
from .train import Stop, TrackEnds
from .warn import Once, collected

DRY, PROTECTED, UNPROTECTED = "dry", "WSP on", "WSP off"


def variants(scenario: SimpleNamespace) -> dict[str, tuple[SimpleNamespace, float | None]]:
    """The three stops: name to (scenario, friction in place of the track's)."""
    protected, unprotected = deepcopy(scenario), deepcopy(scenario)
    protected.brake.wsp.active, unprotected.brake.wsp.active = True, False
    return {DRY: (protected, scenario.dry), PROTECTED: (protected, None), UNPROTECTED: (unprotected, None)}


def stop(name: str, scenario: SimpleNamespace, dry: float | None, path: Path | None, news: Any) -> tuple[str, np.ndarray, RailMap]:
    """One stop: name, its table and its rail. `path` of the FMU, or None for rigid wheelsets; `news` is a queue that gets
    (name, share done) about a hundred times, and (name, warnings), which are not said then."""
    with Fmu(path) if path else nullcontext() as fmu, collected() as texts:
        told = 0

        def tell(run):
            nonlocal told
            done = int(100 * (1.0 - max(run.coach.speed(), 0.0) / scenario.speed))
            if done > told:
                told = done
                news.put((name, done))

        try:
            with closing(Stop(scenario, fmu, dry)) as run:
                table = run.run(tell)
        finally:
            if texts:
                news.put((name, texts))
    news.put((name, 100))
    return name, table, run.contacts.rail


class Died(Exception):
    """A stop whose process was killed."""


def side_by_side(
    scenario: SimpleNamespace,
    path: Path | None,
    progress: Callable[[str, int], None] = lambda name, done: None,
    endless: dict[str, Exception] | None = None,
) -> dict[str, tuple[np.ndarray, RailMap]]:
    """All variants at once; name to (table, rail map). The first that fails ends the others, but one that comes to no end, in time
    or on the track, is put into `endless`, name to error, if that is given."""
    context = multiprocessing.get_context("spawn")
    runs, once = variants(scenario), Once()
    with ExitStack() as stack:

        def start():
            news = stack.enter_context(context.Manager()).Queue()
            others = set(multiprocessing.active_children())
            pool = stack.enter_context(ProcessPoolExecutor(len(runs), context))
            stack.callback(lambda: [child.terminate() for child in set(multiprocessing.active_children()) - others])
            return news, [pool.submit(stop, name, s, dry, path, news) for name, (s, dry) in runs.items()]

        news, jobs = kept_from_children(start)
        try:
            while not all(job.done() for job in jobs):
                _hear(news, progress, once)
                _ended(runs, jobs, endless)
            return _ended(runs, jobs, endless)
        except BrokenProcessPool:
            raise Died("the process of a stop was killed; it may have had too little memory") from None
        finally:
            while not news.empty():
                _hear(news, progress, once)


def _ended(runs, jobs, endless):
    """Stops that have come to their ends: name to (table, rail map). Errors are raised, or put into `endless`."""
    found = {}
    for name, job in zip(runs, jobs):
        error = job.exception() if job.done() else None
        if isinstance(error, TimeoutError | TrackEnds) and endless is not None:
            endless[name] = error
        elif job.done():
            found[name] = job.result()[1:]
    return found


def _hear(news, progress, once):
    """Passes on what comes within a moment: shares done, and warnings, each kind once."""
    try:
        name, heard = news.get(timeout=0.2)
    except queue.Empty:
        return
    if isinstance(heard, int):
        progress(name, heard)
        return
    for text in heard:
        once.warn(text, f"{name}, ")
