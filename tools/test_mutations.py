"""Mutations.py with its table, and with a cargo and tests that are made up: python3 -m unittest discover tools."""

import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import mutations

# Compiles the source into a program that knows it as it was then, and says where that lies.
CARGO = """#!{python}
import json, os, pathlib, sys
if {broken}:
    print(json.dumps({{"message": {{"level": "error", "rendered": "error: no such steel"}}}}))
    sys.exit(101)
build = pathlib.Path(os.environ["CARGO_TARGET_DIR"])
build.mkdir(parents=True, exist_ok=True)
program = build / "steel"
program.write_text({program!r}.replace("SOURCE", repr(pathlib.Path("src/steel.rs").read_text())))
program.chmod(0o755)
kind = ["rlib"] if "--lib" in sys.argv else ["test"]
print(json.dumps({{"executable": str(program), "target": {{"name": "steel", "kind": kind}}, "profile": {{"test": True}}}}))
"""
# Its tests compare the numbers of the source, and of the preset that lies there now, with right ones.
PROGRAM = """#!{python}
import os, pathlib, re, sys
RIGHT = {{"it_is_heavy": "density() -> f64", "it_melts": "MELTS: f64", "its_preset_is_known": "preset", "all_is_well": ""}}
number, factor = (os.environ.get("{switch}") or "0 1").split()
def wrong_by(coefficient):
    return float(factor) if coefficient == int(number) else 1.0
source = SOURCE + "preset " + re.sub(r'.*: ([0-9.]+).*', r"= \\1", pathlib.Path("steel.json").read_text())
right = {{"density() -> f64": 7850.0, "MELTS: f64": 1700.0, "preset": 0.3}}
tests = [test for test in (path.split("::")[-1] for path in sys.argv[2:]) if test in RIGHT]
print(f"running {{len(tests)}} tests")
found = re.compile(r"(density\\(\\) -> f64|MELTS: f64|preset) [={{]+ ?([^;}}\\n]+)")
values = {{name: eval(text.replace("crate::", "")) for name, text in found.findall(source)}}
sys.exit(any(abs(values[RIGHT[test]] / right[RIGHT[test]] - 1) > 0.01 for test in tests if RIGHT[test]) and 101)
"""
STEEL = """pub fn melts() -> f64 {
    const MELTS: f64 = 1700.0;
    MELTS
}
pub fn density() -> f64 { 7850.0 }
pub fn width() -> f64 { 2.0 }
const BOILS: f64 = 3000.0;
"""
TESTS = "".join(f"#[test]\nfn {test}() {{}}\n" for test in ("it_is_heavy", "it_melts", "its_preset_is_known", "all_is_well"))
TABLE = """
[[group]]
file = "src/steel.rs"
test = "steel::it_is_heavy"
coefficients = [["density", "density() -> f64 { «7850.0» }"]]
[[group]]
file = "src/steel.rs"
test = "steel::it_melts"
coefficients = [["melting", "MELTS: f64 = «1700.0»"]]
[[group]]
file = "steel.json"
test = "steel::its_preset_is_known"
coefficients = [["preset", '"friction": «0.3»']]
"""
UNTESTED = TABLE + """
[[group]]
file = "src/steel.rs"
test = "steel::all_is_well"
coefficients = [["width", "width() -> f64 { «2.0» }"]]
"""


class Mutations(unittest.TestCase):
    def outcome(self, *arguments, table=TABLE, steel=STEEL, broken=False):
        """Exit code, output and the files of the copy; those of the checkout stay as they are."""
        with tempfile.TemporaryDirectory() as name:
            root = Path(name).resolve() / "checkout"
            program = PROGRAM.format(python=sys.executable, switch=mutations.SWITCH)
            files = {
                "src/lib.rs": "pub mod steel;\n", "src/steel.rs": steel, "tests/steel.rs": TESTS, "steel.json": '{"friction": 0.3}\n',
                "table.toml": table, "cargo": CARGO.format(python=sys.executable, program=program, broken=broken),
                ".gitignore": "target\n",
            }  # fmt: skip
            for path, text in files.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text)
            (root / "cargo").chmod(0o755)
            subprocess.run(["git", "init", "--quiet", root], check=True)
            said = io.StringIO()
            try:
                with mock.patch.dict(os.environ, CARGO=str(root / "cargo")):
                    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
                        code = mutations.main(arguments, root, root / "table.toml")
            except KeyboardInterrupt:
                code = "interrupted"
            for path, text in files.items():
                self.assertEqual((root / path).read_text(), text, f"{path} of the checkout")
            copy = root / "target" / "mutations" / "source"
            copied = {path: (copy / path).read_text() for path in files if (copy / path).is_file()}
            return code, said.getvalue(), copied

    def test_wrong_coefficients_tables_and_presets_are_caught_in_a_copy(self):
        for factor in ("1.05", "0.95"):
            code, said, copied = self.outcome("--factor", factor)
            self.assertEqual((code, said.count("caught ")), (0, 3), said)
            self.assertIn(f"3 coefficients times {factor}: 3 caught; not: none", said)
            self.assertIn("crate::wrong_by(0) * (7850.0)", copied["src/steel.rs"])
            self.assertIn("let   MELTS: f64 = (crate::wrong_by(1) * (1700.0));", copied["src/steel.rs"])
            self.assertEqual(copied["steel.json"], '{"friction": 0.3}\n')

    def test_a_test_that_passes_all_the_same_is_named_and_is_a_failure(self):
        code, said, _ = self.outcome(table=UNTESTED)
        self.assertEqual((code, said.count("caught ")), (1, 3), said)
        self.assertIn("PASSED width", said)
        self.assertIn("4 coefficients times 1.05: 3 caught; not: width", said)
        self.assertEqual(self.outcome("dens", "melt", table=UNTESTED)[0], 0)

    def test_what_is_too_slightly_wrong_passes(self):
        self.assertEqual(self.outcome("--factor", "1.001")[0], 1)

    def test_an_interrupted_run_leaves_no_wrong_preset_and_the_checkout_alone(self):
        passes = mutations.Copy.passes

        def interrupted(copy, *arguments):
            if "0.3}" not in (copy.source / "steel.json").read_text():
                raise KeyboardInterrupt
            return passes(copy, *arguments)

        with mock.patch.object(mutations.Copy, "passes", interrupted):
            code, _, copied = self.outcome("preset")
        self.assertEqual((code, copied["steel.json"]), ("interrupted", '{"friction": 0.3}\n'))

    def test_tests_that_fail_with_the_right_coefficients_or_do_not_run_tell_nothing(self):
        code, said, _ = self.outcome("density", steel=STEEL.replace("{ 7850.0", "{ 7000.0"), table=TABLE.replace("7850.0", "7000.0"))
        self.assertEqual((code, "fail with the right coefficients" in said), (1, True), said)
        code, said, _ = self.outcome(broken=True)
        self.assertEqual((code, "steel: not compiled\nerror: no such steel" in said), (1, True), said)
        with mock.patch.object(mutations.Mutation, "path", "a_test_of_another_program"), mock.patch.object(mutations, "check"):
            code, said, _ = self.outcome("density")
        self.assertEqual((code, "did not run a_test_of_another_program" in said), (1, True), said)

    def test_a_table_that_does_not_fit_the_source_is_refused_without_compiling(self):
        for old, new, words in [
            ("{ «7850.0» }", "{ «7851.0» }", "0 times, not once"),
            ("density() -> f64 { «7850.0» }", "f64 { «7850.0» }", None),
            ("density() -> f64 { «7850.0» }", "pub «fn»", "3 times, not once"),
            ("«7850.0»", "7850.0", "mark one coefficient"),
            ("it_melts", "it_boils", "no test it_boils"),
            ("MELTS: f64 = «1700.0»", "const BOILS: f64 = «3000.0»", "is a constant; mark a place where it is used"),
            ('"melting"', '"density"', "density stands twice"),
        ]:
            code, said, _ = self.outcome("--check", table=TABLE.replace(old, new), broken=True)
            self.assertEqual(code, 1 if words else 0, said)
            self.assertIn(words or "3 coefficients stand in the source", said)
        self.assertIn("no coefficient has lead in its name", self.outcome("lead")[1])

    def test_all_values_of_a_table_in_one_line_are_switched_where_they_stand(self):
        with tempfile.TemporaryDirectory() as name:
            (Path(name) / "src").mkdir()
            (Path(name) / "src/lib.rs").write_text("")
            (Path(name) / "src/steel.rs").write_text("fn share() {\n    const SHARE: [f64; 2] = [1.0, 0.5];\n}\n")
            texts = ("= [«1.0», 0.5]", "= [1.0, «0.5»]")
            table = [mutations.Mutation(text, "src/steel.rs", text, "steel::test") for text in texts]
            found = mutations.switched(table, Path(name))["src/steel.rs"]
        self.assertIn("    let   SHARE: [f64; 2] = [(crate::wrong_by(0) * (1.0)), (crate::wrong_by(1) * (0.5))];\n", found)

    def test_vibration_modes_of_wrong_bodies_are_neither_those_of_right_ones_nor_kept(self):
        with tempfile.TemporaryDirectory() as name:
            root, copy = Path(name) / "checkout", Path(name) / "copy"
            subprocess.run(["git", "init", "--quiet", root], check=True)
            (copy / "source/target/basis").mkdir(parents=True)
            (copy / "source/target/basis/right").touch()
            make = lambda: mutations.Copy(root, copy, {}, copy / "build", [])  # noqa: E731
            with contextlib.closing(make()) as there:
                with there.forgetful():
                    self.assertFalse(there.kept.exists())
                    there.kept.mkdir()
                    (there.kept / "wrong").touch()
                self.assertEqual([path.name for path in there.kept.iterdir()], ["right"])
                # What a run that is killed within leaves.
                there.kept.rename(there.aside)
            with contextlib.closing(make()) as there:
                self.assertEqual([path.name for path in there.kept.iterdir()], ["right"])

    def test_the_brief_run_takes_what_unit_tests_catch_and_looks_at_the_whole_table(self):
        table = TABLE.replace('"steel::it_is_heavy"', '"lib::steel::tests::it_is_heavy"')
        code, said, _ = self.outcome("--brief", table=table, steel=STEEL + TESTS)
        self.assertEqual(code, 0, said)
        self.assertIn("1 coefficients times 1.05: 1 caught; not: none", said)
        code, said, _ = self.outcome("--brief", table=table.replace("«0.3»", "«0.4»"), steel=STEEL + TESTS)
        self.assertEqual((code, "0 times, not once" in said), (1, True), said)


if __name__ == "__main__":
    unittest.main()
