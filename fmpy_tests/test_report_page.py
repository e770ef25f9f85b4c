"""The report page: what it says is true, bad files are refused in one line, and it works in a browser without network."""

import csv
import shutil
from pathlib import Path

import numpy as np
import pytest

from wheelrail import Wheel, grid, page, report, scenario, simulate, train
from wheelrail.__main__ import main
from wheelrail.page import balance, charts, film, html, sources, stops, units
from wheelrail.page.run import Profiles, of_dataset, of_table

LOW_ADHESION = Path(__file__).parent.parent / "examples" / "train" / "low_adhesion.json"
PROFILES = ("x", "pressure", "shear", "slip", "temperature_wheel", "temperature_rail")
BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
plotly_js = pytest.mark.skipif(not html.drawable(), reason="plotly is not installed")


@pytest.fixture(scope="module")
def run(fmu):
    """A wheel on wet rail, braked beyond adhesion, until it is locked and hot: every output at every step."""
    names = [v.name for v in fmu.description.modelVariables if v.causality == "output" and v.type == "Real" and "[" not in v.name]
    parameters = {"preset": "railway_wet", "mesh.elements_per_half_width": 6, "initial.velocity": 10.0}
    with Wheel(fmu, parameters) as wheel:
        take = lambda: ([wheel.time, *wheel.get(*names)], [wheel.profile(quantity) for quantity in PROFILES])
        samples = [take()]
        for k in range(300):
            wheel.set({"brake.torque": 18e3 * min(k / 150, 1.0)})
            wheel.step(1e-3)
            samples.append(take())
        about = {
            "preset": "railway_wet", "parameters": parameters, "inputs": {"drive.load": 1e5},
            "warnings": [*wheel.log, [0.1, "<b>made up</b>"]], "vehicle_mass": wheel.get("vehicle.mass"),
        }  # fmt: skip
    rows, frames = (np.array(found) for found in zip(*samples))
    patch = Profiles(rows[:, 0], {quantity: frames[:, k] for k, quantity in enumerate(PROFILES)})
    return of_table("A wheel locks", fmu, names, rows, patch, about)


@pytest.fixture(scope="module")
def stopped():
    """Short stops of a coach on rigid wheelsets, dry and on the track."""
    s = scenario.load(LOW_ADHESION)
    s.speed, s.step, s.hold = 8.0, 0.01, 0.5
    found = {}
    for name, dry in (("dry", s.dry), ("WSP on", None)):
        stop = train.Stop(s, None, dry)
        found[name] = stop.run(), stop.contacts.rail
        stop.close()
    return found


def columns(path, run, named=lambda name, series: name, shown=lambda values, series: values):
    """Writes the series of a run as a CSV."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["time", *(named(name, s) for name, s in run.series.items())])
        writer.writerows(zip(run.time, *(shown(s.values, s) for s in run.series.values())))
    return path


def test_the_energy_balance_is_that_of_the_fmu_and_momentum_is_conserved(run):
    found = {b.title: b for b in balance.of_run(run)}
    missing = found["Energy"].rows[-1][1]
    dissipated = sum(run.get(f"energy.{name}")[-1] for name in ("friction", "damping", "plastic"))
    said = run.get("solver.energy_residual")[-1] * dissipated
    print(f"energy: {missing:.3g} J of {dissipated:.4g} J missing, the FMU says {said:.3g} J")
    assert missing == pytest.approx(said, rel=1e-6, abs=1e-6)
    heat = dict(found["Heat"].rows)
    assert abs(found["Heat"].rows[-1][1]) < 1e-9 * heat["+ heat of friction"]
    along = found["Momentum along the rail"].rows
    print(f"momentum: {along[-1][1]:.3g} of {along[0][1]:.4g} N s missing")
    assert abs(along[-1][1]) < 2e-3 * abs(along[0][1])
    turning = found["Angular momentum of the wheel"].rows
    print(f"angular momentum: {turning[-1][1]:.3g} of {turning[0][1]:.4g} N m s missing")
    assert abs(turning[-1][1]) < 5e-3 * abs(turning[1][1])


def test_without_the_vehicles_mass_the_momentum_tells_the_mass_that_moves(run):
    known = run.about.pop("vehicle_mass")
    text = balance.momentum(run).meaning
    run.about["vehicle_mass"] = known
    told = float(text.split(" is ")[1].split(" kg")[0])
    assert told == pytest.approx(known + run.get("wheel.mass")[0], rel=2e-3)


def test_shear_lies_on_the_friction_limit_where_the_film_says_that_it_slips_and_below_where_it_sticks(run):
    shown = film.of_run(run)
    limit, shear, state = (np.array(shown[name], float) for name in ("limit", "shear", "state"))
    pressure = np.array(shown["pressure"], float)
    at = np.searchsorted(run.time, np.array(shown["time"]) - 1e-9)
    assert limit == pytest.approx(run.get("contact.friction")[at][:, None] * pressure, rel=1e-3)
    cold = np.nanmax(shown["temperature_wheel"], axis=1) < 1000.0  # Steel that melts has a film, which lowers the limit.
    slips, sticks = state == 2, state == 1
    assert slips.any() and sticks.any() and (state == 0).any() and not np.any(state == 3)
    # In the cell between a node that sticks and one that slips profiles are straight.
    inside = np.all([np.roll(slips, by, axis=1) for by in range(-2, 3)], axis=0)
    both = inside & cold[:, None]
    assert both.sum() > 0.75 * (slips & cold[:, None]).sum()
    assert np.abs(shear[both]) == pytest.approx(limit[both], rel=5e-3, abs=1e-3)
    assert np.all(np.abs(shear[sticks]) < limit[sticks] * 1.001)
    share = sticks.sum(axis=1) / np.maximum((state > 0).sum(axis=1), 1)
    points = 2.5 / (state > 0).sum(axis=1)
    assert np.all(np.abs(share - run.get("contact.stick_fraction")[at]) < points)
    assert shown["units"] == {
        "pressure": "MPa", "shear": "MPa", "slip": "m/s", "temperature_wheel": "°C", "temperature_rail": "°C"
    }  # fmt: skip
    hottest = run.get("temperature.wheel_max")[at] - 273.15
    seen = np.max(np.array(shown["temperature_wheel"], float), axis=1)
    assert np.all(seen < hottest + 0.1) and np.all(seen > 0.8 * hottest)


def test_without_slip_the_film_tells_stick_from_slip_by_the_friction_limit(run):
    whole, run.patch.values = run.patch.values, {k: v for k, v in run.patch.values.items() if k != "slip"}
    by_limit = film.of_run(run)
    run.patch.values = whole
    by_slip = film.of_run(run)
    known = dict(zip(by_slip["time"], by_slip["state"]))
    cold = [max(row) < 1000.0 for row in by_limit["temperature_wheel"]]  # Molten steel lowers the limit.
    pairs = [(state, known[t]) for t, state, use in zip(by_limit["time"], by_limit["state"], cold) if use and t in known]
    differ = np.mean([np.not_equal(*pair) for pair in pairs])
    print(f"{100 * differ:.2g} % of places in {len(pairs)} frames differ")
    assert len(pairs) > 100 and differ < 0.02


def test_curves_are_in_the_units_of_readers_and_thinning_keeps_extremes(run):
    found = {c["title"]: c for c in charts.of_run(run)[0]}
    curve = lambda title, name: np.array(next(t for t in found[title]["traces"] if t["name"] == name)["y"], float)
    assert found["Temperatures"]["unit"] == "°C" and found["Speed"]["unit"] == "km/h"
    assert curve("Temperatures", "wheel max") == pytest.approx(run.get("temperature.wheel_max") - 273.15, rel=1e-5)
    radius = 0.46
    assert curve("Speed", "tread rω") == pytest.approx(3.6 * radius * run.get("wheel.omega"), abs=0.05)
    assert curve("Forces along the rail, on the wheel", "contact") == pytest.approx(1e-3 * run.get("contact.force_x"), rel=1e-5)
    values = np.random.default_rng(1).normal(size=50_000)
    values[[777, 31_234]] = 40.0, -40.0
    kept = charts.thinned(np.arange(50_000.0), values)
    assert len(kept) <= 2 * charts.POINTS + 2 and {777, 31_234, 0, 49_999} <= set(kept)


def test_a_run_without_heat_has_no_temperatures_and_one_without_friction_never_sticks(fmu):
    names = ("wheel.velocity", "contact.friction", "temperature.wheel_max", "contact.force_y")
    with Wheel(fmu, {"mesh.elements_per_half_width": 6, "thermal.enabled": False}, {"rail.friction": 0.0}) as wheel:
        rows, frames = [[0.0, *wheel.get(*names)]], [[wheel.profile(quantity) for quantity in PROFILES]]
        wheel.step(1e-3)
        rows.append([wheel.time, *wheel.get(*names)])
        frames.append([wheel.profile(quantity) for quantity in PROFILES])
    patch = Profiles(np.array([0.0, 1e-3]), {quantity: np.array(frames)[:, k] for k, quantity in enumerate(PROFILES)})
    cold = of_table("cold", fmu, names, rows, patch)
    assert set(cold.series) == set(names) - {"temperature.wheel_max"}
    shown = film.of_run(cold)
    assert set(shown["units"]) == {"pressure", "shear", "slip"} and set(np.unique(shown["state"])) == {0, 2}


def test_a_csv_with_or_without_units_gives_the_curves_of_the_run(run, packed, tmp_path):
    plain = sources.read(columns(tmp_path / "plain.csv", run), packed)
    named = lambda name, s: (
        f"{name} [°C]" if s.unit == "K" else f"{name} [kN]" if s.unit == "N" else f"{name} [{s.unit}]" if s.unit else name
    )
    shown = lambda values, s: values - 273.15 if s.unit == "K" else 1e-3 * values if s.unit == "N" else values
    labelled = sources.read(columns(tmp_path / "labelled.csv", run, named, shown))
    for other in (plain, labelled):
        for mine, theirs in zip(charts.of_run(run)[0], charts.of_run(other)[0], strict=True):
            assert (mine["title"], mine["unit"]) == (theirs["title"], theirs["unit"])
            for a, b in zip(mine["traces"], theirs["traces"], strict=True):
                assert a["name"] == b["name"]
                assert np.array(a["y"], float) == pytest.approx(np.array(b["y"], float), rel=1e-5, abs=1e-7, nan_ok=True)
    assert plain.series["contact.force_x"].meaning == run.series["contact.force_x"].meaning


def test_flags_of_a_csv_are_read_as_fmi_and_as_python_and_pandas_write_them(tmp_path):
    file, read = tmp_path / "flags.csv", []
    for yes, no in (("true", "false"), ("True", "False"), ("TRUE", "FALSE"), ("1", "0")):
        file.write_text(f"time,wheel.velocity,brake.locked\n0.0,10.0,{no}\n1.0,9.0,{yes}\n2.0,8.0,{no}\n")
        read.append(sources.read(file, None).series["brake.locked"].values.tolist())
    assert read == [[0.0, 1.0, 0.0]] * 4


def test_a_dataset_as_a_netcdf_file_is_the_run(run, packed, tmp_path):
    xarray = pytest.importorskip("xarray", reason="xarray is not installed")
    pytest.importorskip("h5netcdf", reason="h5netcdf is not installed")
    data = {name: ("time", s.values, {"units": s.unit, "long_name": s.meaning}) for name, s in run.series.items()}
    data |= {f"profile.{name}": (("time", "node"), values) for name, values in run.patch.values.items()}
    below = 293.0 + 100.0 * np.exp(-np.outer(np.ones(len(run.time)), np.arange(30.0) / 5.0))
    data["profile.temperature_wheel_below"] = (("time", "depth"), below, {"units": "K"})
    dataset = xarray.Dataset(data, {"time": ("time", run.time, {"units": "s"}), "depth": ("depth", 1e-4 * np.arange(30))})
    dataset.attrs |= {"title": run.title, "preset": "railway_wet", "parameters": '{"initial.velocity": 10.0}', "warnings": "[]"}
    dataset.attrs["fmu_version"] = run.about["fmu_version"]
    dataset.to_netcdf(tmp_path / "run.nc", engine="h5netcdf")
    read = sources.read(tmp_path / "run.nc", packed)
    assert read.about["vehicle_mass"] == run.about["vehicle_mass"]
    assert sources._vehicle_mass(packed, {"fmu_version": "another"}) is None
    assert read.title == run.title and read.about["parameters"] == {"initial.velocity": 10.0}
    assert charts.of_run(read) == charts.of_run(run)
    assert film.of_run(read) == film.of_run(run)
    (field,) = film.fields(read)
    assert field["values"][0][0] == pytest.approx(293.0 + 100.0 - 273.15, rel=1e-4)
    assert film.of_run(of_dataset(dataset)) == film.of_run(run)


@pytest.fixture(scope="module")
def elliptical(fmu):
    """A record of a wheel on an elliptical patch that is braked ever more, with what its lines have and the profiles along it."""
    pytest.importorskip("xarray", reason="xarray is not installed")
    parameters = {"preset": "railway_ellipse", "initial.velocity": 20.0}
    brake = ([0.0, 0.05], [0.0, 9000.0])
    return simulate(parameters, {"brake.torque": brake}, stop=0.05, profiles=True, fmu=fmu)


def test_the_patch_from_above_is_as_long_wide_hot_and_loaded_as_the_fmu_says(elliptical):
    shown = film.of_run(of_dataset(elliptical))
    lines = {name: np.array(rows, float) for name, rows in shown["lines"].items() if name not in ("units", "ahead", "grid")}
    assert len(shown["time"]) == len(elliptical.time) == 51 and shown["lines"]["units"] == {"pressure": "MPa"}
    assert lines["pressure"].max(axis=1) == pytest.approx(1e-6 * elliptical["contact.pressure_max"].values, rel=1e-4)
    assert lines["z"] == pytest.approx(1e3 * elliptical["line.position"].values, rel=1e-4)
    # Strips lie side by side, each about its line, and together are as wide as the patch.
    edges = lines["edges"]
    assert edges.shape == (51, 8) and np.all(edges[:, :-1] < lines["z"]) and np.all(lines["z"] < edges[:, 1:])
    assert edges[:, -1] - edges[:, 0] == pytest.approx(1e3 * elliptical["contact.width"].values, rel=1e-4)
    # What sticks does not reach beyond the line, and gives way from both sides of the patch while the brake grows.
    length = 2.0 * lines["half_length"]
    assert np.all(lines["adheres"] <= length * 1.0001) and np.all(np.diff(lines["adheres"][1:, 3]) < 0.0)
    assert lines["adheres"] == pytest.approx(length * elliptical["line.stick_fraction"].values, rel=1e-4, abs=1e-4)
    for body in ("wheel", "rail"):
        hottest = elliptical[f"temperature.{body}_max"].values - 273.15
        assert lines[f"temperature_{body}"].max(axis=1) == pytest.approx(hottest, rel=1e-4)
    assert set(shown["lines"]["ahead"]) == {1}


def test_a_record_without_profiles_still_shows_the_patch_from_above(elliptical, tmp_path):
    across = [name for name in elliptical.data_vars if elliptical[name].dims[1:] != ("node",)]
    run = of_dataset(elliptical[across])
    shown = film.of_run(run)
    assert "pressure" not in shown and len(shown["lines"]["z"]) == len(shown["time"]) == 51
    assert shown["lines"] == film.of_run(of_dataset(elliptical))["lines"]
    found = shown["lines"]["temperature_wheel"]
    assert max(found[shown["start"]]) == max(map(max, found))
    assert film.of_run(of_dataset(elliptical.drop_dims(["line", "node"]))) is None
    if html.drawable():
        for dataset, along in ((elliptical, True), (elliptical[across], False)):
            text = page.write(tmp_path / "run.html", dataset).read_text(encoding="utf-8")
            assert ('id="film"' in text, 'id="above"' in text, 'id="slider"' in text) == (along, True, True)
            assert text.count('class="readings"') == 1


def test_lines_in_a_csv_and_in_a_file_are_those_of_the_record(elliptical, packed, tmp_path):
    with open(tmp_path / "run.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        names = [name for name in elliptical.data_vars if name.startswith("line.")]
        # The FMU has 13 of each; those beyond contact.lines are 0.
        whole = {name: np.pad(elliptical[name].values, ((0, 0), (0, 6))) for name in names}
        scalars = ["contact.width", "wheel.velocity", "temperature.wheel_max"]
        writer.writerow(["time", *scalars, *(f"{name}[{k}]" for name in names for k in range(1, 14))])
        writer.writerows(np.column_stack([elliptical.time, *(elliptical[n] for n in scalars), *whole.values()]))
    read = sources.read(tmp_path / "run.csv", packed)
    assert set(read.series) == set(scalars)
    assert film.of_run(read)["lines"] == film.of_run(of_dataset(elliptical))["lines"]
    pytest.importorskip("h5netcdf", reason="h5netcdf is not installed")
    elliptical.to_netcdf(tmp_path / "run.nc", engine="h5netcdf")
    assert film.of_run(sources.read(tmp_path / "run.nc", packed)) == film.of_run(of_dataset(elliptical))


@plotly_js
def test_a_record_of_several_runs_is_refused_and_each_of_them_has_its_page(fmu, tmp_path, capsys):
    xarray = pytest.importorskip("xarray", reason="xarray is not installed")
    pytest.importorskip("h5netcdf", reason="h5netcdf is not installed")
    single = [simulate({"initial.velocity": 20.0}, {"brake.torque": 4000.0}, stop=stop, fmu=fmu) for stop in (5e-3, 8e-3)]
    both = xarray.concat(single, "run", join="outer", coords="minimal", compat="override", combine_attrs="override")
    both.to_netcdf(tmp_path / "both.nc", engine="h5netcdf")
    words = "the record is over run (2) besides time, and a page shows one run: write a page of each, such as of record.isel(run=0)"
    with pytest.raises(page.BadFile) as refused:
        page.write(tmp_path / "both.html", both)
    assert words in str(refused.value) and words in refusal([tmp_path / "both.nc"], capsys)
    for k, run in enumerate(single):
        found = of_dataset(both.isel(run=k))
        assert list(found.time) == list(run.time.values)
        assert charts.of_run(found) == charts.of_run(of_dataset(run))
    with pytest.raises(page.BadFile, match="no numbers over time"):
        page.write(tmp_path / "none.html", single[0][[]].assign_coords(time=single[0].time))
    with pytest.raises(page.BadFile, match="no coordinate time"):
        page.write(tmp_path / "none.html", single[0].drop_vars("time"))
    with pytest.warns(UserWarning, match="not on the page, being over sensor besides time: strain"):
        page.write(tmp_path / "more.html", single[0].assign(strain=(("time", "sensor"), np.zeros((6, 2)))))


@plotly_js
@pytest.mark.parametrize("gap", [slice(-1, None), slice(0, 1), slice(2, 4), slice(None)], ids=["end", "start", "between", "all"])
def test_gaps_in_any_quantity_of_a_record_are_drawn_as_gaps(fmu, tmp_path, gap):
    pytest.importorskip("xarray", reason="xarray is not installed")
    parameters = {"preset": "railway_ellipse", "contact.lines": 3, "initial.velocity": 20.0}
    run = simulate(parameters, {"brake.torque": 8000.0}, stop=5e-3, profiles=True, depth=True, fmu=fmu)
    holed = {}
    for name, variable in run.data_vars.items():
        if variable.dtype.kind == "f":
            values = variable.values.copy()
            values[gap] = np.nan
            holed[name] = (variable.dims, values, variable.attrs)
    # Rows of which nothing is known are left out; a velocity keeps them in.
    kept = run.assign({name: of for name, of in holed.items() if name != "wheel.velocity"})
    assert len(of_dataset(kept).time) == 6
    for one in (kept, run.assign({"wheel.velocity": holed["wheel.velocity"]}), run.assign({"profile.temperature_wheel": holed["profile.temperature_wheel"]})):
        page.write(tmp_path / "run.html", one)
    assert units.number(float("nan")) == "–" and units.Shown("N").text(float("inf")) == "–"


def test_a_patch_of_constant_width_is_not_drawn_from_above(fmu):
    pytest.importorskip("xarray", reason="xarray is not installed")
    run = of_dataset(simulate(stop=2e-3, outputs=["line.*", "wheel.velocity"], fmu=fmu))
    assert run.lines is None and film.of_run(run) is None


WRONG = {
    "empty.csv": ("", "empty.csv:1: empty: no line of names of columns"),
    "short.csv": ("time,wheel.velocity\n0,1\n", "1 lines of values"),
    "word.csv": ("time,wheel.velocity\n0,1\n1,fast\n", "word.csv:3: wheel.velocity is 'fast', no number"),
    "ragged.csv": ("time,wheel.velocity\n0,1\n1\n", "ragged.csv:3: 1 entries, line 1 has 2"),
    "back.csv": ("time,wheel.velocity\n0,1\n2,1\n1,1\n", "time must grow from row to row: 2 s is followed by 1 s"),
    "noise.csv": (bytes(range(256)), "expected a record in NetCDF or a CSV"),
    "powershell.csv": ("time,wheel.velocity\n0,1\n1,2\n".encode("utf-16"), "PowerShell"),
    "broken.nc": (b"\x89HDF\r\n\x1a\nbroken", "NetCDF"),
}


def refusal(arguments, capsys):
    """The one line with which `wheelrail report` ends."""
    with pytest.raises(SystemExit) as ended:
        main(["report", *map(str, arguments)])
    code = ended.value.code
    text = code if isinstance(code, str) else capsys.readouterr().err.strip()
    assert code not in (0, None) and text.startswith("error: ") and "\n" not in text
    return text


@pytest.mark.parametrize("name", WRONG)
def test_a_bad_file_is_refused_in_one_line(name, tmp_path, capsys):
    content, expected = WRONG[name]
    (tmp_path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    assert expected in refusal([tmp_path / name], capsys) and list(tmp_path.glob("*.html")) == []


def test_what_is_no_run_and_no_page_is_refused(tmp_path, capsys):
    data = tmp_path / "run.csv"
    data.write_text("time,wheel.velocity\n0,1\n1,2\n")
    for arguments, expected in (
        ([tmp_path / "missing.nc"], "cannot be read (No such file or directory)"),
        ([tmp_path], "no CSV of a stop in it"),
        ([data, "--out", data], "a page ends in .html"),
        ([data, "--out", "/proc/none/page.html"], "cannot be written"),
    ):
        assert expected in refusal(arguments, capsys)
    assert data.read_text().startswith("time")


def test_without_plotly_one_line_says_what_to_install(run, tmp_path, monkeypatch):
    monkeypatch.setattr(html, "drawable", lambda: None)
    with pytest.raises(page.BadFile, match="wheelrail\\[report\\]"):
        page.write(tmp_path / "run.html", run)


def test_results_of_a_train_are_read_from_their_directory(stopped, tmp_path):
    for name, (table, _) in stopped.items():
        report.write_csv(tmp_path / f"train_{name.lower().replace(' ', '_')}.csv", table)
    (tmp_path / "other.csv").write_text("a,b\n1,2\n")
    read = sources.read(tmp_path)
    assert list(read) == ["dry", "wsp on"]
    mine = {name: table for name, (table, _) in stopped.items()}
    assert not stops.recognised(["time", "speed", "peripheral_1"])
    # But for the last one, half a second whose first sample comes or goes with the digits of a CSV.
    assert stops.figures(read)[1:-1] == stops.figures(mine)[1:-1]
    assert stops.figures(mine)[1][1:] == [
        units.number(report.figures(table)["stopping distance"][0]) for table, _ in stopped.values()
    ]
    given = {name: (None, np.zeros(2)) for name in report.columns()} | {"contact_celsius_1": (None, np.array([20.0, np.nan]))}
    assert report.column(stops.of_columns(given), "hottest", 0).tolist() == [293.15, 0.0]
    titles = [c["title"] for c in stops.charts(read["wsp on"], read.values())]
    assert titles[:4] == ["Speed of travel and of the treads", "Slide", "Pressure in the cylinders", "Adhesion used"]


@plotly_js
def test_a_page_is_one_file_of_less_than_six_megabytes_with_everything_escaped(run, stopped, tmp_path):
    for path in (page.write(tmp_path / "run.html", run), page.of_stops(tmp_path / "stops.html", stopped, "Stops & <more>")):
        text = path.read_text(encoding="utf-8")
        print(f"{path.name}: {len(text.encode()) / 1e6:.2f} MB")
        assert len(text.encode()) < 6e6
        assert "<b>made up</b>" not in text and "<more>" not in text
        assert 'src="' not in text and 'href="http' not in text


@pytest.fixture(scope="module")
def browser():
    """A headless browser of the machine."""
    driver = pytest.importorskip("playwright.sync_api", reason="playwright is not installed (requirements/browser.txt)")
    if BROWSER is None:
        pytest.skip("no browser (chromium or google-chrome) is installed")
    with driver.sync_playwright() as playwright:
        opened = playwright.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        yield opened
        opened.close()


def opened(browser, path, **how):
    """A page in the browser, drawn; with it lists of what it complained of and what it asked the network for."""
    tab = browser.new_context(viewport={"width": 1200, "height": 900}, offline=True, **how).new_page()
    complaints, asked = [], []
    tab.on("console", lambda message: complaints.append(message.text) if message.type in ("error", "warning") else None)
    tab.on("pageerror", lambda error: complaints.append(str(error)))
    tab.on("request", lambda request: asked.append(request.url))
    tab.goto(path.as_uri())
    tab.wait_for_selector("body[data-ready]", timeout=120_000)
    return tab, complaints, asked


FIGURES = "() => drawn.map((f) => { const { data, layout } = f.build(); return JSON.parse(JSON.stringify([data, layout])); })"
PRESSURE = "() => [...document.querySelector('#film').data[0].y]"


@plotly_js
def test_the_page_of_a_run_works_in_a_browser_without_network(run, tmp_path, browser):
    go = pytest.importorskip("plotly.graph_objects")
    path = page.write(tmp_path / "run.html", run)
    tab, complaints, asked = opened(browser, path)
    for data, layout in tab.evaluate(FIGURES):
        go.Figure(data=data, layout=layout)  # refuses what plotly does not know

    shown = film.of_run(run)
    show = lambda k: tab.evaluate(
        "(k) => { const s = document.querySelector('#slider'); s.value = k; s.dispatchEvent(new Event('input')); }", k
    )
    settled = lambda k: tab.wait_for_function(
        "(t) => drawn.filter((f) => f.linked).every((f) => f.div.layout.shapes[0].x0 === t)", arg=shown["time"][k]
    )
    for k in (100, len(shown["time"]) - 1):
        show(k)
        settled(k)
        assert tab.evaluate(PRESSURE) == pytest.approx(shown["pressure"][k])
        assert tab.inner_text("#clock") == f"{shown['time'][k]:.3f} s"

    show(0)
    settled(0)
    tab.select_option("#pace", "5")
    tab.click("#play")
    tab.wait_for_function("() => Number(document.querySelector('#slider').value) > 20")
    tab.click("#play")
    assert tab.get_attribute("#play", "aria-pressed") == "false"
    stopped_at = int(tab.input_value("#slider"))
    settled(stopped_at)
    assert tab.evaluate(PRESSURE) == pytest.approx(shown["pressure"][stopped_at])

    colours = lambda: tab.evaluate("() => [...document.querySelector('#map').data[0].z.map((row) => [...row])]")
    hot = colours()
    assert hot == pytest.approx(np.array(shown["temperature_wheel"]).T)
    tab.select_option("#quantity", "state")
    tab.wait_for_function("() => document.querySelector('#map').data[0].zmax === 2.5")
    assert np.array_equal(colours(), np.array(shown["state"]).T)

    entry = tab.locator("#charts .plot").first.locator(".legendtoggle").nth(1)
    entry.scroll_into_view_if_needed()
    entry.click()
    tab.wait_for_function("() => document.querySelector('#charts .plot').data[1].visible === 'legendonly'", timeout=10_000)

    tab.click("#rest summary")
    tab.wait_for_function("() => document.querySelectorAll('#more .js-plotly-plot').length > 5")
    buttons = tab.evaluate("() => [...new Set([...document.querySelectorAll('.modebar-btn')].map((b) => b.dataset.title))]")
    assert sorted(buttons) == ["Download plot as a PNG", "Pan", "Reset axes", "Zoom"]
    assert tab.evaluate("document.documentElement.scrollWidth") <= 1200
    assert complaints == [] and asked == [path.as_uri()]


@plotly_js
def test_the_patch_from_above_moves_with_the_slider(elliptical, tmp_path, browser):
    go = pytest.importorskip("plotly.graph_objects")
    dataset = elliptical.drop_dims("node")
    tab, complaints, asked = opened(browser, page.write(tmp_path / "run.html", dataset))
    for data, layout in tab.evaluate(FIGURES):
        go.Figure(data=data, layout=layout)
    largest = "() => Math.max(...document.querySelector('#above').data[0].z.flat())"
    for k in (0, 50):
        tab.evaluate("(k) => { const s = document.querySelector('#slider'); s.value = k; s.dispatchEvent(new Event('input')); }", k)
        z = [*dataset["line.position"].values[k] * 1e3]
        tab.wait_for_function("(z) => Math.abs(document.querySelector('#above').data[2].y[0] - z) < 1e-4", arg=z[0])
        expected = 1e-6 * float(dataset["contact.pressure_max"][k])
        assert 0.99 * expected < tab.evaluate(largest) <= 1.0001 * expected
    assert complaints == [] and len(asked) == 1


# Boxes of the colour bar of the patch from above and of all texts of its axes that it covers.
COVERED = """() => {
  const box = (e) => e.getBoundingClientRect(), bar = box(document.querySelector('#above .cbfills'));
  return [...document.querySelectorAll('#above :is(.xtitle, .x2title, .ytitle, .y2title, .xtick, .x2tick, .ytick, .y2tick)')]
    .filter((e) => { const b = box(e); return b.left < bar.right && b.right > bar.left && b.top < bar.bottom && b.bottom > bar.top; })
    .map((e) => e.textContent);
}"""
# How far the last figure of each group ends before the group does [px].
LACKS = "() => [...document.querySelectorAll('.charts')].filter((c) => c.children.length && c.clientWidth).map((c) => c.getBoundingClientRect().right - c.lastElementChild.getBoundingClientRect().right)"


@plotly_js
@pytest.mark.parametrize("width", [390, 800, 1440])
def test_nothing_covers_a_label_and_no_figure_stands_beside_an_empty_place(elliptical, tmp_path, browser, width):
    path = page.write(tmp_path / "run.html", elliptical)
    tab = browser.new_context(viewport={"width": width, "height": 900}, offline=True).new_page()
    tab.goto(path.as_uri())
    tab.wait_for_selector("body[data-ready]", timeout=120_000)
    covered, lacks = tab.evaluate(COVERED), tab.evaluate(LACKS)
    # Of even and odd numbers of figures.
    tab.evaluate("() => document.querySelectorAll('.charts').forEach((c) => c.children.length > 1 && c.lastElementChild.remove())")
    lacks += tab.evaluate(LACKS)
    print(f"{width} px: covered {covered}, figures end {lacks} px before their group")
    assert covered == [] and max(lacks) <= 1.0 and tab.evaluate("document.documentElement.scrollWidth") <= width


@plotly_js
def test_the_page_of_stops_changes_from_stop_to_stop_and_fits_a_telephone(stopped, tmp_path, browser):
    path = page.of_stops(tmp_path / "stops.html", stopped)
    tab, complaints, asked = opened(browser, path, color_scheme="dark")
    slide = "() => { const f = [...document.querySelectorAll('#charts .plot')][0]; return [...f.data[1].y]; }"
    seen = {}
    for name in stopped:
        tab.check(f"input[name=view][value='{name}']")
        expected = next(t for t in stops.charts(stopped[name][0], [table for table, _ in stopped.values()])[0]["traces"] if t["name"] == "axle 1")["y"]
        tab.wait_for_function("(n) => document.querySelector('#charts .plot').data[1].y.length === n", arg=len(expected))
        seen[name] = tab.evaluate(slide)
        assert seen[name] == expected
    assert seen["dry"] != seen["WSP on"]
    assert tab.evaluate("getComputedStyle(document.documentElement).backgroundColor") == "rgb(20, 23, 26)"
    tab.set_viewport_size({"width": 420, "height": 800})
    tab.wait_for_function("() => [...document.querySelectorAll('.plot')].every((f) => f.querySelector('svg').clientWidth <= 420)")
    assert tab.evaluate("document.documentElement.scrollWidth") <= 420
    assert complaints == [] and asked == [path.as_uri()]


def test_a_patch_whose_positions_begin_far_from_zero_is_as_wide_as_it_is():
    """As from a table of rows that counts from the middle of the track."""
    width, position = 8e-3, 0.745 + np.array([[0.0, 2e-3, 5e-3]])
    assert grid.edges(position, np.array([width]))[0] == pytest.approx(0.745 + np.array([-1.25e-3, 1e-3, 3.5e-3, 6.75e-3]), abs=1e-12)
