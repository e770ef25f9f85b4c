"""House.py on a made-up house, and its examples: python3 -m unittest discover tools."""

import doctest
import unittest

import house


def load_tests(loader, tests, ignore):
    tests.addTests(doctest.DocTestSuite(house))
    return tests


def impls_in(files):
    return {f"room/{n}.rs": "use super::Thing;\nimpl Thing {}\n" for n in range(files)}


class Figures(unittest.TestCase):
    def figures(self, **files):
        return dict(house.count({name.replace("__", "/") + ".rs": text for name, text in files.items()}))

    def test_a_type_is_counted_where_it_is_defined(self):
        sources = {"room/thing.rs": "struct Thing;", "other/thing.rs": "struct Thing; impl Thing {}", **impls_in(4)}
        figures = dict(house.count(sources))
        self.assertEqual(figures["types with impl in more than 3 files"], ["Thing, room/thing.rs: 4 files"])
        self.assertEqual(figures["type names defined more than once"], ["Thing: other/thing.rs, room/thing.rs"])
        three = {"room/thing.rs": "struct Thing;", **impls_in(3)}
        self.assertEqual(dict(house.count(three))["types with impl in more than 3 files"], [])

    def test_limits_are_the_last_that_pass(self):
        def fields(n):
            return "struct Wide {" + "".join(f"pub f{i}: [f64; 2]," for i in range(n)) + "}"

        def function(n):
            return "fn long() {\n" + "x();\n" * (n - 2) + "}"

        figures = self.figures(a=fields(16) + function(60), b=fields(17).replace("Wide", "Wider") + "\n" + function(61))
        self.assertEqual(figures["structs of more than 16 fields"], ["b.rs:1 Wider: 17 fields"])
        self.assertEqual(figures["functions over 60 lines"], ["b.rs:2 long: 61 lines"])

    def test_comments_and_moves_are_counted(self):
        text = "/// Whether it is.\nfn f() { mem::take(x); } // mem::take\n//" + 119 * "x" + "\n//" + 118 * "x" + "\n"
        figures = self.figures(a=text)
        self.assertEqual(figures["doc comments beginning with Whether"], ["a.rs:1"])
        self.assertEqual(figures["mem::take"], ["a.rs:2"])
        self.assertEqual(figures["comment lines over 120 columns"], ["a.rs:3 (121 columns)"])


if __name__ == "__main__":
    unittest.main()
