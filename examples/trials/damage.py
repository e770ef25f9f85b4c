"""A wheel-damage researcher's first day: the temperature in the contact, over patch, depth and time.

    python examples/trials/damage.py [DIRECTORY]
"""

import wheelrail
from steps import Trial
from wheelrail import page
from wheelrail.plots import pyplot

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
    plt = pyplot()
    run = wheelrail.simulate(START, SLIDE, stop=0.15, profiles=True, depth=True, progress=False)
    wheelrail.celsius(run["profile.temperature_wheel"]).plot(x="time", y="x")
    plt.savefig(out / "patch.png", bbox_inches="tight")
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


if __name__ == "__main__":
    trial.main()
