"""Inputs over time: any form in which a person or pandas gives times means them or is refused; jumps act at their time for every
step, and what varies within a step acts with its mean."""

import datetime
import os
import subprocess
import sys
import warnings
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import wheelrail
from wheelrail.courses import Function, Samples, courses_of, parts, straight
from wheelrail.samples import samples_of

pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
ROOT = Path(__file__).parent.parent
TIMES, VALUES = [0.0, 0.5, 1.0], [1.0, 2.0, 3.0]
NOON = pandas.Timestamp("2026-03-01 12:00")
DATES = [NOON + pandas.Timedelta(seconds=time) for time in TIMES]
STEPS = (0.5e-3, 1e-3, 2e-3, 10e-3, 100e-3)


def series(index, values=VALUES):
    """A Series of the values over an index."""
    return pandas.Series(values, index)


MEANT = {
    "dict": dict(zip(TIMES, VALUES)),
    "pair of lists": (TIMES, VALUES),
    "pair of arrays": (np.array(TIMES), np.array(VALUES)),
    "list of pairs": list(zip(TIMES, VALUES)),
    "list of lists": [list(pair) for pair in zip(TIMES, VALUES)],
    "tuple of pairs": tuple(zip(TIMES, VALUES)),
    "zip": zip(TIMES, VALUES),
    "array of two rows": np.array([TIMES, VALUES]),
    "array of two columns": np.array([TIMES, VALUES]).T,
    "floats": series(TIMES),
    "float32": series(np.float32(TIMES)),
    "named": series(pandas.Index(TIMES, name="time [s]")),
    "milliseconds by name": series(pandas.Index([0, 500, 1000], name="time [ms]")),
    "milliseconds by attribute": xarray.DataArray(VALUES, [("time", [0, 500, 1000], {"units": "ms"})]),
    "minutes by name": series(pandas.Index([0, 0.5 / 60, 1 / 60], name="time (min)")),
    "nullable": series(pandas.Index(pandas.array(TIMES, dtype="Float64"))),
    "spans": series(pandas.to_timedelta(TIMES, unit="s")),
    "spans in ms": (np.array([0, 500, 1000], "m8[ms]"), VALUES),
    "Python's spans": {datetime.timedelta(seconds=time): value for time, value in zip(TIMES, VALUES)},
    "dates": series(DATES),
    "dates in a zone": series(pandas.DatetimeIndex(DATES, tz="Europe/Berlin")),
    "numpy's dates": (np.array(DATES, "M8[ns]"), VALUES),
    "Python's dates": {time.to_pydatetime(): value for time, value in zip(DATES, VALUES)},
    "one column": pandas.DataFrame({"load": VALUES}, index=TIMES),
    "over a coordinate": xarray.DataArray(VALUES, [("time", TIMES, {"units": "s"})]),
}


@pytest.mark.parametrize("name", MEANT)
def test_times_in_this_form_are_seconds_of_the_run(name):
    times, values, _ = samples_of({"drive.load": MEANT[name]})["drive.load"]
    print(name, list(times), list(values))
    assert list(times) == TIMES and list(values) == VALUES


def test_whole_numbers_are_seconds_too():
    for index in ([0, 1, 2], pandas.RangeIndex(3), np.arange(3, dtype="u1"), pandas.Index([0, 1, 2], dtype="Int64")):
        assert list(samples_of({"a": series(index)})["a"][0]) == [0.0, 1.0, 2.0]
    assert list(samples_of({"a": series([-1.0, 0.0, 2.0])})["a"][0]) == [-1.0, 0.0, 2.0]


def test_dates_of_all_inputs_count_from_the_earliest_one():
    later = series(DATES[1:], VALUES[1:])
    found = samples_of({"drive.load": series(DATES), "brake.torque": later})
    assert list(found["brake.torque"][0]) == [0.5, 1.0] and list(found["drive.load"][0]) == TIMES


REFUSED = {
    "texts": (series(["0.0", "0.5", "1.0"]), "to_numeric"),
    "texts with units": (series(["0 s", "0.5 s", "1 s"]), "to_timedelta"),
    "two levels": (series(pandas.MultiIndex.from_product([[0], TIMES])), "neither seconds"),
    "periods": (series(pandas.period_range("2026-01-01", periods=3, freq="500ms")), "to_datetime"),
    "fractions": (series(pandas.Index([0, Fraction(1, 2), Decimal("1.0")], dtype=object)), "to_numeric"),
    "tuples": (series(pandas.Index([(0, 1), (1, 2), (2, 3)], tupleize_cols=False)), "neither seconds"),
    "flags": (series([False, True], [1.0, 2.0]), "neither seconds"),
    "categories": (series(pandas.CategoricalIndex(TIMES)), "neither seconds"),
    "intervals": (series(pandas.interval_range(0, 3)), "neither seconds"),
    "times of the day": ({datetime.time(0, 0, k): k for k in range(3)}, "neither seconds"),
    "days": ({datetime.date(2026, 1, 1 + k): k for k in range(3)}, "neither seconds"),
    "complex": (([0j, 1j, 2j], VALUES), "neither seconds"),
    "a missing time": (series([0.0, np.nan, 1.0]), "time 2 is missing"),
    "a missing date": (series(pandas.to_datetime(["2026-01-01", None, "2026-01-02"])), "time 2 is missing"),
    "a masked time": ((np.ma.array(TIMES, mask=[0, 1, 0]), VALUES), "masked"),
    "a masked value": ((TIMES, np.ma.array(VALUES, mask=[0, 1, 0])), "no finite number"),
    "a missing value": (series(TIMES, [1.0, np.nan, 3.0]), "nan at 0.5 is no finite number"),
    "an endless time": (([0.0, np.inf], [1.0, 2.0]), "inf s is not finite"),
    "unsorted": (series([0.0, 2.0, 1.0]), "1 s follows 2 s"),
    "nanoseconds": (series(np.array(DATES, "M8[ns]").astype("i8")), "seconds of the run"),
    "seconds since 1970": (series([1.7e9, 1.7e9 + 1, 1.7e9 + 2]), "seconds of the run"),
    "metres by name": (series(pandas.Index([0, 500, 1000], name="place [m]")), "time is in 'm': expected s"),
    "metres by attribute": (xarray.DataArray(VALUES, [("place", TIMES, {"units": "m"})]), "time is in 'm': expected s"),
    "a date by attribute": (xarray.DataArray(VALUES, [("time", TIMES, {"units": "seconds since 2026-01-01"})]), "is no unit"),
    "no coordinate": (xarray.DataArray(VALUES, dims="time"), "coordinate"),
    "two columns": (pandas.DataFrame({"a": VALUES, "b": VALUES}, index=TIMES), "2 columns"),
    "two by two lists": ([[0, 1], [5, 6]], "can mean"),
    "two by two array": (np.array([[0, 1], [5, 6]]), "can mean"),
    "two by two tuples": (((0, 1), (5, 6)), "can mean"),
    "too few values": ((TIMES, VALUES[:2]), "3 times and 2 values"),
    "nothing": (([], []), "empty"),
    "no Series": (pandas.Series([], dtype=float), "empty"),
    "no dict": ({}, "empty"),
    "numbers": (VALUES, "no value"),
    "a set": ({1.0, 2.0}, "no order"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_times_that_could_mean_something_else_are_refused(name):
    given, words = REFUSED[name]
    with pytest.raises(ValueError) as refused:
        samples_of({"drive.load": given})
    print(name, refused.value)
    assert words in str(refused.value) and str(refused.value).startswith("drive.load")


def test_dates_with_and_without_a_zone_are_refused_together():
    mixed = {"a": series(DATES), "b": series(pandas.DatetimeIndex(DATES, tz="UTC"))}
    with pytest.raises(ValueError, match="some dates have a time zone"):
        samples_of(mixed)


def impulses(course, stop, step):
    """Begin, end and both values of every part of the steps of a run, as a run takes them."""
    for k in range(int(np.ceil(stop / step - 1e-6))):
        begin = k * step
        for end in parts([course], begin, begin + step):
            yield begin, end, *course.line(begin, end)
            begin = end


@pytest.mark.parametrize("step", STEPS)
def test_a_jump_at_any_whole_millisecond_acts_at_its_time(fmu, step):
    force, worst = fmu.variable("drive.force"), 0.0
    for k in range(1, 201):
        for jump in (k / 1000, k * 1e-3):
            course = Samples(force, [0.0, jump, jump, 1.0], [0.0, 0.0, 5e4, 5e4])
            for begin, end, first, last in impulses(course, 0.3, step):
                assert first == last == (5e4 if begin > jump - 1e-9 else 0.0), (jump, begin)
                worst = max([worst, *(abs(time - jump) for time in (begin, end) if abs(time - jump) < 1e-7)])
    print(f"{1e3 * step} ms: jumps lie at ends of parts within {worst:.1e} s")
    assert worst < 1e-15


def area(course, stop, step):
    """Impulse of an input in a run."""
    return sum(0.5 * (end - begin) * (first + last) for begin, end, first, last in impulses(course, stop, step))


FINE = np.arange(0.0, 0.1, 1e-4)


@pytest.mark.parametrize("step", STEPS)
def test_no_impulse_is_lost_whatever_the_step(fmu, step):
    force = fmu.variable("drive.force")
    pulse = lambda time: 5e4 if 0.0201 <= time < 0.0208 else 0.0
    rng = np.random.default_rng(1)
    noise = rng.normal(size=len(FINE))
    for name, course, exact in [
        ("jumps", Samples(force, [0.0, 0.0201, 0.0201, 0.0208, 0.0208, 0.1], [0.0, 0.0, 5e4, 5e4, 0.0, 0.0]), 35.0),
        ("ramps", Samples(force, [0.0, 0.0201, 0.0202, 0.0207, 0.0208, 0.1], [0.0, 0.0, 5e4, 5e4, 0.0, 0.0]), 30.0),
        ("samples", Samples(force, FINE, list(noise)), np.trapezoid(noise, FINE) + noise[-1] * 1e-4),
        ("function", Function(force, pulse), 35.0),
        ("sine", Function(force, lambda time: np.sin(300.0 * time)), (1.0 - np.cos(30.0)) / 300.0),
    ]:
        found = area(course, 0.1, step)
        print(f"{name}, {1e3 * step} ms: {found:.6g}, exact {exact:.6g}")
        assert found == pytest.approx(exact, rel=1e-4 if name in ("function", "sine") else 1e-9, abs=1e-6 if name == "sine" else 0.0)


def test_a_line_in_place_of_samples_has_their_mean_and_moment_and_stays_within_them():
    rng = np.random.default_rng(2)
    for _ in range(100):
        times, values = np.sort(rng.uniform(size=9)), rng.uniform(size=9)
        first, last = straight(list(zip(times, values)))
        fine = np.linspace(times[0], times[-1], 20001)
        course, line = np.interp(fine, times, values), np.interp(fine, times[[0, -1]], [first, last])
        assert np.trapezoid(line - course, fine) == pytest.approx(0.0, abs=1e-4)
        assert values.min() - 1e-12 <= min(first, last) <= max(first, last) <= values.max() + 1e-12
        if values.min() + 1e-9 < min(first, last) and max(first, last) < values.max() - 1e-9:
            assert np.trapezoid((line - course) * fine, fine) == pytest.approx(0.0, abs=1e-4)


def test_a_pulse_within_a_step_changes_the_speed_as_in_short_steps(fmu):
    parameters = {"initial.velocity": 20.0, "thermal.enabled": False}
    edges = [(0.0, 0.0), (0.0201, 0.0), (0.0201, 5e4), (0.0208, 5e4), (0.0208, 0.0)]
    times = np.round(np.arange(0.0, 0.03, 5e-5), 6)
    sampled = np.interp(times, [0.0201 - 2.5e-5, 0.0201 + 2.5e-5, 0.0208 - 2.5e-5, 0.0208 + 2.5e-5], [0.0, 5e4, 5e4, 0.0])

    def change(force, step):
        run = wheelrail.simulate(parameters, {"drive.force": force}, stop=0.03, step=step, outputs="wheel.velocity", fmu=fmu, progress=False)
        return float(run["wheel.velocity"][-1]) - 20.0

    exact = change(edges, 1e-4)
    forms = {"jumps": edges, "samples": (times, sampled), "function": lambda time: 5e4 if 0.0201 <= time < 0.0208 else 0.0}
    for name, force in forms.items():
        found = {step: change(force, step) for step in (1e-3, 2e-3, 1e-2)}
        print(name, {step: f"{value:.5e}" for step, value in found.items()}, f"exact {exact:.5e}")
        assert all(value == pytest.approx(exact, rel=0.01) for value in found.values())


def test_what_is_not_seen_is_said(fmu):
    elevation = courses_of(fmu, {"rail.elevation": (FINE, list(1e-4 * np.sin(2e3 * FINE)))})["rail.elevation"]
    (text,) = elevation.unseen("rail.elevation", 0.05, 1e-3)
    print(text)
    assert "of 1000 samples lie within communication steps of 0.001 s" in text
    assert not list(elevation.unseen("rail.elevation", 0.05, 1e-4))
    late = Samples(fmu.variable("drive.load"), [100.0, 101.0], [1e5, 1e5])
    assert "100 to 101 s lie outside of the run from 0 to 5 s" in next(iter(late.unseen("drive.load", 5.0, 1e-3)))


def test_a_table_of_inputs_is_a_scenario(fmu):
    table = pandas.DataFrame({"time": [0.0, 2e-3], "drive.load": [1e5, 1.1e5], "brake.torque": [0.0, 1e3]})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = wheelrail.simulate({"initial.velocity": 20.0}, table, outputs="wheel.velocity", fmu=fmu, progress=False)
    assert float(run["drive.load"][-1]) == 1.1e5 and float(run["brake.torque"][1]) == 500.0


class Stream:
    """A table of whoever speaks Arrow and is not pandas, such as polars and DuckDB: all that is known of it is its stream."""

    def __init__(self, table):
        self.table = table

    def __arrow_c_stream__(self, requested_schema=None):
        return self.table.__arrow_c_stream__(requested_schema)


def braked(fmu, inputs):
    """Brake torque of a run of 2 ms."""
    parameters = {"initial.velocity": 20.0, "thermal.enabled": False}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run = wheelrail.simulate(parameters, inputs, outputs="wheel.velocity", fmu=fmu, progress=False)
    return run.time.values.tolist(), run["brake.torque"].values.tolist()


TORQUES = ([0.0, 1e-3, 2e-3], [0.0, 1000.0, 2000.0])


@pytest.mark.parametrize("name", ["time", "Time", "TIME", "t", "t [s]", "Time (ms)", "t/ms"])
def test_a_column_of_times_is_found_by_its_name(fmu, name):
    times = [1e3 * time for time in TORQUES[0]] if "ms" in name else TORQUES[0]
    table = pandas.DataFrame({"brake.torque": TORQUES[1], name: times})
    assert braked(fmu, table) == braked(fmu, table.set_index(name)) == TORQUES


def test_a_key_of_times_says_how_to_write_inputs(fmu):
    for name in ("time", "Time", "t"):
        with pytest.raises(wheelrail.Refused, match=f"{name} is no input: write \\(times, values\\) for each input, or give a table"):
            wheelrail.simulate(inputs={name: TORQUES[0], "brake.torque": TORQUES}, fmu=fmu)


def test_tables_of_arrow_are_inputs(fmu):
    pyarrow = pytest.importorskip("pyarrow")
    columns = {"t": TORQUES[0], "brake.torque [kN m]": [1e-3 * torque for torque in TORQUES[1]]}
    table = pyarrow.table(columns)
    spans = pyarrow.table({"time": pyarrow.array([0, 1, 2], pyarrow.duration("ms")), "brake.torque": TORQUES[1]})
    marks = [pyarrow.field("time", pyarrow.float64(), metadata={"unit": "s"}), pyarrow.field("brake.torque", pyarrow.float64(), metadata={"units": "kN.m"})]
    marked = pyarrow.table(list(columns.values()), schema=pyarrow.schema(marks))
    for given in (table, table.to_batches()[0], table.to_reader(), Stream(table), Stream(spans), Stream(marked)):
        assert braked(fmu, given) == TORQUES, given
    assert braked(fmu, {"brake.torque": (pyarrow.array(TORQUES[0]), pyarrow.chunked_array([TORQUES[1]]))}) == TORQUES
    texts = Stream(pyarrow.table({"time": TORQUES[0], "control.rotation": ["moment", "velocity", "velocity"]}))
    run = wheelrail.simulate(inputs=texts, outputs="wheel.velocity", fmu=fmu)
    assert run["control.rotation"].values.tolist() == ["moment", "moment", "velocity"]


def test_tables_of_arrow_that_are_no_inputs_are_refused_in_words(fmu):
    pyarrow = pytest.importorskip("pyarrow")
    gap = Stream(pyarrow.table({"time": [0.0, 1e-3], "brake.torque": [0.0, None]}))
    with pytest.raises(ValueError, match="brake.torque = nan at 0.001 is no finite number"):
        wheelrail.simulate(inputs=gap, fmu=fmu)
    with pytest.raises(wheelrail.Refused, match="did you mean brake.torque"):
        wheelrail.simulate(inputs=Stream(pyarrow.table({"time": [0.0, 1e-3], "brake.torqe": [0.0, 1.0]})), fmu=fmu)
    with pytest.raises(ValueError, match="is no table of inputs"):
        wheelrail.simulate(inputs=Stream(pyarrow.chunked_array([[0.0, 1.0]])), fmu=fmu)


WITHOUT = """
import sys
sys.modules.update(dict.fromkeys(sys.argv[1].split(",")))  # as if they were not installed
import wheelrail
class Table:
    def __arrow_c_stream__(self, schema=None): raise AssertionError
given = Table() if "pyarrow" in sys.argv[1] else {"brake.torque": ([0.0, 1e-3], [0.0, 1.0])}
try:
    wheelrail.simulate({"initial.velocity": 20.0}, given)
except ImportError as refused:
    print(refused)
"""


@pytest.mark.parametrize("missing, extra", [("pandas", "records"), ("pandas,xarray", "records"), ("xarray", "records"), ("pyarrow", "parquet")])
def test_what_is_not_installed_is_said_with_how_to_install_it(packed, missing, extra):
    environment = os.environ | {"WHEELRAIL_FMU": str(packed)}
    done = subprocess.run([sys.executable, "-c", WITHOUT, missing], env=environment, capture_output=True, text=True, check=True)
    print(done.stdout)
    assert f"{missing.split(',')[0]}, which is not installed: pip install wheelrail[{extra}]" in done.stdout
