"""The Makefile makes a `.venv` anew in a copied or moved checkout, whose package the old one would not import."""

import os
import shutil
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
STAMP = ".venv/.installed"
READ = ("Makefile", "requirements/main.txt", "python/pyproject.toml")


def up_to_date(folder, target=STAMP):
    """Whether make has nothing to do for a target."""
    asked = subprocess.run(["make", "--question", target], cwd=folder, capture_output=True)
    if asked.returncode not in (0, 1):
        raise AssertionError(asked.stderr.decode())
    return asked.returncode == 0


class Environment(unittest.TestCase):
    def setUp(self):
        self.place = tempfile.TemporaryDirectory()
        self.original = Path(self.place.name).resolve() / "a checkout"
        for name in READ:
            (self.original / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.original / name)
        stamp = self.original / STAMP
        stamp.parent.mkdir()
        stamp.write_text(f"{self.original}\n")
        os.utime(stamp, (time.time() + 10, time.time() + 10))

    def tearDown(self):
        self.place.cleanup()

    def test_a_stamp_of_this_folder_is_enough(self):
        self.assertTrue(up_to_date(self.original))

    def test_a_copy_makes_its_own(self):
        copied = self.original.with_name("copy")
        subprocess.run(["cp", "-a", self.original, copied], check=True)
        self.assertFalse(up_to_date(copied))
        self.assertTrue(up_to_date(self.original))

    def test_a_stamp_without_a_folder_is_of_another_one(self):
        (self.original / STAMP).write_text("")
        self.assertFalse(up_to_date(self.original))


if __name__ == "__main__":
    unittest.main()
