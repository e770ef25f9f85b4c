"""What is handed out: pins with hashes, a complete bill of materials, and libraries without folders of whoever built them."""

import importlib.util
import json
import os
import re
import subprocess
import tempfile
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def part(name):
    """A program of packaging/ as a module; pip's package of that name is another one."""
    description = importlib.util.spec_from_file_location(f"wheelrail_{name}", ROOT / "packaging" / f"{name}.py")
    module = importlib.util.module_from_spec(description)
    description.loader.exec_module(module)
    return module


CHECK, HASHES, SBOM = part("check"), part("hashes"), part("sbom")
RUSTC = os.environ.get("RUSTC", "rustc")
CARGO = os.environ.get("CARGO", "cargo")


class Pins(unittest.TestCase):
    def setUp(self):
        self.pins = {}
        for path in sorted(ROOT.glob("requirements/*.txt")):
            for line in HASHES.logical_lines(path.read_text()):
                if HASHES.pin(line):
                    self.pins.setdefault(HASHES.name(HASHES.pin(line)), []).append((path.name, line))

    def test_every_pin_is_one_version_with_hashes_and_nothing_else(self):
        self.assertGreater(len(self.pins), 50)
        for lines in self.pins.values():
            for file, line in lines:
                pinned = HASHES.pin(line).split(";")[0].strip()
                self.assertRegex(pinned, r"^[A-Za-z0-9._-]+==[^\s*=]+$", file)
                self.assertGreater(len(HASHES.hashes(line)), 0, f"{file}: {pinned}: run packaging/hashes.py")
                self.assertEqual(len(HASHES.hashes(line)), line.count("--hash"), f"{file}: {pinned}")
        print(f"{len(self.pins)} pins, {sum(len(HASHES.hashes(line)) for lines in self.pins.values() for _, line in lines)} hashes")

    def test_a_package_of_several_files_is_the_same_in_all(self):
        for lines in self.pins.values():
            self.assertEqual(len({HASHES.pin(line).split(";")[0].strip() for _, line in lines}), 1, lines)
            self.assertEqual(len({tuple(HASHES.hashes(line)) for _, line in lines}), 1, [file for file, _ in lines])

    def test_whoever_installs_them_asks_for_the_hashes(self):
        recipes = [ROOT / "Makefile", *sorted((ROOT / ".github" / "workflows").glob("*.yml"))]
        lines = [(path.name, line) for path in recipes for line in path.read_text().splitlines()]
        installs = [(file, line) for file, line in lines if re.search(r"(\(PIP\)|pip install) .*-r ", line)]
        self.assertGreater(len(installs), 8)
        for file, line in installs:
            self.assertIn("--require-hashes", line, file)

    def test_hashes_are_written_below_pins_and_comments_stay(self):
        listed = {"one-two": ["sha256:" + "a" * 64, "sha256:" + "b" * 64], "three": ["sha256:" + "c" * 64]}
        known, HASHES.known = HASHES.known, lambda pins: listed
        self.addCleanup(setattr, HASHES, "known", known)
        text = '# why\nOne_Two==1.0; sys_platform == "linux" \\\n    --hash=sha256:' + "d" * 64 + "\n# more\nthree==3\n"
        pinned = 'One_Two==1.0; sys_platform == "linux"'
        rows = [f"# why\n{pinned}", f"    --hash=sha256:{'a' * 64}", f"    --hash=sha256:{'b' * 64}\n# more\nthree==3"]
        expected = " \\\n".join([*rows, f"    --hash=sha256:{'c' * 64}\n"])
        self.assertEqual(HASHES.hashed(text), expected)
        self.assertEqual(HASHES.hashed(expected), expected)


class Bill(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.host = SBOM.host()
        cls.bill = SBOM.bill([cls.host])
        cls.components = {entry["bom-ref"]: entry for entry in cls.bill["components"]}

    def test_it_lists_what_cargo_links_and_nothing_else(self):
        library = ["--package", "wheelrail", "--edges", "normal,no-proc-macro", "--target", self.host]
        command = [CARGO, "tree", "--locked", *library, "--prefix", "none"]
        tree = subprocess.run([*command, "--format", "{p}"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
        linked = {tuple(line.split()[:2]) for line in tree.splitlines() if line.strip()}
        listed = {(entry["name"], f"v{entry['version']}") for entry in [self.bill["metadata"]["component"], *self.components.values()]}
        self.assertEqual(listed, linked)
        self.assertGreater(len(listed), 60)
        names = {name for name, _ in listed}
        self.assertTrue({"faer", "libm", "nalgebra", "wheelrail-bodies", "wheelrail-contact", "wheelrail-heat", "wheelrail-numerics", "wheelrail-slave", "wheelrail-surface"} <= names)
        self.assertFalse({"criterion", "libfmi", "proptest", "serde_derive", "syn"} & names)
        self.assertFalse({"clap", "indicatif", "pulldown-cmark", "signal-hook", "zip"} & names)
        print(f"{len(self.components)} crates")

    def test_each_crate_has_the_checksum_of_the_lock_file_and_a_licence(self):
        lock = tomllib.loads((ROOT / "Cargo.lock").read_text())["package"]
        checksums = {(package["name"], package["version"]): package.get("checksum") for package in lock}
        for key, entry in self.components.items():
            checksum = checksums[entry["name"], entry["version"]]
            own = checksum is None
            self.assertEqual(entry.get("hashes"), None if own else [{"alg": "SHA-256", "content": checksum}], key)
            self.assertEqual(entry.get("purl"), None if own else f"pkg:cargo/{entry['name']}@{entry['version']}")
            (licence,) = entry["licenses"]
            self.assertRegex(licence["expression"], r"^[A-Za-z0-9.+-]+(( (OR|AND|WITH) )[A-Za-z0-9.+()-]+)*$", key)

    def test_every_component_is_reached_from_the_product(self):
        needs = {entry["ref"]: entry["dependsOn"] for entry in self.bill["dependencies"]}
        root = self.bill["metadata"]["component"]["bom-ref"]
        self.assertEqual(set(needs), set(self.components) | {root})
        reached, pending = set(), [root]
        while pending:
            key = pending.pop()
            if key not in reached:
                reached.add(key)
                pending += needs[key]
        self.assertEqual(reached, set(needs))
        faer = next(key for key in needs if key.startswith("pkg:cargo/faer@"))
        self.assertTrue(any(key.startswith("pkg:cargo/gemm@") for key in needs[faer]))

    def test_the_same_crates_give_the_same_bytes_and_the_form_is_that_of_cyclonedx(self):
        self.assertEqual(json.dumps(SBOM.bill([self.host])), json.dumps(self.bill))
        self.assertEqual((self.bill["bomFormat"], self.bill["specVersion"], self.bill["version"]), ("CycloneDX", "1.6", 1))
        self.assertRegex(self.bill["serialNumber"], r"^urn:uuid:[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12}$")


class Folders(unittest.TestCase):
    def compiled(self, place, wrapped):
        """A program whose crate from a made-up registry names its source in a message."""
        source = place / "cargo home" / "registry" / "src" / "index-1" / "brittle-1.0.0" / "src" / "lib.rs"
        source.parent.mkdir(parents=True, exist_ok=True)
        source.write_text("pub fn first<T: Copy>(x: &[T], i: usize) -> T { x[i] }\n")
        main = place / "main.rs"
        main.write_text("fn main() { std::process::exit(brittle::first(&[7], std::env::args().count() - 1)) }\n")
        command = [ROOT / "packaging" / "rustc-wrapper", RUSTC] if wrapped else [RUSTC]
        environment = os.environ | {"CARGO_HOME": str(place / "cargo home")}
        for arguments in (
            ["--crate-type", "rlib", "--crate-name", "brittle", source, "-o", place / "libbrittle.rlib"],
            [main, "--extern", f"brittle={place / 'libbrittle.rlib'}", "-o", place / "program"],
        ):
            subprocess.run([*command, "-C", "opt-level=1", *arguments], check=True, env=environment, capture_output=True)
        self.assertEqual(subprocess.run([place / "program"]).returncode, 7)
        subprocess.run(["strip", place / "program"], check=True)
        return (place / "program").read_bytes()

    def test_the_wrapper_leaves_out_the_folder_of_the_registry(self):
        with tempfile.TemporaryDirectory() as temporary:
            place = Path(temporary)
            plain, wrapped = self.compiled(place, False), self.compiled(place, True)
        source = b"brittle-1.0.0/src/lib.rs"
        self.assertIn(os.fsencode(place) + b"/cargo home/registry/src/index-1/" + source, plain)
        self.assertIn(b"crates/" + source, wrapped)
        self.assertNotIn(os.fsencode(place) + b"/cargo home", wrapped)
        self.assertIn("registry/src/index-1/brittle-1.0.0/src/lib.rs", CHECK.builder_paths(plain))
        self.assertEqual(CHECK.builder_paths(wrapped, place / "cargo home"), [])

    def test_folders_of_people_are_seen(self):
        for text in ["/home/ann/.cargo/x.rs", "/root/wheel/src/lib.rs", "/Users/ann/x.rs", r"C:\Users\ann\x.rs", "D:/Users/ann/x.rs"]:
            self.assertEqual(CHECK.builder_paths(b"\0" + text.encode() + b"\0"), [text])
        self.assertEqual(CHECK.builder_paths(b"\0/build/here/src/lib.rs\0", "/build/here"), ["/build/here"])
        self.assertEqual(CHECK.builder_paths(b"\0crates/faer-0.24.4/src/lib.rs /rustc/0123/library/std/x.rs\0", "/build/here"), [])

    def test_functions_of_the_system_are_seen(self):
        CHECK.check_mathematics("library", ["malloc", "memcpy", "floor", "sqrt", "fmi2DoStep", "expand"])
        for name in ["sin", "cosf", "sincos", "exp", "expm1", "log1p", "pow", "hypot", "cbrt", "atan2", "acosh", "fma"]:
            with self.assertRaisesRegex(SystemExit, name):
                CHECK.check_mathematics("library", ["malloc", name])

    def test_functions_that_a_dll_imports_and_does_not_call_decide_nothing(self):
        headers = (
            "ImageBase\t\t0000000180000000\n\n"
            " 00880014\t008800e8 00000000 00000000 00881a8c 008806c0\n\n\tDLL Name: msvcrt.dll\n\tvma:  Hint/Ord Member-Name Bound-To\n"
            "\t8815c2\t 1014  log\n\t8815d0\t 1020  memcpy\n\t8815f0\t 1033  pow\n\n"
            " 00880028\t00880108 00000000 00000000 00881b00 00880700\n\n\tDLL Name: KERNEL32.dll\n"
            "\t881600\t<none>\t    3  WaitOnAddress\n\n"
        )
        code = "   180001000:\tjmp *0x8806c8(%rip)        # 0x1808806c8\n   180001008:\tcall *0x87(%rip)        # 0x180880700\n"
        self.assertEqual(CHECK.called_functions(headers, code), ["WaitOnAddress", "memcpy"])
        self.assertIn("pow", CHECK.called_functions(headers, code + "   180001010:\tjmp *0x87(%rip)        # 1808806d0\n"))


class Exports(unittest.TestCase):
    def test_the_linker_for_windows_exports_the_functions_of_both_versions_and_nothing_else(self):
        with tempfile.TemporaryDirectory() as temporary:
            place = Path(temporary)
            listed = place / "lib.def"
            listed.write_text('LIBRARY\nEXPORTS\n    fmi2DoStep\n    "fmi3DoStep"\n    fmi3GetFloat64\n    rust_eh_personality\n    ZSTD_free\n')
            linker = place / "x86_64-w64-mingw32-gcc"
            linker.write_text('#!/bin/sh\nprintf "%s\\n" "$@" > "$0.called"\n')
            linker.chmod(0o755)
            environment = os.environ | {"PATH": f"{place}{os.pathsep}{os.environ['PATH']}"}
            arguments = ["-shared", f"-Wl,{listed}"]
            subprocess.run([ROOT / "packaging" / "mingw-linker", *arguments], check=True, env=environment)
            self.assertEqual(listed.read_text().split(), ["LIBRARY", "EXPORTS", "fmi2DoStep", '"fmi3DoStep"', "fmi3GetFloat64"])
            self.assertEqual(Path(f"{linker}.called").read_text().split(), arguments)

    def test_dynamic_symbols_are_told_apart_by_their_section(self):
        text = (
            "\nSymbol table '.dynsym' contains 4 entries:\n   Num:    Value          Size Type    Bind   Vis      Ndx Name\n"
            "     0: 0000000000000000     0 NOTYPE  LOCAL  DEFAULT  UND \n"
            "     1: 0000000000000000     0 FUNC    GLOBAL DEFAULT  UND log@GLIBC_2.29 (3)\n"
            "     2: 0000000000035b10    91 FUNC    GLOBAL DEFAULT   14 fmi3DoStep\n"
        )
        self.assertEqual(CHECK.dynamic_symbols(text), (["fmi3DoStep"], ["log"]))


if __name__ == "__main__":
    unittest.main()
