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
STEPS = 60  # of a case of benches/instructions.rs


def built():
    """The program of benches/instructions.rs, which is compiled if need be."""
    command = [os.environ.get("CARGO", "cargo"), "bench", "--locked", "--no-run", "--bench", "instructions", "--message-format", "json"]
    lines = subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    return next(made["executable"] for made in map(json.loads, lines) if made.get("executable"))


def count(program, case):
    """Instructions of a step, on average. Bases are those that tests keep: under valgrind one takes minutes."""
    environment = os.environ | {"WHEELRAIL_CACHE": str(ROOT / "target")}
    with tempfile.TemporaryDirectory() as folder:
        valgrind = ["valgrind", "--tool=callgrind", f"--toggle-collect={COUNTED}", f"--callgrind-out-file={folder}/callgrind"]
        run = subprocess.run([*valgrind, program, case], cwd=ROOT, env=environment, capture_output=True, text=True)
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
    parser.add_argument("--accept", action="store_true", help=f"keep the counts in {KEPT.relative_to(ROOT)}")
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        print("instructions not counted: valgrind is not installed")
        return
    # Counts do not depend on what runs beside them.
    program = built()
    cases = subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = dict(zip(cases, pool.map(lambda case: count(program, case), cases), strict=True))
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
