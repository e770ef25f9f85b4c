"""Example 8: the creep curve of a locomotive, 0 to 21 %, against its measurement.

    make study NAME=creep-curve

Siemens Eurosprinter 127 001 (W. Engel, M. Beck, J. Alders, Elektrische Bahnen 96 (1998) 201-209; as plotted in the user guide of
CONTACT, E. A. H. Vollebregt, 2025, and read from that plot within 0.01): 10 m/s, 106.7 kN on a wheel of 625 mm. Friction falls
with the slip by the law given there, 0.36 (0.38 + 0.62 exp(-0.7 s w)). It is a fit to this measurement: what is tested is the
way from law to curve, not the law. Softening is off, since the measured fall contains the heat. The guide has an elastic layer
between wheel and rail besides, 1.25 mm of 8200 N/mm2. Clean steel is steeper than the measurement at the beginning of the curve, and
both curves are computed: with the layer (contact.layer_flexibility), and without.

Every point is a stationary state: the start of an instance whose velocities are prescribed. A point with the layer outside the
scatter of the measurement, or one of clean steel from 3 % on, where all of the contact slides, ends the example with 1; of
clean steel and smaller creep the table says where it lies.
"""

import argparse
import sys
from pathlib import Path

from wheelrail import Fmu, Refused, Wheel
from wheelrail.plots import COLOURS, save, subplots

SPEED, LOAD, RADIUS = 10.0, 106.7e3, 0.625  # m/s, N, m
LAW = {"friction.coefficient": 0.36, "friction.falling_ratio": 0.38, "friction.falling_decay": 0.7, "friction.softening": 0.0}
MEASURED = (  # creep [%] from, to; adhesion from, to
    (0.5, 1.0, 0.21, 0.33), (1.6, 1.6, 0.28, 0.325), (3.0, 5.0, 0.25, 0.34), (10.0, 13.0, 0.18, 0.29),
    (15.0, 18.0, 0.17, 0.27), (20.0, 21.0, 0.185, 0.23),
)  # fmt: skip
LAYER = 1.25e-3 / 8200e6  # m/Pa, thickness over shear modulus
FITTED = 3.0  # %, creep from which the law is a fit
READING = 0.01  # of the values read from the plot
CREEPS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 1.6, 2, 3, 4, 5, 7, 10, 11.5, 13, 15, 16.5, 18, 20, 21)  # %


def adhesion(fmu, creep, layer=0.0):
    """Adhesion at a creep (r omega - V)/V [%] in traction, with a layer of this flexibility [m/Pa]."""
    share = 0.01 * creep
    parameters = LAW | {
        "thermal.enabled": False, "contact.layer_flexibility": layer, "wheel.radius": RADIUS, "initial.velocity": SPEED, "initial.creepage": -2.0 * share / (2.0 + share),
    }  # fmt: skip
    inputs = {"control.rotation": "velocity", "control.translation": "velocity", "drive.load": LOAD}
    with Wheel(fmu, parameters, inputs) as wheel:
        return wheel.get("contact.adhesion")


def judged(curve):
    """Rows of the measurement with the points of the curve in them, and whether these lie within the scatter."""
    for low, high, least, most in MEASURED:
        points = [(creep, value) for creep, value in curve if low <= creep <= high]
        inside = all(least - READING <= value <= most + READING for _, value in points)
        yield (low, high, least, most), points, inside


def plot(path, clean, layered):
    """The curves and the scatter of the measurement."""
    figure, axis = subplots(figsize=(8, 4))
    axis.plot(*zip(*clean), "--", color=COLOURS[0], linewidth=1, label="FMU, clean")
    axis.plot(*zip(*layered), "o-", color=COLOURS[0], markersize=4, label="FMU, elastic layer")
    for k, (low, high, least, most) in enumerate(MEASURED):
        label = "Eurosprinter, scatter of the measurement" if k == 0 else None
        axis.fill_between([low, max(high, low + 0.3)], least, most, color=COLOURS[1], alpha=0.3, linewidth=0, label=label)
    axis.set(xlabel="creep [%]", ylabel="adhesion [1]", xlim=(0, 22), ylim=(0, 0.4))
    axis.legend(loc="upper right")
    save(path, figure)


def run(options):
    """Both curves; true if they lie within the scatter of the measurement as far as they should."""
    with Fmu(options.fmu) as fmu:
        creeps, fine = CREEPS[::3] if options.brief else CREEPS, True
        clean, layered = ([(creep, adhesion(fmu, creep, layer)) for creep in creeps] for layer in (0.0, LAYER))
    print("creep [%]   measured        FMU")
    for curve, about, least_creep in ((layered, "elastic layer", 0.0), (clean, "clean", FITTED)):
        for (low, high, least, most), points, inside in judged(curve):
            values = ", ".join(f"{value:.3f} ({creep:g})" for creep, value in points)
            says = "" if inside else ", outside" if low >= least_creep else ", outside, as is known"
            print(f"{low:4g} - {high:4g}  {least:.3f} - {most:.3f}   {values}  {about}{says}")
            fine &= inside or low < least_creep
    options.out.mkdir(parents=True, exist_ok=True)
    plot(options.out / "creep_curve.png", clean, layered)
    print(f"\nwritten: {options.out / 'creep_curve.png'}")
    return fine


def arguments():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="default: %(default)s")
    parser.add_argument("--out", type=Path, default=Path("results"), help="directory for the plot")
    parser.add_argument("--brief", action="store_true", help="every third creepage, in seconds")
    return parser.parse_args()


if __name__ == "__main__":
    try:
        sys.exit(0 if run(arguments()) else 1)
    except (FileNotFoundError, Refused) as error:
        sys.exit(f"error: {error}")
