"""Run_tests.py with a cargo that is made up: python3 -m unittest discover tools."""

import contextlib
import io
import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import run_tests

# Hands its programs to the runner that it is told, each in the folder and with the variable that tests see.
CARGO = """#!{python}
import json, os, subprocess, sys
for argument in sys.argv:
    if argument.startswith("target."):
        runner = json.loads(argument.split(" = ")[1])
        for program in {programs}:
            environment = dict(os.environ, WHEEL="round")
            if subprocess.run([*runner, program, "--nocapture"], cwd="{folder}", env=environment).returncode:
                sys.exit(1)
sys.exit({documentation} if "--doc" in sys.argv else {build})
"""
PROGRAM = "#!/bin/sh\necho $WHEEL in $PWD, $1\nexit {code}\n"


class Programs(unittest.TestCase):
    def outcome(self, codes, build=0, documentation=0):
        """Exit code and output with programs that end with `codes`."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name).resolve()
            programs = {str(folder / f"program{k}-0a1b"): PROGRAM.format(code=code) for k, code in enumerate(codes)}
            fake = CARGO.format(
                python=sys.executable, programs=list(programs), folder=folder, build=build, documentation=documentation
            )
            for path, text in (programs | {str(folder / "cargo"): fake}).items():
                Path(path).write_text(text)
                Path(path).chmod(0o755)
            said = io.StringIO()
            with mock.patch.dict(os.environ, CARGO=str(folder / "cargo")), contextlib.redirect_stdout(said):
                try:
                    code = run_tests.main(["-p", "wheel"])
                except SystemExit as end:
                    code = end.code
            return code, said.getvalue().replace(str(folder), "FOLDER")

    def test_every_program_runs_where_and_as_cargo_would_run_it(self):
        code, said = self.outcome([0, 0, 0])
        self.assertEqual(code, 0)
        self.assertEqual(said.count("round in FOLDER, --nocapture"), 3)
        self.assertIn(" s of CPU; failed: none", said)

    def test_each_failure_is_named_and_stops_no_other_program(self):
        code, said = self.outcome([0, 101, 0, 1], documentation=1)
        self.assertEqual((code, said.count("round in FOLDER")), (1, 4))
        last = said.strip().splitlines()[-1]
        self.assertTrue(all(name in last for name in ("program1", "program3", "documentation")), last)
        self.assertNotIn("program0", last)

    def test_what_does_not_compile_and_a_package_without_tests_are_failures(self):
        self.assertEqual(self.outcome([0], build=1)[0], 1)
        self.assertEqual(self.outcome([])[0], 1)


if __name__ == "__main__":
    unittest.main()
