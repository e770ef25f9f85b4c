"""Results of two FMUs compared bit for bit, on runs of all presets, controls, solvers and states of the surfaces.

    .venv/bin/python tools/same_results.py BEFORE.fmu AFTER.fmu [--only NAME,NAME] [--tolerance 0] [--jobs 2]

Each case below runs with both, driven by the Python package of this checkout; every output that both know, all points of the profiles
included, is compared at every communication point. Printed for each case: `same` (every bit), or the largest difference over the
largest magnitude of that output in the run, with the output's name and the time. Ends with 1 if a difference exceeds the tolerance.
"""

import argparse
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

from wheelrail import Fmu, Refused, WheelrailWarning, simulate

# Scenarios: rows of inputs over time, linear between the rows.
STOP = {"time": [0, 0.05, 0.3], "brake.torque": [0, 9000, 9000], "drive.velocity": [20, 20, 19.5]}
VARYING = {
    "time": [0, 0.02, 0.04, 0.06, 0.1, 0.2],
    "drive.moment": [0, -6000, -2000, -7000, -5000, 4000],
    "drive.load": [100e3, 80e3, 110e3, 95e3, 190e3, 10e3],
    "rail.friction": [0.3, 0.3, 0.25, 0.35, 0.3, 0.2],
    "rail.temperature": [293, 293, 300, 285, 320, 293],
}
BRAKE = {"time": [0, 0.02, 0.2], "brake.torque": [0, 40e3, 40e3]}
BLOCKS = {"time": [0, 0.1, 0.3], "drive.tread_heat": [0, 40e3, 40e3], "drive.moment": [0, -5000, -5000]}
RISING = {"time": [0, 0.1, 0.3], "rail.elevation": [0, 0.0005, 0], "rail.slope": [0, 0.01, 0.02]}
LIFTED = {"time": [0, 0.05, 0.1, 0.2], "drive.load": [100e3, 0, 0, 100e3]}
HEAVY = {"time": [0, 0.06, 0.12], "drive.load": [100e3, 500e3, 100e3], "drive.moment": [-5000, -5000, -5000]}
STANDSTILL = {"time": [0, 0.2, 0.4], "drive.velocity": [0.5, -0.5, 0], "brake.torque": [0, 0, 20e3]}


def locked(velocity, radius=0.46):
    """A wheel that is stopped within 20 ms by its angular velocity while its centre goes on at a velocity [m/s]."""
    return {"time": [0, 0.02, 0.2], "drive.omega": [velocity / radius, 0, 0], "drive.velocity": [velocity] * 3}


SPEEDS = {"control.rotation": "velocity", "control.translation": "velocity"}
DRAWN = {"control.translation": "velocity"}

# Name: preset, settings, scenario, communication step [s], end [s].
CASES = {
    "railway": ("railway", {}, VARYING, 1e-3, 0.2),
    "railway_dry": ("railway_dry", {}, VARYING, 1e-3, 0.2),
    "railway_wet": ("railway_wet", {}, VARYING, 1e-3, 0.2),
    "railway_low_adhesion": ("railway_low_adhesion", {}, VARYING, 1e-3, 0.2),
    "railway_damage": ("railway_damage", DRAWN | {"initial.velocity": 20}, STOP, 1e-3, 0.3),
    "paper_a": ("paper_a", {"initial.creepage": 1e-3} | SPEEDS, {}, 1e-3, 0.05),
    "paper_b": ("paper_b", {}, {"time": [0, 0.05], "drive.force": [0, 1000]}, 1e-3, 0.05),
    "paper_c": ("paper_c", SPEEDS, {}, 1e-3, 0.05),
    "paper_d": ("paper_d", {}, {"time": [0, 0.05], "drive.moment": [0, 8000]}, 1e-3, 0.05),
    "fine_steps": ("railway", {"mesh.elements_per_half_width": 10}, VARYING, 1e-4, 0.1),
    "braking": ("railway", {}, {"time": [0, 0.2], "drive.moment": [0, -8000]}, 1e-3, 0.2),
    "locked": ("railway", SPEEDS | {"initial.velocity": 60 / 3.6}, locked(60 / 3.6), 1e-3, 0.2),
    "locked_by_brake": ("railway_wet", DRAWN | {"initial.velocity": 30, "drive.velocity": 30}, BRAKE, 1e-3, 0.2),
    "melting": ("railway_dry", SPEEDS | {"initial.velocity": 40, "mesh.elements_per_half_width": 10}, locked(40.0), 5e-4, 0.1),
    "falling_friction": (
        "railway",
        SPEEDS | {"friction.falling_ratio": 0.4, "friction.falling_decay": 0.6, "initial.velocity": 15},
        {"time": [0, 0.2], "drive.omega": [15 / 0.46, 13.5 / 0.46], "drive.velocity": [15, 15]},
        1e-3,
        0.2,
    ),
    "rough_rail": (
        "railway",
        {"rail.profile": "sinusoid(amplitude = 20e-6, wavelength = 0.05)", "mesh.elements_per_half_width": 10},
        VARYING,
        5e-4,
        0.1,
    ),
    "flat": ("railway", {"wheel.profile": "flat(position = 0.7, length = 0.04)", "mesh.elements_per_half_width": 10}, {}, 5e-4, 0.06),
    "step": ("railway", {"rail.profile": "step(position = 1.0, height = 5e-5)", "mesh.elements_per_half_width": 10}, {}, 2e-4, 0.05),
    "wear": ("railway", SPEEDS | {"damage.wear": "t_gamma", "initial.creepage": 0.02}, {}, 1e-3, 0.1),
    "worn_locked": ("railway_damage", SPEEDS | {"damage.wear": "t_gamma", "initial.velocity": 10}, locked(10.0), 1e-3, 0.1),
    "blocks": ("railway", {"thermal.convection": 30}, BLOCKS, 1e-3, 0.3),
    "support": (
        "railway",
        {"rail.support_stiffness": 5e7, "rail.support_damping": 5e4, "rail.support_mass": 100, "rail.ends": "nonreflecting"},
        RISING,
        1e-3,
        0.3,
    ),
    "lifted": ("railway", {"mesh.elements_per_half_width": 10}, LIFTED, 1e-3, 0.2),
    "standstill": ("railway", DRAWN | {"initial.velocity": 0.5, "initial.creepage": 0}, STANDSTILL, 1e-3, 0.4),
    "heavy": ("railway", {}, HEAVY, 1e-3, 0.12),
    "hot_and_wide": ("railway", SPEEDS | {"initial.velocity": 160 / 3.6}, locked(160 / 3.6), 1e-3, 0.2),
    "ellipse": ("railway_ellipse", {}, VARYING, 1e-3, 0.1),
    "ellipse_heavy": ("railway_ellipse", {}, HEAVY, 1e-3, 0.12),
    "ellipse_locked": ("railway_ellipse", {"initial.velocity": 16.7}, BRAKE, 1e-3, 0.2),
    "ellipse_standstill": ("railway_ellipse", DRAWN | {"initial.velocity": 0.5, "initial.creepage": 0}, STANDSTILL, 1e-3, 0.4),
    "rows": ("railway_s1002_3mm", {}, VARYING, 1e-3, 0.1),
    "sideways": (
        "railway_ellipse",
        {"contact.lateral": True, "control.lateral": "force", "wheel.lateral_mass": 500},
        {"time": [0, 0.05], "drive.lateral_force": [0, 3000], "drive.spin": [0, 0.05], "drive.moment": [0, -3000]},
        1e-3,
        0.05,
    ),
    "hub_height": (
        "railway",
        {"control.vertical": "displacement"},
        {"time": [0, 0.1], "drive.displacement": [-1e-4, -1.2e-4], "drive.moment": [0, -5000]},
        1e-3,
        0.1,
    ),
    "hot_wheel": ("railway", {"thermal.wheel_excess": 200}, VARYING, 1e-3, 0.2),
}


def outputs(fmu):
    """Names of all outputs that an FMU records, points of profiles by the name of their array."""
    variables = (v for v in fmu.variables.values() if v.causality in ("output", "local") and v.type != "String")
    return list(dict.fromkeys(v.name.split("[")[0] for v in variables))


def run(fmu, names, case):
    """The record of a case, or what was said when it failed."""
    preset, settings, rows, step, stop = CASES[case]
    parameters, inputs = {"preset": preset}, {name: (rows["time"], values) for name, values in rows.items() if name != "time"}
    for name, value in settings.items():
        (inputs if fmu.variable(name).causality == "input" else parameters).setdefault(name, value)
    try:
        return simulate(parameters, inputs, stop=stop, step=step, outputs=names, fmu=fmu, progress=False)
    except Refused as failure:
        return str(failure)


def difference(before, after, leave_out=()):
    """Largest difference of two records, relative to the largest magnitude of its output, with its name and time; outputs whose names
    end like those to `leave_out` are none. What is no number differs from everything."""
    worst = (0.0, "", 0.0)
    for name in before.data_vars:
        a, b = before[name].values, after[name].values
        if name.endswith(tuple(leave_out)) or np.array_equal(a, b):
            continue
        if a.shape != b.shape or a.dtype.kind not in "bif":
            return np.inf, name, 0.0
        a, b = a.astype(float).reshape(len(a), -1), b.astype(float).reshape(len(b), -1)
        apart = np.nan_to_num(np.abs(a - b) / (np.max(np.abs(a)) or 1.0), nan=np.inf).max(axis=1)
        worst = max(worst, (float(apart.max()), name, float(before.time[apart.argmax()])))
    return worst


def compare(before, after, tolerance=0.0):
    """Compares two results: how far they are apart, and a line that says so. A case that does not run compares nothing. Beyond a tolerance
    of 0 residuals, which are rounding, and numbers of iterations do not count."""
    if isinstance(before, str) and isinstance(after, str):
        return np.inf, f"both fail{'' if before == after else ', in other words'}: {before[-200:]}"
    if isinstance(before, str) or isinstance(after, str):
        which, said = ("BEFORE", before) if isinstance(before, str) else ("AFTER", after)
        return np.inf, f"{which} failed: {said[-300:]}"
    distance, name, when = difference(before, after, ("residual", "iterations") if tolerance else ())
    return distance, f"{distance:.2e}  {name} at {when:g} s" if distance else "same"


def main():
    """All cases; 1 if one differs by more than the tolerance."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--only", type=lambda text: text.split(","), default=list(CASES), help="names of cases")
    parser.add_argument("--tolerance", type=float, default=0.0, help="largest relative difference; default: none")
    parser.add_argument("--jobs", type=int, default=2, help="runs at a time")
    options = parser.parse_args()
    warnings.simplefilter("ignore", WheelrailWarning)
    failures = 0
    with Fmu(options.before) as before, Fmu(options.after) as after, ThreadPoolExecutor(options.jobs) as pool:
        names = [name for name in outputs(before) if name in set(outputs(after))]
        pairs = {case: [pool.submit(run, fmu, names, case) for fmu in (before, after)] for case in options.only}
        for case, (first, second) in pairs.items():
            distance, text = compare(first.result(), second.result(), options.tolerance)
            failures += distance > options.tolerance
            print(f"{case:>22}  {text}", flush=True)
    print(f"{failures} of {len(options.only)} cases differ")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
