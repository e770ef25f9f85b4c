"""Example 18: what the next wheel meets. Wheels brake one behind the other on a wet rail; each meets what those ahead have left.

    .venv/bin/python examples/ex18_next_wheel.py

The rail is a `RailMap` of cells. Every wheel is an FMU: it takes friction and temperature of the rail from the map, and leaves its
friction energy and heat there. Printed for each wheel: the friction and the temperature that it met in its last step, and the force with
which the rail braked it.
"""

import argparse
import sys
from pathlib import Path

from wheelrail import Fmu, Wheel
from wheelrail.rail_map import RailLaw, RailMap

# Energy [J/m] that cleans, friction of sand, mass of sand [kg/m], width of the contact [m], effusivity of steel [J/(m2 K sqrt(s))].
LAW = RailLaw(cleaning_energy=2e3, sand_friction=0.25, sand_mass=0.02, width=0.014, effusivity=1.36e4)
WET, CLEAN, AIR = 0.06, 0.25, 293.0  # friction before any wheel, and of a cleaned rail; K
SPEED, APART, LENGTH, STEP = 10.0, 2.5, 5.0, 5e-3  # m/s, m between wheels, m of rail, s
TORQUE = 6e3  # N m, twice what the wet rail carries


def wheels(fmu, count):
    """What the wheels meet at the end, (friction, temperature over the air [K], force [N]) of each, and the rail behind them."""
    cells = round(LENGTH / 0.25)
    rail = RailMap(begin=0.0, cell=0.25, degraded=[WET] * cells, recovered=[CLEAN] * cells, law=LAW, axles=count)
    met = []
    for axle in range(count):
        late = axle * APART / SPEED  # s, by which it comes after the first one
        with Wheel(fmu, {"initial.velocity": SPEED}) as wheel:
            place = 0.0
            while place < LENGTH - 1.0:
                now = late + wheel.time
                friction, excess = rail.friction(place, axle), rail.temperature(place, axle, now)
                wheel.set({"rail.friction": friction, "rail.temperature": AIR + excess, "brake.torque": min(TORQUE, 4e5 * wheel.time)})
                wheel.step(STEP)
                before, place = place, wheel.get("wheel.distance")
                power, heat = wheel.get("heat.friction_power", "heat.to_rail")
                rail.leave(axle, before, place, now + STEP, STEP * power, STEP * heat)
            met.append((friction, excess, wheel.get("contact.force_x")))
    return met, rail


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--fmu", type=Path, help="the wheel [that of the package, or target/wheelrail.fmu]")
    parser.add_argument("--wheels", type=int, default=4)
    wishes = parser.parse_args(arguments)
    with Fmu(wishes.fmu) as fmu:
        met, _ = wheels(fmu, wishes.wheels)
    print("wheel  friction  rail over air  braking force")
    for number, (friction, excess, force) in enumerate(met, start=1):
        print(f"{number:5}{friction:10.3f}{excess:13.1f} K{-force:13.0f} N")


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
