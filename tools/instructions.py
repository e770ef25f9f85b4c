#!/usr/bin/env python3
"""Machine instructions of a step, counted by valgrind, beside those that are kept: make bench NAME=instructions

    tools/instructions.py            counts, and says where more than 5 % have been added
    tools/instructions.py --accept   keeps what it counts in benches/instructions.json

Times on a shared machine differ by more than most changes of the code; instructions do not. They differ with the compiler
and with the vector registers of the machine, so that growth is told here and is no failure of a test.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import figures

ROOT = Path(__file__).resolve().parent.parent
KEPT = ROOT / "benches" / "instructions.json"
COUNTED = "wheelrail::simulation::Simulation::advance*"
GROWTH = 0.05
STEPS = 60
COLUMNS = ("time", "drive.moment", "brake.torque", "drive.lateral_velocity")
PERIOD = 0.04  # of a moment that varies, s
MOMENT = -7000.0  # about half of the adhesion limit, N m
COLD = {"thermal.enabled": "false"}
ELLIPSE = {"preset": "railway_ellipse"}
SIDEWAYS = {"contact.lateral": "true"}
# Name, parameters, and inputs by time: a line of a scenario each, of the first of these columns.
HELD = [f"{time},{MOMENT},0" for time in (0, 1)]
SWAYING = [f"{k * PERIOD / 2},{MOMENT},0,{-0.05 if k % 2 else 0.05}" for k in range(10)]
VARYING = [f"{k * PERIOD / 2},{MOMENT * (1.3 if k % 2 else 0.7)},0" for k in range(10)]
LOCKING = ["0,0,7000", "0.02,0,7000", "0.02,0,40000", "1,0,40000"]
CASES = {
    "line, held": ({}, HELD),
    "line, varying": ({}, VARYING),
    "line without heat, held": (COLD, HELD),
    "line without heat, varying": (COLD, VARYING),
    "line, brake that locks": ({}, LOCKING),
    "seven lines, varying": (ELLIPSE, VARYING),
    "seven lines without heat, held": (ELLIPSE | COLD, HELD),
    "seven lines without heat, varying": (ELLIPSE | COLD, VARYING),
    "seven lines sideways without heat, held": (ELLIPSE | COLD | SIDEWAYS, HELD),
    "seven lines sideways without heat, swaying": (ELLIPSE | COLD | SIDEWAYS, SWAYING),
}


def command(program, folder, parameters, lines):
    """The command that simulates a case in a folder."""
    scenario = folder / "scenario.csv"
    names = COLUMNS[: lines[0].count(",") + 1]
    scenario.write_text("\n".join([",".join(names), *lines]) + "\n")
    settings = {"initial.velocity": "27"} | {name: value for name, value in parameters.items() if name != "preset"}
    sets = [word for name, value in settings.items() for word in ("--set", f"{name}={value}")]
    places = ["--resources", str(ROOT / "resources"), "--cache", str(ROOT / "target"), "--out", str(folder / "run.csv")]
    run = ["--preset", parameters.get("preset", "railway"), "--scenario", str(scenario), "--stop", str(STEPS * 1e-3)]
    return [str(program), "simulate", *places, *run, *sets]


def count(program, parameters, lines):
    """Instructions of a step, on average."""
    with tempfile.TemporaryDirectory() as folder:
        valgrind = ["valgrind", "--tool=callgrind", f"--toggle-collect={COUNTED}", f"--callgrind-out-file={folder}/callgrind"]
        simulate = command(program, Path(folder), parameters, lines)
        run = subprocess.run([*valgrind, *simulate], cwd=ROOT, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode or not found or found[1] == "0":
        raise SystemExit(f"instructions cannot be counted: {run.stderr.strip() or COUNTED + ' is not called'}")
    return int(found[1]) / STEPS


def report(counts, kept):
    """A line for each case, and the names of those that have grown."""
    lines, grown = [], []
    for name, now in counts.items():
        change = now / kept[name] - 1.0 if name in kept else None
        if change is not None and change > GROWTH:
            grown.append(name)
        beside = "new" if change is None else f"{100 * change:+.1f} %" + (" MORE THAN BEFORE" if name in grown else "")
        lines.append(f"{name:36} {now / 1e6:8.3f} million instructions a step  {beside}")
    return lines, grown


def figure(name, instructions):
    """The line of a count that pages show.

    >>> figure("line, held", 811646)
    'figure: instructions.line.held [million] = 0.8116 ± 0.2'
    """
    return f"figure: instructions.{'.'.join(re.findall('[a-z]+', name))} [million] = {1e-6 * instructions:.4f} ± 0.2"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--binary", type=Path, default=ROOT / "target" / "release" / "wheelrail")
    parser.add_argument("--accept", action="store_true", help=f"keep the counts in {KEPT.relative_to(ROOT)}")
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        print("instructions not counted: valgrind is not installed")
        return
    # Counts do not depend on what runs beside them.
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda case: count(arguments.binary, *case), CASES.values())
        counts = dict(zip(CASES, found, strict=True))
    lines, grown = report(counts, json.loads(KEPT.read_text()) if KEPT.exists() else {})
    print("\n".join(lines))
    figures.keep("\n".join(figure(*case) for case in counts.items()), "make bench NAME=instructions")
    if arguments.accept:
        KEPT.write_text(json.dumps({name: round(value) for name, value in counts.items()}, indent=1) + "\n")
        print(f"written: {KEPT.relative_to(ROOT)}")
    elif grown:
        print(f"more than {100 * GROWTH:g} % have been added: {'; '.join(grown)}. If they are worth it: tools/instructions.py --accept")


if __name__ == "__main__":
    main()
