"""Many stops on many machines: speed x adhesion x payload x threshold of the slide protection, over dask.distributed.

Every stop is a task of its own; its row is written as soon as it is there. A sweep that was stopped goes on where it was: rows
that are in the file already are not computed again. A worker that dies loses nothing: its tasks go to others.
A stop that fails, or computes for longer than a limit, is named with its reason in a file of its own, and the next run tries it
again; the others go on.
"""

import csv
import hashlib
import json
import time
from contextlib import nullcontext
from copy import deepcopy
from itertools import product
from pathlib import Path
from types import SimpleNamespace

from .files import BadFile
from .fmu import Fmu, Refused
from .report import figures, known
from .scenario import settle
from .train import Stop

KEYS = ("speed", "adhesion", "payload", "slide_high")
RESULTS = (
    "stopping distance", "stopping time", "slide while sliding, p95", "longest lock", "mean adhesion",
    "energy into rail and tread", "peak temperature", "depth above Ac1", "air used",
)  # fmt: skip
REASON = "reason"  # why a stop has no results


# What a row does not depend on: swept values, the time after which a stop is given up, and what comes after it.
APART = ("sweep", "speed", "adhesion", "payload", "longest", "hold")


def header():
    """Names of the columns: scenario, keys, results; of the worst axle where there is one value per axle."""
    return ["scenario", *KEYS, *RESULTS]


def points(scenario):
    """All combinations of a scenario's sweep, the fastest first: they take longest, and no worker is left with one at the end."""
    values = vars(scenario.sweep)
    found = [dict(zip(KEYS, map(float, point))) for point in product(*(values[key] for key in KEYS))]
    return sorted(found, key=lambda point: -point["speed"])


def fingerprint(scenario, rigid):
    """Names what a sweep is of, the swept values apart, so that rows of another one are not taken for its own."""
    rest = {k: v for k, v in vars(scenario).items() if k not in APART}
    rest["wheel"] = scenario.wheel | scenario.sweep.wheel
    text = json.dumps([rest, rigid], default=lambda v: vars(v) if isinstance(v, SimpleNamespace) else str(v), sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:12]


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


def one(scenario, point, path, limit=0.0):
    """One stop: the point with its results, or with why there are none, under `REASON`. `path` of the FMU; None takes rigid
    wheelsets; a bare name is looked for where dask puts files that were sent to its workers; `limit` as in `watch`."""
    try:
        return point | results(scenario, point, path, limit)
    except (TooSlow, TimeoutError, Refused, ValueError) as error:
        return point | {REASON: " ".join(str(error).split())}


def results(scenario, point, path, limit):
    """Key figures of one stop."""
    scenario = deepcopy(scenario)
    scenario.speed, scenario.adhesion, scenario.payload = point["speed"], point["adhesion"], point["payload"]
    scenario.brake.wsp.slide_high = point["slide_high"]
    scenario.wheel |= scenario.sweep.wheel
    scenario.hold = 0.0  # rows hold nothing of the time after it stands
    settle(scenario)
    if path is not None and not Path(path).is_absolute():
        from distributed import get_worker

        path = Path(get_worker().local_directory) / path
    with Fmu(path) if path else nullcontext() as fmu:
        run = Stop(scenario, fmu)
        try:
            found = figures(run.run(watch(limit)))
        finally:
            run.close()
    worst = lambda name: min if name == "mean adhesion" else max
    values = {name: found[name][0] for name in RESULTS}
    return {name: float(worst(name)(known(v)) if isinstance(v, list) else v) for name, v in values.items()}


def done(path, name):
    """Rows of a file that belong to the scenario of this name; others are an error. A torn last line is cut off."""
    path = Path(path)
    if not path.is_file():
        return []
    text = path.read_text(encoding="utf-8")
    if not text.endswith("\n"):
        text = text[: text.rfind("\n") + 1]
        path.write_text(text, encoding="utf-8")
    rows = list(csv.DictReader(text.splitlines()))
    for line, row in enumerate(rows, start=2):
        if list(row) != header():
            raise BadFile(f"{path}:1: not the columns of a sweep: {', '.join(row)}")
        if row["scenario"] != name:
            raise BadFile(f"{path}:{line}: a row of another scenario ({row['scenario']}, this is {name}); take another --out")
    return [{key: float(value) for key, value in row.items() if key != "scenario"} for row in rows]


def unfinished(path):
    """Where stops without results are named: beside the results."""
    path = Path(path)
    return path.with_name(f"{path.stem}_unfinished.csv")


def sweep(client, scenario, fmu, path, progress=lambda row: None, limit=0.0):
    """Computes what is missing in the file at `path`; returns all rows with results, and the points without, with their
    reasons. `fmu` None takes rigid wheelsets; `limit` [s] of one stop, 0: none."""
    from distributed import as_completed
    from distributed.diagnostics.plugin import UploadFile

    name = fingerprint(scenario, fmu is None)
    rows = done(path, name)
    known = {tuple(row[key] for key in KEYS) for row in rows}
    missing = [point for point in points(scenario) if tuple(point.values()) not in known]
    if fmu is not None:
        client.register_plugin(UploadFile(str(fmu)))
        fmu = Path(fmu).name
    # Whoever kills a worker may hit the same task several times.
    futures = client.map(lambda point: one(scenario, point, fmu, limit), missing, pure=False, retries=3)
    point_of, failed = dict(zip((future.key for future in futures), missing)), []
    with open(path, "a", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, header())
        if not rows and file.tell() == 0:
            writer.writeheader()
        for future in as_completed(futures):
            error = future.exception()
            row = future.result() if error is None else point_of[future.key] | {REASON: f"{type(error).__name__}: {error}"}
            future.release()  # or it is computed again when the worker that keeps its result dies
            progress(row)
            if REASON in row:
                failed.append(row)
                continue
            writer.writerow({"scenario": name} | {key: repr(value) for key, value in row.items()})
            file.flush()
            rows.append(row)
    write_unfinished(unfinished(path), name, failed)
    return rows, failed


def write_unfinished(path, name, failed):
    """Names stops without results in a file; without any there is no file."""
    if not failed:
        path.unlink(missing_ok=True)
        return
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ["scenario", *KEYS, REASON])
        writer.writeheader()
        writer.writerows({"scenario": name} | row for row in failed)


def described(row):
    """A point in words."""
    return ", ".join(f"{key} {row[key]:g}" for key in KEYS)


class Progress:
    """A bar whose share and remaining time count a stop by its initial speed, which its duration follows; `known` rows are done."""

    def __init__(self, scenario, known):
        from tqdm import tqdm

        everything = points(scenario)
        self.count, self.done = len(everything), len(known)
        weigh = lambda rows: sum(row["speed"] for row in rows)
        form = "{desc}: {percentage:3.0f}% |{bar}| [{elapsed}<{remaining}{postfix}]"
        self.bar = tqdm(total=weigh(everything), initial=weigh(known), desc="stops", bar_format=form)

    def tell(self, row):
        """A stop has come to its end, or failed."""
        self.done += 1
        found = "no result" if REASON in row else f"{row['stopping distance']:.0f} m"
        self.bar.set_postfix_str(f"{self.done} of {self.count}; {described(row)}: {found}", refresh=False)
        self.bar.update(row["speed"])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.bar.close()


def run(options, scenario):
    """The command: cluster, progress, file, picture."""
    from distributed import Client, LocalCluster

    from .plots import draw_sweep

    options.out.mkdir(parents=True, exist_ok=True)
    path = options.out / "sweep.csv"
    fmu = None if options.rigid else options.fmu
    known = done(path, fingerprint(scenario, options.rigid))
    local = lambda: LocalCluster(n_workers=options.workers, threads_per_worker=1, dashboard_address=None)
    with nullcontext() if options.scheduler else local() as cluster, Client(options.scheduler or cluster) as client:
        with Progress(scenario, known) as progress:
            rows, failed = sweep(client, scenario, fmu, path, progress.tell, options.limit)
    for row in failed:
        print(f"no result: {described(row)}: {row[REASON]}")
    if not rows:
        raise TimeoutError(f"no stop came to its end; see {unfinished(path)}")
    draw_sweep(options.out / "sweep.png", rows)
    if failed:
        print(f"{len(failed)} stops without results, named in {unfinished(path)}; the next run tries them again")
    print(f"{len(rows)} stops, {len(known)} of them known before; written: {path}, {options.out / 'sweep.png'}")
