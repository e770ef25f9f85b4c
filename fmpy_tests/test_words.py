"""Words that only this project would understand, or idioms that say nothing to a stranger, stand on no page."""

import re

from documented import ROOT

# What a page says instead. Commands, names of files and other code are no words of a page.
PRIVATE = {
    r"houses?": "source, or what is meant",
    r"rooms?": "module",
    r"doors?": "function, interface",
    r"ceilings?": "limit",
    r"kept aside|set aside": "stored, left out",
    r"judge?ments?": "estimate, chosen",
    r"hand(?:ed|s|ing)? (?:out|on)": "publish, pass",
    r"taken along": "saved",
    r"for ever": "always, without end",
    r"in the place of": "instead of",
    r"remembers?": "keeps",
    r"(?:lives?|dwells?) (?:in|on|only|where)": "is, has",
    r"at home": "where it is",
    r"carr(?:y|ies|ied) on": "continue, has the factor",
    r"looks on": "sees, depends on",
    r"housekeeping|gatekeepers?|ledgers?": "what it does",
}
# The tables of the thesis are generated, with "judgement" as a status that the page explains.
EXCEPT = {"docs/thesis.md": "judgement"}
SKIPPED = ("CHANGELOG.md", "docs/reference.md")  # what was; generated from the descriptions of variables


def pages():
    """Markdown pages by their paths."""
    found = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), ROOT / "python/README.md", *ROOT.glob("site/pages/*.md")]
    return {path.relative_to(ROOT).as_posix(): path.read_text() for path in found}


def prose(text):
    """A page without code, targets of links and marks of figures, its lines where they were."""
    keep_lines = lambda match: "\n" * match[0].count("\n")
    text = re.sub(r"^```.*?^```", keep_lines, text, flags=re.MULTILINE | re.DOTALL)
    text = re.sub(r"^ {4}\S.*$", "", text, flags=re.MULTILINE)
    text = re.sub(r"<!--.*?-->|(?<!`)`[^`]+`(?!`)|\]\([^)]*\)", keep_lines, text, flags=re.DOTALL)
    return text


def found(name, text):
    """Lines in which private words stand: page, line, word, and what to say."""
    for words, instead in PRIVATE.items():
        for match in re.finditer(rf"\b(?:{words})\b".replace(" ", r"\s+"), prose(text), re.IGNORECASE):
            if name not in EXCEPT or EXCEPT[name] not in match[0].lower():
                line = prose(text)[: match.start()].count("\n") + 1
                yield f"{name}:{line}: {' '.join(match[0].split())} (say: {instead})"


def test_no_private_word_stands_on_a_page():
    texts = {name: text for name, text in pages().items() if name not in SKIPPED}
    assert len(texts) > 45
    wrong = [line for name, text in texts.items() for line in found(name, text)]
    assert not wrong, "\n".join(wrong)


def test_private_words_are_seen_in_prose_and_not_in_code():
    code = "    make house\n\n```text\nroom\n```\n"
    page = f"# House\n\nAll rooms, `make house` and [it](rooms.svg).\n\n{code}\nKept\naside; the doorway, the Judgement.\n"
    seen = sorted(line.split(" (")[0] for line in found("a.md", page))
    assert seen == ["a.md:11: Kept aside", "a.md:12: Judgement", "a.md:1: House", "a.md:3: rooms"]
    assert not list(found("docs/thesis.md", "A judgement."))
