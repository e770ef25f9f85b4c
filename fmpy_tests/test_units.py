"""A unit beside a value is used or refused by its name, by every reader: start values, inputs, tables, records, pages, files."""

import csv
import math
import warnings
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pint
import pytest

import wheelrail
from wheelrail import Refused, analysis, page, report, scenario
from wheelrail.courses import courses_of
from wheelrail.page import charts, sources
from wheelrail.page.run import of_dataset
from wheelrail.tables import BadFile
from wheelrail.units import UnitError, converted, headed, in_si, unit_of

pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
TRAIN = Path(__file__).parent.parent / "examples" / "train"
COLD = {"initial.velocity": 20.0, "thermal.enabled": False}


@pytest.mark.parametrize("version", ["fmu", "fmu3"])
def test_units_of_the_description_are_read_as_it_defines_them(version, request):
    description, found = request.getfixturevalue(version).description, 0
    for unit in description.unitDefinitions:
        known = unit_of(unit.name)
        assert (known.name(), known.factor, known.offset) == (unit.name, 1, 0)
        assert dict(known.bases) == {base: power for base in ("kg", "m", "s", "rad", "K", "A", "mol", "cd") if (power := getattr(unit.baseUnit, base))}
        for display in unit.displayUnits:
            shown = unit_of(display.name)
            found += 1
            # The description has the way from SI units, display = factor · value + offset.
            assert float(shown.factor) * display.factor == pytest.approx(1.0, rel=1e-15) and shown.name() == unit.name
            assert float(shown.offset) == pytest.approx(-display.offset * float(shown.factor), rel=1e-15)
    print(f"{len(description.unitDefinitions)} units, {found} display units")
    assert found > 20


@pytest.mark.parametrize("text, value, si", [
    ("km/h", 1 / 3.6, "m/s"), ("kN m", 1e3, "N.m"), ("kN·m", 1e3, "N.m"), ("kN*m", 1e3, "N.m"), ("kNm", 1e3, "N.m"), ("kgf.m", 9.80665, "N.m"),
    ("m s-1", 1.0, "m/s"), ("m s**-2", 1.0, "m/s2"), ("m/s²", 1.0, "m/s2"), ("kilometer / hour", 1 / 3.6, "m/s"), ("W / (m2 K)", 1.0, "W/(m2.K)"),
    ("°C", 274.15, "K"), ("degrees_Celsius", 274.15, "K"), ("K/s", 1.0, "K/s"), ("min", 60.0, "s"), ("milliseconds", 1e-3, "s"), ("µm", 1e-6, "m"),
    ("rpm", math.pi / 30, "rad/s"), ("deg", math.pi / 180, "rad"), ("%", 0.01, "1"), ("bar", 1e5, "Pa"), ("daN", 10.0, "N"), ("t", 1e3, "kg"),
    ("kWh", 3.6e6, "J"), ("l", 1e-3, "m3"), ("N s/m", 1.0, "N.s/m"), ("", 1.0, "1"),
])  # fmt: skip
def test_units_as_people_write_them(text, value, si):
    known = unit_of(text)
    assert known.to_si(1.0) == pytest.approx(value, rel=1e-15) and known.name() == si


def test_units_that_pint_knows_are_read_and_others_are_refused():
    assert unit_of("mph").to_si(1.0) == pytest.approx(0.44704, rel=1e-12) and unit_of("mph").name() == "m/s"
    assert unit_of("degF").to_si(212.0) == pytest.approx(373.15, rel=1e-12)
    for text in ("blinks", "dB", "km/", "(m", "km//", "m)"):
        with pytest.raises(UnitError, match="is no unit that is known here"):
            print(text, unit_of(text))


def test_a_decimal_in_another_unit_is_the_decimal_in_si_units():
    wrong = [k for k in range(100_000) if unit_of("ms").to_si(float(k)) != float(f"{k}e-3")]
    assert not wrong and unit_of("km/h").to_si(72) == 20.0 and unit_of("kN").to_si(8.1) == 8100.0


def test_names_may_have_their_unit_behind_them():
    for text in ("v [km/h]", "v (km/h)", "v/km/h", "v / km/h", "v in km/h", "v, km/h", " v[km/h] "):
        assert headed(text) == ("v", "km/h")
    assert headed("profile.x[3] [mm]") == ("profile.x[3]", "mm") and headed("profile.x[3]") == ("profile.x[3]", None)
    assert headed("Speed of the wheel / km/h") == ("Speed of the wheel", "km/h") and headed("two words") == ("two words", None)


TIMES, SPEEDS = [0.0, 0.5, 1.0], [72.0, 36.0, 18.0]  # s, km/h
Q = pint.Quantity


class Astropy(np.ndarray):
    """What astropy gives: an array with `unit` and `value`."""

    def __new__(cls, values, unit):
        made = np.asarray(values).view(cls)
        made.unit = SimpleNamespace()
        made.unit = type("Unit", (), {"__str__": lambda self: unit})()
        return made

    @property
    def value(self):
        return self.view(np.ndarray)


def array(unit, times=TIMES, of="s"):
    """A DataArray of the speeds."""
    return xarray.DataArray(SPEEDS, [("time", times, {"units": of})], attrs={"units": unit})


def noted(series, **attrs):
    """A Series with attributes."""
    series.attrs.update(attrs)
    return series


USED = {
    "attribute": {"drive.velocity": array("km/h")},
    "attribute of the times": {"drive.velocity": array("km/h", [0, 500, 1000], "ms")},
    "times of an array": {"drive.velocity [km/h]": (array("1", [0, 500, 1000], "ms").time, SPEEDS)},
    "name": {"drive.velocity [km/h]": (TIMES, SPEEDS)},
    "name with a stroke": {"drive.velocity/km/h": dict(zip(TIMES, SPEEDS))},
    "name and attribute": {"drive.velocity [km/h]": array("km/h")},
    "Series with an attribute": {"drive.velocity": noted(pandas.Series(SPEEDS, TIMES), units="km/h")},
    "Series as a run's table notes it": {"drive.velocity": noted(pandas.Series(SPEEDS, TIMES, name="v"), variables={"v": {"units": "km/h"}})},
    "Series by its name": {"drive.velocity": pandas.Series(SPEEDS, pandas.Index([0, 500, 1000], name="time [ms]"), name="v [km/h]")},
    "Series by a name with a stroke": {"drive.velocity": pandas.Series(SPEEDS, pandas.Index([0, 500, 1000], name="t/ms"), name="Wheel speed/km/h")},
    "pair with an array": {"drive.velocity": (TIMES, array("km/h"))},
    "pint": {"drive.velocity": (Q([0, 500, 1000], "ms"), Q(SPEEDS, "km/h"))},
    "pint, one by one": {"drive.velocity": [(Q(1e3 * time, "ms"), Q(speed, "km/h")) for time, speed in zip(TIMES, SPEEDS)]},
    "pint in an array": {"drive.velocity": xarray.DataArray(Q(SPEEDS, "km/h"), [("time", TIMES)])},
    "pint, mixed": {"drive.velocity": {0.0: Q(72, "km/h"), 0.5: Q(10, "m/s"), 1.0: Q(500, "cm/s")}},
    "astropy": {"drive.velocity": (Astropy(TIMES, "s"), Astropy(SPEEDS, "km / h"))},
}


@pytest.mark.parametrize("name", USED)
def test_a_unit_beside_an_input_is_used(fmu, name):
    course = courses_of(fmu, USED[name])["drive.velocity"]
    assert course.times == TIMES and [course.at(time) for time in TIMES] == [20.0, 10.0, 5.0]


NAMES = ("left/right", "Y/Q", "L/V", "Q/P", "wheel/rail", "v / v0", "front (mean)", "speed (raw)", "in front", "v in front", "v, axle 2", "m")


@pytest.mark.parametrize("name", NAMES)
def test_a_name_that_holds_no_unit_is_a_name(fmu, name):
    series, plain = pandas.Series(SPEEDS, pandas.Index(TIMES, name=name), name=name), {"drive.velocity": (TIMES, SPEEDS)}
    frame = pandas.DataFrame({name: SPEEDS}, TIMES)
    with_unit = noted(series.copy(), units="km/h")
    for given, of in ((series, 1.0), (frame[name], 1.0), (frame, 1.0), (series.to_xarray().rename({name: "time"}), 1.0), (with_unit, 1 / 3.6)):
        course, expected = (courses_of(fmu, inputs)["drive.velocity"] for inputs in ({"drive.velocity": given}, plain))
        assert course.times == expected.times and course.values == pytest.approx([of * value for value in expected.values], rel=1e-15)


def test_a_column_of_times_may_say_what_it_is(fmu):
    for heading, of in (("time (local)", 1.0), ("t / ms", 1e3), ("Time [ms]", 1e3)):
        table = pandas.DataFrame({heading: [of * time for time in (0.0, 1e-3, 2e-3)], "drive.load": [8e4, 8e4, 9e4]})
        run = wheelrail.simulate(COLD, table, outputs="contact.force_y", fmu=fmu, progress=False)
        assert run.time.values.tolist() == [0.0, 1e-3, 2e-3]


def test_functions_and_single_values_have_units_too(fmu):
    for given in (Q(72, "km/h"), array("km/h")[0], Astropy(72.0, "km / h"), lambda time: Q(72, "km/h")):
        assert courses_of(fmu, {"drive.velocity": given})["drive.velocity"].at(0.3) == 20.0
    for given in (72, lambda time: 72):
        assert courses_of(fmu, {"drive.velocity [km/h]": given})["drive.velocity"].at(0.3) == 20.0


REFUSED = {
    "another quantity": ({"drive.velocity": array("N")}, "drive.velocity is in 'N': expected m/s, or km/h"),
    "an unknown unit": ({"drive.velocity": array("furlong/blink")}, "drive.velocity: 'furlong/blink' is no unit"),
    "two marks": ({"drive.velocity [km/h]": array("m/s")}, "'km/h' by one mark and in 'm/s' by another"),
    "one input twice": ({"drive.velocity [km/h]": 72, "drive.velocity": 20.0}, "drive.velocity is given twice"),
    "turns or radians": ({"drive.omega": Q(5, "Hz")}, "drive.omega is in 'Hz': expected rad/s, or rpm"),
    "a choice": ({"control.rotation [s]": 1}, "control.rotation is in 's': expected a number without a unit"),
    "brackets that hold none": ({"drive.velocity": pandas.Series(SPEEDS, TIMES, name="speed [left]")}, "drive.velocity: 'left' is no unit"),
    "another quantity by a stroke": ({"drive.velocity": pandas.Series(SPEEDS, TIMES, name="pull/kN")}, "drive.velocity is in 'kN': expected m/s"),
    "times in metres": ({"drive.velocity": array("km/h", TIMES, "m")}, "drive.velocity: time is in 'm': expected s"),
    "times in words": ({"drive.velocity": array("km/h", TIMES, "lunches")}, "drive.velocity: time: 'lunches' is no unit"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_unit_that_does_not_fit_is_refused_by_name(fmu, name):
    given, words = REFUSED[name]
    with pytest.raises((Refused, ValueError)) as refused:
        courses_of(fmu, given)
    print(refused.value)
    assert words in str(refused.value)


def test_a_wheel_takes_start_values_and_inputs_in_their_units(start):
    wheel = start({"initial.velocity [km/h]": 72, "vehicle.mass": Q(5, "t")}, {"drive.load": Q(80, "kN")})
    assert wheel.get("initial.velocity", "vehicle.mass", "drive.load") == [20.0, 5000.0, 80e3]
    wheel.set({"brake.torque/kN m": 0.5, "rail.temperature": Q(30.0, "degC"), "rail.friction": xarray.DataArray(25.0, attrs={"units": "%"})})
    wheel.set_rates({"brake.torque [kN m/s]": 1.0})
    wheel.step(1e-3)
    assert wheel.get("rail.temperature", "rail.friction") == [303.15, 0.25]
    # 500 N m, and 1 N m more after a step of 1 ms: the ramp in kN m is used.
    assert -wheel.get("brake.torque_actual") == pytest.approx(501.0, rel=1e-9)
    for values, words in (({"drive.load": Q(80, "degC")}, "drive.load is in '°C': expected N, or kN"), ({"drive.load [kgf.m]": 1}, "expected N")):
        with pytest.raises(Refused, match=words.replace(".", "\\.")):
            wheel.set(values)
    with pytest.raises(Refused, match="thermal.wheel_excess is a difference"):
        start({"thermal.wheel_excess [°C]": 5.0})


def test_changes_of_inputs_have_units_too(start):
    wheel = start(COLD)
    wheel.step(1e-3)
    gains = lambda changes: wheel.derivatives(["wheel.velocity", "contact.force_y"], changes)
    plain = gains({"drive.force": 1000.0, "drive.load": 10.0})
    print(plain)
    assert plain[0] > 0.0
    for changes in ({"drive.force [kN]": 1.0, "drive.load": Q(0.01, "kN")}, {"drive.force": Q(1000.0, "N"), "drive.load/N": 10}):
        assert gains(changes) == plain
    assert gains({"rail.temperature": Q(1.0, "K")}) == gains({"rail.temperature": 1.0})
    for changes, words in (
        ({"drive.force": Q(1.0, "m")}, "drive.force is in 'm': expected N, or kN"),
        ({"drive.force [foo]": 1.0}, "drive.force: 'foo' is no unit"),
        ({"rail.temperature [°C]": 1.0}, "rail.temperature is a difference"),
        ({"drive.force": "much"}, "drive.force = 'much' is not a number"),
    ):  # fmt: skip
        with pytest.raises(Refused, match=words):
            gains(changes)


def test_a_run_in_other_units_is_the_run(fmu):
    run = lambda inputs, **more: wheelrail.simulate(
        COLD, inputs, outputs=["wheel.velocity", "hub.moment"], fmu=fmu, progress=False, **more
    )  # fmt: skip
    plain = run({"brake.torque": ([0.0, 2e-3], [0.0, 3000.0])})
    table = pandas.DataFrame({"t/ms": [0, 2], "brake.torque/kN m": [0.0, 3.0]})
    for inputs, more in ((table, {}), ({"brake.torque [kN m]": ([0.0, 2e-3], [0.0, 3.0])}, {"step": Q(1, "ms"), "stop": Q(2, "ms")})):
        assert run(inputs, **more).identical(plain)
    by_attribute = pandas.DataFrame({"time": [0.0, 2e-3], "brake.torque": [0.0, 3.0]})
    by_attribute.attrs["units"] = {"brake.torque": "kN m"}
    assert run(by_attribute).identical(plain)
    with pytest.raises(ValueError, match="stop is in 'm'"):
        run(table, stop=Q(1, "m"))


@pytest.fixture(scope="module")
def braked(fmu):
    """A short run of a wheel that brakes on a rail that warms up."""
    inputs = {"brake.torque": ([0.0, 8e-3], [0.0, 9000.0]), "rail.temperature": ([0.0, 8e-3], [293.15, 303.15])}
    return wheelrail.simulate({"initial.velocity": 20.0}, inputs, profiles=True, depth=True, fmu=fmu, progress=False)


def in_other_units(run):
    """A record with other units: °C, km/h, kN, mm, and times in ms."""
    other = wheelrail.celsius(run).assign_coords(time=("time", 1e3 * run.time.values, {"units": "ms"}))
    of = {"m/s": ("km/h", 3.6), "N": ("kN", 1e-3), "m": ("mm", 1e3)}
    new = lambda v: (v * of[v.attrs["units"]][1]).assign_attrs(v.attrs, units=of[v.attrs["units"]][0])
    return other.assign({name: new(v) for name, v in other.data_vars.items() if v.attrs.get("units") in of})


def test_a_record_in_celsius_is_an_input_in_celsius(fmu, braked):
    warm = wheelrail.celsius(braked)
    for inputs in (warm[["rail.temperature"]], {"rail.temperature": warm["rail.temperature"]}, wheelrail.table(warm)[["rail.temperature"]]):
        again = wheelrail.simulate({"initial.velocity": 20.0}, inputs, outputs="wheel.velocity", fmu=fmu, progress=False)
        np.testing.assert_allclose(again["rail.temperature"], braked["rail.temperature"], rtol=1e-15)


def test_the_page_of_a_record_is_the_same_in_all_units(braked, tmp_path):
    of = lambda run: [[(c["title"], c["unit"], [(t["name"], np.array(t["y"], float)) for t in c["traces"]]) for c in group] for group in charts.of_run(run)]
    wheelrail.save(in_other_units(braked), tmp_path / "other.nc")
    for other in (of_dataset(in_other_units(braked)), sources.read(tmp_path / "other.nc")):
        for mine, theirs in zip(sum(of(of_dataset(braked)), []), sum(of(other), []), strict=True):
            assert mine[:2] == theirs[:2]
            for (name, a), (same, b) in zip(mine[2], theirs[2], strict=True):
                assert name == same
                np.testing.assert_allclose(a, b, rtol=2e-5, atol=1e-6 * np.nanmax(np.abs(a), initial=0.0))
    hottest = of_dataset(wheelrail.celsius(braked)).get("temperature.wheel_max")
    np.testing.assert_allclose(hottest, braked["temperature.wheel_max"], rtol=1e-14)


def test_damage_and_patches_of_a_record_are_the_same_in_all_units(fmu, braked):
    mine, theirs = (wheelrail.damage.report(run) for run in (braked, in_other_units(braked)))
    print(f"hottest {mine.hottest:.2f} K and {theirs.hottest:.2f} K")
    assert theirs.hottest == pytest.approx(mine.hottest, rel=1e-12) and theirs.rail_peak == pytest.approx(mine.rail_peak, rel=1e-12)
    run = wheelrail.simulate(
        {"preset": "railway_ellipse", "contact.lines": 3, "initial.velocity": 20.0}, stop=1e-3, outputs=["contact.width", "line.*"], patch=True,
        fmu=fmu, progress=False,
    )  # fmt: skip
    patch, other = wheelrail.patch(run), wheelrail.patch(in_other_units(run).assign_coords(x=run["x"]))
    for name in ("pressure", "temperature_wheel"):
        np.testing.assert_allclose(other[name], patch[name], rtol=1e-9)


def test_a_record_with_a_unit_that_does_not_fit_has_no_page(braked):
    for unit, words in (("blinks", "is no unit that is known here"), ("furlong", "wheel.velocity is in 'm': expected m/s"), ("N", "wheel.velocity is in 'N': expected m/s")):
        with pytest.raises(BadFile, match=words):
            of_dataset(braked.assign({"wheel.velocity": braked["wheel.velocity"].assign_attrs(units=unit)}))
    own = braked.assign(hardness=("time", np.ones(len(braked.time)), {"units": "HV"}))
    assert of_dataset(own).series["hardness"].unit == "HV"


def written(path, header, rows):
    """A CSV file."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([header, *rows])
    return path


def test_columns_of_files_of_results_may_be_in_any_unit(tmp_path, packed):
    file = written(tmp_path / "run.csv", ["time [ms]", "wheel.velocity [km/h]", "contact.force_y [kN]"], [[k, 72.0, 100.0 + k] for k in range(3)])
    read = sources.read(file, packed)
    assert list(read.time) == [0.0, 1e-3, 2e-3] and list(read.get("wheel.velocity")) == [20.0] * 3 and read.get("contact.force_y")[2] == 102e3
    over, force = analysis.read_columns(file, ("time", "contact.force_y"))
    assert list(over) == [0.0, 1e-3, 2e-3] and list(force) == [100e3, 101e3, 102e3]
    wrong = written(tmp_path / "wrong.csv", ["time", "wheel.velocity [kN]"], [[0, 1], [1, 1]])
    for reader in (lambda: sources.read(wrong, packed), lambda: analysis.read_columns(wrong, ("time", "wheel.velocity"))):
        with pytest.raises(BadFile, match="wheel.velocity is in 'kN': expected m/s"):
            reader()
    names, units = report.columns(), {"speed": "speed [km/h]", "hottest_1": "contact_celsius_1 [K]"}
    rows = [[{"time": k, "speed": 36 - 18 * k, "hottest_1": 400 + 10 * k}.get(name, 1) for name in names] for k in range(2)]
    (found,) = sources.read(written(tmp_path / "stop.csv", [units.get(name, name) for name in names], rows)).values()
    assert list(report.column(found, "speed")) == [10.0, 5.0] and list(report.column(found, "hottest", 0)) == [400.0, 410.0]
    if page.drawable():
        assert page.of_file(file, tmp_path / "run.html", packed).is_file()


def sections(tmp_path, heading, rows):
    """The example's scenario with other sections of its track."""
    import shutil

    folder = Path(shutil.copytree(TRAIN, tmp_path / "train", dirs_exist_ok=True))
    written(folder / "leaves.csv", heading, rows)
    return folder / "low_adhesion.json"


def test_columns_of_a_track_may_be_in_any_unit(tmp_path):
    rows = [[12.0, "dry", 12, 5], [12.4, "wet", 0, 0]]
    path = sections(tmp_path, ["position [km]", "condition", "slope [‰]", "temperature [K]"], rows)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        track = scenario.load(path, {"track.begin": 12000.0}).track
    assert track.sections.position == [12000.0, 12400.0] and track.sections.slope == [0.012, 0.0]
    for heading, words in (("temperature [°C]", "temperature is a difference"), ("temperature [bar]", "temperature is in 'bar': expected K")):
        with pytest.raises(BadFile, match=words):
            scenario.load(sections(tmp_path, ["position", "condition", "slope", heading], [[0, "dry", 0, 0]]))


def test_a_unit_in_the_name_of_a_key_says_how_to_write_it():
    for key, words in (("speed [km/h]", "write 'speed', and its values in m/s"), ("track.begin [km]", "write 'track.begin', and its values in m")):
        with pytest.raises(BadFile) as refused:
            scenario.load(TRAIN / "low_adhesion.json", {key: 1.0})
        assert words in str(refused.value)
    with pytest.raises(BadFile, match="not a number"):
        scenario.load(TRAIN / "low_adhesion.json", {"speed": Q(100, "km/h")})


def test_stationary_rolling_takes_units(fmu):
    steady = lambda velocity, creepage: wheelrail.steady({"thermal.enabled": False}, velocity=velocity, creepage=creepage, outputs="contact.force_x", fmu=fmu)
    plain = steady(20.0, [1e-3])
    assert steady(Q(72, "km/h"), Q([0.1], "percent")).identical(plain)
    with pytest.raises(ValueError, match="velocity is in 'N': expected m/s"):
        steady(Q(72, "N"), [1e-3])
    with pytest.raises(Refused, match="follows from velocity"):
        wheelrail.steady({}, {"drive.velocity [km/h]": 72}, fmu=fmu)


def test_a_number_without_a_unit_stays_as_it_is():
    values = np.array([1.0, 2.0])
    assert converted("force", values, None, "N") is values and converted("force", values, "N", "N") is values


@pytest.mark.parametrize("kind", ["int8", "uint8", "int16", "int32", "int64"])
def test_integers_of_any_size_are_converted(kind):
    for unit, si, of in (("kN", "N", 1e3), ("bar", "Pa", 1e5), ("deg", "rad", math.pi / 180.0)):
        np.testing.assert_allclose(converted("column", np.array([0, 100], kind), unit, si), [0.0, 100.0 * of], rtol=1e-15)
    many = np.array([360_000])
    np.testing.assert_allclose(converted("angle", many, "deg", "rad"), np.radians(many), rtol=1e-15)


@pytest.mark.parametrize("name", ["Y/Q", "L/V", "gain/day", "contact.force_x (mean)", "contact.force_x in peak", "part, axle 2"])
@pytest.mark.parametrize("about", [{}, {"units": "1"}])
def test_a_quantity_that_a_person_adds_to_a_record_may_have_any_name(name, about):
    record = xarray.Dataset({name: ("time", [1.0, 2.0], about)}, {"time": ("time", [0.0, 1.0], {"units": "s"})})
    assert in_si(record).identical(record)
    assert of_dataset(record).series[name].values.tolist() == [1.0, 2.0]
    with pytest.raises(UnitError, match="foo"):
        in_si(record.rename({name: "contact.force_x [foo]"}).map(lambda v: v.assign_attrs(units="")))
