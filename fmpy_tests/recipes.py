"""How every documented command is run: as it stands, or in a shorter version, at the place where people type it.

A recipe is what is typed, and as which texts it stands in the pages; without texts as what is typed. Braces are filled in:
{out} is an empty folder, {fmu} the packed FMU, {small} a scenario of a slow train, {version} the version of the package.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Recipe:
    """What is typed, what it stands for, and what its output must contain."""

    typed: str
    texts: tuple = ()
    says: str = ""

    @property
    def documented(self):
        """Texts of the pages that this recipe runs."""
        return self.texts or (self.typed,)


def short(study, arguments, says="written"):
    """A study whose program gets options by ARGS and a folder by OUT."""
    return Recipe(f'make study NAME={study} ARGS="{arguments}" OUT={{out}}', (f"make study NAME={study}",), says)


# In a checkout whose FMU is packed.
CHECKOUT = (
    Recipe("make help", says="make clean"),
    Recipe('make demo ARGS="--speed-kmh=20" OUT={out}', ("make demo", "make demo ARGS=--speed-kmh=20"), "written"),
    short("creep-curve", "--brief"),
    short("ellipse", "--brief"),
    short("angle-of-attack", "--brief"),
    short("hunting", "--brief --speeds 75"),
    short("published", "--brief"),
    short("masters", "--brief"),
    short("suspension", "--brief"),
    short("own-vehicle", "--brief"),
    short("surfaces", "--brief"),
    Recipe(
        'make study NAME=flat ARGS="--once --slide 0.1 --roll 0.2" OUT={out}', ("make study NAME=flat", 'make study NAME=flat ARGS="--once --slide 0.1 --roll 0.2"'), "written"
    ),
    Recipe(
        'make study NAME=eight-wheels ARGS="--seconds 0.02 --settling 0.02 --drives held"', ("make study NAME=eight-wheels", 'make study NAME=eight-wheels ARGS="--seconds 5"'), "threads",
    ),
    Recipe(
        'make study NAME=eight-wheels ARGS="--seconds 0.01 --settling 0.05 --drives slide --set preset=railway_ellipse"',
        ('make study NAME=eight-wheels ARGS="--set preset=railway_ellipse"',), "threads",
    ),
    Recipe('make study NAME=eight-wheels ARGS="--before {fmu} --seconds 0.02 --settling 0.02 --drives varying"', ('make study NAME=eight-wheels ARGS="--before older.fmu"',), "threads"),
    Recipe(
        "make train SCENARIO={small} OUT={out} FORCE=1",
        ("make train", "make train SCENARIO=my/scenario.json", "make train SCENARIO=my/scenario.json FORCE=1"), "stopping distance",
    ),
    Recipe("make sweep SCENARIO={small} OUT={out}", ("make sweep",), "written"),
    Recipe("make ssp SCENARIO=examples/train/low_adhesion.json", ("make ssp", "make ssp SCENARIO=my/scenario.json"), "written"),
    Recipe('make endurance ARGS="--steps 3000"',
        ("make endurance", "cargo run --release --example ex03_endurance -- --steps 1000000"), "Recover",
    ),  # fmt: skip
    Recipe("make endurance NAME=parameters ARGS=2", ("make endurance NAME=parameters",), "2 parameter sets"),
    Recipe("cargo run --release --locked -p wheelrail-contact --example strip", says="Carter"),
    Recipe(
        "cargo run --release --locked --example fields -- --creepage 2e-3 --set mesh.elements_per_half_width=5 --set material.expansion=0 --out {out}",
        ("cargo run --release --example fields", "cargo run --release --example fields -- --creepage 2e-3 --out fields"), "fields.pvd with 1 moments",
    ),
    Recipe(
        "cargo run --release --locked --example fields -- --torque 4000 --stop 2e-3 --every 1e-3 --set mesh.elements_per_half_width=5 --out {out}",
        ("cargo run --release --example fields -- --torque 4000 --stop 0.05 --every 0.01 --out film",), "fields.pvd with 3 moments",
    ),
    Recipe("target/release/wheelrail-pack pack --out {out}/packed.fmu", ("wheelrail-pack pack",), "packed.fmu"),
    Recipe("target/release/wheelrail-pack describe --fmi 3", ("wheelrail-pack describe",), 'fmiVersion="3.0"'),
    Recipe("make fmu"),
    Recipe("make wheel", says=".whl"),
    Recipe("tools/house.py", says="lines"),
    Recipe("tools/mutations.py --check", says="coefficients stand in the source"),
    Recipe("tools/house.py --all"),
    Recipe("tools/figures.py --by-hand", says="rows"),
    Recipe("tools/house.py --json", says="{{"),
    Recipe("tools/house.py contact"),
    Recipe("tools/house.py contact rolling"),
    Recipe(
        ".venv/bin/python examples/ex05_locked_wheels.py --speeds 60 --steps 1e-3 --meshes 10 --stop 0.05 --out {out}",
        ("python examples/ex05_locked_wheels.py --speeds 60 --steps 1e-3,2e-4 --meshes 10,20",),
    ),
    Recipe("python3 packaging/release.py v{version}", ("python3 packaging/release.py v0.4.0",), "{version}"),
    Recipe("python3 packaging/sbom.py --out {out}/bill.json", ("python3 packaging/sbom.py --out FILE [--target TRIPLE ...]",), "crates"),
    Recipe(".venv/bin/python packaging/wheel.py --sdist --out {out}", (".venv/bin/python packaging/wheel.py --sdist [--out FOLDER]",), ".tar.gz"),
    Recipe(".venv/bin/python packaging/wheel.py {fmu} --out {out}", (".venv/bin/python packaging/wheel.py FMU [--out FOLDER]",), ".whl"),
    Recipe(
        ".venv/bin/python tools/same_results.py {fmu} {fmu} --only railway,paper_a",
        (
            ".venv/bin/python tools/same_results.py BEFORE.fmu AFTER.fmu [--only NAME,NAME] [--tolerance 0] [--jobs 2]",
            ".venv/bin/python tools/same_results.py BEFORE.fmu AFTER.fmu",
        ), "0 of 2 cases differ",
    ),
    Recipe(".venv/bin/python examples/ex00_minimal.py", says="temperature.wheel_max"),
    Recipe(".venv/bin/python examples/ex18_next_wheel.py", says="braking force"),
    Recipe(
        ".venv/bin/python examples/ex17_own_controller.py --seconds 0.2",
        (".venv/bin/python examples/ex17_own_controller.py", ".venv/bin/python examples/ex17_own_controller.py --controller my.fmu --step 2e-3"),
        "no protection",
    ),
    Recipe(
        ".venv/bin/python -m wheelrail ssp examples/train/low_adhesion.json --coach target/release --out {out} && .venv/bin/python "
        "examples/ex17_own_controller.py --package {out}/coach_and_wheels.ssp --out {out}/own.ssp",
        (".venv/bin/python examples/ex17_own_controller.py --package target/coach_and_wheels.ssp --out own.ssp",), "own.ssp",
    ),  # fmt: skip
    Recipe(".venv/bin/python -m pytest -s fmpy_tests/test_dependencies.py", (".venv/bin/python -m pytest -s",), " passed"),
)

# In an empty folder with an environment into which the wheel alone was installed, in this order.
WHEEL = (
    Recipe(
        "python -m wheelrail.examples try", ("python -m wheelrail.examples try", "python -m wheelrail.examples FOLDER"), "ex00_minimal.py"
    ),
    Recipe("cd try && python examples/ex00_minimal.py", ("python examples/ex00_minimal.py",), "temperature.wheel_max"),
    Recipe("python -m wheelrail --version", says="{version}"),
    Recipe("python -m wheelrail train {small} --force", ("python -m wheelrail train examples/train/low_adhesion.json",), "stopping distance"),
    Recipe("python -m wheelrail force results/low_adhesion/train_wsp_on.csv --column force_1", says="mean"),
    Recipe(
        "python -m wheelrail train {small} --rigid --force", (".venv/bin/python -m wheelrail train SCENARIO --rigid",), "stopping distance"
    ),
    Recipe("python -m wheelrail sweep {small} --rigid", ("python -m wheelrail sweep examples/train/low_adhesion.json",), "written"),
    Recipe(
        "cd try && python -m wheelrail ssp examples/train/low_adhesion.json --coach {root}/target/release",
        ("python -m wheelrail ssp examples/train/low_adhesion.json",), "written",
    ),
    Recipe("python -m wheelrail schema scenario", says='"properties"'),
    Recipe("python -m wheelrail force run.csv", says="mean"),
    Recipe(
        "python -m wheelrail force run.csv --out {out}",
        ("python -m wheelrail force | spectrum | octaves | flat | filter",),
    ),
    Recipe("python -m wheelrail spectrum run.csv"),
    Recipe("python -m wheelrail octaves rail.csv --over position --column height", ("python -m wheelrail octaves rail.csv",)),
    Recipe("python -m wheelrail flat run.csv"),
    Recipe("python -m wheelrail filter", says="CNOSSOS"),
    Recipe("python -m wheelrail report run.nc", says="run.html"),
    Recipe("python -m wheelrail damage run.nc", says="hottest point of the tread"),
    Recipe("python -m wheelrail export run.nc", ("python -m wheelrail export run.nc", "python -m wheelrail export run.nc --out film"), "patch.pvd"),
    Recipe("python -m wheelrail simulate --scenario brake.csv --out brake_run.csv", ("python -m wheelrail simulate --scenario brake.csv --out run.csv",), "energy residual"),
    Recipe("wheelrail simulate --scenario brake.csv --stop 0.05 --out run5.csv", ("wheelrail simulate --scenario brake.csv --stop 5 --out run.csv", "wheelrail simulate --out run.csv"), "energy residual"),
    Recipe(
        "wheelrail simulate --stop 0.1 --wheel-profile out.csv --out run1.csv",
        ("wheelrail simulate --wheel-profile out.csv", "wheelrail simulate … --wheel-profile out.csv"),
    ),
    Recipe("wheelrail steady --velocity 27.8 --table", says="creepage"),
    Recipe("wheelrail steady --preset paper_d --creepage=-1e-3:1e-3:41 > curve.csv && head -2 curve.csv",
        ("wheelrail steady --preset paper_d --creepage=-1e-3:1e-3:41 > curve.csv",), "creepage",
    ),  # fmt: skip
    Recipe("python -m wheelrail steady --creepage 0:2e-3:5", says="contact.force_x"),
    Recipe(
        "cd try && python -m wheelrail patch examples/profiles/s1002.prw examples/profiles/60e1.prr --inclination 1:40 --shift -1:3:2",
        (
            "python -m wheelrail patch examples/profiles/s1002.prw examples/profiles/60e1.prr --inclination 1:40 --shift -1:3:2",
            "python -m wheelrail patch examples/profiles/s1002.prw examples/profiles/60e1.prr --inclination 1:40", "python -m wheelrail patch",
        ), "equivalent conicity",
    ),  # fmt: skip
    Recipe("python -m wheelrail completion bash", says="complete"),
    Recipe("python -m wheelrail report run.csv --out page.html", (".venv/bin/python -m wheelrail report RUN [--out FILE.html]",), "page.html"),
)

# What is not run here, and why. Targets, files, options, tests and packages that these name exist all the same: see the test.
NOT_RUN = {
    "computes for minutes and has no short version; what it measures is compared elsewhere": (
        "make endurance NAME=temperatures", "make endurance NAME=memory", "make bench", "make bench NAME=ordinary", "make bench NAME=ordinary BEFORE=…",
        "make bench NAME=ordinary BEFORE=older.fmu",
        'make bench NAME=ordinary BEFORE=older.fmu ARGS="--cases varying-30,lock-up --repeats 5 --json results/ordinary.json"',
        'make bench NAME=ordinary BEFORE=older.fmu ARGS="--set mesh.grid_elements_per_half_width=20 --set mesh.elements_per_half_width=10"',
        "make study NAME=locked-wheels", "tools/structural_width.py", "tools/structural_width.py wheels",
        "cargo bench",
    ),
    "recomputes figures of the thesis, most of which its tests compute in every run": (
        "make thesis", "make thesis FULL=1", "make thesis ACCEPT=1", "cargo run -p wheelrail-thesis -- --page",
        'cargo run --release --locked -p wheelrail-thesis -- "B 14" "C 14" "C 15"',
        'cargo run --release --locked -p wheelrail-thesis -- "C 7" "C 8–11"',
        'cargo run --release --locked -p wheelrail-thesis -- "A 11" "D T1"',
        'cargo run --release --locked -p wheelrail-thesis -- "A 13–14" "B 18–19"',
        'cargo run --release --locked -p wheelrail-thesis -- "A 5–6"', 'cargo run --release --locked -p wheelrail-thesis -- "I 5.1" "B 7"',
        'cargo run --release --locked -p wheelrail-thesis -- "D 11–15"', 'cargo run --release --locked -p wheelrail-thesis -- "D 16–17"',
    ),
    "this test runs within it, or it compiles everything once more": (
        ".ci/run", "make test", "make test-fmpy", "make loop TEST=brake", "make loop TEST=tree", "make loop TEST=NAME",
        "make loop TEST=default_values", "make loop TEST=model_description", "python3 -m unittest discover tools", "make loop TEST=lib ARGS=MODULE::",
        "make figures", "make figures ALL=1", "make figures ACCEPT=1", 'make figures ACCEPT=1 REASON="..."',
        'make figures ACCEPT=1 REASON="fewer nodes"', "python3 tools/run_tests.py -p wheelrail --test contact", "tools/figures.py --keep locked-wheels make study NAME=locked-wheels",
        "make mutations", "tools/mutations.py", "tools/mutations.py film damping", "tools/mutations.py --factor 0.95",
        "tools/mutations.py --brief", "tools/figures.py", "make bench NAME=instructions", "tools/instructions.py", "tools/instructions.py --accept",
        "make loop TEST=lib", "make loop TEST=lib ARGS=profile", "make loop TEST=lib ARGS=every_output", "make docs", "make clean", "make fmu PROFILES=no",
        "cargo build --release", "cargo check --release --lib", "cargo loop --test wheel brake::", "cargo test",
        "cargo test --release -p wheelrail-thesis -- --nocapture", "cargo test --release -p wheelrail-thesis --test all NAME::",
        "cargo run --release --example", "tools/run_tests.py", "tools/run_tests.py -p wheelrail -p wheelrail-slave",
    ),
    "writes into the checkout what other tests compare with what is there": (
        "make describe", ".venv/bin/python examples/reference/make.py --fmu target/wheelrail.fmu",
        ".venv/bin/python docs/model_png.py", ".venv/bin/python docs/doors_png.py", "docs/third_party.py",
    ),
    "needs compilers for Windows, WebAssembly, wine, another machine or packages from the network": (
        "make bench-page",
        "make fmu ALL=1", "make fmu ALL=1 CHECK=1", "make wheel ALL=1", "make release", "python3 packaging/handout.py FOLDER", "make site", "make sweep SCHEDULER=tcp://cluster:8786",
        "make sweep SCHEDULER=tcp://host:8786", "dask scheduler", "dask worker tcp://cluster:8786",
        "python3 packaging/hashes.py [FILE...]", "python3 packaging/check.py FMU", "python3 packaging/check.py FMU --run", "wheelrail-pack pack --binary linux64=target/release/libwheelrail.so",
        "wheelrail-pack pack --binary win64=path/to/wheelrail.dll --binary darwin64=path/to/libwheelrail.dylib",
        "pip install ./python", "pip install './python[records]'", "pip install 'wheelrail[records]'", "pip install 'wheelrail[report]'",
        "pip install exudyn", "pip install wheelrail", "python -m pip install 'wheelrail[sweep]'",
    ),
    "the fixture does it: it makes the environment of the other recipes": ("python -m venv venv", "pip install wheelrail-….whl", "pip install 'wheelrail-….whl[records]'"),
    "another test calls just that": (
        *(f"python examples/trials/{who}.py [DIRECTORY]" for who in ("brakes", "damage", "vehicle")), "fmpy validate",
    ),
    "stands for any of the others": ("make TARGET",),
}  # fmt: skip
