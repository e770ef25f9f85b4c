"""Formulas written in the characters of Unicode, `λ_t = −μ λ_n`, set as HTML: italic symbols, raised and lowered indices.

The theory pages write mathematics this way because it can be read in a terminal, on a forge and inside the FMU. Only the
layout changes: `_`, `^` and brackets around an index go, every other character stays. It needs neither scripts nor fonts from elsewhere.
"""

import re
from html import escape, unescape

LETTER = "A-Za-zΑ-Ωα-ωϑϕϱℓ"
MARK = "\u0300-\u036f"  # combining accents, such as the tilde of M̃
INDEX = rf"[{LETTER}0-9∞]+(?:,[{LETTER}0-9∞]+)*"
GROUP = r"(?:\((?P<{0}>[^()]*)\)|\{{(?P<{0}_too>[^{{}}]*)\}})"  # brackets around an index go, too
TOKEN = re.compile(
    rf"_(?:(?P<low>{INDEX})|{GROUP.format('lows')})|\^(?:(?P<high>[−-]?[{LETTER}0-9.]*[{LETTER}0-9])|{GROUP.format('highs')})"
    rf"|(?P<word>[A-Za-z]{{2,}}[{MARK}]?(?:'s)?)|(?P<letter>[{LETTER}][{MARK}]*)"
)
# What makes a piece of code in running text a formula: its words are functions or products, and it is no name of the code.
FUNCTIONS = {
    "sin", "cos", "tan", "tanh", "sinh", "cosh", "coth", "exp", "ln", "log", "sign", "max", "min", "Pe", "erf", "arctan",
    "ds", "dt", "du", "dx", "dy", "dz", "dT", "smooth",
}  # fmt: skip
CODE = re.compile(r"::|\w\.[a-z]\w|\.(rs|py|md|json)\b|[\\\"$]|(?<![_^])\{|--|[a-z]{2,}_[a-z]{2,}|=\s*[a-z]{2,}")
FORMULA = re.compile(r"[=≤≥<>←⇒∫ΣΠ√∂∇]")
# At the end of a line: the unit, and the number.
NOTES = re.compile(r" {2,}(?P<unit>\[[^=]*\])?(?P<number> *\([0-9]+[a-z]?\))?$")


def _token(found):
    """HTML of a symbol, a word or an index."""
    low, high = (found[name] or found[name + "s"] or found[name + "s_too"] for name in ("low", "high"))
    if low:
        return f"<sub>{escape(low)}</sub>"
    if high:
        return f"<sup>{escape(high)}</sup>"
    return escape(found["word"]) if found["word"] else f"<i>{escape(found['letter'])}</i>"


def typeset(text):
    """HTML of a formula in one line.

    >>> typeset("λ_t = −μ p^0.95 y_{n+1} e^(−x)")
    '<i>λ</i><sub>t</sub> = −<i>μ</i> <i>p</i><sup>0.95</sup> <i>y</i><sub>n+1</sub> <i>e</i><sup>−x</sup>'
    """
    pieces, end = [], 0
    for found in TOKEN.finditer(text):
        pieces += [escape(text[end : found.start()]), _token(found)]
        end = found.end()
    return "".join([*pieces, escape(text[end:])])


def _line(line):
    """A line of a block: formulas, and to their right the unit and the number. Cells are parted by two spaces or more."""
    line = line.rstrip()
    indent, notes = len(line) - len(line.lstrip()), NOTES.search(line)
    cells = re.split(r" {2,}", (line[: notes.start()] if notes else line).strip())
    left = "".join(f"<span>{typeset(cell)}</span>" for cell in cells)
    right = "".join(f"<span>{escape(note.strip())}</span>" for note in notes.groups() if note) if notes else ""
    return f'<div class="line"><div class="formula" style="padding-left:{0.5 * indent:g}em">{left}</div><div class="note">{right}</div></div>'


def fence(source, language, css_class, options, md, **_):
    """HTML of a block, called by pymdownx.superfences; what is no formula stays a block of text."""
    if not FORMULA.search(source):
        return f"<pre><code>{escape(source)}</code></pre>"
    return f'<div class="{css_class}">' + "".join(_line(line) for line in source.splitlines() if line.strip()) + "</div>"


def is_formula(text):
    """Whether code within a sentence is mathematics.

    >>> [is_formula(text) for text in ("λ_n ≥ 0", "u", "tanh(s/ε)", "u_free,w", "M = ∫NN")]
    [True, True, True, True, True]
    >>> [is_formula(text) for text in ("solver.tolerance", "contact::line", "make test", "src/lib.rs", "true", "")]
    [False, False, False, False, False, False]
    """
    if not text or CODE.search(text):
        return False
    words = [found["word"] for found in TOKEN.finditer(text) if found["word"]]
    product = lambda word: len(word) == 2 and word.isupper() and FORMULA.search(text)
    return all(word in FUNCTIONS or product(word) for word in words)


def symbols(html):
    """A page whose inline code is set as mathematics where it is some; blocks stay."""
    def replaced(found):
        text = unescape(found[1])
        return f'<span class="symbol">{typeset(text)}</span>' if is_formula(text) else found[0]

    parts = re.split(r"(<pre.*?</pre>)", html, flags=re.DOTALL)
    return "".join(part if part.startswith("<pre") else re.sub(r"<code>([^<]*)</code>", replaced, part) for part in parts)
