#!/usr/bin/env python3
"""CPU time of every test program, as `cargo test` runs them: table of user and system seconds.

    tools/test_times.py                       the programs of the product and of the thesis, and compiling them
    tools/test_times.py --test heat_steps     arguments are handed to cargo test
    tools/test_times.py --each --test brake   every test in a process of its own: CPU seconds per test
    tools/test_times.py --python .venv/bin/python --out target/test-times.md
                                              pytest as well, and the table as a page

Times are those of the process and of all the processes that it waited for. Cargo starts each program through this script
(`--run`), so that folder and environment are those of an ordinary test.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PRODUCT, THESIS = "product", "thesis"


def timed(command, **options):
    """Exit code, CPU [s] and wall time [s] of a command."""
    start = os.times()
    with subprocess.Popen(command, **options) as process:
        code = process.wait()
    end = os.times()
    cpu = end.children_user - start.children_user + end.children_system - start.children_system
    return code, cpu, end.elapsed - start.elapsed


def name_of(program):
    """Name of a test program without the hash that cargo appends.

    >>> name_of("/target/release/deps/heat_steps-0a1b2c3d4e5f6a7b")
    'heat_steps'
    """
    return Path(program).name.rsplit("-", 1)[0]


def run(program, arguments, log, each):
    """Runs a test program in the place of cargo and appends its time to the log."""
    names = [None]
    if each:
        listed = subprocess.run([program, "--list", "--format", "terse"], capture_output=True, text=True, check=True)
        names = [line.removesuffix(": test") for line in listed.stdout.splitlines() if line.endswith(": test")]
    worst = 0
    for name in names:
        code, cpu, wall = timed([program, *arguments, *(["--exact", name] if name else [])])
        worst = max(worst, abs(code))
        with open(log, "a") as file:
            file.write(json.dumps({"name": f"{name_of(program)} {name or ''}".strip(), "cpu": cpu, "wall": wall}) + "\n")
    sys.exit(worst)


def measured(cargo, package, arguments, each):
    """Times of compiling and of every test program of a package, and if all tests passed."""
    command = [cargo, "test", "--release", "--locked", "--no-fail-fast", *package, *arguments]
    code, cpu, wall = timed([*command, "--no-run"], cwd=ROOT)
    if code != 0:
        sys.exit(code)
    compiling = {"cpu": cpu, "wall": wall}
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder) / "times"
        log.touch()
        runner = [sys.executable, str(Path(__file__).resolve()), *(["--each"] if each else []), "--run", str(log)]
        code, cpu, wall = timed([*command, "--config", f'target."cfg(all())".runner = {json.dumps(runner)}'], cwd=ROOT)
        rows = [json.loads(line) for line in log.read_text().splitlines()]
    rest = cpu - sum(row["cpu"] for row in rows)
    return compiling, rows + [{"name": "cargo and documentation tests", "cpu": rest, "wall": 0.0}], code == 0


def table(parts, compiling):
    """Page of the times.

    >>> print(table({"product": [{"name": "a", "cpu": 1, "wall": 1}, {"name": "b", "cpu": 2.25, "wall": 2}]}, 0.0))
    | program | CPU \\\\[s\\\\] | wall \\\\[s\\\\] |
    |---|---|---|
    | b | 2.2 | 2.0 |
    | a | 1.0 | 1.0 |
    | **product** | **3.2** | **3.0** |
    | **all tests** | **3.2** | |
    | compiling the tests, dependencies compiled before | 0.0 | |
    """
    lines = ["| program | CPU \\\\[s\\\\] | wall \\\\[s\\\\] |", "|---|---|---|"]
    total = 0.0
    for part, rows in parts.items():
        for row in sorted(rows, key=lambda row: -row["cpu"]):
            lines.append(f"| {row['name']} | {row['cpu']:.1f} | {row['wall']:.1f} |")
        cpu, wall = (sum(row[key] for row in rows) for key in ("cpu", "wall"))
        lines.append(f"| **{part}** | **{cpu:.1f}** | **{wall:.1f}** |")
        total += cpu
    lines.append(f"| **all tests** | **{total:.1f}** | |")
    lines.append(f"| compiling the tests, dependencies compiled before | {compiling:.1f} | |")
    return "\n".join(lines)


def main():
    if "--run" in sys.argv:
        at = sys.argv.index("--run")
        log, program, *arguments = sys.argv[at + 1 :]
        run(program, arguments, log, "--each" in sys.argv[:at])
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--each", action="store_true", help="every test in a process of its own")
    parser.add_argument("--python", help="Python that runs the tests of the packed FMU, too")
    parser.add_argument("--out", type=Path, help="page to write")
    parser.add_argument("--cargo", default=os.environ.get("CARGO", "cargo"))
    options, arguments = parser.parse_known_args()
    packages = {PRODUCT: [], THESIS: ["-p", "wheelrail-thesis"]} if not arguments else {PRODUCT: []}
    parts, compiling, passed = {}, 0.0, True
    for name, package in packages.items():
        built, parts[name], good = measured(options.cargo, package, arguments, options.each)
        compiling, passed = compiling + built["cpu"], passed and good
    if options.python:
        command = [options.python, "-m", "pytest", "--numprocesses", "logical", "fmpy_tests"]
        code, cpu, wall = timed(command, cwd=ROOT)
        parts["packed FMU"] = [{"name": "pytest fmpy_tests", "cpu": cpu, "wall": wall}]
        passed = passed and code == 0
    page = table(parts, compiling)
    print(page)
    if options.out:
        options.out.write_text(f"# CPU time of the tests\n\n{page}\n")
    sys.exit(not passed)


if __name__ == "__main__":
    main()
