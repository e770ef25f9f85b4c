"""Checks an FMU for Linux and Windows: `make fmu ALL=1` and `make fmu ALL=1 CHECK=1` call this.

    python3 packaging/check.py FMU          what the binaries export and need, and their size
    python3 packaging/check.py FMU --run    also runs them in a C master (host.c), Windows under wine, ARM under qemu, and compares
"""

import argparse
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

HERE = Path(__file__).parent
# Places of both libraries in an FMU, by the version of FMI.
BINARIES = {
    "2.0": ("binaries/linux64/wheelrail.so", "binaries/win64/wheelrail.dll"),
    "3.0": ("binaries/x86_64-linux/wheelrail.so", "binaries/x86_64-windows/wheelrail.dll"),
}
# Place of a third one, where it has been built; FMI 2.0 has no name for it.
ARM = "binaries/aarch64-linux/wheelrail.so"
ARM_GCC = "aarch64-linux-gnu"  # of the compiler that makes a master for it
FUNCTIONS = 34 + 75  # of FMI 2.0 for co-simulation and of FMI 3.0; tests/fmi/fmi_library.rs lists them
GLIBC = (2, 17)  # newest version that linux64 may need
# Bytes of a library for Linux. Without one of the savings of packaging/build it has more: the unused kernels of products of matrices alone are
# 1.4 MB. tests/fmi/fmi_library.rs watches the size of the ordinary library in every test run.
SIZE = 6e6
NEEDED = {"libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
# Functions that a system computes, each with other last digits: results would depend on it.
MATHEMATICS = re.compile(r"(a?(sin|cos|tan)h?|sincos|atan2|exp|exp2|exp10|expm1|log|log2|log10|log1p|pow|cbrt|hypot|fma)f?")
# Folders of whoever built a library; places in the source of crates are named from the name of the crate on.
BUILDER = re.compile(rb"(?:registry/src/|/home/|/root/|/Users/|[A-Z]:[\\/]Users[\\/])[!-~]*")
BILL = "documentation/licenses/wheelrail.cdx.json"
# Part of every Windows.
SYSTEM = re.compile(r"(kernel32|ntdll|msvcrt|advapi32|ws2_32|userenv|bcrypt|bcryptprimitives|api-ms-win-.*)\.dll")
TOLERANCE = 1e-9  # relative to the largest value of an output, or of a whole profile, in the run
# What remains of sums that cancel is compared with the size of these sums: the first is a share of the friction energy,
# of energies as large as the work of the hub, the second a share of all heat.
SCALES = {
    "solver.energy_residual": lambda largest: largest["energy.hub_work"] / largest["energy.friction"],
    "solver.heat_residual": lambda largest: 1.0,
    "heat.to_hub": lambda largest: largest["heat.friction_power"],
}


def output(*command, **options):
    """Standard output of a command that must succeed."""
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, **options).stdout


def require(condition, message):
    if not condition:
        sys.exit(f"error: {message}")


def check_functions(binary, names):
    others = [name for name in names if not name.startswith(("fmi2", "fmi3"))]
    require(not others, f"{binary} exports {others}")
    require(len(set(names)) == FUNCTIONS, f"{binary} exports {len(names)} functions, not {FUNCTIONS}: {sorted(names)}")


def check_mathematics(binary, names):
    """No function of the system decides over digits of results."""
    found = sorted(name for name in names if MATHEMATICS.fullmatch(name))
    require(not found, f"{binary} takes {found} from the system: take them from the crate libm")


def builder_paths(contents, *folders):
    """Folders of whoever built a library that stand in it: those named, and what looks like a home or a registry of crates."""
    own = [folder for folder in (str(folder).encode() for folder in folders) if folder in contents]
    return sorted({found.decode() for found in own + BUILDER.findall(contents)})


def check_paths(binary):
    """No folder of whoever built the library."""
    homes = {HERE.resolve().parent, Path.home(), Path(os.environ.get("CARGO_HOME", Path.home() / ".cargo"))} - {Path("/")}
    found = builder_paths(binary.read_bytes(), *homes)
    require(not found, f"{binary} names folders of this machine in {len(found)} places, such as {found[:3]}: see packaging/rustc-wrapper")


def dynamic_symbols(text):
    """Names of the dynamic symbols that a library defines, and of those that it takes from others, as readelf lists them."""
    rows = [line.split() for line in text.splitlines() if re.match(r"\s+\d+: [0-9a-f]{16} ", line)]
    known = [(row[6], row[7].split("@")[0]) for row in rows if len(row) > 7]
    return [name for place, name in known if place != "UND"], [name for place, name in known if place == "UND"]


def check_linux(binary):
    """Exports, versions of glibc, libraries, functions of the system, size, symbols; of any processor."""
    platform = binary.parent.name
    defined, taken = dynamic_symbols(output("readelf", "--wide", "--dyn-syms", binary))
    check_functions(binary, defined)
    check_mathematics(binary, taken)
    versions = {tuple(map(int, version.split("."))) for version in re.findall(r"GLIBC_([0-9.]+)", output("readelf", "--wide", "-V", binary))}
    require(versions, f"{binary} asks for no version of glibc: is it a library?")
    newest = ".".join(map(str, max(versions)))
    require(max(versions) <= GLIBC, f"{binary} needs glibc {newest}")
    needed = set(re.findall(r"\(NEEDED\).*\[(.+)\]", output("readelf", "--wide", "-d", binary)))
    require(needed and needed <= NEEDED, f"{binary} needs {sorted(needed - NEEDED) or 'no library: is it one?'}")
    size = binary.stat().st_size
    require(size < SIZE, f"{binary} has {size / 1e6:.2f} MB")
    require(".symtab" not in output("readelf", "--wide", "-S", binary), f"{binary} is not stripped")
    print(f"{platform}: {FUNCTIONS} functions, glibc {newest}, {size / 1e6:.2f} MB, needs {' '.join(sorted(needed))}")


def called_functions(headers, code):
    """Imported functions to whose slot an instruction refers. The linker also imports what only code calls that it leaves out."""
    base = int(re.search(r"^ImageBase\s+([0-9a-f]+)$", headers, re.MULTILINE)[1], 16)
    slots = {}
    for part in re.split(r"\n (?=[0-9a-f]{8}(?:\s+[0-9a-f]{8}){5}\n)", headers)[1:]:
        first = base + int(part.split("\n")[0].split()[5], 16)
        names = re.findall(r"^\s+[0-9a-f]+\s+(?:<none>\s+)?[0-9a-f]+\s+(\w+)$", part, re.MULTILINE)
        slots |= {first + 8 * place: name for place, name in enumerate(names)}
    referred = {int(address, 16) for address in set(re.findall(r"# (?:0x)?([0-9a-f]+)", code))}
    return sorted(name for slot, name in slots.items() if slot in referred)


def check_windows(binary):
    """Exports, libraries, functions of the system."""
    text = output("x86_64-w64-mingw32-objdump", "-p", binary)
    table = text.split("[Ordinal/Name Pointer] Table")[-1].split("\n\n")[0]
    check_functions(binary, re.findall(r"^\s+\[ *\d+\](?: \+base\[ *\d+\])?(?: +[0-9a-f]{4,8})? (\S+)$", table, re.MULTILINE))
    called = called_functions(text, output("x86_64-w64-mingw32-objdump", "-d", "--no-show-raw-insn", binary))
    require("memcpy" in called or "malloc" in called, f"{binary} calls no function of the system: is it a library?")
    check_mathematics(binary, called)
    needed = {name.lower() for name in re.findall(r"DLL Name: (\S+)", text)}
    others = sorted(name for name in needed if not SYSTEM.fullmatch(name))
    require(needed and not others, f"{binary} needs {others}")
    print(f"win64: {FUNCTIONS} functions, {binary.stat().st_size / 1e6:.2f} MB, needs {' '.join(sorted(needed))}")


def outputs(description):
    """Version of FMI, identity of the FMU, names of its real outputs with the points of profiles, their value references and sizes."""
    root = ElementTree.parse(description).getroot()
    if root.get("fmiVersion") == "2.0":
        variables = [v for v in root.iter("ScalarVariable") if v.get("causality") in ("output", "local") and v.find("Real") is not None]
        return "2.0", root.get("guid"), [v.get("name") for v in variables], [v.get("valueReference") for v in variables]
    names, references = [], []
    for row in root.find("ModelVariables").iterfind("Float64[@causality='output']"):
        name, dimension = row.get("name"), row.find("Dimension")
        size = 1 if dimension is None else int(dimension.get("start"))
        names += [name] if dimension is None else [f"{name}[{k}]" for k in range(1, size + 1)]
        references.append(f"{row.get('valueReference')}:{size}")
    return "3.0", root.get("instantiationToken"), names, references


def compiled(compiler, version, program, *options):
    """The C master for a version of FMI."""
    output(compiler, "-std=c11", "-O1", "-Wall", "-Wextra", f"-DFMI={version[0]}", HERE / "host.c", "-o", program, *options)
    return program


def rows(text):
    """Lines of numbers."""
    return [[float(value) for value in line.split()] for line in text.splitlines()]


def largest_difference(names, one, two):
    """Largest difference between two runs and the name of that output."""
    require(len(one) == len(two) > 0, "the runs differ in length")
    require([row[0] for row in one] == [row[0] for row in two], "the runs differ in their steps")
    family = {name: name.split("[")[0] for name in names}
    largest = dict.fromkeys(family.values(), 0.0)
    for i, name in enumerate(names, start=1):
        largest[family[name]] = max(largest[family[name]], *(abs(row[i]) for row in one))
    worst = (0.0, "none")
    for i, name in enumerate(names, start=1):
        require(all(math.isfinite(row[i]) for row in one + two), f"{name} is not finite")
        difference = max(abs(a[i] - b[i]) for a, b in zip(one, two))
        scale = SCALES[name](largest) if name in SCALES else largest[family[name]]
        if difference > 0.0:
            worst = max(worst, (difference / scale if scale > 0.0 else math.inf, name))
    return worst


def compare(platform, how, names, linux, other):
    """Compares a run on another platform with that on Linux; `how` says where it ran."""
    difference, name = largest_difference(names, linux, other)
    print(f"{platform}: the same under {how}; largest difference {difference:.2e} ({name})")
    require(difference <= TOLERANCE, f"{name} differs by {difference:.2e} between linux64 and {platform}")


def run_windows(version, library, arguments, directory):
    """Lines of the C master for Windows under wine, and the version of wine."""
    gcc = "x86_64-w64-mingw32-gcc"
    host = compiled(gcc, version, directory / "host.exe")
    output(gcc, "-O1", "-Wall", "-Wextra", "-shared", HERE / "bcryptprimitives.c", "-o", directory / "bcryptprimitives.dll", "-ladvapi32")
    environment = os.environ | {"WINEPREFIX": str(directory / "wine"), "WINEDEBUG": "-all"}
    identity, resources, *references = arguments
    drive = "file:///Z:" if version == "2.0" else "Z:"
    printed = output("wine", host, library, identity, drive + resources, *references, env=environment)
    # Its server writes to its folder for some seconds more, and the folder could not be removed.
    if server := shutil.which("wineserver", path=os.pathsep.join([os.environ["PATH"], "/usr/lib/wine"])):
        output(server, "--wait", env=environment)
    return rows(printed), output("wine", "--version").strip()


def run_arm(version, library, arguments, directory):
    """Lines of the C master for Linux on ARM under qemu, and the version of qemu."""
    host = compiled(f"{ARM_GCC}-gcc", version, directory / "host.arm", "-ldl")
    printed = output("qemu-aarch64", "-L", f"/usr/{ARM_GCC}", host, library, *arguments)
    return rows(printed), " ".join(output("qemu-aarch64", "--version").split()[:3])


def run(fmu, directory):
    """Runs all binaries and compares them."""
    version, identity, names, references = outputs(fmu / "modelDescription.xml")
    scheme, resources = "file://" if version == "2.0" else "", (fmu / "resources").as_posix()
    host = compiled("cc", version, directory / "host", "-ldl")
    linux = rows(output(host, fmu / BINARIES[version][0], identity, scheme + resources, *references))
    print(f"linux64: FMI {version}, {len(names)} outputs, state saved and restored")
    arguments = (identity, resources, *references)
    if not shutil.which("wine"):
        print("win64: skipped: wine is not installed")
    else:
        windows, wine = run_windows(version, fmu / BINARIES[version][1], arguments, directory)
        compare("win64", wine, names, linux, windows)
    if not (fmu / ARM).is_file():
        return
    if missing := [program for program in ("qemu-aarch64", f"{ARM_GCC}-gcc") if not shutil.which(program)]:
        print(f"aarch64-linux: skipped: {' and '.join(missing)} not installed")
        return
    arm, qemu = run_arm(version, fmu / ARM, arguments, directory)
    compare("aarch64-linux", qemu, names, linux, arm)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fmu", type=Path)
    parser.add_argument("--run", action="store_true", help="also run both binaries and compare")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as temporary:
        directory = Path(temporary)
        fmu = directory / "fmu"
        with zipfile.ZipFile(arguments.fmu) as archive:
            require("modelDescription.xml" in archive.namelist(), f"{arguments.fmu} is no FMU")
            version = ElementTree.fromstring(archive.read("modelDescription.xml")).get("fmiVersion")
            linux, windows = BINARIES[version]
            missing = {linux, windows, BILL} - set(archive.namelist())
            require(not missing, f"{arguments.fmu} lacks {sorted(missing)}")
            archive.extractall(fmu)
        check_linux(fmu / linux)
        check_windows(fmu / windows)
        arm = [ARM] if (fmu / ARM).is_file() else []
        for binary in arm:
            check_linux(fmu / binary)
        for binary in (linux, windows, *arm):
            check_paths(fmu / binary)
        if arguments.run:
            run(fmu, directory)


if __name__ == "__main__":
    main()
