"""Everything that names a version names the same one, and a tag of another one is refused."""

import subprocess
import sys
import unittest
from pathlib import Path

CHECK = Path(__file__).resolve().parent.parent / "packaging" / "release.py"


def check(tag):
    """The check of a release with a tag."""
    return subprocess.run([sys.executable, CHECK, tag], capture_output=True, text=True)


class Release(unittest.TestCase):
    def test_versions_are_the_same_and_the_tag_counts(self):
        version = check("main")
        self.assertEqual((version.returncode, version.stderr), (0, ""))
        self.assertEqual(check(f"v{version.stdout.strip()}").returncode, 0)
        other = check("v99.0.0")
        self.assertEqual(other.returncode, 1)
        self.assertIn("the tag 99.0.0", other.stderr)


if __name__ == "__main__":
    unittest.main()
