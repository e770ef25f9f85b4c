"""The table of contact patches over the lateral shift of a wheelset, from profiles of wheel and rail: the command `patch`."""

from __future__ import annotations

import math
import re
import time
from argparse import ArgumentTypeError, Namespace
from fractions import Fraction
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from . import profile_files
from .contact_geometry import Track, conicity
from .contact_patch import EndOfProfile, Strips, rows, strips
from .files import BadFile
from .output import fresh, write_rows
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


class Over(NamedTuple):
    """Patches of the right wheel over the shift."""

    shifts: np.ndarray  # m
    patches: list[Strips]
    rigid: np.ndarray  # radius of the wheel where rigid bodies touch, with roll [m]

    @property
    def radius(self) -> np.ndarray:
        """Radius at the centre of load [m]."""
        return np.array([patch.mean(patch.radius) for patch in self.patches])


def over(track: Track, shifts: np.ndarray, load: float, modulus: float, yaw: float = 0.0, tell: Any = None) -> Over:
    """Patches at shifts [m] under a load [N], `modulus` [Pa] as in `half_space.Tiles`; `yaw` [rad/m] turns the wheelset with the shift.
    `tell` is called after each."""
    patches, rigid = [], []
    for shift in shifts:
        pose = track.pose(shift, yaw * shift)
        try:
            patches.append(strips(track.side, pose, load, modulus))
        except (EndOfProfile, IndexError):
            advice = "take smaller ones, or give profiles that reach farther"
            raise BadFile(f"--shift: at {1e3 * shift:g} mm the patch reaches the end of a profile; {advice}") from None
        rigid.append(track.side.lowest(pose)[1])
        if tell:
            tell(shift)
    return Over(np.asarray(shifts), patches, np.array(rigid))


def conicities(found: Over, track: Track, amplitudes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Equivalent conicities [1] at amplitudes [m] of rigid wheels without roll (EN 15302), and of the centres of load."""
    side, end = track.side, min(-found.shifts[0], found.shifts[-1])
    y = np.linspace(-end - 2e-3, end + 2e-3, 401)
    rigid = conicity(y, track.rigid_difference(y), amplitudes, side.radius, side.half_spacing)
    shifts = found.shifts[np.abs(found.shifts) <= end + 1e-9]
    radius = np.interp(shifts, found.shifts, found.radius) - np.interp(-shifts, found.shifts, found.radius)
    return rigid, conicity(shifts, radius, amplitudes, side.radius, side.half_spacing)


def write(path: Path, found: Over, count: int, words: str) -> None:
    """Writes the table with `count` rows for each shift, `words` in a comment above it; units of its columns beside it."""
    with fresh(path) as new, open(new, "w", encoding="utf-8") as file:
        print(f"# {words.replace(';', ',')}", ",".join(name for name, *_ in COLUMNS), sep="\n", file=file)
        for shift, patch in zip(found.shifts, found.patches):
            for row in zip(*rows(patch, count)):
                print(",".join(f"{value:.9g}" for value in (shift, *row)), file=file)
    write_rows(path.with_name(f"{path.stem}_columns.csv"), [("column", "unit", "description"), *COLUMNS])


def shifts_of(text: str) -> np.ndarray:
    """Shifts [m] of a text such as -7:7:0.1, the first one, the last one and the step in millimetres, or of a single one."""
    try:
        first, *rest = (float(part) for part in text.split(":"))
        last, step = rest or (first, 1.0)
        count = round((last - first) / step) + 1
        if not (step > 0.0 and 1 <= count <= MOST_SHIFTS and abs(first) <= 50.0 and abs(last) <= 50.0):
            raise ValueError
    except (ValueError, OverflowError):
        raise ArgumentTypeError(f"{text!r} is no shift [mm] or FIRST:LAST:STEP with up to {MOST_SHIFTS} shifts within 50 mm") from None
    return np.round(1e-3 * (first + step * np.arange(count)), 12)


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
    command.add_argument("--shift", type=shifts_of, default="-7:7:0.2", help="one, or FIRST:LAST:STEP, to the right [mm], default %(default)s")
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
    wheel, rail = profile_files.read(options.wheel, "wheel"), profile_files.read(options.rail, "rail")
    rail = profile_files.inclined(rail, options.inclination, options.rail)
    print(f"{wheel.words}\n{rail.words}", flush=True)
    began, track = time.perf_counter(), Track(wheel, rail, options.gauge, options.radius, 0.5 * options.spacing)
    modulus = options.youngs_modulus / (2.0 * (1.0 - options.poissons_ratio**2))
    with Progress(len(options.shift), "patches") as bar:
        found = over(track, options.shift, options.load, modulus, tell=lambda shift: bar.advance(1, f"{1e3 * shift:g} mm"))
    print(f"{len(found.shifts)} shifts in {time.perf_counter() - began:.1f} s; largest pressure {1e-6 * max(np.max(p.peak) for p in found.patches):.0f} MPa")
    amplitudes = AMPLITUDES[AMPLITUDES <= min(-found.shifts[0], found.shifts[-1])]
    known = conicities(found, track, amplitudes) if len(amplitudes) else None
    for name, values in zip(("rigid", "of the centre of load"), known or ()):
        print(f"equivalent conicity, {name}: " + ", ".join(f"{v:.3f} ({1e3 * a:g} mm)" for a, v in zip(amplitudes, values) if np.isfinite(v)))
    words = f"{options.wheel.name} on {options.rail.name}, gauge {options.gauge:g} m, contact.rows_load = {options.load:g} N, wheel.radius = {options.radius:g} m"
    write(options.out, found, options.rows, words)
    draw(options.out.with_suffix(".png"), found, options.rows, amplitudes, known, words)
    print(f"written: {options.out}, {options.out.stem}_columns.csv, {options.out.stem}.png")
