"""What is said of counted instructions beside those that are kept."""

import doctest
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import instructions


def load_tests(loader, tests, ignore):
    tests.addTests(doctest.DocTestSuite(instructions))
    return tests


class Report(unittest.TestCase):
    def test_growth_by_more_than_a_twentieth_is_told_and_nothing_less(self):
        kept = {"a": 1e6, "b": 1e6, "c": 1e6}
        lines, grown = instructions.report({"a": 1.049e6, "b": 1.06e6, "c": 0.5e6, "d": 1.0}, kept)
        self.assertEqual(grown, ["b"])
        self.assertIn("+6.0 % MORE THAN BEFORE", lines[1])
        self.assertIn("-50.0 %", lines[2])
        self.assertTrue(lines[3].endswith("new"))


if __name__ == "__main__":
    unittest.main()
