#!/usr/bin/env python3
"""Coefficients of the source, each 5 % off in a copy of it: the test that is named for it must fail.

    tools/mutations.py                    all coefficients of tools/mutations.toml
    tools/mutations.py film damping       those whose names hold one of these words
    tools/mutations.py --factor 0.95      too small in place of too large
    tools/mutations.py --check            whether the table fits the source, without compiling
    tools/mutations.py --brief            those that unit tests catch, with crates that are compiled for the product

The copy and what is compiled of it lie in target/mutations: the working tree is never touched. Coefficients of the copy are
multiplied by what an environment variable says, so that one build serves them all; presets are read anew. The brief run compiles the
copy beside the product, whose crates it shares, and does not optimise it: that would take longer than its tests do without. Exit
code 1 if a test passes with a wrong coefficient, fails with the right ones or does not run.
"""

import argparse
import fcntl
import json
import os
import re
import shutil
import subprocess
import sys
import time
import tomllib
from contextlib import closing, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TABLE = Path(__file__).with_suffix(".toml")
MARKED = re.compile(r"([^«»]*)«([^«»]+)»([^«»]*)", re.DOTALL)
# Code on which vibration modes depend that tests keep in the folder `basis`.
OF_BODIES = ("bodies/src/", "numerics/src/analytic.rs", "numerics/src/axes.rs", "numerics/src/fem/", "numerics/src/linalg/")
# Packages with unit tests, by the name that the table has for these, and their folders.
UNITS = {"lib": ("wheelrail", ""), "bodies-lib": ("wheelrail-bodies", "bodies/"), "contact-lib": ("wheelrail-contact", "contact/"), "heat-lib": ("wheelrail-heat", "heat/"), "surface-lib": ("wheelrail-surface", "surface/"), "numerics-lib": ("wheelrail-numerics", "numerics/")}
# Where and how tests are compiled: all of them, and those of the brief run. To cargo, crates of the copy are those of the checkout: in
# the folder of the product they must differ by their profile, lest it takes the one for the other.
WHOLE = ("target/mutations/build", ["--profile", "edit"])
UNOPTIMISED = [f"profile.release.package.{name}.opt-level=0" for name in ("wheelrail", "wheelrail-slave", "wheelrail-bodies", "wheelrail-contact", "wheelrail-heat", "wheelrail-surface", "wheelrail-numerics")]
BRIEF = ("target", ["--release", *(word for setting in UNOPTIMISED for word in ("--config", setting))])
# Number of the coefficient that is wrong, and its factor.
SWITCH = "WHEELRAIL_WRONG_COEFFICIENT"
# What the libraries of the copy with such a coefficient have besides.
SWITCHED = """
/// The factor of a coefficient: 1 unless the environment says that it is wrong.
pub fn wrong_by(coefficient: usize) -> f64 {
    static WRONG: std::sync::OnceLock<Option<(usize, f64)>> = std::sync::OnceLock::new();
    let read = || {
        let said = std::env::var("%s").ok()?;
        let (number, factor) = said.split_once(' ')?;
        Some((number.parse().ok()?, factor.parse().ok()?))
    };
    match WRONG.get_or_init(read) {
        Some((number, factor)) if *number == coefficient => *factor,
        _ => 1.0,
    }
}
""" % SWITCH


class Unfit(Exception):
    """A table that does not fit the source, or tests that do not run."""


@dataclass(frozen=True)
class Mutation:
    """A coefficient: its name, the file and the text around it, and the test `program::path::of::the::test`."""

    name: str
    file: str
    text: str
    test: str

    @property
    def program(self):
        return self.test.split("::", 1)[0]

    @property
    def path(self):
        return self.test.split("::", 1)[1]

    def place(self, source):
        """Beginning and end of the coefficient in its source."""
        parts = MARKED.fullmatch(self.text)
        if not parts:
            raise Unfit(f"{self.name}: mark one coefficient as «…» in {self.text!r}")
        before, value, after = parts.groups()
        found = source.count(before + value + after)
        if found != 1:
            raise Unfit(f"{self.name}: {self.file} has {before + value + after!r} {found} times, not once")
        start = source.index(before + value + after) + len(before)
        return start, start + len(value)

    def wrong(self, preset, factor):
        """A preset with the value `factor` times as large."""
        start, end = self.place(preset)
        return preset[:start] + repr(factor * float(preset[start:end])) + preset[end:]

    @property
    def is_preset(self):
        return self.file.endswith(".json")


def read(table):
    """All mutations of a table."""
    mutations = []
    for group in tomllib.loads(Path(table).read_text())["group"]:
        mutations += [Mutation(name, group["file"], text, group["test"]) for name, text in group["coefficients"]]
    return mutations


def check(mutations, root):
    """Raises `Unfit` unless every text is found once, can be switched, has its test and a name of its own."""
    switched(mutations, root)
    names = [mutation.name for mutation in mutations]
    for mutation in mutations:
        mutation.place((root / mutation.file).read_text())
        if names.count(mutation.name) > 1:
            raise Unfit(f"{mutation.name} stands twice in the table")
        *modules, test = mutation.path.split("::")
        files = ["/".join(["tests", mutation.program, *modules]) + ".rs"]
        if mutation.program in UNITS:
            _, folder = UNITS[mutation.program]
            files = ["/".join([f"{folder}src", *modules[:-1]]) + end for end in (".rs", "/mod.rs", "/tests.rs")]
        sources = [(root / file).read_text() for file in files if (root / file).is_file()]
        if not any(re.search(rf"#\[test\]\s+fn {test}\(", source) for source in sources):
            raise Unfit(f"{mutation.name}: {' or '.join(files)} has no test {test}")


def switched(mutations, root):
    """Texts of the files in which the environment tells the factors of coefficients; their numbers are those in the list."""
    sources = {mutation.file: (root / mutation.file).read_text() for mutation in mutations if not mutation.is_preset}
    libraries = {f"{file.partition('src/')[0]}src/lib.rs" for file in sources}
    texts = {library: (root / library).read_text() + SWITCHED for library in libraries}
    numbered = [(number, mutation) for number, mutation in enumerate(mutations) if not mutation.is_preset]
    places = [(*mutation.place(sources[mutation.file]), number, mutation) for number, mutation in numbered]
    for start, end, number, mutation in sorted(places, key=lambda place: place[:2], reverse=True):
        text = texts.get(mutation.file, sources[mutation.file])
        before, _, line = text[:start].rpartition("\n")
        # A constant within a function may be a variable as well; places before it stay where they are.
        line = re.sub(r"^( +)const ", r"\1let   ", line)
        if "const " in line:
            raise Unfit(f"{mutation.name}: {line.strip()} is a constant; mark a place where it is used")
        value = text[start:end]
        texts[mutation.file] = f"{before}\n{line}(crate::wrong_by({number}) * ({value})){text[end:]}"
    return texts


class Copy:
    """A copy of a checkout in `folder`, in which some files have other texts; its tests are compiled into `build` as `options` say."""

    def __init__(self, root, folder, texts, build, options):
        self.source, self.build, self.options = folder / "source", build, options
        self.kept, self.aside = (self.source / "target" / name for name in ("basis", "basis.aside"))
        self.source.mkdir(parents=True, exist_ok=True)
        self.lock = open(folder / "lock", "w")
        try:
            fcntl.flock(self.lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            self.close()
            raise Unfit(f"another run uses {folder}: wait for its end") from None
        self.remember()
        listed = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        names = subprocess.run(listed, cwd=root, capture_output=True, check=True).stdout.decode().split("\0")
        files = {name for name in names if name and (root / name).is_file()}
        for path in [path for path in self.source.rglob("*") if path.is_file()]:
            name = path.relative_to(self.source)
            if name.parts[0] != "target" and str(name) not in files:
                path.unlink()
        for name in files:
            self.write(name, texts[name].encode() if name in texts else (root / name).read_bytes())

    @contextmanager
    def forgetful(self):
        """Within, no vibration modes are known, and those that are found are forgotten."""
        self.kept.mkdir(parents=True, exist_ok=True)
        self.kept.rename(self.aside)
        try:
            yield
        finally:
            self.remember()

    def remember(self):
        """Ends `forgetful`, also that of a run that was killed."""
        if self.aside.is_dir():
            shutil.rmtree(self.kept, ignore_errors=True)
            self.aside.rename(self.kept)

    def close(self):
        """Lets others use the copy."""
        self.lock.close()

    def write(self, name, content):
        """Gives a file its content; one that has it stays as it is, for the compiler's sake."""
        path = self.source / name
        if not (path.is_file() and path.read_bytes() == content):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)

    def programs(self, names):
        """Compiles test programs: their executables by name."""
        chosen = [word for name in sorted(names) if name not in UNITS for word in ("--test", name)]
        units = [name for name in UNITS if name in names]
        # All packages that are chosen are compiled with the features of the product.
        chosen += ["--lib", *(word for name in {"lib": None} | dict.fromkeys(units) for word in ("-p", UNITS[name][0]))] if units else []
        command = [os.environ.get("CARGO", "cargo"), "test", *self.options, "--locked", "--no-run"]
        environment = dict(os.environ, CARGO_TARGET_DIR=str(self.build))
        command += ["--message-format", "json", *chosen]
        done = subprocess.run(command, cwd=self.source, env=environment, text=True, stdout=subprocess.PIPE)
        artifacts = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
        if done.returncode:
            said = [each["message"] for each in artifacts if "message" in each]
            errors = [each["rendered"] for each in said if each["level"] == "error"]
            raise Unfit("\n".join([f"{', '.join(sorted(names))}: not compiled", *errors]))
        tests = [each for each in artifacts if each.get("executable") and each["profile"]["test"]]
        of_target = {package.replace("-", "_"): name for name, (package, _) in UNITS.items()}
        name = lambda each: each["target"]["name"] if each["target"]["kind"] == ["test"] else of_target.get(each["target"]["name"], "lib")  # noqa: E731
        return {name(each): each["executable"] for each in tests}

    def passes(self, executable, paths, switch=""):
        """Whether some tests of a program pass, with one wrong coefficient or none, and what they print."""
        environment = dict(os.environ, CARGO_TARGET_DIR=str(self.build)) | ({SWITCH: switch} if switch else {})
        done = subprocess.run(
            [executable, "--exact", *paths], cwd=self.source, env=environment, text=True, errors="replace",
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
        )  # fmt: skip
        if f"running {len(paths)} test" not in done.stdout:
            raise Unfit(f"{executable} did not run {', '.join(paths)}:\n{done.stdout}")
        return done.returncode == 0, done.stdout


def run(there, root, mutations, factor):
    """Makes coefficients wrong one after the other and tells what is caught: the names of those that are not."""
    tests = {}
    for mutation in mutations:
        tests.setdefault(mutation.program, set()).add(mutation.path)
    programs = there.programs(tests)
    outcomes = {program: there.passes(programs[program], sorted(paths)) for program, paths in tests.items()}
    failed = {program: said for program, (passed, said) in outcomes.items() if not passed}
    if failed:
        raise Unfit(f"{', '.join(failed)}: fail with the right coefficients\n" + "\n".join(failed.values()))
    missed = []
    for number, mutation in enumerate(mutations):
        start = time.monotonic()
        program = programs[mutation.program]
        if mutation.is_preset:
            preset = (root / mutation.file).read_text()
            there.write(mutation.file, mutation.wrong(preset, factor).encode())
            try:
                passed, _ = there.passes(program, [mutation.path])
            finally:
                there.write(mutation.file, preset.encode())
        else:
            with there.forgetful() if mutation.file.startswith(OF_BODIES) else nullcontext():
                passed, _ = there.passes(program, [mutation.path], f"{number} {factor}")
        missed += [mutation.name] if passed else []
        word, wall = "PASSED" if passed else "caught", time.monotonic() - start
        print(f"{word} {mutation.name:46} {mutation.test} ({wall:.1f} s)", flush=True)
    return missed


def main(arguments, root=ROOT, table=TABLE):
    """Exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", help="words in the names of coefficients")
    parser.add_argument("--factor", type=float, default=1.05, help="wrong over right value (1.05)")
    parser.add_argument("--check", action="store_true", help="only whether the table fits the source")
    parser.add_argument("--brief", action="store_true", help="only those that unit tests catch")
    chosen = parser.parse_args(arguments)
    try:
        mutations = read(table)
        check(mutations, root)
        if chosen.check:
            print(f"{len(mutations)} coefficients stand in the source, and so do their tests")
            return 0
        if chosen.brief:
            mutations = [each for each in mutations if each.program in UNITS]
        mutations = [each for each in mutations if not chosen.words or any(word in each.name for word in chosen.words)]
        if not mutations:
            raise Unfit(f"no coefficient has {' or '.join(chosen.words)} in its name")
        build, options = BRIEF if chosen.brief else WHOLE
        with closing(Copy(root, root / "target/mutations", switched(mutations, root), root / build, options)) as there:
            missed = run(there, root, mutations, chosen.factor)
    except Unfit as unfit:
        print(f"mutations: {unfit}", file=sys.stderr)
        return 1
    count = f"{len(mutations)} coefficients times {chosen.factor}: {len(mutations) - len(missed)} caught"
    print(f"{count}; not: {', '.join(missed) or 'none'}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
