"""Figures.py on figures and pages that are made up, and its examples: python3 -m unittest discover tools."""

import contextlib
import doctest
import io
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import figures


def load_tests(loader, tests, ignore):
    tests.addTests(doctest.DocTestSuite(figures))
    return tests


PAGE = "| width | within 1.0e-4, 3.0e-4<!--width:.1e--> | `hertz` |\n\nIt takes\n12.5 % of 3.85 µm<!--share:.1% hub:.2f-->.\n"
SAID = "running 3 tests\nfigure: width = 1e-4, 3e-4\nfigure: share = 0.125 < 1e-3\nfigure: hub [µm] = 3.85 ± 0.01\n"


class Figures(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = Path(folder.name)
        (self.root / "docs").mkdir()
        (self.root / "docs/validation.md").write_text("")
        self.page = self.root / "README.md"
        places = {"ROOT": self.root, "PRINTED": self.root / "target", "KEPT": self.root / "docs/figures.csv", "PAGES": (self.page,)}
        patches = mock.patch.multiple(figures, **places)
        patches.start()
        self.addCleanup(patches.stop)
        self.page.write_text(PAGE)
        self.says(SAID)
        self.assertEqual(self.outcome("--accept"), 0)

    def says(self, text, program="hertz"):
        figures.keep(text, program)

    def outcome(self, *arguments):
        """Exit code of the command, or what it says is wrong."""
        with contextlib.redirect_stdout(io.StringIO()):
            return figures.main(arguments)

    def reason(self, name):
        return figures.read(figures.KEPT)[name]["reason"]

    def test_what_was_printed_is_kept_and_pages_that_say_so_are_left_alone(self):
        rows = figures.read(figures.KEPT)
        self.assertEqual({name: row["value"] for name, row in rows.items()}, {"width.1": 1e-4, "width.2": 3e-4, "share": 0.125, "hub": 3.85})
        self.assertEqual((rows["hub"]["unit"], rows["hub"]["better"], rows["hub"]["printed by"]), ("µm", "± 0.01", "hertz"))
        self.assertEqual((self.page.read_text(), self.outcome("--all")), (PAGE, 0))

    def test_a_worse_figure_stops_until_it_is_accepted_with_a_reason_and_the_page_then_says_it(self):
        self.says("figure: width = 1e-4, 3.7e-4\n")
        self.assertIn("width.2 is worse: 0.00037 after 0.0003 (hertz)", self.outcome())
        self.assertIn("need a reason", self.outcome("--accept"))
        self.assertEqual(self.page.read_text(), PAGE)
        self.assertEqual(self.outcome("--accept", "--reason", "fewer nodes"), 0)
        self.assertEqual(self.reason("width.2"), "0.0003 before: fewer nodes")
        self.assertEqual(self.page.read_text(), PAGE.replace("3.0e-4", "3.7e-4"))
        self.says("figure: width = 1e-4, 3e-4\n")
        self.assertEqual((self.outcome("--accept"), self.reason("width.2")), (0, "0.0003 before: fewer nodes"))
        self.says("figure: width = 1e-4, 2e-4\n")
        self.assertEqual((self.outcome("--accept"), self.reason("width.2")), (0, ""))

    def test_a_better_figure_and_a_small_change_do_not_stop(self):
        self.says("figure: width = 0.7e-4, 3.5e-4\n")
        self.assertEqual(self.outcome(), 0)

    def test_a_value_of_two_sides_stops_beyond_its_tolerance_either_way(self):
        for value, stops in ((3.87, False), (3.83, False), (3.9, True), (3.8, True)):
            self.says(f"figure: hub [µm] = {value} ± 0.01\n")
            self.assertEqual("hub is another one" in str(self.outcome()), stops, value)

    def test_a_page_that_was_changed_by_hand_stops_and_is_written_anew(self):
        self.page.write_text(PAGE.replace("12.5 %", "12.4 %"))
        self.assertIn("README.md:4", self.outcome())
        self.assertEqual((self.outcome("--accept"), self.page.read_text()), (0, PAGE))

    def test_a_mark_that_goes_or_names_nothing_stops(self):
        self.page.write_text(PAGE.replace("<!--width:.1e-->", ""))
        self.assertIn("width.1, printed by hertz, stands on no page", self.outcome())
        self.page.write_text(PAGE + "9<!--nothing:.1e-->\n")
        self.assertIn("nothing is not in", self.outcome())
        self.page.write_text(PAGE + "| 9 | <!--hub:.1e--> |\n")
        self.assertIn("1 numbers should stand before", self.outcome())

    def test_figures_of_tests_must_all_be_printed_where_all_ran_and_those_of_studies_need_not(self):
        self.says("figure: flat = 3\n", "make study NAME=surfaces")
        self.page.write_text(PAGE + "3<!--flat:.0f-->\n")
        self.assertEqual(self.outcome("--accept"), 0)
        for file in figures.PRINTED.iterdir():
            file.unlink()
        self.says(SAID.replace("figure: hub [µm] = 3.85 ± 0.01\n", ""))
        self.assertEqual(self.outcome(), 0)
        said = self.outcome("--all")
        self.assertIn("hub of hertz was not printed", said)
        self.assertNotIn("flat", said)

    def test_a_new_figure_two_programs_with_one_name_and_lines_that_cannot_be_read_are_refused(self):
        self.says("figure: new = 1\n")
        self.assertIn("new = 1, printed by hertz, is not in", self.outcome())
        self.says("figure: hub = 1\n", "carter")
        self.assertIn("hub is printed by carter and by hertz", self.outcome())
        for text in ("figure: a = nan", "figure: a: 1", "figure: a = 1 ± 0.1\nfigure: a = 2 ± 0.1", "figure: a = one"):
            with self.assertRaises(ValueError, msg=text):
                figures.parsed(text + "\n", "hertz")

    def test_rows_of_tables_without_a_mark_are_found(self):
        head = "| quantity | measured | test |\n|---|---|---|\n"
        rows = "| a | 1.0<!--a:.1f--> | `b` |\n| c | 2 | `d` |\n| e | no panic | `f` |\n"
        self.assertEqual(figures.by_hand(head + rows + "\n| other | 3 | 4 |\n"), ["| c | 2 | `d` |"])

    def test_a_study_is_run_and_its_figures_are_kept(self):
        with contextlib.redirect_stdout(io.StringIO()) as said:
            self.assertEqual(figures.study("waves", ["echo", "figure: peak = 3"]), 0)
        self.assertEqual(said.getvalue(), "figure: peak = 3\n")
        self.assertEqual(figures.printed()["peak"]["printed by"], "make waves")


if __name__ == "__main__":
    unittest.main()
