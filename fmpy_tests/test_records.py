"""Records: what they hold is what the wheel said, they keep it in files, and they follow a wheel that goes back in time."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

import wheelrail
from wheelrail import Refused

pytest.importorskip("xarray", reason="xarray is not installed (requirements/records.txt)")
PAGE = Path(__file__).parent.parent / "docs" / "records.md"
BRAKED = {"brake.torque": 4000.0}


def test_a_record_is_what_the_wheel_said_at_every_nth_step(start):
    wheel = start({"initial.velocity": 20.0})
    record = wheel.record("contact.*", "wheel.velocity", "control.rotation", profiles=["pressure"], every=2)
    wheel.set(BRAKED)
    said = [(wheel.time, *wheel.get("contact.force_x", "contact.patches"), wheel.profile("pressure"))]
    for k in range(5):
        wheel.step(1e-3)
        if k % 2:
            said.append((wheel.time, *wheel.get("contact.force_x", "contact.patches"), wheel.profile("pressure")))
    run = record.dataset()
    time, force, patches, pressure = zip(*said)
    np.testing.assert_array_equal(run.time, time)
    # The first sample is from before the brake was set, which changes nothing but what it asks for.
    np.testing.assert_array_equal(run["contact.force_x"][1:], force[1:])
    np.testing.assert_array_equal(run["contact.patches"], patches)
    np.testing.assert_array_equal(run["profile.pressure"], pressure)
    assert run["profile.pressure"].dims == ("time", "node") and "profile.x" in run
    # Of inputs those that changed are over time, the others are an attribute.
    np.testing.assert_array_equal(run["brake.torque"], [0.0, 4000.0, 4000.0])
    assert json.loads(run.attrs["inputs"])["drive.load"] == 100e3
    assert (run["control.rotation"] == "moment").all()
    assert "wheel.omega" not in run and "wheel.velocity" in run


def test_units_meanings_and_the_parameters_that_differ_are_attributes(fmu):
    run = wheelrail.simulate({"preset": "railway_dry", "initial.velocity": 10.0, "mesh.grid_elements_per_half_width": 8}, stop=2e-3, fmu=fmu)
    assert run["contact.pressure_max"].attrs["units"] == "Pa" and "peak" in run["contact.pressure_max"].attrs["comment"]
    assert run["contact.pressure_max"].attrs["long_name"] == "Largest contact pressure"
    assert run.attrs["preset"] == "railway_dry" and run.attrs["fmu_version"] == fmu.description.version
    assert json.loads(run.attrs["parameters"]) == {"initial.velocity": 10.0, "mesh.grid_elements_per_half_width": 8}
    assert run["brake.locked"].dtype == bool and "units" not in run["brake.locked"].attrs
    frame = run.to_dataframe()
    assert frame.loc[2e-3, "wheel.velocity"] == run["wheel.velocity"][-1]


def test_a_wheel_that_goes_back_takes_its_record_along(start):
    wheel = start()
    record, rare = wheel.record("wheel.distance"), wheel.record("wheel.distance", every=2)
    wheel.step(1e-3)
    saved = wheel.save()
    wheel.step(5e-3)
    wheel.restore(saved)
    wheel.forget(saved)
    wheel.step(1e-3)
    run = record.dataset()
    np.testing.assert_allclose(run.time, [0.0, 1e-3, 2e-3], rtol=1e-12)
    np.testing.assert_allclose(rare.dataset().time, [0.0, 2e-3], rtol=1e-12)
    assert (np.diff(run["wheel.distance"]) > 0.0).all()


def test_a_record_outlives_its_wheel_and_holds_its_warnings(fmu):
    with wheelrail.Wheel(fmu, {"initial.velocity": 20.0}) as wheel:
        record = wheel.record("wheel.velocity")
        wheel.set({"rail.temperature": 20.0})
        wheel.step(1e-3)
    warnings = json.loads(record.dataset().attrs["warnings"])
    assert len(warnings) == 1 and warnings[0]["time"] == 0.0 and "rail.temperature = 20 K" in warnings[0]["text"]


def test_inputs_are_constants_samples_series_and_functions(fmu):
    xarray, pandas = pytest.importorskip("xarray"), pytest.importorskip("pandas")
    load = {0.0: 1e5, 4e-3: 1.1e5}
    inputs = {
        "drive.load": (list(load), list(load.values())),
        "brake.torque": lambda time: 1e6 * time,
        "rail.friction": ([0.0, 2e-3, 2e-3], [0.3, 0.3, 0.2]),
        "rail.slope": 0.01,
        "drive.force": pandas.Series(load) - 1e5,
        "rail.temperature": xarray.DataArray([293.0, 303.0], [("time", [0.0, 4e-3])]),
    }
    run = wheelrail.simulate({"initial.velocity": 20.0}, inputs, outputs=["hub.force_y", "brake.torque_actual"], fmu=fmu)
    assert run.time[-1] == 4e-3 and len(run.time) == 5
    np.testing.assert_allclose(run["drive.load"], 1e5 + 2.5e6 * run.time, rtol=1e-12)
    np.testing.assert_allclose(run["drive.force"], run["drive.load"] - 1e5, atol=1e-8)
    np.testing.assert_allclose(run["rail.temperature"], 293.0 + 2500.0 * run.time, rtol=1e-12)
    # Linear within a step: what the hub carries at a communication point is what the function says there.
    np.testing.assert_allclose(-run["hub.force_y"], run["drive.load"], rtol=1e-9)
    np.testing.assert_allclose(-run["brake.torque_actual"][1:], 1e6 * run.time[1:], rtol=1e-9)
    # A jump is held from its time on, and the step up to it does not know of it.
    np.testing.assert_allclose(run["rail.friction"], [0.3, 0.3, 0.3, 0.2, 0.2], rtol=1e-12)
    assert json.loads(run.attrs["inputs"])["rail.slope"] == 0.01


def test_warnings_of_steps_that_are_taken_back_go_with_them(start):
    wheel = start({"initial.velocity": 20.0})
    saved = wheel.save()
    record = wheel.record("wheel.velocity")
    wheel.set({"rail.temperature": 20.0})
    wheel.step(1e-3)
    assert json.loads(record.dataset().attrs["warnings"])
    wheel.restore(saved)
    wheel.forget(saved)
    assert json.loads(record.dataset().attrs["warnings"]) == []


def test_choices_over_time_hold(fmu):
    omega = 20.0 / 0.46
    inputs = {"control.rotation": ([0.0, 2e-3], ["moment", "velocity"]), "drive.omega": omega}
    run = wheelrail.simulate({"initial.velocity": 20.0}, inputs, stop=4e-3, outputs="wheel.omega", fmu=fmu)
    assert list(run["control.rotation"]) == ["moment"] * 3 + ["velocity"] * 2
    assert run["wheel.omega"][-1] == omega


@pytest.mark.parametrize("ending", ["nc", "parquet"])
def test_files_keep_values_units_and_attributes(fmu, tmp_path, ending):
    pytest.importorskip({"nc": "h5py", "parquet": "pyarrow"}[ending])
    inputs = {"control.rotation": ([0.0, 2e-3], ["moment", "velocity"]), "drive.omega": 20.0 / 0.46}
    run = wheelrail.simulate({"initial.velocity": 20.0}, inputs, stop=4e-3, profiles=ending == "nc", fmu=fmu, title="a try")
    path = wheelrail.save(run, tmp_path / "new" / f"run.{ending}")
    back = wheelrail.load(path)
    assert set(back.variables) == set(run.variables) and back.attrs == run.attrs and back.attrs["title"] == "a try"
    for name in run.variables:
        np.testing.assert_array_equal(back[name].values, run[name].values)
        assert back[name].attrs == run[name].attrs and back[name].dims == run[name].dims


def test_what_stops_a_run_carries_the_record_so_far(fmu):
    def load(time):
        if time > 2.5e-3:
            raise KeyboardInterrupt
        return 1e5

    with pytest.raises(KeyboardInterrupt) as interrupted:
        wheelrail.simulate(inputs={"drive.load": load}, stop=1.0, fmu=fmu)
    assert len(interrupted.value.run.time) == 3
    with pytest.raises(Refused, match="model.nominal_load") as refused:
        wheelrail.simulate(inputs={"drive.load": ([0.0, 3e-3, 4e-3], [1e5, 1e5, 1e7])}, fmu=fmu)
    assert len(refused.value.run.time) == 4 and "0.003 of 0.004 s" in refused.value.__notes__[0]


def test_a_bar_is_for_terminals(fmu, capsys):
    wheelrail.simulate(stop=2e-3, fmu=fmu)
    assert capsys.readouterr() == ("", "")


def test_the_page_does_what_it_says(packed, tmp_path, monkeypatch):
    pytest.importorskip("pyarrow")
    import matplotlib

    matplotlib.use("Agg")
    monkeypatch.setenv("WHEELRAIL_FMU", str(Path(packed).resolve()))
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.S)
    place = {}
    for block in blocks:
        exec(compile(block, str(PAGE), "exec"), place)
    assert len(blocks) == 8 and len(place["frame"]) == 51
    assert place["lines"]["line.pressure_max"].dims == ("time", "line")
    assert place["again"].identical(place["run"]) and Path("results/run.parquet").is_file()
    surface = place["again"]["profile.temperature_wheel"]
    assert surface.dims == ("time", "node") and surface["x"].attrs["units"] == "m"


@pytest.fixture(scope="module")
def braked(fmu):
    """A wheel on an elliptical patch that brakes: all outputs, those of its lines among them."""
    parameters = {"preset": "railway_ellipse", "initial.velocity": 27.8}
    return wheelrail.simulate(parameters, {"brake.torque": 8000.0}, stop=5e-3, fmu=fmu)


def test_lines_of_an_elliptical_patch_add_up_to_it_and_are_symmetric_about_its_middle(braked):
    position, force, load, power, pressure = (
        braked[f"line.{name}"] for name in ("position", "force_x", "force_y", "friction_power", "pressure_max")
    )
    assert force.dims == ("time", "line") and force.sizes["line"] == 7 and force.attrs["units"] == "N"
    np.testing.assert_array_equal(braked["z"], position[0])
    assert braked["z"].dims == ("line",) and braked["z"].attrs["units"] == "m"
    np.testing.assert_allclose(force.sum("line"), braked["contact.force_x"], rtol=1e-9)
    np.testing.assert_allclose(load.sum("line"), braked["contact.force_y"], rtol=1e-9)
    assert (power[-1] > 0.0).all()
    # Positions grow from line to line, and either side of the middle is the mirror of the other.
    assert (np.diff(position) > 0.0).all() and (2.0 * position[:, -1] < braked["contact.width"]).all()
    np.testing.assert_array_equal(position, -position[:, ::-1])
    for values in (force, load, pressure):
        np.testing.assert_array_equal(values, values[:, ::-1])
    np.testing.assert_allclose(pressure.max("line"), braked["contact.pressure_max"], rtol=1e-12)
    assert (pressure.argmax("line") == 3).all() and (np.diff(pressure[:, :4]) > 0.0).all()


def test_what_the_wheel_says_of_its_lines_is_what_a_record_holds(start):
    wheel = start({"preset": "railway_ellipse", "contact.lines": 5, "initial.velocity": 20.0})
    record = wheel.record("line.pressure_max", "line.stick*")
    wheel.step(1e-3)
    run = record.dataset()
    assert wheel.lines() == run.sizes["line"] == 5
    named = {"line.position", "line.pressure_max", "line.stick_fraction"}
    assert {name for name in run.data_vars if name.startswith("line.")} == named
    np.testing.assert_array_equal(run["line.pressure_max"][-1], wheel.line("pressure_max"))
    assert "contact.force_x" not in run


def test_the_only_line_of_a_patch_of_constant_width_is_recorded_where_it_is_named(fmu):
    braking = {"initial.velocity": 20.0}, {"brake.torque": 8000.0}
    run = wheelrail.simulate(*braking, stop=2e-3, outputs=["*.force_x", "line.force_x"], fmu=fmu)
    assert run["line.force_x"].sizes["line"] == 1 and "line.pressure_max" not in run
    np.testing.assert_allclose(run["line.force_x"][:, 0], run["contact.force_x"], rtol=1e-12)
    for outputs in (None, "*force*"):
        run = wheelrail.simulate(*braking, stop=2e-3, outputs=outputs, fmu=fmu)
        assert "line" not in run.sizes and "contact.force_x" in run


def test_lines_keep_their_place_in_files_and_are_left_out_of_tables(braked, tmp_path):
    pytest.importorskip("h5py")
    assert wheelrail.load(wheelrail.save(braked, tmp_path / "run.nc")).identical(braked)
    frame = wheelrail.table(braked)
    assert len(frame) == len(braked.time) and "contact.width" in frame and not any("line." in name for name in frame)


def test_depth_profiles_begin_with_the_surface(fmu):
    run = wheelrail.simulate({"initial.velocity": 20.0}, {"brake.torque": 6000.0}, stop=5e-3, depth=True, fmu=fmu)
    below = run["profile.temperature_wheel_below"]
    assert below.dims == ("time", "depth") and run["depth"].attrs["units"] == "m" and run["depth"][-1] == pytest.approx(0.02)
    np.testing.assert_allclose(below[:, 0], run["temperature.wheel_nominal"], rtol=1e-9)
    np.testing.assert_allclose(run["profile.temperature_rail_below"][:, 0], run["temperature.rail_nominal"], rtol=1e-9)
    warm = wheelrail.celsius(run)["temperature.wheel_nominal"]
    assert warm.attrs["units"] == "°C" and warm[0] == pytest.approx(run["temperature.wheel_nominal"][0].item() - 273.15)
