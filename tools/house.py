#!/usr/bin/env python3
"""Counts of the source that say how well the house is built.

    tools/house.py                  the figures, each with its worst cases
    tools/house.py contact rolling  the figures of these folders or files below src/, bodies/src/, contact/src/, heat/src/, surface/src/ and numerics/src/
    tools/house.py --all            every case, not only the worst
    tools/house.py --json           figures alone, for comparing two commits

Unit tests (`#[cfg(test)]`) count for comments and lines of source only. Types are told apart by the file that
defines them: two types of one name in two folders are two types, and one duplicate name.
"""

import argparse
import json
import re
import sys
from pathlib import Path

MAX_IMPL_FILES = 3
MAX_FIELDS = 16
MAX_COLUMNS = 120
MAX_FUNCTION = 60
LISTED = 12
ROOT = Path(__file__).resolve().parent.parent
# Folders of the source; files of those beside src/ are named with theirs.
SOURCES = ("src", "bodies/src", "contact/src", "heat/src", "numerics/src", "surface/src")

WORD = r"[A-Za-z_][A-Za-z0-9_]*"
TOKEN = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
      | (?P<string>\bb?r(?P<hashes>\#*)".*?"(?P=hashes)|b?"(?:\\.|[^"\\])*"|b?'(?:\\(?:u\{[^}]*\}|x..|.)|[^'\\])')""",
    re.VERBOSE | re.DOTALL,
)


def code_of(text):
    """Source with comments and literals blanked out; every position and line break stays.

    >>> code_of('let s = "a { b"; // }\\nlet c = \\'{\\';')
    'let s =        ;     \\nlet c =    ;'
    >>> code_of("fn f<'a>(x: &'a str) {}")
    "fn f<'a>(x: &'a str) {}"
    """
    return TOKEN.sub(lambda found: re.sub(r"[^\n]", " ", found.group()), text)


def closing(code, at):
    """Position behind the bracket that closes the one at `at`."""
    pairs = {"{": "}", "(": ")", "[": "]"}
    opened, closed, depth = code[at], pairs[code[at]], 0
    for position in range(at, len(code)):
        depth += (code[position] == opened) - (code[position] == closed)
        if depth == 0:
            return position + 1
    return len(code)


def without_tests(code):
    """Code without the items that are compiled for tests only.

    >>> without_tests("a #[cfg(test)] mod tests { fn f() {} } b").split()
    ['a', 'b']
    """
    while (found := re.search(r"#\[cfg\(test\)\]", code)) is not None:
        end = re.compile(r"[{;]").search(code, found.end())
        stop = len(code) if end is None else closing(code, end.start()) if end.group() == "{" else end.end()
        code = code[: found.start()] + re.sub(r"[^\n]", " ", code[found.start() : stop]) + code[stop:]
    return code


def line_of(code, at):
    return code.count("\n", 0, at) + 1


def functions(code):
    """Name, line and number of lines of every function with a body.

    >>> functions("fn short();\\nfn long(x: [u8; 3]) {\\n  x\\n}")
    [('long', 2, 3)]
    """
    found = []
    for head in re.finditer(rf"\bfn\s+({WORD})", code):
        depth = 0
        for at in range(head.end(), len(code)):
            depth += (code[at] in "([") - (code[at] in ")]")
            if depth == 0 and code[at] in "{;":
                if code[at] == "{":
                    end = closing(code, at)
                    found.append((head[1], line_of(code, head.start()), code.count("\n", head.start(), end) + 1))
                break
    return found


def split_fields(body):
    """Parts of a list between its commas, brackets of every kind respected.

    >>> split_fields("a: u8, b: HashMap<K, (V, W)>, c: [f64; 2],")
    ['a: u8', 'b: HashMap<K, (V, W)>', 'c: [f64; 2]']
    """
    parts, depth, part, before = [], 0, "", ""
    for c in body:
        depth += (c in "([{<") - (c in ")]}") - (c == ">" and before != "-")
        if c == "," and depth == 0:
            parts.append(part.strip())
            part = ""
        else:
            part += c
        before = c
    return [part for part in [*parts, part.strip()] if part]


def bundled(code):
    """Name and line of every function that takes arguments apart which it gets as tuples.

    >>> bundled("fn f((a, b): (u8, u8)) {}\\nfn g(a: (u8, u8), h: impl Fn((u8, u8))) {}\\nfn h<T: Fn(u8)>(x: T, (y, z): P) {}")
    [('f', 1), ('h', 3)]
    """
    found = []
    for head in re.finditer(rf"\bfn\s+({WORD})", code):
        at = head.end()
        if code[at] == "<":
            at += re.search(r"(?<!-)>\s*\(", code[at:]).end() - 1
        arguments = split_fields(code[at + 1 : closing(code, at) - 1])
        if any(argument.startswith("(") for argument in arguments):
            found.append((head[1], line_of(code, head.start())))
    return found


def structs(code):
    """Name, line and number of named fields of every struct.

    >>> structs("struct Unit; struct Point { #[serde(skip)] x: f64, y: f64 }")
    [('Point', 1, 2)]
    """
    found = []
    for head in re.finditer(rf"\bstruct\s+({WORD})[^;{{(]*\{{", code):
        body = code[head.end() : closing(code, head.end() - 1) - 1]
        found.append((head[1], line_of(code, head.start()), len(split_fields(body))))
    return found


def types(code):
    """Names and lines of the types that a file defines; associated types of a trait or an `impl` are none of them.

    >>> types("pub struct A; enum B { C }\\ntrait D { type E; }\\nimpl D for A { type E = u8; }\\ntype F = u8;")
    [('A', 1), ('B', 1), ('D', 2), ('F', 4)]
    """
    outside = code
    heads = re.finditer(r"(?m)^[ \t]*(?:pub(?:\([^)]*\))?\s+)?(?:unsafe\s+)?(?:impl|trait)\b", code)
    for head in reversed(list(heads)):
        opened = code.find("{", head.end())
        if opened >= 0:
            end = closing(code, opened)
            outside = outside[:opened] + re.sub(r"[^\n]", " ", outside[opened:end]) + outside[end:]
    heads = re.finditer(rf"\b(?:struct|enum|trait|union|type)\s+({WORD})", outside)
    return [(head[1], line_of(code, head.start())) for head in heads]


def without_generics(text):
    """A piece of code without what stands between angle brackets.

    >>> without_generics("<'a, T: Into<u8>> Trait<T> for a::Thing<'a> ").split()
    ['Trait', 'for', 'a::Thing']
    """
    out, depth, before = "", 0, ""
    for c in text:
        if c == "<":
            depth += 1
        elif c == ">" and before != "-":
            depth -= 1
        elif depth == 0:
            out += c
        before = c
    return out


def impls(code):
    """Name of the type and line of every `impl`, of a trait or not.

    >>> impls("impl<'a> From<u8> for crate::Thing<'a> where u8: Copy {}\\nfn f() -> impl Fn() {}\\nimpl Other {}")
    [('Thing', 1), ('Other', 3)]
    """
    found = []
    for head in re.finditer(r"(?m)^[ \t]*(?:unsafe\s+)?impl\b([^{;]*)\{", code):
        target = without_generics(head[1]).split(" where ")[0].split(" for ")[-1].strip()
        if (name := re.search(rf"({WORD})\W*$", target)) is not None:
            found.append((name[1], line_of(code, head.start())))
    return found


def beginning(text):
    """Lines of doc comments that begin with What, Whether or The same, by that beginning.

    >>> beginning("/// What it is.\\n/// What is left.\\nstruct A;\\n//! The same.")
    {'What': [1], 'Whether': [], 'The same': [4]}
    """
    found = {"What": [], "Whether": [], "The same": []}
    before = False
    for number, line in enumerate(text.split("\n"), 1):
        comment = re.match(r"\s*//[/!] ?(.*)", line)
        if comment and not before:
            for word, lines in found.items():
                if re.match(rf"{word}\b", comment[1]):
                    lines.append(number)
        before = comment is not None
    return found


def owner(name, file, defined):
    """File that defines the type which `file` means: the nearest in the tree; None for a type of someone else."""
    parts = Path(file).with_suffix("").parts

    def common(other):
        shared = 0
        for mine, theirs in zip(parts, Path(other).with_suffix("").parts):
            if mine != theirs:
                break
            shared += 1
        return shared

    return max(sorted(defined.get(name, ())), key=common, default=None)


def test_files(sources):
    """Files that are compiled for tests only.

    >>> sorted(test_files({"a/mod.rs": "#[cfg(test)]\\nmod tests;", "a/tests.rs": "", "tests.rs": ""}))
    ['a/tests.rs']
    """
    found = set()
    for file, text in sources.items():
        path = Path(file)
        folder = path.parent if path.name in ("mod.rs", "lib.rs", "main.rs") else path.with_suffix("")
        for name in re.findall(rf"#\[cfg\(test\)\]\s*(?:pub(?:\([^)]*\))?\s+)?mod\s+({WORD})\s*;", code_of(text)):
            found |= {(folder / f"{name}.rs").as_posix(), (folder / name / "mod.rs").as_posix()} & sources.keys()
    return found


def count(sources):
    """Every figure with its cases, the worst first, from a dictionary of file names and texts."""
    tests = test_files(sources)
    codes = {file: without_tests(code_of(text)) for file, text in sources.items() if file not in tests}
    defined = {}
    for file, code in codes.items():
        for name, _ in types(code):
            defined.setdefault(name, []).append(file)
    homes = {}
    for file, code in codes.items():
        for name, _ in impls(code):
            if (home := owner(name, file, defined)) is not None:
                homes.setdefault((name, home), set()).add(file)
    spread = sorted((-len(files), name, home) for (name, home), files in homes.items())
    wide = sorted((-n, f"{file}:{line}", name) for file, code in codes.items() for name, line, n in structs(code))
    long = sorted((-n, f"{file}:{line}", name) for file, code in codes.items() for name, line, n in functions(code))
    takes = [
        f"{file}:{line_of(code, found.start())}"
        for file, code in codes.items()
        for found in re.finditer(r"\bmem::take\b", code)
    ]
    tuples = [f"{file}:{line} {name}" for file, code in codes.items() for name, line in bundled(code)]
    twice = sorted((-len(files), name, sorted(files)) for name, files in defined.items() if len(files) > 1)
    begins = {word: [] for word in beginning("")}
    for file, text in sources.items():
        for word, lines in beginning(text).items():
            begins[word] += [f"{file}:{line}" for line in lines]
    broad = [
        f"{file}:{number} ({len(line)} columns)"
        for file, text in sources.items()
        for number, line in enumerate(text.split("\n"), 1)
        if len(line) > MAX_COLUMNS and re.match(r"\s*//|.*[;,{}] //", line)
    ]
    spread = [f"{name}, {home}: {-n} files" for n, name, home in spread if -n > MAX_IMPL_FILES]
    wide = [f"{at} {name}: {-n} fields" for n, at, name in wide if -n > MAX_FIELDS]
    long = [f"{at} {name}: {-n} lines" for n, at, name in long if -n > MAX_FUNCTION]
    return [
        (f"types with impl in more than {MAX_IMPL_FILES} files", spread),
        (f"structs of more than {MAX_FIELDS} fields", wide),
        ("mem::take", takes),
        ("functions that take tuples of arguments apart", tuples),
        ("type names defined more than once", [f"{name}: {', '.join(files)}" for _, name, files in twice]),
        *((f"doc comments beginning with {word}", cases) for word, cases in begins.items()),
        (f"comment lines over {MAX_COLUMNS} columns", broad),
        (f"functions over {MAX_FUNCTION} lines", long),
    ]


def read(folders, rooms):
    """Texts of the source files below folders of the checkout, an error if one of the rooms has none."""
    files = {path.relative_to(ROOT).as_posix(): path.read_text() for folder in folders for path in sorted((ROOT / folder).rglob("*.rs"))}
    files = {file.removeprefix("src/"): text for file, text in files.items()}
    unknown = [room for room in rooms if not any(within(file, [room]) for file in files)]
    if unknown:
        sys.exit(f"no source file in {', '.join(unknown)}")
    return files


def within(case, rooms):
    """True if a case, or a file, belongs to one of some rooms.

    >>> within("Thing, contact/grid/a.rs: 4 files", ["contact"]), within("contact/a.rs:3", ["src/contact/a"])
    (True, True)
    >>> within("old/contact/a.rs:3", ["contact"]), within("contacts/a.rs:3", ["contact"]), within("a.rs", [])
    (False, False, True)
    >>> within("numerics/src/linalg/a.rs:3", ["linalg"]), within("numerics/src/linalg/a.rs:3", ["numerics/src/linalg"])
    (True, True)
    """
    names = [re.escape(room.removeprefix("src/").rstrip("/")) for room in rooms]
    return not rooms or any(re.search(rf"(^|[ ,])((bodies|contact|heat|numerics|surface)/src/)?{name}($|[/:.,])", case) for name in names)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rooms", nargs="*", help="folders or files below src/; without them everything")
    parser.add_argument("--root", action="append", help="folder of the source; may be given more than once")
    parser.add_argument("--all", action="store_true", help="every case")
    parser.add_argument("--json", action="store_true", help="figures alone")
    options = parser.parse_args()
    sources = read(options.root or SOURCES, options.rooms)
    figures = count(sources)
    chosen = [text for file, text in sources.items() if within(file, options.rooms)]
    lines = sum(len(text.splitlines()) for text in chosen)
    figures = [(name, [case for case in cases if within(case, options.rooms)]) for name, cases in figures]
    if options.json:
        numbers = {name: len(cases) for name, cases in figures}
        print(json.dumps({**numbers, "files": len(chosen), "lines": lines}, indent=1))
        return
    for name, cases in figures:
        print(f"{len(cases):6} {name}")
        shown = cases if options.all else cases[:LISTED]
        for case in shown:
            print(f"         {case}")
        if len(shown) < len(cases):
            print(f"         and {len(cases) - len(shown)} more (--all)")
    print(f"{lines:6} lines of source in {len(chosen)} files")


if __name__ == "__main__":
    main()
