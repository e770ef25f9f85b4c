"""What a slide leaves in a wheel: hottest place, flats, martensite and hardness over depth, beside what others have observed.

    python -m wheelrail damage run.nc

`report(run)` reads a record made with `depth=True`. As long as a place of the tread is still hot, steel cools and the findings may
change; the report says so, and `settle` rolls a wheel on until nothing does any more.
"""

from __future__ import annotations

import json
import sys
from argparse import Namespace
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .output import beside, write_columns, write_rows
from .records import made_of
from .units import ZERO_CELSIUS, in_si

if TYPE_CHECKING:
    import xarray

    from .fmu import Wheel

# Weight percent of a wheel steel within ER7 (EN 13262 allows 0.52 C), ASSUMED: that of the default of damage.martensite_start.
STEEL = {"C": 0.50, "Mn": 0.75, "Cr": 0.25, "Si": 0.35, "Ni": 0.0}
BAR = "{desc} [{elapsed}{postfix}]"
BASE = 260.0  # HV of the wheel as it was: judgement, for 820 to 940 MPa of tensile strength
OUTPUTS = (
    "damage.peak_temperature", "damage.hottest_point", "damage.flats", "damage.hot_places", "wheel.flat_length", "wheel.flat_depth",
    "damage.flattening", "damage.ac1_depth", "damage.martensite_depth", "damage.cooling_rate", "damage.time_above_ac1",
    "damage.melted", "damage.rail_peak",
)  # fmt: skip
PROFILES = ("profile.peak_temperature", "profile.martensite")
# Observations of others, each with its source.
SILINGE = "Silinge 1996, Proc. IMechE F 213 (1999) 1-13, abstract"
RAIL = "rail after wheel slip, Eng. Fail. Anal. 22 (2012) 152-165, abstract"
GALTON = "Galton 1878, in a biography of Westinghouse"


class NoDamage(ValueError):
    """A record without what a report of damage needs."""


@dataclass(frozen=True)
class Damage:
    """Findings at the end of a run, in SI units; arrays are over `depth` [m]."""

    time: float  # s, of the end
    hottest: float  # K, of the tread so far
    place: float  # rad, wheel.angle at which the place touches that became hottest over its depth
    flats: int  # places heated in one piece
    hot_places: int  # their parts that are still hot
    flat_length: float  # m
    flat_depth: float  # m
    flattening: float  # m
    ac1_depth: float  # m
    martensite_depth: float  # m
    cooling_rate: float  # K/s, of the point longest above Ac1
    time_above_ac1: float  # s
    melted: float  # m
    rail_peak: float  # K
    used: float | None  # share of the friction limit of the cold rail that a locked wheel used; None: never locked, or not recorded
    depth: np.ndarray
    peak: np.ndarray  # K
    martensite: np.ndarray  # 1, that there is at the end
    hardness: np.ndarray  # HV; NaN where steel that was above Ac1 has not become martensite or cold yet

    @property
    def final(self) -> bool:
        """Whether nothing is hot any more, so that findings do not change by themselves."""
        return self.hot_places == 0

    def rows(self) -> list[tuple[str, str]]:
        """Findings as texts, name and value with unit."""
        state = "cold: the findings are final" if self.final else "still cooling: the findings may change"
        found = [
            ("state", state if self.flats else "no place was heated in one piece"),
            ("hottest point of the tread", f"{self.hottest - ZERO_CELSIUS:.0f} °C"),
            ("hottest point of the rail", f"{self.rail_peak - ZERO_CELSIUS:.0f} °C"),
            ("depth of the flat", f"{1e6 * self.flat_depth:.1f} µm"), ("length of the flat", f"{1e3 * self.flat_length:.1f} mm"),
            ("places heated in one piece", str(self.flats)),
        ]  # fmt: skip
        if not self.flats:
            return found
        so_far = "" if self.final else " so far"
        hardest = f"{np.nanmax(self.hardness):.0f} HV{so_far}" if self.final or self.martensite.any() else "not known before it is cold"
        rate = f"{self.cooling_rate:.0f} K/s" if self.cooling_rate > 0.0 else "not yet at 500 °C" if self.ac1_depth > 0.0 else "never above Ac1"
        return found + [
            ("touches at wheel.angle", f"{self.place:.4f} rad, {np.degrees(self.place):.1f}°"),
            ("depth above Ac1", f"{1e3 * self.ac1_depth:.3f} mm"), ("longest time above Ac1", f"{self.time_above_ac1:.3f} s"),
            ("cooling from 800 to 500 °C", rate), ("depth of martensite, half or more", f"{1e3 * self.martensite_depth:.3f} mm{so_far}"),
            ("largest hardness", hardest), ("molten layer at most", f"{1e6 * self.melted:.0f} µm"),
        ]  # fmt: skip

    def comparisons(self) -> list[tuple[str, str, str]]:
        """What others observed, what this run shows, and the source; only what the run has something to say to."""
        found = []
        if self.flats:
            shows = f"{1e3 * self.martensite_depth:.2f} mm deep" if self.martensite_depth > 0.0 else "none"
            shows = shows if self.final else "none yet" if self.martensite_depth == 0.0 else f"{shows} so far"
            found.append(("martensite beneath every flat", shows, SILINGE))
        if self.final and self.martensite_depth > 0.0:
            found.append(("hardness of martensite in rail steel 884 HV", f"{np.nanmax(self.hardness):.0f} HV in wheel steel", RAIL))
            found.append(("its depth in a rail 0.23 to 0.31 mm", f"{1e3 * self.martensite_depth:.2f} mm in the wheel", RAIL))
            found.append(("turn off all martensite and several millimetres more", f"more than {1e3 * self.martensite_depth:.1f} mm", SILINGE))
        if self.used is not None:
            found.append(("a locked wheel brakes with less than a third of a rolling one", f"{self.used:.2f} of the limit at rest", GALTON))
        return found

    def lines(self) -> list[str]:
        """The report as lines of text."""
        width = max(len(name) for name, _ in self.rows())
        text = [f"{name:{width}}  {value}" for name, value in self.rows()]
        if self.comparisons():
            text += ["", "observed by others | here | source", *(" | ".join(row) for row in self.comparisons())]
        return text


def report(run: xarray.Dataset, *, steel: Mapping[str, float] = STEEL, base: float = BASE) -> Damage:
    """The findings at the end of a record made with `depth=True`.

    `steel` is the composition in weight percent (C, Mn, Cr, Si, Ni) and `base` [HV] the hardness of the wheel as it was.
    """
    missing = [name for name in (*OUTPUTS, *PROFILES) if name not in run]
    if missing:
        raise NoDamage(f"the record has no {missing[0]}: make it with depth=True and all outputs")
    run = in_si(run)
    last = {name.split(".")[1]: run[name].values[-1] for name in OUTPUTS}
    if unknown := [name for name, value in last.items() if not np.isfinite(value)]:
        raise NoDamage(f"the record has no value of damage.{unknown[0]} at its end: cut it off where its values end")
    peak, martensite = (run[name].values[-1] for name in PROFILES)
    whole = {name: int(last.pop(name)) for name in ("flats", "hot_places")}
    numbers = {name: float(value) for name, value in last.items() if name not in ("peak_temperature", "hottest_point")}
    # While the point that was hottest longest is above 500 degC, steel that is cold has cooled at least as fast as martensite needs.
    given = json.loads(run.attrs.get("parameters", "{}"))
    rate = numbers["cooling_rate"] or float(given.get("damage.critical_cooling", 50.0))
    hard = hardness(martensite, rate, steel, base)
    if whole["hot_places"]:
        hard[(run["depth"].values <= numbers["ac1_depth"]) & (martensite == 0.0)] = np.nan
    return Damage(
        time=float(run["time"][-1]), hottest=float(last["peak_temperature"]), place=float(last["hottest_point"]), used=_used(run),
        depth=run["depth"].values, peak=peak, martensite=martensite, hardness=hard, **whole, **numbers,
    )  # fmt: skip


def hardness(martensite: np.ndarray, cooling_rate: float, steel: Mapping[str, float] = STEEL, base: float = BASE) -> np.ndarray:
    """Vickers hardness [HV] of steel with shares of martensite [1], an array: that of martensite and of the steel as it was, `base`,
    by their shares.

    Martensite has 127 + 949 C + 27 Si + 11 Mn + 8 Ni + 16 Cr + 21 lg V, in weight percent, V [K/h] the cooling rate (Maynier,
    Dollet and Bastien 1978, from memory; the terms of composition were read in a second source). `cooling_rate` is in K/s.
    """
    weight = {"C": 949.0, "Si": 27.0, "Mn": 11.0, "Ni": 8.0, "Cr": 16.0}
    quenched = 127.0 + sum(factor * steel.get(name, 0.0) for name, factor in weight.items())
    quenched += 21.0 * np.log10(max(3600.0 * cooling_rate, 1.0))
    share = np.clip(martensite, 0.0, 1.0)
    return share * quenched + (1.0 - share) * base


def settle(wheel: Wheel, *, step: float = 5e-3, longest: float = 120.0, progress: bool = True) -> float:
    """Steps a wheel on, by `step` [s], until no place of its tread is hot; returns the seconds that took.

    Inputs stay as they are: release the brake before. Records of the wheel go on, and take a sample at the end. The bar of the
    `progress` shows on a terminal only. Raises `TimeoutError` after `longest` [s].
    """
    from .progress import Bar, is_terminal

    begin = wheel.time
    with Bar(desc="cooling", bar_format=BAR, disable=not (progress and is_terminal(sys.stderr))) as bar:
        while hot := wheel.get("damage.hot_places"):
            if wheel.time - begin > longest:
                raise TimeoutError(f"{hot} places of the tread are still hot after {longest:g} s")
            wheel.step(step)
            bar.set_postfix_str(f"{wheel.time - begin:.2f} s rolled, {hot} places hot", refresh=False)
            bar.update()
    wheel.sample()
    return wheel.time - begin


def _used(run: xarray.Dataset) -> float | None:
    """Mean share that a locked, travelling wheel uses of the friction limit of the cold rail."""
    if not {"wheel.omega", "wheel.velocity", "contact.force_x", "contact.force_y"} <= set(run.data_vars):
        return None
    locked = (run["wheel.omega"].values == 0.0) & (np.abs(run["wheel.velocity"].values) > 1.0) & (run["contact.force_y"].values > 0.0)
    cold = run["rail.friction"].values if "rail.friction" in run else json.loads(run.attrs.get("inputs", "{}")).get("rail.friction")
    if not locked.any() or cold is None or not np.all(cold):
        return None
    return float(np.mean((np.abs(run["contact.force_x"].values) / (cold * run["contact.force_y"].values))[locked]))


def add_command(commands: Any) -> None:
    """Adds the command to those of `wheelrail`."""
    command = commands.add_parser("damage", help="what a slide left in the wheel: flats, martensite, hardness over depth")
    command.add_argument("run", type=Path, help="NetCDF record of a run with depth=True")
    command.add_argument("--out", type=Path, help="CSV over the depth; default: beside RUN")


def run(options: Namespace) -> None:
    """Prints the report and writes peak temperature, martensite and hardness over the depth."""
    found = made_of(options.run, report)
    out = options.out or beside(options.run, "damage")
    columns = beside(out, "columns")
    rows = zip(found.depth, found.peak, found.martensite, found.hardness)
    text = lambda v: "" if np.isnan(v) else f"{v:.9g}"
    write_rows(out, [("depth", "peak_temperature", "martensite", "hardness"), *([text(v) for v in row] for row in rows)])
    write_columns(columns, [
        ("depth", "m", "below the tread"), ("peak_temperature", "K", "highest so far at that depth"),
        ("martensite", "1", "largest share that there is at the end"),
        ("hardness", "HV", "of that share and of the steel as it was; empty where it is not known before the steel is cold"),
    ])  # fmt: skip
    print("\n".join(found.lines()))
    print(f"written: {out}, {columns}")
