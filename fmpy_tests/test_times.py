"""A recorded time is the number that a person writes, whatever the step, however long the run, whoever records it."""

import json
from decimal import Decimal, localcontext
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

import wheelrail
from wheelrail import scenario, train
from wheelrail.__main__ import main
from wheelrail.times import after, at

pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
ROOT = Path(__file__).parent.parent
COLD = {"initial.velocity": 20.0, "thermal.enabled": False}
STEPS = ["1e-4", "2e-4", "1e-3", "2.5e-3", "5e-3", "0.01", "0.1", "7e-6", "0.00123"]


def run_of(fmu, **more):
    """A short run."""
    return wheelrail.simulate(COLD, outputs="wheel.velocity", fmu=fmu, progress=False, **more)


@pytest.mark.parametrize("step", STEPS)
def test_times_of_steps_are_the_decimals_that_a_person_writes(step):
    time, mended, missed = 0.0, 0, 0
    for count in (*range(5000), 999_999, 10_000_000, 123_456_789):
        written = float(count * Decimal(step))
        assert at(count, float(step)) == written
        missed += count * float(step) != written
        if count < 5000:
            assert time == written
            time = after(time, float(step))
            mended += 1
    print(f"step {step} s: {mended} sums are decimals; {missed} products of floating point are not")


@pytest.mark.parametrize("below", [3, 7, 48_000, 44_100])
def test_times_of_steps_that_are_fractions_are_the_nearest_numbers_to_them(below):
    step, time = 1.0 / below, 0.0
    for count in range(2000):
        assert at(count, step) == count / below
        assert time == pytest.approx(count / below, rel=1e-15)
        time = after(time, step)
    assert at(below, step) == 1.0 and float(3 * Fraction(1, 3)) == 1.0


def test_steps_of_other_lengths_add_up_to_rounding():
    time, exact = 0.0, Fraction(0)
    for step in np.random.default_rng(1).uniform(1e-5, 1e-2, 2000):
        time, exact = after(time, step), exact + Fraction(float(step))
    assert time == pytest.approx(float(exact), rel=1e-13)
    assert after(np.float64(0.1), np.float32(0.5)) == 0.6 and after(-0.3, 0.1) == -0.2


def test_times_do_not_depend_on_the_decimals_of_the_thread():
    with localcontext(prec=5):
        assert after(12345.678, 1e-3) == 12345.679


def test_a_refused_step_leaves_time_and_record(start):
    wheel = start(COLD)
    recorder = wheel.record("wheel.velocity")
    for _ in range(9):
        wheel.step(1e-3)
    for h in (-1.0, float("nan")):
        with pytest.raises(wheelrail.Refused):
            wheel.step(h)
        assert wheel.time == 0.009
    wheel.step(1e-3)
    assert recorder.dataset().time.values.tolist() == [at(k, 1e-3) for k in range(11)]


def test_a_record_has_the_times_that_are_looked_up(fmu):
    run = run_of(fmu, stop=0.2)
    missed = [k for k in range(201) if k * 1e-3 != float(f"{k}e-3")]
    print(f"{len(missed)} of 201 products are not the decimals")
    assert list(run.time.values) == [float(f"{k}e-3") for k in range(201)] and len(missed) > 20
    assert float(run["wheel.velocity"].sel(time=0.009)) > 0.0


@pytest.mark.parametrize("steps", [(1e-3, 5e-3), (1e-3, 2.5e-3), (2e-4, 1e-3)])
def test_records_of_two_steps_meet_at_all_common_times(fmu, steps):
    fine, coarse = (run_of(fmu, stop=0.12, step=step) for step in steps)
    common = (fine["wheel.velocity"] - coarse["wheel.velocity"]).time
    expected = sorted({Decimal(k) * Decimal(repr(steps[0])) for k in range(1000)} & {Decimal(k) * Decimal(repr(steps[1])) for k in range(1000)})
    expected = [float(time) for time in expected if time <= Decimal("0.12")]
    print(f"steps {steps}: {len(common)} common times")
    assert list(common.values) == expected


def test_jumps_within_steps_do_not_move_the_labels(fmu):
    force = [(0.0, 0.0), (0.0023, 0.0), (0.0023, 1e3), (0.0201, 1e3), (0.0201, 0.0)]
    run = wheelrail.simulate(COLD, {"drive.force": force}, stop=0.03, outputs="wheel.velocity", fmu=fmu, progress=False)
    assert list(run.time.values) == [float(f"{k}e-3") for k in range(31)]


def test_a_loop_of_ones_own_has_the_times_of_a_run_and_the_fmu_says_the_same(start):
    wheel = start({"initial.velocity": 20.0})
    record = wheel.record("wheel.velocity")
    for _ in range(50):
        wheel.step(1e-3)
    saved = wheel.save()
    wheel.step(5e-3)
    wheel.restore(saved)
    wheel.forget(saved)
    wheel.set({"rail.temperature": 20.0})
    for _ in range(10):
        wheel.step(1e-3)
    run = record.dataset()
    assert list(run.time.values) == [float(f"{k}e-3") for k in range(61)]
    (warning,) = [w for w in json.loads(run.attrs["warnings"]) if "rail.temperature" in w["text"]]
    assert warning["time"] == 0.05 and "t = 0.05 s" in warning["text"]


def test_warnings_of_the_fmu_name_the_times_of_the_record(start):
    """The FMU adds start and step of every call itself: .009 s and .001 s are less than .01 s."""
    wheel = start({"initial.velocity": 20.0})
    record = wheel.record("wheel.velocity")
    for _ in range(10):
        wheel.step(1e-3)
    wheel.set({"rail.temperature": 20.0})
    wheel.step(1e-3)
    (told,) = json.loads(record.dataset().attrs["warnings"])
    assert told["time"] == 0.01 and told["text"].startswith("t = 0.01 s: ") and 0.009 + 0.001 != 0.01


def test_a_stop_of_a_train_has_such_times():
    loaded = scenario.load(ROOT / "examples" / "train" / "low_adhesion.json", {"speed": 5.0, "step": 0.01, "hold": 0.5})
    stop = train.Stop(loaded)
    table = stop.run()
    stop.close()
    assert list(table[:, 0]) == [float(f"{k}e-2") for k in range(1, len(table) + 1)] and len(table) > 100


@pytest.mark.parametrize("step", ["0.001", "0.0025", "0.0001", "0.3333333333333333"])
def test_the_command_line_writes_such_times(step, packed, capsys):
    stop, whole = (0.05, False) if float(step) < 0.1 else (1.0, True)
    main(["simulate", "--step", step, "--stop", str(stop), "--outputs", "wheel.velocity", "--set", "thermal.enabled=false", "--fmu", str(packed)])
    cells = [line.split(",")[0] for line in capsys.readouterr().out.splitlines()][1:]
    assert cells == [str(k / 3) if whole else str(at(k, float(step))) for k in range(len(cells))] and len(cells) == round(stop / float(step)) + 1
    assert max(map(len, cells[:-1])) <= (20 if whole else 7)


@pytest.mark.parametrize("ending", ["nc", "parquet"])
def test_a_record_over_spans_of_time_or_dates_comes_back_as_it_was(fmu, tmp_path, ending):
    run = run_of(fmu, stop=5e-3)
    spans = pandas.to_timedelta(run.time.values, unit="s")
    for times in (spans, pandas.Timestamp("2026-03-01 12:00") + spans, run.time.values):
        kept = run.assign_coords(time=("time", times, run.time.attrs if times is run.time.values else {}))
        back = wheelrail.load(wheelrail.save(kept, tmp_path / f"run.{ending}"))
        assert back.time.dtype.kind == kept.time.dtype.kind
        np.testing.assert_array_equal(back.time.values, kept.time.values)
        np.testing.assert_array_equal(back["wheel.velocity"].values, run["wheel.velocity"].values)
