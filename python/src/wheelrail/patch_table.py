"""The table of contact patches over the lateral shift of a wheelset, from profiles of wheel and rail: the command `patch`."""

from __future__ import annotations

import math
import re
import time
from argparse import ArgumentTypeError, Namespace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np

from . import profile_files
from .contact_geometry import EndOfProfile, Track
from .contact_patch import Over, conicities, over
from .files import BadFile
from .output import beside, fresh, write_columns
from .progress import Progress

COLUMNS = (
    ("shift", "m", "of the wheelset to the right, where this is its right wheel; one block of rows for each, ascending"),
    ("position", "m", "of the middle of the row: length along the wheel's profile from the taping circle, to the right positive, ascending"),
    ("half_length", "m", "half of the length of the row along the track"),
    ("load_share", "1", "load of the row, normal to its surface, over that of all rows of the block"),
    ("width", "m", "of the row along the profile, half of it on each side of its position"),
    ("angle", "rad", "between row and axle, positive where it rises to the right, as on the flange of a right wheel"),
    ("radius", "m", "of the wheel at the row"),
    ("lateral", "m", "lateral distance of the row's centre of load from the taping circle, to the right positive"),
)  # fmt: skip
MOST_SHIFTS, MOST_ROWS = 1000, 13
WIDEST = 50.0  # mm, of shifts
JUMP, BEARING = 4e-3, 0.03  # m that a row moves from shift to shift, and its share of the load, of which a word is said
AMPLITUDES = 1e-3 * np.arange(1, 11)  # m, of which the conicity is told
# Options with a number: name, default, range, factor to SI, and words.
NUMBERS = (
    ("gauge", 1435.0, (600.0, 1700.0), 1e-3, "between the rails, 14 mm below their tops [mm]"),
    ("spacing", 1500.0, (650.0, 1800.0), 1e-3, "of the taping circles of both wheels [mm]"),
    ("radius", 460.0, (100.0, 1000.0), 1e-3, "of the wheel at the taping circle [mm]"),
    ("load", 1e5, (10.0, 1e6), 1.0, "of the patch, normal to its surface: contact.rows_load [N]"),
    ("youngs-modulus", 210e9, (1e9, 1e12), 1.0, "of wheel and rail [Pa]"),
    ("poissons-ratio", 0.3, (0.0, 0.49), 1.0, "of wheel and rail [1]"),
    ("rows", 9, (2, MOST_ROWS), 1, "of each block"),
)


def write(path: Path, found: Over, count: int, words: str) -> None:
    """Writes the table with `count` rows for each shift, `words` in a comment above it; units of its columns beside it."""
    with fresh(path) as new, open(new, "w", encoding="utf-8") as file:
        print(f"# {words.replace(';', ',')}", ",".join(name for name, *_ in COLUMNS), sep="\n", file=file)
        for shift, patch in zip(found.shifts, found.rows(count)):
            for row in zip(*patch):
                print(",".join(f"{value:.9g}" for value in (shift, *row)), file=file)
    write_columns(beside(path, "columns"), COLUMNS)


def jumps(found: Over, count: int) -> list[tuple[float, float]]:
    """Pairs of neighbouring shifts [m] between which rows with more than `BEARING` of the load move by more than `JUMP`: the FMU would draw
    them straight across."""
    table = found.rows(count)
    places, shares = np.array([rows.position for rows in table]), np.array([rows.load_share for rows in table])
    moved = (np.abs(np.diff(places, axis=0)) > JUMP) & (np.minimum(shares[1:], shares[:-1]) > BEARING)
    return [(found.shifts[k], found.shifts[k + 1]) for k in np.flatnonzero(np.any(moved, axis=1))]


def shifts_of(text: str) -> np.ndarray:
    """Shifts [m] of a text in millimetres: a single one, FIRST:LAST:STEP, or several of these behind commas, such as -7:6:0.1,6.02:6.4:0.02."""
    found = []
    try:
        for part in text.split(","):
            first, *rest = (float(number) for number in part.split(":"))
            last, step = rest or (first, 1.0)
            if not (step > 0.0 and abs(first) <= WIDEST and abs(last) <= WIDEST and (last - first) / step < MOST_SHIFTS):
                raise ValueError
            found += [first + step * k for k in range(round((last - first) / step) + 1)]
    except ValueError:
        found = []
    if not 1 <= len(found) <= MOST_SHIFTS or np.any(np.diff(found) <= 0.0):
        advice = f"such as 3, -7:7:0.1 (FIRST:LAST:STEP) or both, ascending behind commas; up to {MOST_SHIFTS} within {WIDEST:g} mm"
        raise ArgumentTypeError(f"{text!r} says no shifts [mm]; {advice}")
    return np.round(1e-3 * np.array(found), 12)


def inclination_of(text: str) -> float:
    """Inclination [1] of a text such as 1:40, or 0."""
    try:
        found = float(Fraction(text.replace(":", "/")))
    except (ValueError, ZeroDivisionError):
        found = math.nan
    if not abs(found) <= 0.2:
        raise ArgumentTypeError(f"{text!r} is no inclination such as 1:40")
    return found


def add_command(commands: Any) -> None:
    """Adds the command to those of `wheelrail`."""
    command = commands.add_parser("patch", help="table of contact patches over the shift, from profiles of wheel and rail")
    command._negative_number_matcher = re.compile(r"-\.?\d")  # shifts begin with a sign
    command.add_argument("wheel", type=Path, help="profile: SIMPACK, MiniProf or two columns")
    command.add_argument("rail", type=Path, help="profile, of two columns with positions to the field side")
    command.add_argument("--shift", type=shifts_of, default="-7:7:0.2", help="one, FIRST:LAST:STEP, or several, to the right [mm], default %(default)s")
    command.add_argument("--inclination", type=inclination_of, default=0.0, help="by which the rail is turned besides, such as 1:40, default 0")
    for name, default, _, _, about in NUMBERS:
        command.add_argument(f"--{name}", type=type(default), default=default, help=f"{about}, default %(default)g")
    command.add_argument("--out", type=Path, default=Path("patch.csv"), help="table; a picture and units lie beside it, default %(default)s")


def run(options: Namespace) -> None:
    """Reads the profiles, presses them together at each shift, and writes table and picture."""
    from .patch_picture import draw

    for name, _, (low, high), factor, _ in NUMBERS:
        value = getattr(options, name.replace("-", "_"))
        if not low <= value <= high:
            raise BadFile(f"--{name} = {value:g} is outside {low:g} to {high:g}")
        setattr(options, name.replace("-", "_"), factor * value)
    if options.out.suffix != ".csv":
        raise BadFile(f"--out {options.out}: no name that ends with .csv, by which the FMU knows a file")
    wheel, rail = profile_files.read(options.wheel, "wheel"), profile_files.read(options.rail, "rail")
    rail = profile_files.inclined(rail, options.inclination, options.rail)
    print(f"{wheel.words}\n{rail.words}", flush=True)
    began, track = time.perf_counter(), Track(wheel, rail, options.gauge, options.radius, 0.5 * options.spacing)
    modulus = options.youngs_modulus / (2.0 * (1.0 - options.poissons_ratio**2))
    try:
        with Progress(len(options.shift), "patches") as bar:
            found = over(track, options.shift, options.load, modulus, tell=lambda shift: bar.advance(1, f"{1e3 * shift:g} mm"))
    except EndOfProfile as error:
        raise BadFile(f"--shift: {error}; take smaller ones, or give profiles that reach farther") from None
    print(f"{len(found.shifts)} shifts in {time.perf_counter() - began:.1f} s; largest pressure {1e-6 * max(np.max(p.peak) for p in found.patches):.0f} MPa")
    amplitudes = AMPLITUDES[AMPLITUDES <= min(-found.shifts[0], found.shifts[-1])]
    known = conicities(found, track, amplitudes) if len(amplitudes) else None
    for name, values in zip(("rigid", "of the centre of load"), known or ()):
        told = ", ".join(f"{value:.3f} ({1e3 * a:g} mm)" for a, value in zip(amplitudes, values) if np.isfinite(value))
        print(f"equivalent conicity, {name}: {told or 'none at these shifts'}")
    for low, high in jumps(found, options.rows):
        print(f"from {1e3 * low:g} to {1e3 * high:g} mm rows that bear jump by more than {1e3 * JUMP:g} mm: add shifts in between")
    words = f"{options.wheel.name} on {options.rail.name}, gauge {options.gauge:g} m, contact.rows_load = {options.load:g} N, wheel.radius = {options.radius:g} m"
    write(options.out, found, options.rows, words)
    draw(options.out.with_suffix(".png"), found, options.rows, amplitudes, known, words)
    print(f"written: {options.out}, {beside(options.out, 'columns').name}, {options.out.stem}.png")
