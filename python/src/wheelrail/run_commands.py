"""Commands that run a wheel: `simulate`, a run over time, and `steady`, stationary rolling at one or many creepages.

What ends a run, Ctrl-C as well, leaves in its files what was computed until then.
"""

from __future__ import annotations

import sys
from argparse import ArgumentTypeError, Namespace
from collections.abc import Mapping
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import numpy as np

from . import operating, runs
from .files import Real, Text, read_csv
from .fmu import Fmu, default_path, fmu_of_wheel
from .output import check_place, write, write_columns
from .records import library
from .samples import LATEST
from .tables import BadFile
from .units import named
from .values import Refused

if TYPE_CHECKING:
    import pandas
    import xarray

OUTPUTS = (
    "wheel.velocity,wheel.omega,wheel.distance,contact.force_x,contact.force_y,contact.moment,contact.creepage,contact.utilisation,"
    "contact.stick_fraction,contact.half_width,contact.pressure_max,temperature.wheel_max,temperature.rail_max,heat.friction_power,"
    "hub.force_x,hub.moment,solver.energy_residual"
)
SUMMARY = (
    "wheel.velocity", "wheel.distance", "contact.creepage", "temperature.wheel_max", "temperature.rail_max", "solver.heat_residual",
    "solver.energy_residual",
)  # fmt: skip
ROLLING = 1.0  # m/s: below, the peak of the creepage is not of interest, which is a ratio of speeds


def add_command(commands: Any) -> None:
    """Adds the commands to those of `wheelrail`."""
    simulate = commands.add_parser("simulate", help="a run over time as a CSV, and a summary on the error stream")
    simulate.add_argument("--scenario", type=Path, metavar="FILE.csv", help="inputs over time: a column time [s], others named after inputs")
    simulate.add_argument("--stop", type=float, metavar="S", help="end of the run [s], default: that of the scenario, or 1")
    simulate.add_argument("--step", type=float, default=1e-3, metavar="S", help="communication step [s], default %(default)g")
    simulate.add_argument("--outputs", default=OUTPUTS, metavar="NAMES", help="with commas; profile.pressure stands for all its points")
    simulate.add_argument("--every", type=int, default=1, metavar="N", help="write every Nth communication point only, and the last")
    simulate.add_argument("--columns", type=Path, metavar="FILE.csv", help="names, units and meanings of the columns")
    simulate.add_argument("--wheel-profile", type=Path, metavar="FILE.csv", help="profile of the wheel at the end, for wheel.profile of another run")
    steady = commands.add_parser("steady", help="stationary rolling: forces over creepage, or one operating point")
    steady.add_argument("--velocity", type=float, metavar="M/S", help="default: initial.velocity")
    steady.add_argument(
        "--creepage", type=operating.ranged, metavar="X|FROM:TO:COUNT", help="default: up to 1.5 times Carter's full slip in 16 points"
    )
    steady.add_argument("--table", action="store_true", help="a table in everyday units instead of a CSV")
    for command in (simulate, steady):
        command.add_argument("--preset", metavar="NAME", help="parameter set, default railway")
        command.add_argument(
            "--set", dest="settings", type=setting, action="append", default=[], metavar="NAME=VALUE", help="a parameter or input; repeatable"
        )
        command.add_argument("--out", type=Path, metavar="FILE.csv", help="default: standard output")
        command.add_argument("--fmu", type=Path, default=default_path(), help="default: %(default)s")


def run(options: Namespace) -> None:
    """Runs one of the commands. What is refused before anything is computed is a wrong argument."""
    try:
        with fmu_of_wheel(options.fmu, " or with --fmu") as fmu:
            (simulate if options.command == "simulate" else steady)(options, fmu)
    except (Refused, ValueError, ImportError) as error:
        if hasattr(error, "run"):
            raise
        raise BadFile(str(error)) from None


def setting(text: str) -> tuple[str, object]:
    """Name and value of NAME=VALUE: a number where it is one, else the text."""
    name, sign, value = map(str.strip, text.partition("="))
    if not (name and sign):
        raise ArgumentTypeError(f"{text!r}: expected NAME=VALUE, such as drive.load=8e4")
    try:
        return name, float(value)
    except ValueError:
        return name, value


def given(options: Namespace, fmu: Fmu) -> tuple[dict[str, object], dict[str, object]]:
    """Parameters and inputs of `--preset` and `--set`."""
    found = {"parameter": {"preset": options.preset} if options.preset else {}, "input": {}}
    for name, value in options.settings:
        variable = fmu.variable(named(name, fmu.variables)[0])
        if variable.causality not in found:
            raise Refused(f"{name} is of causality {variable.causality} and cannot be set")
        if variable.type == "Boolean" and value in ("true", "false"):
            value = value == "true"
        found[variable.causality][name] = value
    return found["parameter"], found["input"]


def scenario(fmu: Fmu, path: Path) -> dict[str, object]:
    """Inputs over time of a CSV with the column `time` [s] and columns named after inputs; choices stand there by name or number."""
    inputs = {name: _field(variable) for name, variable in fmu.variables.items() if variable.causality == "input"}
    falls = lambda row, before: before and row["time"] < before["time"] and f"time = {row['time']:g} s follows {before['time']:g} s"
    columns = read_csv(path, {"time": Real(-LATEST, LATEST, "s", "seconds of the run")} | inputs, falls)
    times = columns.pop("time")
    choices = {name: [int(v) if v.isdigit() else v for v in values] for name, values in columns.items() if isinstance(values[0], str)}
    return {name: (times, values) for name, values in (columns | choices).items() if values[0] not in (None, "")}


def _field(variable):
    """What the file of a scenario may say of an input."""
    about = (variable.description or variable.name).split(";")[0]
    if variable.type == "Real":
        low, high = (float(edge) if edge is not None else sign * np.inf for edge, sign in ((variable.min, -1.0), (variable.max, 1.0)))
        return Real(low, high, variable.unit or "1", about, optional=True)
    names = [item.name for item in variable.declaredType.items]
    return Text(about, "", (*names, *map(str, range(1, len(names) + 1))))


def simulate(options: Namespace, fmu: Fmu) -> None:
    """A run to a CSV, with a summary."""
    _apart(options)
    parameters, inputs = given(options, fmu)
    if options.wheel_profile:
        parameters["wheel.profile_save"] = str(options.wheel_profile)
    inputs |= scenario(fmu, options.scenario) if options.scenario else {}
    names = [name.strip() for name in options.outputs.split(",")]
    recorded = [*(name.partition("[")[0] for name in names), *SUMMARY]
    began = perf_counter()
    record, ended = _ran(runs.simulate, parameters, inputs, stop=options.stop, step=options.step, outputs=recorded, every=options.every, fmu=fmu)
    wall = perf_counter() - began
    rows = frame(record, names)
    if options.columns:
        about = {name: fmu.variable(name) for name in rows.columns}
        rows_about = [(name, v.unit or "", v.description) for name, v in about.items()]
        write_columns(options.columns, [("time", "s", "Time"), *rows_about])
    text = rows.to_csv(lineterminator="\n")
    write(options.out, text) if options.out else sys.stdout.write(text)
    if ended:
        for path in filter(None, (options.out, options.wheel_profile)):
            print(f"{path} holds what was computed up to {float(record.time[-1])} s", file=sys.stderr)
        raise ended
    print("\n".join(summary(fmu, record, wall)), file=sys.stderr)


def _ran(function, *arguments, **named):
    """What a run gives, and None; or what it gave until something ended it, and that."""
    try:
        return function(*arguments, **named), None
    except (Refused, KeyboardInterrupt) as failure:
        if not hasattr(failure, "run"):
            raise
        return failure.run, failure


def _apart(options):
    """Refuses two files in one place, results over the scenario, or under the profile of the wheel, and places for none."""
    seen = {}
    for option in ("--out", "--scenario", "--columns", "--wheel-profile"):
        path = getattr(options, option[2:].replace("-", "_"), None)
        if path and (first := seen.setdefault(path.resolve(), option)) != option:
            raise BadFile(f"{first} and {option} are one file, {path}; give each a path of its own")
        if path and option != "--scenario":
            check_place(path, option)


def frame(record: xarray.Dataset, names: list[str]) -> pandas.DataFrame:
    """The outputs of a record that are asked for, over the time; those with points in a column for each, from `[1]` on."""
    columns = {}
    for name in names:
        stem, _, point = name.partition("[")
        if stem not in record and "depth" not in record:
            raise BadFile(f"{stem} does not change over time: name a profile over the depth beside it, such as profile.peak_temperature")
        values = record[stem].values if stem in record else np.tile(record["depth"].values, (record.sizes["time"], 1))
        found = {name: values} if values.ndim == 1 else {f"{stem}[{k}]": column for k, column in enumerate(values.T, 1)}
        if point and name not in found:
            raise BadFile(f"{name}: {stem} has {len(found)} points")
        columns |= {name: found[name]} if point else found
    flags = {name: np.where(values, "true", "false") for name, values in columns.items() if values.dtype == bool}
    return library("pandas").DataFrame(columns | flags, index=record["time"].to_index())


def summary(fmu: Fmu, record: xarray.Dataset, wall: float) -> list[str]:
    """Lines about a run, in everyday units. Peaks are those of the points that were recorded."""
    at_end = {name: float(record[name][-1]) for name in SUMMARY}
    creepage = record["contact.creepage"].values[np.abs(record["wheel.velocity"].values) > ROLLING]
    peak = max(float(record[f"temperature.{body}_max"].max()) for body in ("wheel", "rail"))
    figures = {"speed at the end": "wheel.velocity", "distance": "wheel.distance", "peak creepage (above 1 m/s)": "contact.creepage"}
    figures |= {"peak temperature": "temperature.wheel_max", "heat residual": "solver.heat_residual"} if peak > 0.0 else {}
    figures |= {"energy residual": "solver.energy_residual"}
    at_end |= {"contact.creepage": max(creepage, key=abs, default=0.0), "temperature.wheel_max": peak}
    simulated = float(record.time[-1])
    lines = ["  {:<28}{:>11} {}".format(what, *shown(fmu, name, at_end[name])).rstrip() for what, name in figures.items()]
    return [*lines, f"  {'real-time factor':<28}{simulated / wall:#11.4g} x ({simulated:g} s in {wall:.4g} s, with the start)"]


def shown(fmu: Fmu, name: str, value: float) -> tuple[str, str]:
    """A value with four digits in the unit for people, and that unit."""
    variable = fmu.variable(name)
    known = {unit.name: unit.displayUnits for unit in fmu.description.unitDefinitions}
    display = next((each for each in known.get(variable.unit, ()) if each.name == variable.displayUnit), None)
    unit = display.name if display else variable.unit or ""
    value = value * float(display.factor) + float(display.offset or 0.0) if display else value
    return f"{value:#.4g}" if value else "0", "" if unit == "1" else unit


def steady(options: Namespace, fmu: Fmu) -> None:
    """A curve over the creepage to a CSV, or as a table."""
    _apart(options)
    parameters, inputs = given(options, fmu)
    curve, ended = _ran(operating.steady, parameters, inputs, creepage=options.creepage, velocity=options.velocity, fmu=fmu)
    rows = curve.to_dataframe()
    text = table(fmu, rows) if options.table else rows.to_csv(index=False, lineterminator="\n")
    write(options.out, text) if options.out else sys.stdout.write(text)
    if ended:
        count = operating.COUNT if options.creepage is None else len(options.creepage)
        if options.out:
            print(f"{options.out} holds the first {len(rows)} of {count} creepages", file=sys.stderr)
        raise ended


def table(fmu: Fmu, rows: Mapping[str, Any]) -> str:
    """Columns under short names and units for people."""
    cells = [[name.rpartition(".")[2], f"[{shown(fmu, name, 1.0)[1] or 1}]", *(shown(fmu, name, value)[0] for value in rows[name])] for name in rows]
    return "".join(" ".join(f"{cell:>14}" for cell in line) + "\n" for line in zip(*cells))
