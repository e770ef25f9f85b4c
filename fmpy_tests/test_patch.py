"""The patch as it is: profiles of every line in records, on a regular grid, in the page and for ParaView."""

import base64
import struct
from xml.etree import ElementTree

import numpy as np
import pytest

xarray = pytest.importorskip("xarray", reason="xarray is not installed (requirements/records.txt)")

import wheelrail
from wheelrail import grid, page, paraview
from wheelrail.__main__ import main

START, BRAKE = {"preset": "railway_ellipse", "initial.velocity": 20.0}, {"brake.torque": 8000.0}
CONE = 1e-9  # by which shear may exceed friction times pressure, relative: rounding


@pytest.fixture(scope="module")
def run(fmu):
    """A braked wheel on seven lines."""
    return wheelrail.simulate(START, BRAKE, stop=6e-3, profiles=True, patch=True, fmu=fmu, progress=False)


@pytest.fixture(scope="module")
def laid(run):
    return wheelrail.patch(run)


def test_the_line_of_the_largest_pressure_is_that_of_the_profiles_and_all_carry_their_forces(run):
    middle = int(np.argmax(run["line.pressure_max"].values[-1]))
    for quantity in ("pressure", "shear", "slip", "temperature_wheel", "temperature_rail"):
        np.testing.assert_array_equal(run[f"patch.{quantity}"][:, middle], run[f"profile.{quantity}"])
    carried = np.trapezoid(run["patch.pressure"].values, run["x"].values, axis=2) * run["line.width"].values
    # Sums over samples miss a little of every half ellipse.
    np.testing.assert_allclose(carried, run["line.force_y"], rtol=0.04)
    assert np.ptp(run["patch.pressure"].values[-1].max(axis=1)) > 1e8
    cone = run["line.friction"] * run["patch.pressure"]
    assert (np.abs(run["patch.shear"]) <= cone * (1.0 + CONE) + 1.0).all()


def test_looking_at_lines_changes_nothing_in_a_run(run, fmu):
    plain = wheelrail.simulate(START, BRAKE, stop=6e-3, profiles=True, fmu=fmu, progress=False)
    assert plain.identical(run.drop_vars([name for name in run.data_vars if name.startswith("patch.")]))


def test_the_patch_of_fmi_3_is_that_of_fmi_2(run, fmu3):
    other = wheelrail.simulate(START, BRAKE, stop=6e-3, profiles=True, patch=True, fmu=fmu3, progress=False)
    for name in (name for name in run.data_vars if name.startswith("patch.")):
        np.testing.assert_array_equal(other[name], run[name])


def test_a_number_beyond_the_lines_shows_that_of_the_largest_pressure_and_a_chosen_line_has_no_derivatives(start):
    wheel = start(START, BRAKE)
    usual = [wheel.profile(name) for name in ("pressure", "temperature_wheel")]
    wheel.set({"contact.shown_line": wheel.lines() + 1})
    assert [wheel.profile(name) for name in ("pressure", "temperature_wheel")] == usual
    wheel.set({"contact.shown_line": 1})
    assert 0.0 < max(wheel.profile("pressure")) < 0.8 * max(usual[0])
    with pytest.raises(wheelrail.Refused, match=r"profile.pressure\[31\] has derivatives with contact.shown_line = 0 only"):
        variable = wheel.fmu.variable("profile.pressure[31]")
        wheel._calls(wheel.slave.getRealOutputDerivatives, [variable.valueReference], [1])
    wheel.set({"contact.shown_line": 0})
    assert max(wheel.profile("pressure")) > 1e8


def test_the_grid_is_the_ellipse_of_hertz_and_carries_the_load(run, laid):
    a, b = float(run["contact.half_width"][-1]), 0.5 * float(run["contact.width"][-1])
    peak, now = float(run["contact.pressure_max"][-1]), laid.isel(time=-1)
    hertz = peak * np.sqrt(np.clip(1.0 - (now["x"] / a) ** 2 - (now["z"] / b) ** 2, 0.0, None))
    error = np.abs(now["pressure"] - hertz) / peak
    load = float(now["pressure"].sum()) * float(laid["x"][1] - laid["x"][0]) * float(laid["z"][1] - laid["z"][0])
    print(f"from Hertz by {float(error.max()):.3f}, {float((error**2).mean()) ** 0.5:.4f} in the mean; load {load / float(run['contact.force_y'][-1]):.4f}")
    assert (error**2).mean() < 0.01**2 and error.max() < 0.08
    assert load == pytest.approx(float(run["contact.force_y"][-1]), rel=0.02)
    assert np.array_equal(now["state"] > 0.0, now["pressure"] > 0.0)
    # A braked wheel sticks ahead and slips behind.
    middle = now["state"].values[len(now["z"]) // 2]
    assert middle[middle > 0.0][0] == 2.0 and middle[middle > 0.0][-1] == 1.0
    assert (np.abs(now["shear"]) <= 1.001 * float(run["contact.friction"][-1]) * now["pressure"] + 1.0).all()
    assert np.isnan(now["temperature_wheel"][0]).all() and np.isfinite(now["temperature_wheel"][len(now["z"]) // 2]).all()


def test_lines_of_a_closed_form_are_laid_on_a_grid_within_a_hundredth_of_the_peak():
    a, b, mu = 6e-3, 5e-3, 0.3
    z_lines, nodes = np.linspace(-1.0, 1.0, 9)[1:-1] * b, np.linspace(-20e-3, 20e-3, 61)
    shape = lambda x, z: np.sqrt(np.clip(1.0 - (x / a) ** 2 - (z / b) ** 2, 0.0, None))
    lines = {"pressure": shape(nodes[None], z_lines[:, None]), "slip": np.where(nodes < 1e-3, 1e-3, 0.0) * np.ones((7, 1))}
    lines["shear"] = -mu * lines["pressure"]
    x, z = np.linspace(-6.5e-3, 6.5e-3, 61), np.linspace(-5.2e-3, 5.2e-3, 41)
    half = a * np.sqrt(1.0 - (z_lines / b) ** 2)
    found = grid.laid(lines, nodes, z_lines, half, np.array([-b, b]), x, z, np.array([0.0, 0.3 * b]))
    np.testing.assert_allclose(found["pressure"], shape(x[None], z[:, None]), atol=0.01)
    np.testing.assert_allclose(found["shear"], -mu * found["pressure"], atol=1e-12)
    np.testing.assert_allclose(found["rim"], a * np.sqrt([[1.0], [1.0 - 0.09]]) * [-1.0, 1.0], rtol=1e-6, atol=2e-5)
    border = [x[row == 1.0].min() for row in found["state"] if (row == 1.0).any()]
    assert np.abs(np.array(border) - 1e-3).max() < 0.7e-3
    # Turned round, the patch is the patch turned round.
    turned = {name: (-1.0 if name == "shear" else 1.0) * values[:, ::-1] for name, values in lines.items()}
    back = grid.laid(turned, -nodes[::-1], z_lines, half, np.array([-b, b]), -x[::-1], z)
    np.testing.assert_allclose(back["pressure"], found["pressure"][:, ::-1], atol=1e-12)
    nothing = grid.laid({"pressure": np.zeros((7, 61))}, nodes, z_lines, 0.0 * half, np.array([-b, b]), x, z)
    assert not nothing["pressure"].any() and not nothing["state"].any()


def test_a_line_of_constant_width_is_the_same_across_it(fmu):
    run = wheelrail.simulate({"initial.velocity": 20.0}, BRAKE, stop=2e-3, patch=True, fmu=fmu, progress=False)
    laid = wheelrail.patch(run, along=41, across=9).isel(time=-1)
    inside = np.abs(laid["z"]) < 0.5 * float(run["contact.width"][-1])
    pressure = laid["pressure"].values[inside.values]
    assert len(pressure) >= 5 and np.ptp(pressure, axis=0).max() == 0.0 and not laid["pressure"].values[~inside.values].any()
    assert pressure.max() == pytest.approx(float(run["contact.pressure_max"][-1]), rel=0.01)
    with pytest.raises(grid.NoPatch, match="patch=True"):
        wheelrail.patch(run.drop_vars("patch.pressure"))


def read(path):
    """Dimensions (z, x), spacing and arrays of an image, and its unit by name."""
    root = ElementTree.parse(path).getroot()
    whole = [int(n) for n in root.find("ImageData").get("WholeExtent").split()]
    shape = whole[5] + 1, whole[1] + 1
    arrays = {}
    for array in root.iter("DataArray"):
        content = base64.b64decode(array.text)
        assert struct.unpack("<I", content[:4])[0] == len(content) - 4
        arrays[array.get("Name")] = np.frombuffer(content[4:], "<f4").reshape(shape)
    return [float(n) for n in root.find("ImageData").get("Spacing").split()], arrays


def test_paraview_gets_the_grid_of_every_instant(run, laid, tmp_path, capsys):
    wheelrail.save(run, tmp_path / "run.nc")
    main(["export", str(tmp_path / "run.nc"), "--out", str(tmp_path / "film")])
    assert f"written: {tmp_path / 'film' / 'patch.pvd'}" in capsys.readouterr().out
    sets = list(ElementTree.parse(tmp_path / "film" / "patch.pvd").iter("DataSet"))
    assert [float(s.get("timestep")) for s in sets] == pytest.approx(list(run["time"].values))
    spacing, arrays = read(tmp_path / "film" / sets[-1].get("file"))
    assert spacing[0] == pytest.approx(float(laid["x"][1] - laid["x"][0]), rel=1e-6) and spacing[2] == pytest.approx(float(laid["z"][1] - laid["z"][0]), rel=1e-6)
    for name in laid.data_vars:
        unit = laid[name].attrs["units"]
        np.testing.assert_allclose(arrays[f"{name} [{unit}]"], laid[name][-1], rtol=1e-6, atol=1e-30)
    with pytest.raises(SystemExit):
        main(["export", str(tmp_path / "film" / "patch.pvd")])
    assert "expected a record, .nc" in capsys.readouterr().err
    assert len(paraview.index([0.0], ["a"]).splitlines()) == 6


def test_the_page_has_the_patch_as_it_is(run, laid, tmp_path):
    shown = page.film.of_run(page.run.of_dataset(run))["lines"]["grid"]
    assert set(shown["quantities"]) == {"pressure", "shear", "slip", "state", "temperature_wheel", "temperature_rail"}
    found = shown["quantities"]["pressure"]
    whole = np.frombuffer(base64.b64decode(found["packed"]), "<u2").reshape(run.sizes["time"], len(shown["z"]), len(shown["x"]))
    largest = found["low"] + whole[-1].max() / found["levels"] * (found["high"] - found["low"])
    assert found["unit"] == "MPa" and largest == pytest.approx(1e-6 * float(laid["pressure"][-1].max()), rel=0.01)
    if not page.drawable():
        pytest.skip("plotly is not installed")
    assert "interpolated between them" in page.write(tmp_path / "run.html", run).read_text(encoding="utf-8")
