"""Draws the pictures of README's doors, one panel each: docs/door_train.png, docs/door_vehicle.png and docs/door_damage.png.

    .venv/bin/python docs/doors_png.py

Needs target/wheelrail.fmu, and of `make train` and `make study NAME=flat` what they write into results/.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import pandas as pd

from wheelrail import Fmu
from wheelrail.plots import COLOURS, save, subplots

ROOT = Path(__file__).resolve().parent.parent
SIZE = (3.4, 2.5)  # inch
HUNTING = 70.0  # m/s, above the critical speed


def panel(name, title, ylabel, draw):
    """A picture of one panel over time."""
    figure, axis = subplots(figsize=SIZE)
    draw(axis)
    axis.set(title=title, xlabel="time [s]", ylabel=ylabel)
    save(ROOT / "docs" / f"door_{name}.png", figure)


def train(axis):
    """Speeds of a coach and of its treads, braked with slide protection on leaves."""
    run = pd.read_csv(ROOT / "results" / "low_adhesion" / "train_wsp_on.csv")
    for k, colour in zip(range(1, 5), COLOURS):
        axis.plot(run["time"], 3.6 * run[f"peripheral_{k}"], color=colour, linewidth=0.8, label=f"axle {k}")
    axis.plot(run["time"], 3.6 * run["speed"], color="black", label="coach")
    axis.legend(fontsize=7)


def vehicle(axis):
    """Lateral shift of a wheelset with the profiles S1002 and 60E1 that hunts."""
    sys.path.insert(0, str(ROOT / "examples"))
    from ex16_hunting import Profiled, hunting, patches

    with Fmu(ROOT / "target" / "wheelrail.fmu") as fmu, TemporaryDirectory() as folder:
        rows = hunting(fmu, Profiled(HUNTING, table=patches(Path(folder))))
    axis.plot(rows[:, 0], 1e3 * rows[:, 1], color=COLOURS[0])


def damage(axis):
    """Depths to which a locked wheel's steel has been above Ac1, and is martensite now."""
    run = pd.read_csv(ROOT / "results" / "flat.csv")
    axis.axvspan(0.0, run["time"][run["wheel.omega"] < 1.0].max(), color="0.94")
    for name, label, colour in (("ac1", "above Ac1", COLOURS[1]), ("martensite", "martensite", COLOURS[0])):
        axis.plot(run["time"], 1e3 * run[f"damage.{name}_depth"], color=colour, label=label)
    axis.legend(fontsize=7)


if __name__ == "__main__":
    panel("train", "A coach brakes on leaves", "speed [km/h]", train)
    panel("vehicle", f"A wheelset hunts at {HUNTING:g} m/s", "shift [mm]", vehicle)
    panel("damage", "What a locked wheel leaves", "depth [mm]", damage)
