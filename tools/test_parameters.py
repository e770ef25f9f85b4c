"""Every parameter is told of: on a page beside the generated reference, or, if it is an expert's, in an example, preset or the package."""

import re
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
GENERATED = ROOT / "docs" / "reference.md"


def parameters(heading):
    """Names in the table of the reference below a heading."""
    section = GENERATED.read_text().split(f"## {heading}\n", 1)[1].split("\n## ", 1)[0]
    return re.findall(r"^\| `([\w.]+)`", section, re.MULTILINE)


def text(*patterns):
    """Text of all files of some patterns, without the generated page and pages that tell what was."""
    files = {file for pattern in patterns for file in ROOT.glob(pattern)}
    return "\n".join(file.read_text() for file in sorted(files) if file != GENERATED and "history" not in file.parts)


def missing(names, where):
    """Names that do not stand in a text as whole words."""
    return [name for name in names if not re.search(rf"(?<![\w.]){re.escape(name)}(?![\w])", where)]


class Parameters(unittest.TestCase):
    pages = text("README.md", "docs/**/*.md", "python/README.md")

    def test_every_basic_parameter_stands_on_a_page(self):
        names = parameters("Basic parameters")
        self.assertGreater(len(names), 30)
        self.assertEqual(missing(names, self.pages), [], "say in docs/parameters.md what they are for")

    def test_every_expert_parameter_stands_on_a_page_or_in_something_that_sets_it(self):
        names = parameters("Expert parameters")
        self.assertGreater(len(names), 50)
        used = self.pages + text("examples/**/*.py", "examples/**/*.json", "resources/*.json", "python/src/**/*.py")
        self.assertEqual(missing(names, used), [], "say in docs/parameters.md what they are for")

    def test_a_longer_name_is_not_the_shorter_one(self):
        self.assertEqual(missing(["a.b", "a.c"], "`a.b_d`, `x.a.b` and `a.c`"), ["a.b"])


if __name__ == "__main__":
    unittest.main()
