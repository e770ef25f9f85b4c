"""Many stops on many machines: all combinations of the values that a scenario lists for any keys, over dask.distributed.

Every stop is a task of its own; its row is written as soon as it is there. A sweep that was stopped goes on where it was: rows
that are in the file already are not computed again. A worker that dies loses nothing: its tasks go to others.
A stop that fails, or computes for longer than a limit, is named with its reason in a file of its own, and the next run tries it
again; the others go on. What a stop is longer than is a dry one with the same speed, load and brake, computed once each.
"""

import hashlib
import inspect
import json
import math
import time
from contextlib import closing, nullcontext
from itertools import product
from pathlib import Path
from types import SimpleNamespace

from .controllers import ControllerFailed
from .files import BadFile
from .fmu import Fmu, Refused
from .output import beside
from .own import OwnClass
from .report import figures, known
from .scenario import SHORT, changed
from .sweep_table import DRY, EXTENSION, OF_DRY, OVER_DRY, REASON, RESULTS, Table, shown
from .sweep_table import write_meanings, write_unfinished
from .train import Stop, TrackEnds
from .warn import Once, collected

TOLD = "warnings"  # of a stop
# Swept if a scenario names no key.
DEFAULT = {"speed": [27.8, 38.9], "adhesion": [0.05, 0.1]}
# What a row does not depend on: the time after which a stop is given up, what comes after it, names, where files are.
APART = ("sweep", "longest", "hold", "name", "paths", "path")
# Keys on which a dry stop does not depend: nothing slides there. Those of `brake.wsp` count if the protection is one's own.
WITHOUT_SLIDE = ("adhesion", "track.conditions.", "track.sand.", "track.cleaning_energy", "brake.sander.")
OF_PROTECTION = "brake.wsp."
OF_VALVES = ("brake.wsp.fill_time", "brake.wsp.vent_time")


class SchedulerGone(Exception):
    """The scheduler does not answer any more."""


def lists(scenario):
    """Swept keys and their values."""
    named = {key: values for key, values in vars(scenario.sweep).items() if key != "wheel"}
    twice = [short for short, path in SHORT.items() if short in named and path in named]
    if twice:
        raise BadFile(f"{scenario.paths['scenario']}: sweep: {twice[0]} and {SHORT[twice[0]]} are the same key")
    return named or DEFAULT


def points(scenario):
    """All combinations of a scenario's sweep, the fastest first: they take longest, and no worker is left with one at the end."""
    swept = lists(scenario)
    found = [dict(zip(swept, point)) for point in product(*swept.values())]
    return sorted(found, key=lambda point: -speed(scenario, point))


def speed(scenario, point):
    """Initial speed of a point [m/s]."""
    return point.get("speed", scenario.speed)


def reference(scenario, point):
    """What of a point its dry stop depends on."""
    own = scenario.brake.protection or "brake.protection" in point
    apart = WITHOUT_SLIDE if own else (*WITHOUT_SLIDE, OF_PROTECTION)
    path = lambda key: SHORT.get(key, key)
    return {key: value for key, value in point.items() if path(key) in OF_VALVES or not path(key).startswith(apart)}


def references(scenario):
    """The dry stops of all points, each once."""
    found = {}
    for point in points(scenario):
        needed = reference(scenario, point)
        found.setdefault(json.dumps(needed), needed)
    return list(found.values())


def at(scenario, point):
    """The scenario of a point."""
    found = changed(scenario, point)
    found.wheel |= {k: v for k, v in scenario.sweep.wheel.items() if f"wheel.{k}" not in point}
    found.hold = 0.0  # rows hold nothing of the time after it stands
    return found


def scenarios_of(scenario, of):
    """Scenarios of points; a wrong value is an error that names the point."""
    found = []
    for point in of:
        try:
            found.append(at(scenario, point))
        except BadFile as error:
            raise BadFile(f"{scenario.paths['scenario']}: sweep, {described(point)}: {error}") from None
    return found


def fingerprint(scenario, rigid):
    """Names what a sweep is of, the swept values apart, so that rows of another one are not taken for its own."""
    rest = {k: v for k, v in vars(scenario).items() if k not in APART}
    rest["wheel"] = scenario.wheel | scenario.sweep.wheel
    swept = sorted(SHORT.get(key, key) for key in lists(scenario))
    text = json.dumps([_without(rest, swept), swept, rigid, _contents(scenario, swept)], default=str, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def _contents(scenario, swept):
    """What the files and classes that are swept contain."""
    named = [(key, value) for key, values in lists(scenario).items() for value in values if isinstance(value, str)]
    others = lambda key: [other for other in swept if other != SHORT.get(key, key)]
    return [[key, value, _without(at(scenario, {key: value}), others(key))] for key, value in named]


def _without(value, swept, place=""):
    """Plain values of a scenario without those that are swept and without what results do not depend on."""
    if isinstance(value, OwnClass):
        return value.digest()
    if inspect.isclass(value):
        return f"{value.__module__}:{value.__qualname__}"
    # Names in plain dictionaries, such as parameters of one's own classes, are free.
    apart = APART if isinstance(value, SimpleNamespace) else ()
    if isinstance(value, SimpleNamespace):
        value = vars(value)
    if not isinstance(value, dict):
        return value
    return {
        k: _without(v, swept, f"{place}{k}.") for k, v in value.items() if f"{place}{k}" not in swept and k not in apart
    }


class TooSlow(Exception):
    """A stop that computes for longer than it may."""


def watch(limit):
    """A progress function that ends a stop after `limit` seconds of wall time, 0: never. It is asked after every step."""
    began = time.monotonic()

    def check(run):
        if limit and time.monotonic() - began > limit:
            raise TooSlow(
                f"computed for more than {limit:g} s: at {run.contacts.time:.2f} s, {run.coach.speed():.2f} m/s after "
                f"{run.coach.travelled():.0f} m"
            )

    return check


def one(scenario, dry, path, limit=0.0):
    """Results of one stop, or why there are none, under `REASON`; its warnings, if any, under `TOLD`. `dry`: a friction in place of the track's, or None; `path` of
    the FMU; None takes rigid wheelsets; a bare name is looked for where dask puts files that were sent to its workers; `limit` as
    in `watch`."""
    with collected() as texts:
        try:
            found = results(scenario, dry, path, limit)
        except (TooSlow, TimeoutError, Refused, ControllerFailed, TrackEnds, BadFile, ValueError) as error:
            found = {REASON: " ".join(str(error).split())}
    return found | ({TOLD: texts} if texts else {})


def results(scenario, dry, path, limit):
    """Key figures of one stop."""
    if path is not None and not Path(path).is_absolute():
        from distributed import get_worker

        path = Path(get_worker().local_directory) / path
    with Fmu(path) if path else nullcontext() as fmu, closing(Stop(scenario, fmu, dry)) as run:
        found = figures(run.run(watch(limit)))
    worst = lambda name: min if name == "mean adhesion" else max
    values = {name: found[name][0] for name in (RESULTS if dry is None else OF_DRY)}
    return {name: float(worst(name)(known(v)) if isinstance(v, list) else v) for name, v in values.items()}


class Files:
    """Files of a sweep: the stops, and the dry ones."""

    def __init__(self, scenario, rigid, path):
        self.path, self.name = Path(path), fingerprint(scenario, rigid)
        self.stops = Table(self.path, self.name, lists(scenario), [*RESULTS, *OVER_DRY])
        self.dry = Table(beside(self.path, "dry"), self.name, references(scenario)[0], OF_DRY)

    def missing(self, scenario):
        """What is to be computed, dry stops first: (dry, point)."""
        dry = [(True, point) for point in references(scenario) if not self.dry.has(point)]
        return dry + [(False, point) for point in points(scenario) if not self.stops.has(point)]

    def over_dry(self, row):
        """Adds what a row is longer than."""
        known = {self.dry.identity(dry): dry["stopping distance"] for dry in self.dry.rows}
        row[DRY] = known.get(self.dry.identity(row), math.nan)
        row[EXTENSION] = 100.0 * (row["stopping distance"] / row[DRY] - 1.0)
        return row

    def fill(self):
        """Writes what was not known yet when a row was written."""
        waiting = [self.over_dry(row) for row in self.stops.rows if math.isnan(row[DRY])]
        if any(not math.isnan(row[DRY]) for row in waiting):
            self.stops.rewrite()


def sweep(client, scenario, fmu, path, progress=lambda row: None, limit=0.0):
    """Computes what is missing in the file at `path`; returns all rows with results, and the points without, with their
    reasons. Warnings are said once of each kind. `fmu` None takes rigid wheelsets; `limit` [s] of one stop, 0: none. `progress` gets every row; those of dry stops
    have `DRY` true."""
    from distributed.diagnostics.plugin import UploadFile

    files, once = Files(scenario, fmu is None, path), Once()
    missing, failed = files.missing(scenario), []
    made = scenarios_of(scenario, [point for _, point in missing])
    if fmu is not None:
        client.register_plugin(UploadFile(str(fmu)))
        fmu = Path(fmu).name
    write_meanings(beside(files.path, "columns"), files.stops.keys)
    for (dry, point), found in finished(client, missing, made, fmu, limit):
        texts = found.pop(TOLD, ())
        row = point | ({DRY: True} if dry else {}) | found
        if REASON in row:
            failed.append(row)
        elif dry:
            files.dry.add(row)
        else:
            files.stops.add(files.over_dry(row))
        progress(row)
        for text in texts:
            once.warn(text, f"{described(row)}, ")
    files.fill()
    write_unfinished(beside(files.path, "unfinished"), files.name, [*files.stops.keys, DRY], failed)
    return files.stops.rows, failed


def finished(client, missing, made, fmu, limit):
    """(dry, point) and results of stops, as they come to their ends; dry ones have precedence."""
    from distributed import CancelledError, as_completed

    submit = lambda task, scenario: client.submit(
        # Whoever kills a worker may hit the same task several times.
        one, scenario, scenario.dry if task[0] else None, fmu, limit, pure=False, retries=3, priority=int(task[0])
    )
    futures = [submit(task, scenario) for task, scenario in zip(missing, made)]
    task_of = {future.key: task for future, task in zip(futures, missing)}
    # Those who wait for results hold no futures: a result whose worker dies is not computed again.
    waiting = as_completed(futures, loop=client.loop)
    del futures
    for future in waiting:
        if future.cancelled():
            raise SchedulerGone("it does not answer any more")
        error = future.exception()
        if isinstance(error, CancelledError):
            raise SchedulerGone("it does not answer any more")
        found = future.result() if error is None else {REASON: " ".join(f"{type(error).__name__}: {error}".split())}
        task = task_of[future.key]
        future.release()
        yield task, found


def described(row):
    """A point in words."""
    keys = [key for key in row if key not in (*RESULTS, *OVER_DRY, REASON)]
    words = ", ".join(f"{key} {shown(row[key])}" for key in keys)
    return ", ".join(filter(None, ["dry" if row.get(DRY) is True else "", words])) or "the scenario"
