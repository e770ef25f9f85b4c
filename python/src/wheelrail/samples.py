"""Times and values of an input, in whatever form a person or pandas gives them: seconds of the run, or a refusal.

| given | time |
|---|---|
| `{0.0: 1e5, 0.5: 8e4}` | its keys |
| `([0.0, 0.5], [1e5, 8e4])`, an array of two rows | the first list or row |
| `[(0.0, 1e5), (0.5, 8e4)]`, an array of two columns | the first of each pair |
| a Series, a DataFrame of one column, a DataArray | its index or coordinate |

Times are numbers of seconds, or of a unit that an index or attribute names, spans of time (timedelta), or dates, which
count from the earliest one of all inputs. Values may have a unit beside them.
"""

import numpy as np

from .records import library
from .units import agreed, behind, beside, converted
from .values import short

LATEST = 1e8  # s: a later time is a date, or counts something else than seconds
SPANS = ("m", "M")  # numpy's kinds of spans of time and of dates


def samples_of(inputs):
    """Times [s], values and their unit, None where nothing says it, by name; dates of all inputs count from the earliest one."""
    found = {name: _columns(name, given) for name, given in inputs.items()}
    found = {name: (_index(name, times), values, unit) for name, (times, values, unit) in found.items()}
    dates = {name: times for name, (times, *_) in found.items() if getattr(times.dtype, "kind", "") == "M"}
    if len({times.tz is None for times in dates.values()}) > 1:
        raise ValueError(f"{', '.join(dates)}: some dates have a time zone, others do not; give all or none of them one")
    begin = min((times.min() for times in dates.values()), default=None)
    return {name: (_seconds(name, times, begin), values, unit) for name, (times, values, unit) in found.items() if _fit(name, times, values)}


def _columns(name, given):
    """Times as they are given, a list of values, and their unit."""
    if hasattr(given, "columns") and hasattr(given, "index"):  # a DataFrame
        if len(given.columns) != 1:
            raise ValueError(f"{name} is a table of {len(given.columns)} columns: choose one, such as table[{short(given.columns[0])}]")
        given = given.iloc[:, 0]
    given, unit = beside(given)
    if hasattr(given, "to_series"):  # a DataArray
        return *_of_array(name, given), unit
    if not getattr(given, "size", 1) or isinstance(given, dict) and not given:
        raise ValueError(f"{name} is empty: expected a value at one time at least")
    if hasattr(given, "index") and hasattr(given, "to_numpy"):  # a Series
        return given.index, list(given), unit
    if hasattr(given, "items"):
        return list(given.keys()), list(given.values()), unit
    if isinstance(given, (set, frozenset)):
        raise ValueError(f"{name} = {short(given)} is a set, which has no order: give a list of pairs")
    if hasattr(given, "__next__"):
        given = list(given)
    times, values = _of_sequence(name, given)
    values, of = beside(values)
    return times, list(values), agreed(name, (unit, of))


def _of_array(name, given):
    """Times and values of a DataArray over the time."""
    if given.ndim != 1 or given.dims[0] not in given.coords:
        raise ValueError(f"{name} is an array over {given.dims}: expected one dimension, with a coordinate of times [s]")
    return given.coords[given.dims[0]], list(given.values)


def _of_sequence(name, given):
    """Times and values of a pair of sequences, or of a sequence of pairs."""
    wrong = f"{name} = {short(given)} is no value, no pair of times and values, no list of such pairs, and no function of the time"
    if not isinstance(given, (tuple, list, np.ndarray)) or not len(given):
        raise ValueError(wrong)
    if isinstance(given, tuple):  # Arrow's arrays have no numbers of Python in them
        given = tuple(part.to_pylist() if hasattr(part, "to_pylist") else part for part in given)
    if hasattr(given, "dtype") and given.ndim != 2 or not all(hasattr(part, "__len__") and not isinstance(part, str) for part in given):
        raise ValueError(wrong)
    pairs = all(len(part) == 2 for part in given)
    if len(given) == 2 and pairs:
        inner = {type(part) for part in given}
        if isinstance(given, list) and inner == {tuple}:
            return [part[0] for part in given], [part[1] for part in given]
        if not isinstance(given, tuple) or inner == {tuple}:
            raise ValueError(
                f"{name} = {short(given)} can mean two times and two values, or two pairs of both: write ([t1, t2], [v1, v2]), "
                "or [(t1, v1), (t2, v2)]"
            )
    if len(given) == 2:
        return given[0], given[1]
    if not pairs:
        raise ValueError(wrong)
    return [part[0] for part in given], [part[1] for part in given]


def _index(name, times):
    """Times as an index of pandas, whose kinds tell numbers, spans and dates apart."""
    pandas = library("pandas")
    if not len(times):
        raise ValueError(f"{name} is empty: expected a value at one time at least")
    times, unit = beside(times)
    unit = unit or behind(getattr(times, "name", None))
    if isinstance(times, (list, tuple)):
        times = [converted(f"{name}: time", *beside(time), "s") for time in times]
    if np.ma.is_masked(times):
        raise ValueError(f"{name}: some times are masked: leave such samples out")
    try:
        index = times.to_index() if hasattr(times, "to_index") else pandas.Index(times)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name}: {short(times)} are no times: {error}") from None
    if index.hasnans:
        raise ValueError(f"{name}: time {int(np.flatnonzero(index.isna())[0]) + 1} is missing (NaN or NaT): leave such samples out")
    if getattr(index.dtype, "kind", "O") not in ("i", "u", "f", *SPANS):
        raise ValueError(
            f"{name}: times are {short(list(index[:3]))}, neither seconds, nor spans of time, nor dates; `pandas.to_numeric`, "
            "`to_timedelta` or `to_datetime` make such of texts"
        )
    return index if index.dtype.kind in SPANS else pandas.Index(converted(f"{name}: time", index, unit, "s"))


def _fit(name, times, values):
    """Refuses other numbers of values than times."""
    if len(times) != len(values) or not len(values):
        raise ValueError(f"{name} has {len(times)} times and {len(values)} values: expected one value for each, at least one")
    for time, value in zip(times, values):
        if np.ma.is_masked(value) or isinstance(value, (float, np.floating)) and not np.isfinite(value):
            raise ValueError(f"{name} = {value} at {time} is no finite number: leave such samples out")
    return True


def _seconds(name, index, begin):
    """Times in seconds, ascending; dates count from `begin`."""
    spans = index - begin if index.dtype.kind == "M" else index
    times = np.asarray(spans.total_seconds() if spans.dtype.kind == "m" else spans, dtype=float)
    if not np.isfinite(times).all():
        raise ValueError(f"{name}: time {times[~np.isfinite(times)][0]} s is not finite")
    if (falls := np.flatnonzero(np.diff(times) < 0.0)).size:
        k = falls[0]
        raise ValueError(f"{name}: times must ascend, {times[k + 1]:g} s follows {times[k]:g} s")
    if (far := np.flatnonzero(np.abs(times) > LATEST)).size:
        raise ValueError(
            f"{name}: time {times[far[0]]:g} s is more than {LATEST:g} s: times are seconds of the run; of dates and nanoseconds "
            "`pandas.to_datetime` and `to_timedelta` make an index that is understood"
        )
    return times


def of_arrow(given):
    """The DataFrame of a table of polars, pyarrow, DuckDB or whatever else hands over a stream of Arrow (`__arrow_c_stream__`); units in
    the metadata of its columns are kept in `attrs`."""
    try:
        pyarrow = library("pyarrow")
    except ImportError as failure:
        raise ImportError(f"inputs of {type(given).__module__}: {failure}; or make a table of pandas of them") from failure
    library("pandas")
    try:
        made = pyarrow.table(given)
        frame = made.to_pandas()
    except (pyarrow.ArrowException, TypeError, ValueError) as failure:
        raise ValueError(f"{short(given)} is no table of inputs: {str(failure).splitlines()[0]}") from failure
    texts = {field.name: field.metadata or {} for field in made.schema}
    units = {name: (about.get(b"units") or about.get(b"unit") or b"").decode() for name, about in texts.items()}
    frame.attrs = {"units": units} | frame.attrs
    return frame
