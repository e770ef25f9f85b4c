"""The command `sweep`: scheduler, progress, files, picture; what can go wrong with a cluster is one line and what to do."""

import logging
import warnings
from contextlib import ExitStack

from .files import BadFile
from .interrupt import kept_from_children
from .output import Unwritten, beside, results_folder
from .progress import Progress
from .sweep import Files, SchedulerGone, described, lists, points, references, scenarios_of, speed, sweep
from .sweep_table import REASON

PATIENCE = 10.0  # s, for a scheduler to answer and for its first worker


class SweepStopped(Exception):
    """A sweep that came to no end; the text says what is there and what to do, `code` is that of the command."""

    def __init__(self, text, code=1):
        super().__init__(text)
        self.code = code


def run(options, scenario):
    """All stops that are missing, the file, the picture."""
    try:
        import distributed
    except ImportError as error:
        raise BadFile(f"sweep needs the package {error.name}: python -m pip install 'wheelrail[sweep]'") from None
    from .plots_sweep import draw_sweep

    path = results_folder(options.out, scenario.paths["scenario"].stem) / "sweep.csv"
    unfinished = beside(path, "unfinished")
    scenarios_of(scenario, points(scenario))  # wrong values are said before anything is deleted or begins
    if options.force:
        for old in (path, beside(path, "dry"), unfinished):
            old.unlink(missing_ok=True)
    fmu, files = None if options.rigid else options.fmu, Files(scenario, options.rigid, path)
    swept = " × ".join(f"{key} ({len(values)})" for key, values in lists(scenario).items())
    missing, before = files.missing(scenario), len(files.stops.rows)
    stops = f"{len(points(scenario))} stops and {len(references(scenario))} dry ones, {len(missing)} to compute"
    print(f"{scenario.name}: {swept}: {stops}", flush=True)
    rows, failed = files.stops.rows, []
    if missing:
        rows, failed = _computed(distributed, options, scenario, fmu, path, missing)
    for row in failed:
        print(f"no result: {described(row)}: {row[REASON]}")
    if not rows:
        raise SweepStopped(f"no stop came to its end; see {unfinished}")
    if failed:
        print(f"{len(failed)} stops without results, named in {unfinished}; the next run tries them again")
    written = [path, beside(path, "dry"), beside(path, "columns")]
    problem = draw_sweep(path.with_suffix(".png"), rows, list(lists(scenario)), scenario.name)
    written += [] if problem else [path.with_suffix(".png")]
    print(f"{len(rows)} stops, {before} of them known before; written: {', '.join(map(str, written))}")
    if problem:
        print(f"no picture: {problem}")


def _computed(distributed, options, scenario, fmu, path, missing):
    """Rows and failures of a sweep on a cluster; Ctrl-C and a scheduler that is gone leave what is done."""
    weigh = lambda row: speed(scenario, row)
    done = sum(map(weigh, points(scenario) + references(scenario))) - sum(weigh(point) for _, point in missing)
    count = 0

    def tell(row):
        nonlocal count
        count += 1
        found = "no result" if REASON in row else f"{row['stopping distance']:.0f} m"
        progress.advance(weigh(row), f"{count} of {len(missing)}; {described(row)}: {found}")

    try:
        with ExitStack() as stack:
            client = stack.enter_context(_client(distributed, options, stack))
            total = done + sum(weigh(point) for _, point in missing)
            progress = stack.enter_context(Progress(total, "stops", done))
            return sweep(client, scenario, fmu, path, tell, options.limit)
    except KeyboardInterrupt as stop:
        reason, code = str(stop) or "stopped", getattr(stop, "code", 130)
    except Unwritten as error:
        reason, code = str(error), 1
    except (SchedulerGone, distributed.CancelledError, OSError) as error:
        reason, code = f"connection to the scheduler lost ({error or type(error).__name__})", 1
    there = f" after {count} of {len(missing)} stops; results are in {path.parent}, and the same command goes on from there"
    raise SweepStopped(reason + (there if count else ": no stop had come to its end"), code)


def _client(distributed, options, stack):
    """A client of the scheduler that was asked for, or of workers on this machine, which Ctrl-C does not reach: it is ours."""
    for name in ("", ".nanny", ".worker", ".scheduler", ".client", ".comm"):
        logging.getLogger(f"distributed{name}").setLevel(logging.CRITICAL)
    warnings.filterwarnings("ignore", module="distributed")
    if not options.scheduler:
        workers = {"n_workers": options.workers, "threads_per_worker": 1, "dashboard_address": ":0", "silence_logs": logging.CRITICAL}
        cluster = kept_from_children(lambda: stack.enter_context(distributed.LocalCluster(**workers)))
        return distributed.Client(cluster, set_as_default=False)
    address = options.scheduler if "://" in options.scheduler else f"tcp://{options.scheduler}"
    start = "start one with `dask scheduler`, or leave out --scheduler for workers on this machine"
    try:
        # Not the default: a client that failed would stay that of everything else in this process that uses dask.
        client = distributed.Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        text = " ".join(str(error).split()) or type(error).__name__
        raise SweepStopped(f"no scheduler answers at {address} within {PATIENCE:g} s ({text}); {start}") from None
    try:
        client.wait_for_workers(1, timeout=PATIENCE)
    except TimeoutError:
        client.close()
        text = f"the scheduler at {address} has no worker: start `dask worker {address}` where this package is installed"
        raise SweepStopped(text) from None
    return client
