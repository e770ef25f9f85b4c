"""A whole run in one call: parameters, inputs over time, communication steps, and the record of it."""

from __future__ import annotations

import logging
import sys
from collections.abc import Iterable, Mapping
from contextlib import ExitStack
from math import ceil
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from .courses import HEIGHT, RATE, courses_of, parts
from .fmu import Fmu, Wheel
from .samples import of_arrow
from .times import at
from .units import TIMES, beside, headed
from .values import check_names, number, short
from .warn import warn

if TYPE_CHECKING:
    import pandas
    import xarray

log = logging.getLogger(__name__)
ROUNDING = 1e-6  # difference of times, in steps, that is rounding only
BAR = "{desc}: {percentage:3.0f} % |{bar}| {n:.4g} of {total:.4g} s [{elapsed}<{remaining}]"


def simulate(
    parameters: Mapping[str, object] | None = None,
    inputs: Mapping[str, object] | pandas.DataFrame | None = None,
    *,
    stop: float | None = None,
    step: float = 1e-3,
    outputs: str | Iterable[str] | None = None,
    profiles: bool | str | Iterable[str] = False,
    depth: bool | str | Iterable[str] = False,
    patch: bool = False,
    every: int = 1,
    fmu: Fmu | str | Path | None = None,
    progress: bool = True,
    title: str = "",
) -> xarray.Dataset:
    """The record of a run from 0 to `stop` in communication steps of `step`, both in seconds: an xarray Dataset.

    `inputs` are by name constants, functions of the time, or samples over time [s] in any of the forms of `samples`: a dict, pairs,
    a pandas Series. Between samples they are linear, choices hold. Two samples at one time make a jump, at that time whatever
    the step is; what varies within a step acts with its mean (`courses`). A table (pandas, or polars, pyarrow and others that speak
    Arrow) has a column for every input, over its index or its column `time`, as a scenario of the command line. A unit beside a
    value or behind a name (`drive.velocity [km/h]`) is used, or refused by its name; without one values are in SI units.
    Without `stop` the run ends with the last of these times, or at 1 s. `outputs`, `profiles`, `depth`, `patch` and `every`
    say what is recorded, see `records.Recorder`. `fmu` is an opened `Fmu`, the path of one, or `default_path()`.

    What stops a run carries the record so far as its attribute `run`. The bar of the `progress` shows on a terminal only.
    """
    parameters, inputs = parameters or {}, _by_name(inputs)
    check_names(parameters, "simulate")
    check_names(inputs, "simulate")
    with ExitStack() as stack:
        fmu = fmu if hasattr(fmu, "description") else stack.enter_context(Fmu(fmu))
        courses = courses_of(fmu, inputs)
        step = _seconds("step", step, "more than 0")
        if stop is None:
            stop = max((course.end for course in courses.values()), default=0.0) or 1.0
        stop = _seconds("stop", stop, "at least 0", zero=True)
        for name, course in courses.items():
            for text in () if course.constant else course.unseen(name, stop, step):
                warn(text)
        wheel = stack.enter_context(Wheel(fmu, parameters, {name: course.at(0.0) for name, course in courses.items()}))
        names = [outputs] if isinstance(outputs, str) else outputs or ()
        recorder = wheel.record(*names, profiles=profiles, depth=depth, every=every, title=title, patch=patch)
        log.info("run of %g s in steps of %g s", stop, step)
        began = perf_counter()
        try:
            _advance(wheel, courses, stop, step, progress)
        except BaseException as failure:
            failure.run = recorder.dataset()
            failure.add_note(f"ended at {wheel.time:g} of {stop:g} s; the attribute `run` of this exception is its record")
            log.error("run ended at %g of %g s: %s", wheel.time, stop, failure)
            raise
        log.info("run of %g s done in %.3g s", stop, perf_counter() - began)
        recorder.sample()
        return recorder.dataset()


def _advance(wheel, courses, stop, step, progress):
    """Steps a wheel to the end; inputs that vary are ramps within a step."""
    from .progress import Bar, is_terminal

    steps = max(ceil(stop / step - ROUNDING), 0)
    moving = {name: course for name, course in courses.items() if not course.constant}
    with Bar(total=stop, desc="run", bar_format=BAR, disable=not (progress and is_terminal(sys.stderr))) as bar:
        for k in range(steps):
            rest = stop - wheel.time
            h = rest if rest < (1.0 - ROUNDING) * step else step
            *first, last = parts(moving.values(), wheel.time, wheel.time + h)
            for end in first:
                _prescribe(wheel, moving, end)
                wheel.advance(end - wheel.time, end)
                h = last - end
            _prescribe(wheel, moving, last)
            wheel.step(h, stop if k == steps - 1 else at(k + 1, step))
            bar.update(wheel.time - bar.n)


def _prescribe(wheel, moving, end):
    """Sets inputs that vary for a step up to a time [s], as ramps."""
    if not moving:
        return
    lines = {name: course.line(wheel.time, end) for name, course in moving.items()}
    at_end = {RATE: moving[HEIGHT].rate(end)} if HEIGHT in moving and RATE not in moving else {}
    wheel.set({name: value for name, (value, _) in lines.items()} | at_end)
    real = [name for name in lines if wheel.fmu.variable(name).type == "Real"]
    rates = {name: (lines[name][1] - lines[name][0]) / (end - wheel.time) for name in real}
    wheel.set_rates({name: rate for name, rate in rates.items() if rate})


def _by_name(inputs):
    """Inputs by name. A table, of pandas or of whatever speaks Arrow, has a column for each, over its index or its column of times."""
    if inputs is None:
        return {}
    if hasattr(inputs, "__arrow_c_stream__") and not hasattr(inputs, "iloc"):
        inputs = of_arrow(inputs)
    if not hasattr(inputs, "iloc") or not hasattr(inputs, "columns"):
        return inputs
    if not inputs.columns.is_unique:
        raise ValueError(f"inputs have the column {inputs.columns[inputs.columns.duplicated()][0]!r} twice")
    times = "time" if "time" in inputs.columns else None
    if times is None and inputs.index.name is None:
        times = next((column for column in inputs.columns if str(headed(column)[0]).lower() in TIMES), None)
    columns = {name: inputs[name] for name in inputs.columns if name != times}
    if times is None:
        return columns
    over, unit = beside(inputs[times])
    return {name: column.set_axis(over.array).rename_axis(f"time [{unit or 's'}]") for name, column in columns.items()}


def _seconds(name, value, range_, zero=False):
    """A length of time."""
    found = number(name, value, "s")
    if found is None or found < 0.0 or found == 0.0 and not zero:
        raise ValueError(f"{name} = {short(value)} is not a number of seconds, {range_}")
    return found
