"""Everything that names a version names the same one, and a tag of another one is refused."""

import hashlib
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

CHECK = Path(__file__).resolve().parent.parent / "packaging" / "release.py"
sys.path.insert(0, str(CHECK.parent))
import handout  # noqa: E402


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


CHANGES = "# Changelog\n\n## [2.0.0] - 2027-01-01\n\nNew.\n\n- One.\n\n## [1.0.0] - 2026-01-01\n\nOld.\n"


class Handout(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.target, self.out = Path(temporary.name, "target"), Path(temporary.name, "out")
        for pattern in (*handout.FILES, "site/index.html", "site/a/b.html"):
            path = self.target / pattern.format(version="2.0.0").replace("*", "py3-none-any")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(pattern)

    def test_all_files_lie_beside_their_checksums_and_the_notes_of_their_version(self):
        self.out.mkdir()
        (self.out / "old.txt").touch()
        handout.gather(self.target, self.out, "2.0.0", CHANGES)
        names = {path.name for path in self.out.iterdir()}
        self.assertEqual(len(names), len(handout.FILES) + 3)
        self.assertNotIn("old.txt", names)
        self.assertEqual((self.out / "NOTES.md").read_text(), "# wheelrail 2.0.0\n\nNew.\n\n- One.\n")
        lines = [line.split() for line in (self.out / "SHA256SUMS").read_text().splitlines()]
        self.assertEqual({name for _, name in lines}, names - {"SHA256SUMS"})
        for digest, name in lines:
            self.assertEqual(hashlib.sha256((self.out / name).read_bytes()).hexdigest(), digest)
        with zipfile.ZipFile(self.out / "wheelrail-2.0.0-pages.zip") as pages:
            self.assertEqual(pages.namelist(), ["a/b.html", "index.html"])

    def test_what_is_missing_is_named_and_nothing_is_written(self):
        (self.target / "wheelrail-fmi3-all.fmu").unlink()
        with self.assertRaisesRegex(SystemExit, "wheelrail-fmi3-all.fmu"):
            handout.gather(self.target, self.out, "2.0.0", CHANGES)
        with self.assertRaisesRegex(SystemExit, "3.0.0"):
            handout.notes(CHANGES, "3.0.0")
        self.assertFalse(self.out.exists())


if __name__ == "__main__":
    unittest.main()
