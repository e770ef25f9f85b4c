"""A wheel-damage researcher's first day: the temperature in the contact, over patch, depth and time.

    python examples/trials/damage.py [DIRECTORY]
"""

import wheelrail
from steps import Trial
from wheelrail import page, paraview, plots

trial = Trial("wheel damage")
START, SLIDE = {"initial.velocity": 20.0}, {"brake.torque": ([0.0, 0.02], [0.0, 30e3])}
kept = {}


@trial.step("a run as a DataFrame", "no call gave a table")
def frame(out):
    run = wheelrail.simulate(START, SLIDE, stop=0.05, progress=False)
    table = run.to_dataframe()
    assert len(table) == 51 and table["contact.creepage"].iloc[-1] > 0.0
    return f"{len(table)} rows, {len(table.columns)} columns"


@trial.step("temperature over patch and time, as a picture", "read point by point, drawn by hand")
def patch(out):
    picture, axes = plots.subplots(figsize=(6.4, 4.8))
    run = wheelrail.simulate(START, SLIDE, stop=0.15, profiles=True, depth=True, progress=False)
    wheelrail.celsius(run["profile.temperature_wheel"]).plot(x="time", y="x", ax=axes)
    picture.savefig(out / "patch.png", bbox_inches="tight")
    kept["run"] = run
    hottest = float(run["profile.temperature_wheel"].max()) - 273.15
    assert hottest > 300.0 and (out / "patch.png").stat().st_size > 5000
    return f"up to {hottest:.0f} °C"


@trial.step("temperature over depth and time", "not to be had")
def depth(out):
    below = kept["run"]["profile.temperature_wheel_below"]
    rise = below.max("time") - below.min("time")
    # Heat enters from above and does not reach the depth within the run.
    assert below.dims == ("time", "depth") and rise[0] > 300.0 and rise[-1] < 1.0
    return f"{below.sizes['depth']} depths to {1e3 * float(below['depth'][-1]):.1f} mm"


@trial.step("the run in a file for others", "CSV of outputs alone")
def file(out):
    path = wheelrail.save(kept["run"], out / "slide.nc")
    again = wheelrail.load(path)
    assert again.identical(kept["run"])
    return f"NetCDF, {path.stat().st_size / 1e6:.1f} MB, equal when read"


@trial.step("the patch as a film", "none")
def film(out):
    page.write(out / "slide.html", kept["run"])
    size = (out / "slide.html").stat().st_size
    # A page without a film weighs nearly as much.
    assert '<section id="patch">' in (out / "slide.html").read_text(encoding="utf-8")
    return f"one page of {size / 1e6:.1f} MB"


@trial.step("what the slide left, until it is cold", "a second run, told where to look")
def left(out):
    with wheelrail.Fmu() as fmu, wheelrail.Wheel(fmu, START) as wheel:
        record = wheel.record(depth=True, every=5)
        for _ in range(150):
            wheel.set({"brake.torque": min(30e3, 1.5e6 * wheel.time)})
            wheel.step(1e-3)
        wheel.set({"brake.torque": 0.0})
        wheelrail.damage.settle(wheel)
    found = wheelrail.damage.report(record.dataset())
    assert found.final and found.martensite_depth > 1e-4 and found.hardness.max() > 600.0
    return f"martensite to {1e3 * found.martensite_depth:.2f} mm, {found.hardness.max():.0f} HV"


@trial.step("the patch over x and z, for ParaView", "seven bars")
def seen(out):
    run = wheelrail.simulate({"preset": "railway_ellipse"} | START, {"brake.torque": 8e3}, stop=5e-3, patch=True, progress=False)
    index = paraview.export(run, out / "film")
    grid = wheelrail.patch(run)
    assert index.is_file() and float(grid["pressure"].max()) > 1e9
    return f"{grid.sizes['z']} × {grid.sizes['x']} places at {grid.sizes['time']} instants"


if __name__ == "__main__":
    trial.main()
