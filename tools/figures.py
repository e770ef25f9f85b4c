#!/usr/bin/env python3
"""Figures of the pages: tests and studies print them, docs/figures.csv keeps them, and the pages are written from it.

    make figures                          compares what was printed last with the values that are kept, and these with the pages
    make figures ALL=1                    every figure of a test must have been printed, too: `make test` ends with it
    make figures ACCEPT=1 REASON="..."    keeps what was printed and writes the pages; a worse figure needs the reason
    tools/figures.py --by-hand            figures of the tables of docs/validation.md that no program writes
    tools/figures.py --keep locked-wheels make study NAME=locked-wheels    runs a study and keeps the figures that it prints

A test prints a line `figure: NAME = VALUES`, with up to a unit in brackets behind the name, and one of these at its end:

    figure: hertz.width = 1.0e-4              the smaller, in magnitude, the better; printed again, the largest counts
    figure: impulse [N s] = 2e-14 < 1e-12     the same, and all that is smaller than 1e-12 is equally good
    figure: hub.approach [µm] = 3.848 ± 0.01  neither better nor worse within 1 % of what is kept, or printed before
    figure: ramps = 2.3e-3, 2.7e-3, 3.3e-3    three figures, ramps.1 to ramps.3

The programs that run tests keep these lines below target/figures; studies of minutes print theirs if WHEELRAIL_FIGURES is
set, as --keep does. A page marks the numbers by a comment behind them, which names their figures and the form of each as
Python's f-strings do: `within 2.3e-3, 2.7e-3, 3.3e-3<!--ramps:.1e-->`. The form `.1%` multiplies by 100 and leaves the sign
% to the page, `-.1%` and `+.1%` show which way a deviation goes, and `*` stands for any part of a name.
"""

import argparse
import csv
import math
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PRINTED = ROOT / "target" / "figures"
KEPT = ROOT / "docs" / "figures.csv"
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), *sorted((ROOT / "docs/theory").glob("*.md")))
FIELDS = ("name", "value", "unit", "better", "printed by", "reason")
# A change by less than this share is neither better nor worse.
SHARE = 0.2
# Rows of docs/validation.md whose measured values have no mark. Who marks one lowers it.
BY_HAND = 4
NUMBER = re.compile(r"(?<![\w.])[+−-]?(?:\d+(?:\.\d+)?|\.\d+)(?:e[+−-]?\d+)?(?!\w)")
NAME = r"[A-Za-z][\w.]*"
LINE = re.compile(rf"^figure: (?P<name>{NAME})(?: \[(?P<unit>[^]]+)\])? = (?P<values>[^±<\n]+)(?: (?P<better>[±<] \S+))?$", re.MULTILINE)
ITEM = r"[A-Za-z][\w.*]*:[^\s>]+"
MARK = re.compile(rf"<!--(?P<items>{ITEM}(?: {ITEM})*)-->")


def parsed(text, program):
    """Rows of the figures that a program has printed, by name. One that it prints again keeps its largest magnitude.

    >>> parsed("figure: a [m] = 1e-3, -2e-3\\nfigure: a [m] = 2e-3, 1e-3\\n", "x")["a.2"]["value"]
    -0.002
    """
    rows = {}
    for line in LINE.finditer(text):
        values = [float(value) for value in line["values"].split(",")]
        for place, value in enumerate(values, 1):
            name = line["name"] if len(values) == 1 else f"{line['name']}.{place}"
            row = {"name": name, "value": value, "unit": line["unit"] or "", "better": line["better"] or "smaller", "printed by": program, "reason": ""}
            before = rows.get(name)
            if not math.isfinite(value):
                raise ValueError(f"{program}: figure {name} is {value}")
            if before and row["better"].startswith("±") and change(before, row):
                raise ValueError(f"{program}: figure {name} is printed as {before['value']:g} and as {value:g}")
            if not before or abs(value) > abs(before["value"]):
                rows[name] = row
    if (lines := len(re.findall("^figure: ", text, re.MULTILINE))) > len(LINE.findall(text)):
        raise ValueError(f"{program}: a line of {lines} that begin with `figure: ` cannot be read: see tools/figures.py")
    return rows


def read(file):
    """Rows of a table of figures, by name; none if there is no such file."""
    if not file.is_file():
        return {}
    with file.open(newline="") as lines:
        return {row["name"]: row | {"value": float(row["value"])} for row in csv.DictReader(lines)}


def write(file, rows):
    """Writes a table of figures, sorted by who prints them."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with file.open("w", newline="") as lines:
        table = csv.DictWriter(lines, FIELDS, lineterminator="\n")
        table.writeheader()
        for row in sorted(rows.values(), key=lambda row: (row["printed by"], row["name"])):
            table.writerow(row | {"value": f"{row['value']:.6g}"})


def keep(text, program):
    """Keeps what a program has printed, beside what it printed when other tests of it ran."""
    if rows := parsed(text, program):
        file = PRINTED / (re.sub(r"\W+", "-", program) + ".csv")
        write(file, read(file) | rows)


def printed():
    """All figures that were printed, by name."""
    rows = {}
    for file in sorted(PRINTED.glob("*.csv")):
        for name, row in read(file).items():
            if name in rows:
                raise ValueError(f"figure {name} is printed by {rows[name]['printed by']} and by {row['printed by']}")
            rows[name] = row
    return rows


def change(old, new):
    """What has become of a figure: "worse", "better" or "".

    >>> row = lambda value, better="smaller": {"value": value, "better": better}
    >>> [change(row(1e-3), row(new)) for new in (1.2e-3, -1.21e-3, 8e-4, 7e-4)]
    ['', 'worse', '', 'better']
    >>> change(row(1e-14), row(3e-13, "< 1e-12")), change(row(3.85), row(3.9, "± 0.01")), change(row(0.0), row(1e-9))
    ('', 'worse', 'worse')
    """
    kind, _, number = new["better"].partition(" ")
    if kind == "±":
        return "worse" if abs(new["value"] - old["value"]) > float(number) * abs(old["value"]) else ""
    least = float(number) if kind == "<" else 0.0
    before, now = (max(abs(row["value"]), least) for row in (old, new))
    return "worse" if now > (1 + SHARE) * before else "better" if now < (1 - SHARE) * before else ""


def compared(kept, found, everything):
    """What is wrong with the values that are kept: (lines to say, names of figures that are worse)."""
    lines, worse = [], []
    for name, row in found.items():
        if name not in kept:
            lines.append(f"{name} = {row['value']:.4g}, printed by {row['printed by']}, is not in {KEPT.name}")
        elif now := change(kept[name], row):
            worse += [name] if now == "worse" else []
            word = "another one" if row["better"].startswith("±") else now
            lines.append(f"{name} is {word}: {row['value']:.4g} after {kept[name]['value']:.4g} ({row['printed by']})")
    for name in missing(kept, found) if everything else ():
        lines.append(f"{name} of {kept[name]['printed by']} was not printed")
    return lines, worse


def missing(kept, found):
    """Figures of tests that were not printed. Studies are run by hand, and a program in Python may be skipped as a whole where
    what it needs is not installed."""
    printers = {row["printed by"] for row in found.values()}
    runs = lambda program: program in printers or not program.startswith("fmpy_tests/")
    tests = {name: row["printed by"] for name, row in kept.items() if not row["printed by"].startswith("make ")}
    return [name for name, program in tests.items() if name not in found and runs(program)]


def renewed(kept, found, reason, everything):
    """The values to keep: those found, with the reason beside every worse one."""
    gone = missing(kept, found) if everything else ()
    rows = {name: row for name, row in kept.items() if name not in gone}
    for name, row in found.items():
        now = change(kept[name], row) if name in kept else ""
        before = kept[name]["reason"] if name in kept and now != "better" else ""
        rows[name] = row | {"reason": f"{kept[name]['value']:.4g} before: {reason}" if now == "worse" else before}
    return rows


def formatted(value, form):
    """A number as pages write it: its magnitude, unless the form has a sign.

    >>> [formatted(*pair) for pair in ((-1.04e-4, ".1e"), (-0.0123, "-.1%"), (1178.9, ".0f"), (0.004, "+.1%"), (-1e-9, "-.2f"))]
    ['1.0e-4', '−1.2', '1179', '+0.4', '0.00']
    """
    value = value if form[:1] in "+-" else abs(value)
    text = format(100 * value, form[:-1] + "f") if form.endswith("%") else format(value, form)
    text = re.sub(r"e([+-])0*(\d)", lambda found: f"e{found[1].strip('+')}{found[2]}", text)
    return text.replace("-", "−", 1) if text.startswith("-") and float(text) else text.lstrip("-")


def named_by(item, rows):
    """Names of the figures that the item of a mark stands for, numbers in them by their size.

    >>> rows = ("a.1", "a.2", "a.10", "ramp.10.x", "ramp.2.x", "ramp.2.y")
    >>> named_by("a", rows), named_by("ramp.*.x", rows), named_by("a.2", rows)
    (['a.1', 'a.2', 'a.10'], ['ramp.2.x', 'ramp.10.x'], ['a.2'])
    """
    if item in rows:
        return [item]
    pattern = re.escape(item).replace(r"\*", r"[\w.]+") if "*" in item else re.escape(item) + r"\.\d+"
    pieces = lambda name: [float(piece) if piece[:1].isdigit() else piece for piece in re.split(r"(\d+(?:\.\d+)?)", name)]
    return sorted((name for name in rows if re.fullmatch(pattern, name)), key=pieces)


def numbers(items, rows):
    """Names and texts of the numbers that a mark asks for."""
    found = []
    for item in items.split(" "):
        name, form = item.split(":", 1)
        names = named_by(name, rows)
        if not names:
            raise ValueError(f"{name} is not in {KEPT.name}")
        found += [(name, formatted(rows[name]["value"], form)) for name in names]
    return found


def filled(text, rows, named=None):
    """A page whose marked numbers are those of the rows; adds the names of its figures to `named`.

    >>> filled("within 9, .8 %<!--a:.1%--> of", {"a.1": {"value": .012}, "a.2": {"value": .003}})
    'within 1.2, 0.3 %<!--a:.1%--> of'
    """
    pieces, end = [], 0
    for mark in MARK.finditer(text):
        new = numbers(mark["items"], rows)
        before = text[end : mark.start()]
        places = list(NUMBER.finditer(before))[-len(new) :]
        gaps = [before[a.end() : b.start()] for a, b in zip(places, places[1:])] + [before[places[-1].end() :] if places else "|"]
        if len(places) < len(new) or any("|" in gap or len(gap) > 24 for gap in gaps):
            raise ValueError(f"{len(new)} numbers should stand before {mark[0]}: …{before[-60:]}")
        for place, (name, number) in zip(places, new):
            pieces += [before[: place.start()] if place is places[0] else before[last : place.start()], number]
            last = place.end()
            if named is not None:
                named.add(name)
        pieces += [before[last:], mark[0]]
        end = mark.end()
    return "".join([*pieces, text[end:]])


def pages(rows, accept):
    """Compares the pages with the rows, or writes them; what is wrong, as lines."""
    lines, named = [], set()
    for page in PAGES:
        text = page.read_text()
        try:
            new = filled(text, rows, named)
        except ValueError as error:
            lines.append(f"{page.relative_to(ROOT)}: {error}")
            continue
        if new != text and accept:
            page.write_text(new)
            print(f"written: {page.relative_to(ROOT)}")
        elif new != text:
            pairs = zip(text.splitlines(), new.splitlines())
            lines += [f"{page.relative_to(ROOT)}:{n}: is not what {KEPT.name} says" for n, (a, b) in enumerate(pairs, 1) if a != b]
    return lines + [f"{name}, printed by {rows[name]['printed by']}, stands on no page" for name in rows if name not in named]


def by_hand(text):
    """Rows of tables with the column "measured" whose values no program writes."""
    rows, column = [], None
    for line in text.splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)] if line.startswith("|") else []
        if "measured" in cells:
            column = cells.index("measured")
        elif column and len(cells) > column and re.search(r"\d", cells[column]) and not MARK.search(cells[column]):
            rows.append(line)
        column = column if cells else None
    return rows


def study(name, command):
    """Runs a study and keeps the figures that it prints; its exit code."""
    lines = []
    told = os.environ | {"WHEELRAIL_FIGURES": "1"}
    with subprocess.Popen(command, env=told, stdout=subprocess.PIPE, text=True, errors="replace") as running:
        for line in running.stdout:
            lines.append(line)
            print(line, end="", flush=True)
    keep("".join(lines), f"make {name}")
    return running.returncode


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--accept", action="store_true", help="keep what was printed, and write the pages")
    parser.add_argument("--reason", default="", help="why a worse figure is accepted")
    parser.add_argument("--all", action="store_true", help="every figure of a test must have been printed")
    parser.add_argument("--by-hand", action="store_true", help="list what no program writes")
    parser.add_argument("--keep", nargs=argparse.REMAINDER, metavar=("NAME", "COMMAND"), help="run a study and keep its figures")
    wishes = parser.parse_args(arguments)
    hand = by_hand((ROOT / "docs/validation.md").read_text())
    if wishes.keep:
        return study(wishes.keep[0], wishes.keep[1:])
    if wishes.by_hand:
        print("\n".join([*hand, f"{len(hand)} rows"]))
        return 0
    try:
        kept, found = read(KEPT), printed()
    except ValueError as error:
        return str(error)
    lines, worse = compared(kept, found, wishes.all)
    if wishes.accept:
        if worse and not wishes.reason:
            return "\n".join([*lines, 'worse figures need a reason: make figures ACCEPT=1 REASON="..."'])
        kept, lines = renewed(kept, found, wishes.reason, wishes.all), []
        write(KEPT, kept)
    lines += pages(kept, wishes.accept)
    if len(hand) > BY_HAND:
        lines.append(f"docs/validation.md: {len(hand)} rows without a mark, {BY_HAND} before")
    print(f"{len(kept)} figures on pages, {len(found)} of them printed; {len(hand)} rows of docs/validation.md by hand")
    stops = [line for line in lines if " is better: " not in line]
    said = "\n".join([*lines, "make figures ACCEPT=1 keeps what was printed and writes the pages"])
    if lines and not stops:
        print(said)
    return said if stops else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
