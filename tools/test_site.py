"""The site names every page of the repository, and its mathematics changes nothing but the layout."""

import ast
import doctest
import html
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SITE = ROOT / "site"
sys.path.insert(0, str(SITE))
import api  # noqa: E402
import mathematics  # noqa: E402

THEORY = sorted((ROOT / "docs" / "theory").glob("*.md"))


def load_tests(loader, tests, ignore):
    tests.addTests(doctest.DocTestSuite(mathematics))
    return tests


def pages():
    """Every Markdown page that belongs on the site, by its path there."""
    patterns = ("*.md", "docs/*.md", "docs/*/*.md", "python/README.md")
    found = {path.relative_to(ROOT).as_posix() for pattern in patterns for path in ROOT.glob(pattern)}
    return found | {path.name for path in (SITE / "pages").glob("*.md")}


def bare(text):
    """Characters without spaces and what is written around an index."""
    return re.sub(r"[\s_^(){}]", "", text)


class Site(unittest.TestCase):
    def test_the_navigation_names_every_page_once_and_no_other(self):
        named = re.findall(r"^ +- [^:]+: (\S+\.md)$", (SITE / "mkdocs.yml").read_text(), re.MULTILINE)
        self.assertEqual(sorted(named), sorted(pages()), "add the page to `nav` in site/mkdocs.yml")
        self.assertGreater(len(named), 40)

    def test_every_module_and_every_name_of_the_python_package_has_its_line(self):
        modules, names = api.modules(), {name: (place, text) for name, place, text in api.exported()}
        self.assertTrue({"wheelrail.fmu", "wheelrail.damage", "wheelrail.page"} <= set(modules) and "wheelrail.examples" not in modules)
        self.assertTrue(all(modules.values()) and all(text for _, text in names.values()))
        tree = ast.parse((api.PACKAGE / "__init__.py").read_text())
        exported = next(ast.literal_eval(n.value) for n in tree.body if isinstance(n, ast.Assign) and n.targets[0].id == "__all__")
        self.assertEqual(set(exported), {*names, "damage"})
        self.assertEqual(names["Fmu"][0], "wheelrail.fmu.Fmu")

    def test_diagrams_are_pictures_and_no_source_text(self):
        fenced = {path: re.findall(r"^```(\w+)", (ROOT / path).read_text(), re.MULTILINE) for path in pages() if (ROOT / path).is_file()}
        self.assertFalse({path for path, kinds in fenced.items() if {"mermaid", "dot", "plantuml"} & set(kinds)})

    def test_formulas_keep_their_characters_in_their_order(self):
        blocks = [block for page in THEORY for block in re.findall(r"^```text\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)]
        self.assertGreater(len(blocks), 60)
        for block in blocks:
            shown = html.unescape(re.sub(r"<[^>]+>", "", mathematics.fence(block, "", "mathematics", {}, None)))
            self.assertEqual(bare(shown), bare(block))

    def test_symbols_in_the_text_become_formulas_and_names_of_the_code_do_not(self):
        page = "<p><code>λ_n</code> of <code>solver.tolerance</code></p><pre><code>λ_n</code></pre>"
        expected = '<p><span class="symbol"><i>λ</i><sub>n</sub></span> of <code>solver.tolerance</code></p><pre><code>λ_n</code></pre>'
        self.assertEqual(mathematics.symbols(page), expected)


if __name__ == "__main__":
    unittest.main()
