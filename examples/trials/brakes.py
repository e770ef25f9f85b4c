"""A brake engineer's first day: a stop, a slide protection of one's own, a sweep of a key of one's own.

    python examples/trials/brakes.py [DIRECTORY]

Rigid wheelsets, which compute a stop in seconds, stand for those of the FMU but in one step: the calls are the same.
"""

import contextlib
import csv
import io
import json
import shutil
from pathlib import Path

from steps import Trial
from wheelrail import Fmu, page, report, scenario
from wheelrail.__main__ import main
from wheelrail.train import Stop

trial = Trial("brakes and slide protection")
FILE = Path(__file__).parents[1] / "train" / "low_adhesion.json"
SHORT = {"speed": 15.0, "step": 0.01, "hold": 0.2}
kept = {}


@trial.step("a stop and its key figures", "undocumented, found in the source")
def stop(out):
    run = Stop(scenario.load(FILE, SHORT))
    table = run.run()
    kept["mine"], kept["rail"] = table, run.contacts.rail
    distance, unit = report.figures(table)["stopping distance"]
    assert 50.0 < distance < 1000.0
    return f"{distance:.0f} {unit}"


class Gentle:
    """Vents an axle that slides by more than a tenth."""

    def __init__(self, wsp, speeds):
        self.reference = max(speeds)

    def step(self, h, speeds):
        self.reference = max(max(speeds), self.reference - 1.5 * h)
        return ["vent" if v < 0.9 * self.reference else "apply" for v in speeds]


@trial.step("a slide protection of one's own (and a class of six lines)", "found in the source")
def protection(out):
    loaded = scenario.load(FILE, SHORT)
    loaded.brake.protection = Gentle
    table = Stop(loaded).run()
    distance = report.figures(table)["stopping distance"][0]
    assert distance != report.figures(kept["mine"])["stopping distance"][0]
    return f"{distance:.0f} m"


@trial.step("a sweep of a key of one's own", "four keys only, no dry stop")
def sweep(out):
    folder = shutil.copytree(FILE.parent, out / "train", dirs_exist_ok=True)
    swept = {"sweep": {"speed": [10.0], "vehicle.body.mass": [30e3, 40e3]}}
    (folder / "mine.json").write_text(json.dumps(json.loads(FILE.read_text()) | {"step": 0.01, "hold": 0.2} | swept))
    with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
        main(["sweep", str(folder / "mine.json"), "--rigid", "--out", str(out), "--workers", "1", "--force"])
    with open(out / "mine" / "sweep.csv", encoding="utf-8") as rows:
        longer = [float(row["extension over dry"]) for row in csv.DictReader(rows)]
    assert len(longer) == 2 and all(extension > 0.0 for extension in longer) and abs(longer[0] - longer[1]) > 1.0
    return f"extensions over dry {', '.join(f'{extension:.0f}' for extension in longer)} %"


@trial.step("a train whose wheels have patches of ellipses, in the FMU", "one kind of wheel")
def patches(out):
    loaded = scenario.load(FILE, {"speed": 5.0, "step": 0.01, "wheel.preset": "railway_ellipse", "track.slope": 0.004})
    with Fmu() as fmu, contextlib.closing(Stop(loaded, fmu)) as run:
        for _ in range(10):
            run.step(0.01)
    seen = run.contacts.seen[0]
    assert seen.load > 80e3 and seen.hottest > 290.0
    return f"{1e-3 * seen.load:.0f} kN on an axle, contact of {seen.hottest - 273.15:.0f} °C"


@trial.step("an axle whose wheels differ, on rails that differ, in the FMU", "both wheels alike")
def different(out):
    loaded = scenario.load(FILE, {"speed": 5.0, "step": 0.01, "right_wheel.preset": "railway_ellipse", "right_friction": 0.2})
    with Fmu() as fmu, contextlib.closing(Stop(loaded, fmu)) as run:
        for _ in range(10):
            run.step(0.01)
        left, right = (side.wheel.get("wheel.omega") for side in run.contacts.wheelsets[0].sides)
    assert abs(left - right) < 1e-4 * left
    return f"both wheels turn with {left:.3f} rad/s"


@trial.step("a page of stops to send around", "none")
def sent(out):
    page.of_stops(out / "stops.html", {"mine": (kept["mine"], kept["rail"])}, "my stop")
    size = (out / "stops.html").stat().st_size
    # A page without stops weighs nearly as much.
    assert ">mine<" in (out / "stops.html").read_text(encoding="utf-8")
    return f"{size / 1e6:.1f} MB, opens without network"


if __name__ == "__main__":
    trial.main()
