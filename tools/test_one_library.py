"""Build, tests and thesis ask for the same features of every package, so that each is compiled once for all of them."""

import os
import subprocess
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def compiled(*arguments):
    """Pairs of package and features that a command of cargo compiles."""
    command = [os.environ.get("CARGO", "cargo"), "tree", "--locked", "--prefix", "none", "--format", "{p} [{f}]"]
    lines = subprocess.run([*command, *arguments], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return {line.removesuffix(" (*)") for line in lines.splitlines() if line.strip()}


class OneLibrary(unittest.TestCase):
    def test_each_package_is_compiled_once(self):
        product, tests = compiled("--edges", "normal,build"), compiled("--edges", "normal,build,dev")
        # Together with the product, as the Makefile builds them.
        both = ("--edges", "normal,build", "--package", "wheelrail", "--package", "wheelrail-pack", "--package")
        coach, bench = compiled(*both, "wheelrail-coach"), compiled(*both, "wheelrail-bench")
        thesis = compiled("--edges", "normal,build,dev", "--package", "wheelrail-thesis")
        contact = compiled("--edges", "normal,build,dev", "--package", "wheelrail-contact")
        self.assertTrue(any(line.startswith("nalgebra ") for line in product & thesis))
        packages = {line.split(" ")[0] for line in tests}
        for name, other in [("cargo build", product), ("the coach", coach), ("the bench", bench), ("the thesis", thesis), ("the contact", contact)]:
            again = sorted(line for line in other - tests if line.split(" ")[0] in packages)
            self.assertEqual(
                again,
                [],
                f"{name} compiles these once more than cargo test: name the features that differ in [dependencies] of Cargo.toml",
            )


if __name__ == "__main__":
    unittest.main()
