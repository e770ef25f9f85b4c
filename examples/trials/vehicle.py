"""A vehicle dynamicist's first day: a wheel in a loop of one's own, then one's own vehicle on eight wheels.

    python examples/trials/vehicle.py [DIRECTORY]
"""

import sys
from pathlib import Path

from steps import Trial
from wheelrail import Fmu, Refused, Wheel, steady

sys.path.insert(0, str(Path(__file__).parents[1]))
import ex12_own_vehicle as own  # noqa: E402

trial = Trial("vehicle dynamics")
COARSE = {"thermal.enabled": False, "mesh.elements_per_half_width": 6}


@trial.step("values of mixed types in one call", "refused: one type a call")
def mixed(out):
    with Fmu() as fmu, Wheel(fmu, COARSE) as wheel:
        found = wheel.get("contact.force_y", "control.rotation", "solver.internal_steps")
    assert found[0] > 0.0 and isinstance(found[1], int)
    return str([round(value) for value in found])


@trial.step("a record of one's own loop", "lists filled by hand")
def loop(out):
    with Fmu() as fmu, Wheel(fmu, COARSE) as wheel:
        record = wheel.record("contact.*", "wheel.*")
        for _ in range(50):
            wheel.step(1e-3)
    run = record.dataset()
    assert run.sizes["time"] == 51 and run["contact.force_y"].attrs["units"] == "N"
    return f"{run.sizes['time']} samples of {len(run.data_vars)} outputs"


@trial.step("a curve of forces over creepage", "another program, with Rust")
def curve(out):
    found = steady(COARSE, creepage=[0.0, 1e-3, 2e-3])
    assert found["contact.utilisation"][-1] > found["contact.utilisation"][1] > 0.1
    return f"{float(found['contact.utilisation'][1]):.2f} of the limit at 0.1 %"


@trial.step("the same on a rail that is not clean", "no layer between wheel and rail")
def dirty(out):
    clean, dirty = (steady(COARSE | {"contact.layer_flexibility": layer}, creepage=[0.0, 1e-3]) for layer in (0.0, 1.5e-13))
    share = float(dirty["contact.force_x"][-1] / clean["contact.force_x"][-1])
    assert 0.2 < share < 0.5
    return f"{share:.2f} of the force at 0.1 %"


@trial.step("a misspelt name", "IndexError or no word")
def misspelt(out):
    with Fmu() as fmu, Wheel(fmu, COARSE) as wheel:
        try:
            wheel.profile("presure")
        except Refused as refused:
            return str(refused).split(";")[0]
    raise AssertionError("a misspelt name passed")


@trial.step("one's own vehicle on eight wheels, 5 ms", "no recipe")
def vehicle(out):
    with Fmu() as fmu:
        found = own.errors(fmu, 1.0, (5e-3,), 1e-3, parameters=COARSE)
    assert found[5e-3, True] < 1e-4
    return f"{found[5e-3, True]:.0e} of the speed change off, {found[5e-3, False]:.0e} without the correction"


if __name__ == "__main__":
    trial.main()
