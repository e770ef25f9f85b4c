"""A whole run in one call: parameters, inputs over time, communication steps, and the record of it."""

from contextlib import ExitStack
from math import ceil, isfinite
from numbers import Real

import numpy as np

from .fmu import Fmu, Wheel
from .values import Refused, check_names, short, to_fmu

ROUNDING = 1e-6  # difference of times, in steps, that is rounding only
BAR = "{desc}: {percentage:3.0f} % |{bar}| {n:.4g} of {total:.4g} s [{elapsed}<{remaining}]"


def simulate(
    parameters=None,
    inputs=None,
    *,
    stop=None,
    step=1e-3,
    outputs=None,
    profiles=False,
    depth=False,
    every=1,
    fmu=None,
    progress=True,
    title="",
):
    """The record of a run from 0 to `stop` in communication steps of `step`, both in seconds: an xarray Dataset.

    `inputs` are by name constants, pairs of times [s] and values (also a pandas Series or a DataArray over time), between which
    they are linear, or functions of the time; choices hold. Two values at the same time make a jump, and the last one holds.
    Without `stop` the run ends with the last of these times, or at 1 s. `outputs`, `profiles`, `depth` and `every` say
    what is recorded, see `records.Recorder`. `fmu` is an opened `Fmu`, the path of one, or `default_path()`.

    What stops a run carries the record so far as its attribute `run`. The bar of the `progress` shows on a terminal only.
    """
    parameters, inputs = parameters or {}, inputs or {}
    check_names(parameters, "simulate")
    check_names(inputs, "simulate")
    with ExitStack() as stack:
        fmu = fmu if hasattr(fmu, "description") else stack.enter_context(Fmu(fmu))
        courses = {name: _course(fmu, name, given) for name, given in inputs.items()}
        step = _seconds("step", step, "more than 0")
        if stop is None:
            stop = max((course.end for course in courses.values()), default=0.0) or 1.0
        stop = _seconds("stop", stop, "at least 0", zero=True)
        wheel = stack.enter_context(Wheel(fmu, parameters, {name: course.at(0.0) for name, course in courses.items()}))
        names = [outputs] if isinstance(outputs, str) else outputs or ()
        recorder = wheel.record(*names, profiles=profiles, depth=depth, every=every, title=title)
        try:
            _advance(wheel, courses, stop, step, progress)
        except BaseException as failure:
            failure.run = recorder.dataset()
            failure.add_note(f"ended at {wheel.time:g} of {stop:g} s; the attribute `run` of this exception is its record")
            raise
        recorder.sample()
        return recorder.dataset()


def _advance(wheel, courses, stop, step, progress):
    """Steps a wheel to the end; inputs that vary are ramps within a step."""
    from tqdm import tqdm

    steps = max(ceil(stop / step - ROUNDING), 0)
    moving = {name: course for name, course in courses.items() if not course.constant}
    # None: where there is a terminal.
    with tqdm(total=stop, desc="run", bar_format=BAR, disable=None if progress else True) as bar:
        for k in range(steps):
            wheel.time = k * step
            rest = stop - wheel.time
            h = rest if rest < (1.0 - ROUNDING) * step else step
            if moving:
                now = {name: course.at(wheel.time) for name, course in moving.items()}
                wheel.set(now)
                rates = {name: (moving[name].before(wheel.time + h) - now[name]) / h for name in moving if moving[name].linear}
                wheel.set_rates({name: rate for name, rate in rates.items() if rate})
            wheel.step(h)
            wheel.time = stop if k == steps - 1 else (k + 1) * step
            bar.update(h)


class _Course:
    """An input over time: its value from a time on, and that up to a time, which differ at a jump only."""

    constant, linear, end = False, True, 0.0

    def at(self, time):
        """The value from `time` [s] on."""
        raise NotImplementedError

    def before(self, time):
        """The value up to `time` [s]."""
        return self.at(time)


class _Constant(_Course):
    """An input that holds its value."""

    constant = True

    def __init__(self, value):
        self.value = value

    def at(self, time):
        return self.value


class _Function(_Course):
    """An input that is a function of the time."""

    def __init__(self, variable, function):
        self.variable, self.function, self.linear = variable, function, variable.type == "Real"

    def at(self, time):
        try:
            return to_fmu(self.variable, self.function(time))
        except Refused as refused:
            raise Refused(f"at {time:g} s {refused}") from None


class _Samples(_Course):
    """An input with values at times."""

    def __init__(self, variable, times, values):
        self.times, self.values, self.end = times, values, float(times[-1])
        self.linear = variable.type == "Real"

    def at(self, time):
        return self._value(time, np.searchsorted(self.times, time, side="right"))

    def before(self, time):
        return self._value(time, np.searchsorted(self.times, time, side="left"))

    def _value(self, time, after):
        """The value on the piece that ends with the sample `after`."""
        if after == 0 or after == len(self.times) or not self.linear:
            return self.values[max(after - 1, 0)]
        (t0, t1), (v0, v1) = self.times[after - 1 : after + 1], self.values[after - 1 : after + 1]
        return v0 + (v1 - v0) * (time - t0) / (t1 - t0)


def _course(fmu, name, given):
    """The course of an input: from a constant, pairs of times and values, or a function."""
    variable = fmu.variable(name)
    if variable.causality != "input":
        where = "give it in parameters" if variable.causality == "parameter" else "it can be recorded only"
        raise Refused(f"{name} is no input but {'an' if variable.causality[0] in 'aeiou' else 'a'} {variable.causality}: {where}")
    if callable(given):
        return _Function(variable, given)
    if hasattr(given, "to_series"):  # a DataArray
        given = given.to_series()
    if hasattr(given, "index") and hasattr(given, "to_numpy"):  # a Series
        given = (given.index.to_numpy(), given.to_numpy())
    if isinstance(given, str) or isinstance(given, Real) or getattr(given, "shape", None) == ():
        return _Constant(to_fmu(variable, given))
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise ValueError(f"{name} = {short(given)} is no value, no pair of times and values, and no function of the time")
    return _Samples(variable, *_samples(variable, *given))


def _samples(variable, times, values):
    """Times that ascend, and as many values as the variable wants them."""
    name = variable.name
    try:
        times, values = np.asarray(times, dtype=float), list(values)
    except (TypeError, ValueError):
        raise ValueError(f"{name} = ({short(times)}, {short(values)}): expected as many times [s] as values") from None
    if times.ndim != 1 or len(times) != len(values) or not len(values):
        raise ValueError(f"{name} has {times.size} times and {len(values)} values: expected one value for each, at least one")
    if not np.isfinite(times).all():
        raise ValueError(f"{name}: time {times[~np.isfinite(times)][0]} s is not finite")
    if (falls := np.flatnonzero(np.diff(times) < 0.0)).size:
        k = falls[0]
        raise ValueError(f"{name}: times must ascend, {times[k + 1]:g} s follows {times[k]:g} s")
    return times, [to_fmu(variable, value) for value in values]


def _seconds(name, value, range_, zero=False):
    """A length of time."""
    value = value.item() if getattr(value, "shape", None) == () else value
    if isinstance(value, bool) or not isinstance(value, Real) or not isfinite(value) or value < 0.0 or value == 0.0 and not zero:
        raise ValueError(f"{name} = {short(value)} is not a number of seconds, {range_}")
    return float(value)
