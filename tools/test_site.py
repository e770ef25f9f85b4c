"""The site names every page of the repository, and its mathematics changes nothing but the layout."""

import doctest
import html
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SITE = ROOT / "site"
sys.path.insert(0, str(SITE))
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

    def test_formulas_keep_their_characters_in_their_order(self):
        blocks = [block for page in THEORY for block in re.findall(r"^```text\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)]
        self.assertGreater(len(blocks), 60)
        for block in blocks:
            shown = html.unescape(re.sub(r"<[^>]+>", "", mathematics.fence(block, "", "mathematics", {}, None)))
            self.assertEqual(bare(shown), bare(block))

    def test_symbols_in_the_text_become_formulas_and_names_of_the_code_do_not(self):
        page = "<p><code>λ_n</code> of <code>solver.contact</code></p><pre><code>λ_n</code></pre>"
        expected = '<p><span class="symbol"><i>λ</i><sub>n</sub></span> of <code>solver.contact</code></p><pre><code>λ_n</code></pre>'
        self.assertEqual(mathematics.symbols(page), expected)


if __name__ == "__main__":
    unittest.main()
