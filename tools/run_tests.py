#!/usr/bin/env python3
"""The tests of packages as `cargo test` runs them, several programs at a time: most of them keep one core busy.

    tools/run_tests.py -p wheelrail -p wheelrail-slave     arguments are handed to cargo test

Cargo hands every program to this script (`--keep`), which notes it with its folder and environment. Every file of a program
that lies in a folder of tests/ then runs in a process of its own, one on each core, and each prints what it has to say when it
has ended. Tests of the documentation follow. What tests print is searched for the figures of the pages (figures.py), and shown
if they fail.
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
# So many of the longest are named at the end.
LONGEST = 12


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


def files(program):
    """The runs of a program: one for every file of tests, with its name, if it consists of files; else one."""
    command, name = program["command"], Path(program["command"][0]).name.rsplit("-", 1)[0]
    if not (ROOT / "tests" / name / "main.rs").is_file():
        return [program | {"name": name}]
    listed = subprocess.run(
        [*command, "--list", "--format", "terse"], cwd=program["folder"], env=program["environment"], text=True, check=True, stdout=subprocess.PIPE
    ).stdout
    tests = [line.removesuffix(": test") for line in listed.splitlines() if line.endswith(": test")]
    of_file = {}
    for test in tests:
        of_file.setdefault(test.split("::")[0], []).append(test)
    return [program | {"name": file, "command": [*command, "--exact", *names]} for file, names in of_file.items()]


def run(program):
    """Name, exit code, output, wall time and CPU time [s] of a run."""
    start, name = time.monotonic(), program["name"]
    process = subprocess.Popen(
        [*program["command"], "--show-output"], cwd=program["folder"], env=program["environment"], text=True, errors="replace",
        stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
    )  # fmt: skip
    with process.stdout:
        output = process.stdout.read()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = code = os.waitstatus_to_exitcode(status)
    # Without what tests said that have passed.
    said = re.sub(r"\nsuccesses:\n.*?(?=\n(?:failures|test result):)", "", output, flags=re.DOTALL)
    try:
        figures.keep(output, "unit tests" if name == "wheelrail" else name)
    except ValueError as error:
        said, code = f"{said}{error}\n", code or 1
    return name, code, said, time.monotonic() - start, used.ru_utime + used.ru_stime


def main(arguments):
    """Exit code: 1 if a program fails, or if there is none."""
    cargo = [os.environ.get("CARGO", "cargo"), "test", "--release", "--locked", *arguments]
    failed, times, programs = [], [], [file for program in kept(cargo) for file in files(program)]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for future in as_completed([pool.submit(run, program) for program in programs]):
            name, code, output, wall, cpu = future.result()
            print(f"\n     {name}, {wall:.1f} s, of CPU {cpu:.1f} s{output}", flush=True)
            failed += [name] if code else []
            times.append((cpu, name))
    if not set(CHOICES) & set(arguments) and subprocess.run([*cargo, "--doc"], cwd=ROOT).returncode:
        failed.append("tests of the documentation")
    print("longest of CPU: " + ", ".join(f"{name} {cpu:.0f} s" for cpu, name in sorted(times, reverse=True)[:LONGEST]))
    print(f"{len(programs)} runs, {sum(cpu for cpu, _ in times):.0f} s of CPU; failed: {', '.join(failed) or 'none'}")
    return 1 if failed or not programs else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--keep"]:
        keep(sys.argv[2], sys.argv[3:])
    else:
        sys.exit(main(sys.argv[1:]))
