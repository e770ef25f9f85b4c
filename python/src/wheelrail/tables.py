"""Tables as text (CSV): a line of names, and below it lines with one cell for each name.

Cells are separated by commas, numbers have decimal points. Blank lines and lines that begin with `#` are skipped, a mark of
byte order and any ending of lines are taken, cells may stand in quotes. Everything else is refused, with line and column. Profiles
of rails and wheels are read by the same rules.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Iterator
from difflib import get_close_matches
from pathlib import Path

NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?", re.ASCII)
THOUSANDS = re.compile(r"[-+]?[1-9]\d{0,2}(,\d{3})+(\.\d*)?", re.ASCII)
SEPARATORS = {";": "semicolons", "\t": "tabs"}


class BadFile(Exception):
    """A file that cannot be used; the text names file, line, name and range."""


def nearest(name: str, known: Iterable[str], likeness: float = 0.6) -> str:
    """The end of a refusal of a name: the known one that resembles it, if there is one; a `likeness` of 1 is that of equal names."""
    return "".join(f"; did you mean {other}?" for other in get_close_matches(name, known, n=1, cutoff=likeness))


SAVE = 'save it as UTF-8 ("CSV UTF-8" in Excel, Out-File -Encoding utf8 in PowerShell, "encoding" in editors)'


def text_of(path: str | Path) -> str:
    """Text of a regular file in UTF-8; what another encoding seems to be, and how to save it otherwise, is said."""
    path = Path(path)
    if path.is_fifo() or path.is_char_device():
        raise BadFile(f"{path}: is no regular file")
    try:
        content = path.read_bytes()
        text = content.decode("utf-8-sig")  # some editors begin files with a mark
    except OSError as error:
        raise BadFile(f"{path}: cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError as error:
        raise BadFile(f"{path}: cannot be read: {encoding_of(content, error.start)}") from None
    if "\0" in text:
        raise BadFile(f"{path}: cannot be read: {encoding_of(content)}")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def encoding_of(content: bytes, valid: int = 0) -> str:
    """What a content seems to be that is no text in UTF-8 from a byte on, and what to do."""
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return f'it is text in UTF-16, as > in Windows PowerShell and "Unicode Text" in Excel write it; {SAVE}'
    if content.startswith(b"PK\x03\x04"):
        return f"it is an archive, such as a workbook of Excel, and no text; {SAVE}"
    if b"\0" in content:
        return f"it has zero bytes, as text in UTF-16 does that Windows programs write, or it is no text; {SAVE}"
    line = 1 + content[:valid].count(b"\n")
    return f"line {line} is not in UTF-8 (byte {content[valid]:#04x}), perhaps in Latin-1 or Windows-1252; {SAVE}"


def read_table(path: str | Path) -> tuple[list[str], int, Iterator[tuple[int, list[str]]]]:
    """Names of the columns, the line in which they stand, and rows as pairs of line and cells, lazily."""
    lines = enumerate(text_of(path).split("\n"), start=1)  # Python reads any ending of lines as this one
    lines = [(line, text.strip()) for line, text in lines]
    lines = [(line, text) for line, text in lines if text and not text.startswith("#")]
    if not lines:
        raise BadFile(f"{path}:1: empty: no line of names of columns")
    head, first = lines[0]
    names = _cells(path, head, first)
    if len(names) == 1 and (found := [word for sign, word in SEPARATORS.items() if sign in first]):
        raise BadFile(f"{path}:{head}: columns are separated by {found[0]}; write commas, and decimal points in numbers")
    for k, name in enumerate(names):
        if not name:
            raise BadFile(f"{path}:{head}: column {k + 1} has no name")
        if name in names[:k]:
            numbers = f"{first} are no names of columns, which the first line must have"
            raise BadFile(f"{path}:{head}: {numbers if NUMBER.fullmatch(name) else f'column {name!r} twice; leave one of them out'}")
    return names, head, _rows(path, len(names), head, lines[1:])


def headings_of(path: str | Path) -> list[str]:
    """What seem to be the names of the columns of a file, whatever it is."""
    with open(path, encoding="utf-8-sig", errors="replace") as file:
        return [name.strip() for name in file.readline().split(",")]


def _rows(path, width, head, lines):
    """Line and cells of every row; one with other cells than names is refused."""
    for line, text in lines:
        cells = _cells(path, line, text)
        if len(cells) != width:
            much = "commas separate entries, numbers have decimal points: 1.5, not 1,5"
            advice = much if len(cells) > width else "write a value for each"
            raise BadFile(f"{path}:{line}: {len(cells)} entries, line {head} has {width}; {advice}")
        yield line, cells


def _cells(path, line, text):
    """Cells of a line without the blanks and the quotes around them."""
    if '"' not in text:
        return [cell.strip() for cell in text.split(",")]
    if text.count('"') % 2:
        raise BadFile(f"{path}:{line}: a quote is not closed in this line")
    return [cell.strip() for cell in next(csv.reader([text], skipinitialspace=True))]


def number_in(path: str | Path, line: int, name: str, cell: str) -> float:
    """The number in a cell."""
    if NUMBER.fullmatch(cell):
        return float(cell)
    raise BadFile(f"{path}:{line}: {name} is {cell!r}, not a number{comma(cell)}")


def comma(cell: str) -> str:
    """Advice on a cell with commas, which stand in the place of a decimal point or between thousands."""
    if "," not in cell:
        return ""
    joined = cell.replace(",", "")
    if not THOUSANDS.fullmatch(cell):
        return "; write a decimal point in the place of the comma"
    if cell.count(",") == 1 and "." not in cell:
        return f"; write {joined} if the comma separates thousands, {cell.replace(',', '.')} if it is a decimal comma"
    return f"; write {joined}: thousands are not separated"
