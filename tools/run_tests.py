#!/usr/bin/env python3
"""The tests of packages as `cargo test` runs them, several programs at a time: most of them keep one core busy.

    tools/run_tests.py -p wheelrail -p wheelrail-slave     arguments are handed to cargo test

Cargo hands every program to this script (`--keep`), which notes it with its folder and environment; then they run, one on
each core, and each prints what it has to say when it has ended. Tests of the documentation follow. What tests print is
searched for the figures of the pages (figures.py), and shown if they fail.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path

import figures

ROOT = Path(__file__).resolve().parent.parent
# All but the tests of the documentation, unless some are chosen.
KINDS = ("--lib", "--bins", "--tests")
CHOICES = ("--lib", "--bin", "--test", "--example", "--doc")


def keep(queue, command):
    """Notes a command with the folder and the environment in which it is to run."""
    with open(queue, "a") as file:
        file.write(json.dumps({"command": command, "folder": os.getcwd(), "environment": dict(os.environ)}) + "\n")


def kept(cargo):
    """The programs that a command of cargo would run."""
    with tempfile.TemporaryDirectory() as folder:
        queue = Path(folder) / "queue"
        queue.touch()
        runner = json.dumps([sys.executable, str(Path(__file__).resolve()), "--keep", str(queue)])
        kinds = () if set(CHOICES) & set(cargo) else KINDS
        if subprocess.run([*cargo, *kinds, "--quiet", "--config", f'target."cfg(all())".runner = {runner}'], cwd=ROOT).returncode:
            sys.exit(1)
        return [json.loads(line) for line in queue.read_text().splitlines()]


def run(program):
    """Name, exit code, output and wall time [s] of a program."""
    start = time.monotonic()
    done = subprocess.run(
        [*program["command"], "--show-output"], cwd=program["folder"], env=program["environment"], text=True, errors="replace",
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    name = Path(program["command"][0]).name.rsplit("-", 1)[0]
    # Without what tests said that have passed.
    said, code = re.sub(r"\nsuccesses:\n.*?(?=\n(?:failures|test result):)", "", done.stdout, flags=re.DOTALL), done.returncode
    try:
        figures.keep(done.stdout, "unit tests" if name == "wheelrail" else name)
    except ValueError as error:
        said, code = f"{said}{error}\n", code or 1
    return name, code, said, time.monotonic() - start


def main(arguments):
    """Exit code: 1 if a program fails, or if there is none."""
    cargo = [os.environ.get("CARGO", "cargo"), "test", "--release", "--locked", *arguments]
    failed, programs = [], kept(cargo)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for future in as_completed([pool.submit(run, program) for program in programs]):
            name, code, output, wall = future.result()
            print(f"\n     {name}, {wall:.1f} s{output}", flush=True)
            failed += [name] if code else []
    if not set(CHOICES) & set(arguments) and subprocess.run([*cargo, "--doc"], cwd=ROOT).returncode:
        failed.append("tests of the documentation")
    print(f"{len(programs)} programs; failed: {', '.join(failed) or 'none'}")
    return 1 if failed or not programs else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--keep"]:
        keep(sys.argv[2], sys.argv[3:])
    else:
        sys.exit(main(sys.argv[1:]))
