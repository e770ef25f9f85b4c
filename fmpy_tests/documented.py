"""Commands that this repository tells people to type: where they stand, and how they read.

    .venv/bin/python fmpy_tests/documented.py

prints all of them with the files in which they stand; `recipes.py` says how each is run.
"""

import ast
import json
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
# What a command begins with: a program with something behind it, or a script of this repository.
PROGRAM = re.compile(
    r"(?:[A-Z][A-Z_]*=\S+ )*(?:\.venv/bin/|target/release/)?"
    r"(?:make|cargo|pip|python3?|wheelrail|wheelrail-train|wheelrail-pack|fmpy|dask|octave) +[\w./'<{\[-]"
    r"|\.ci/run$|packaging/build\b|(?:\.venv/bin/)?pytest +(?:-|\S+/)"
    r"|(?:tools|docs)/(?!test_(?!times))[\w/-]+\.py|(?:packaging|examples)/[\w/-]+\.py +(?:--?\w|[a-z])"
)
# Pages that tell what was.
PAST = ("CHANGELOG.md",)
PYTHON = ("python/src", "bench", "examples", "packaging", "tools", "docs", "site")
RUST = ("examples", "bench", "benches", "bodies", "pack", "src", "coach", "contact", "heat", "numerics", "surface", "thesis", "slave")
SHELL = ("", "sh", "bash", "console", "text")


def commands(text):
    """Commands in a text that is one line of a shell: without comments, and without what is explained behind two spaces."""
    text = re.split(r"\s#\s|\s{2,}", text.strip())[0]
    parts = (" ".join(part.split()).rstrip(".,;") for part in re.split(r"&&|; |→", text))
    return [part for part in parts if PROGRAM.match(part)]


def spans(text):
    """Texts between single backticks, within which a line may end."""
    return [" ".join(span.split()) for span in re.findall(r"(?<!`)`([^`]+)`(?!`)", text)]


def indented(text):
    """Lines that stand indented on their own, and what their comments name."""
    lines = [line for line in text.splitlines() if line.startswith("    ")]
    return lines + [span for line in lines for span in spans(line)]


def of_markdown(text):
    """Lines of blocks of a shell, indented lines and spans of a page."""
    blocks = re.findall(r"^```(\w*)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    rest = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
    prose = "\n".join(line for line in rest.splitlines() if not line.startswith("    "))
    lines = [line for language, block in blocks if language in SHELL for line in block.splitlines()]
    return lines + indented(rest) + spans(prose)


def of_python(text):
    """Texts of a Python file, documentation as well as messages, and what they say to install."""
    nodes = ast.walk(ast.parse(text))
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    hints = [hint for text in texts for hint in re.findall(r"(?:python -m )?pip install [-\w./'\[\]]*[\w'\]]", text)]
    return [line for text in texts for line in indented(text) + spans(text)] + hints


def of_rust(text):
    """Indented lines and spans of the documentation of a Rust file."""
    comments = "\n".join(re.findall(r"^ *//[/!] ?(.*)", text, re.MULTILINE))
    return indented(comments) + spans(comments)


def of_makefile(text):
    """Commands of the head, which `make help` prints: `make`, a target, and variables of it."""
    head = "\n".join(line for line in text.split("\n\n")[0].splitlines() if "ARGS=\"...\"" not in line)
    return re.findall(r"\bmake [a-z0-9-]+(?: [A-Z]+=(?:\"[^\"]*\"|[^\s;,:]+(?::[^\s;,]+)?))*", head)


def of_notebook(text):
    """Those of the Markdown cells of a notebook."""
    cells = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "markdown"]
    return [line for cell in cells for line in of_markdown("".join(cell["source"]))]


def sources():
    """Files that may name commands, with what reads them."""
    pages = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), ROOT / "python/README.md", *ROOT.glob("site/pages/*.md")]
    yield from ((page, of_markdown) for page in pages if not page.relative_to(ROOT).as_posix().startswith(PAST))
    yield ROOT / "Makefile", of_makefile
    python = [file for folder in PYTHON for file in (ROOT / folder).rglob("*.py")]
    yield from ((file, of_python) for file in python)
    yield from ((file, of_rust) for folder in RUST for file in (ROOT / folder).rglob("*.rs"))
    yield from ((file, of_notebook) for file in (ROOT / "examples").glob("*.ipynb"))


def documented(files=None):
    """Names of the files in which every command stands, by its text."""
    found = {}
    for file, reader in files or sources():
        for line in reader(file.read_text()):
            for text in commands(line):
                found.setdefault(text, set()).add(file.relative_to(ROOT).as_posix())
    return found


def blocks():
    """Python blocks of every page, by its path."""
    found = {}
    for page, reader in sources():
        if reader is of_markdown:
            code = re.findall(r"^```python\n(.*?)^```", page.read_text(), re.MULTILINE | re.DOTALL)
            found |= {page.relative_to(ROOT).as_posix(): code} if code else {}
    return found


if __name__ == "__main__":
    for command, files in sorted(documented().items()):
        print(f"{command}   <- {', '.join(sorted(files))}")
