"""Every command that pages, heads and messages tell people to type is run, as it stands or in a shorter version (`recipes.py`)."""

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tomllib
from pathlib import Path

import pytest
from documented import ROOT, blocks, commands, documented, of_markdown, of_python
from recipes import CHECKOUT, NOT_RUN, WHEEL

# What has been built is taken as it is: this test is no build.
KEPT = (
    "target/release/.built", "target/release/.coach", "target/wheelrail.fmu", ".venv/.installed", ".venv/.train", ".venv/.masters",
    ".venv/.records",
)  # fmt: skip
MAKE = " ".join(["make", *(f"-o {path}" for path in KEPT)])
VERSION = tomllib.loads((ROOT / "python/pyproject.toml").read_text())["project"]["version"]


def clean(**variables):
    """The environment without what would lead a command to this checkout or to the make that runs this test."""
    foreign = ("PYTHON", "WHEELRAIL", "COV", "MAKE", "MFLAGS", "VIRTUAL_ENV", "PYTEST", "CARGO_TARGET_DIR")
    return {name: value for name, value in os.environ.items() if not name.startswith(foreign)} | variables


def small(folder):
    """A scenario of a slow train whose brake acts at once, with the files it names."""
    shutil.copytree(ROOT / "examples/train", folder / "train")
    brake = folder / "train" / "disc_brake.json"
    brake.write_text(json.dumps(json.loads(brake.read_text()) | {"fill_time": 0.1, "delay": 0.0}))
    path = folder / "train" / "low_adhesion.json"
    scenario = json.loads(path.read_text()) | {"speed": 0.5, "step": 0.01, "hold": 0.05, "sweep": {"speed": [0.5, 0.6]}}
    scenario["wheel"] |= {"mesh.elements_per_half_width": 6}
    path.write_text(json.dumps(scenario))
    return path


def typed(recipe, cwd, out, environment, packed):
    """Output of what a recipe types; it must end with 0 and say what it is to say."""
    names = {"out": out, "fmu": packed, "root": ROOT, "version": VERSION, "small": out / "train" / "low_adhesion.json"}
    if "{small}" in recipe.typed:
        small(out)
    command = re.sub(r"\bmake (?=[a-z])", f"{MAKE} ", recipe.typed.format(**names))
    done = subprocess.run(["bash", "-c", command], cwd=cwd, env=environment, capture_output=True, text=True, timeout=600)
    print(command, done.stdout[-2000:], done.stderr[-2000:], sep="\n")
    assert done.returncode == 0, f"{command}: ends with {done.returncode}\n{done.stdout[-2000:]}\n{done.stderr[-3000:]}"
    assert recipe.says.format(**names) in done.stdout + done.stderr, f"{command}: does not say {recipe.says!r}"
    return done.stdout


@pytest.fixture(scope="module")
def empty(tmp_path_factory, packed):
    """A folder with an environment into which the wheel alone was installed, packages of others beside it, and results to look at."""
    place = tmp_path_factory.mktemp("empty")
    build = [sys.executable, ROOT / "packaging/wheel.py", packed, "--out", place]
    subprocess.run(build, cwd=place, env=clean(), check=True, capture_output=True)
    # The pip of the tests installs into it: unpacking another one would take longer than all the rest.
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", "venv"], cwd=place, env=clean(), check=True)
    (wheel,) = place.glob("*.whl")
    python = place / "venv/bin/python"
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-index", wheel]
    subprocess.run(pip, cwd=place, env=clean(), check=True)
    # Dependencies come from the environment of the tests, whose own link to the checkout such a line does not follow.
    packages = subprocess.run([python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"], capture_output=True, text=True)
    Path(packages.stdout.strip(), "others.pth").write_text(sysconfig.get_path("purelib") + "\n")
    environment = clean(PATH=f"{place / 'venv/bin'}:{os.environ['PATH']}", MPLBACKEND="Agg")
    make = (
        "import wheelrail, numpy, csv; assert wheelrail.__file__.startswith('venv') or '/venv/' in wheelrail.__file__, wheelrail.__file__\n"
        "run = wheelrail.simulate({'initial.velocity': 20.0}, {'brake.torque': 8000.0}, stop=0.3, every=10, progress=False, depth=True, patch=True)\n"
        "wheelrail.save(run, 'run.nc'); wheelrail.table(run).astype(float).to_csv('run.csv')\n"
        "rows = [(0.01 * k, 1e-5 * numpy.sin(3.0 * k)) for k in range(500)]\n"
        "csv.writer(open('rail.csv', 'w')).writerows([('position', 'height'), *rows])\n"
    )
    subprocess.run([python, "-c", make], cwd=place, env=environment, check=True)
    (place / "brake.csv").write_text("time,brake.torque\n0,0\n0.005,0\n0.01,2000\n")
    return place, environment


@pytest.mark.parametrize("recipe", CHECKOUT, ids=lambda recipe: recipe.documented[0])
def test_commands_of_a_checkout_run(recipe, packed, tmp_path):
    typed(recipe, ROOT, tmp_path, clean(MPLBACKEND="Agg"), packed.resolve())


def test_python_commands_run_from_the_wheel_in_an_empty_environment(empty, packed, tmp_path):
    place, environment = empty
    for number, recipe in enumerate(WHEEL):
        out = tmp_path / str(number)
        out.mkdir()
        typed(recipe, place, out, environment, packed.resolve())


def words(text):
    """Words of a command; programs of an environment by their names alone."""
    return re.sub(r"^(?:\.venv/bin/|target/release/)", "", text).replace("python3", "python").split()


def is_part(text, whole):
    """True if a command names the same program and nothing that a longer one lacks, in the same order."""
    short, long = words(text), iter(words(whole))
    return short[:2] == words(whole)[:2] and short[0] != "make" and all(word in long for word in short)


def unknown(texts, known):
    """Commands for which there is no recipe, nor one of a longer form of them."""
    return [text for text in texts if text not in known and not any(is_part(text, other) for other in known)]


def known():
    """All texts that a recipe runs or that have a reason not to be run."""
    run = [text for recipe in (*CHECKOUT, *WHEEL) for text in recipe.documented]
    return run + [text for texts in NOT_RUN.values() for text in texts]


def test_every_documented_command_has_a_recipe_and_every_recipe_is_documented():
    found, recipes = documented(), known()
    print(f"{len(found)} commands, {len(recipes)} texts of recipes, {sum(map(len, NOT_RUN.values()))} of them not run")
    missing = {text: sorted(found[text]) for text in unknown(found, recipes)}
    assert not missing, f"say in recipes.py how these are run: {missing}"
    assert len(recipes) == len(set(recipes)), [text for text in recipes if recipes.count(text) > 1]
    stale = sorted(set(recipes) - set(found))
    assert not stale, f"these stand on no page: {stale}"


def test_every_target_of_the_makefile_stands_in_its_head():
    text = (ROOT / "Makefile").read_text()
    targets = set(re.search(r"^\.PHONY: ((?:.*\\\n)*.*)", text, re.MULTILINE)[1].replace("\\", "").split())
    named = set(re.findall(r"^# make ([a-z0-9-]+)", text, re.MULTILINE))
    assert len(targets) <= 25, sorted(targets)
    assert named <= targets and targets - named == {"test-rust", "test-fmpy", "environments", "compilers"}, targets ^ named


def test_every_study_stands_in_the_head_of_the_makefile_and_a_retired_target_says_its_new_form():
    text = (ROOT / "Makefile").read_text()
    studies = re.search(r"^STUDIES := (.*)", text, re.MULTILINE)[1].split()
    assert re.findall(r"^#                ([a-z-]+)  +[a-z]", text, re.MULTILINE) == studies
    for study in studies:
        assert len(list((ROOT / "examples").glob(f"ex??_{study.replace('-', '_')}.py"))) == 1, study
    retired = {"hunting": "study NAME=hunting", "platforms-check": "fmu ALL=1 CHECK=1", "quick": "loop TEST=lib"}
    for target, now in retired.items():
        done = subprocess.run([*MAKE.split(), target], cwd=ROOT, env=clean(), capture_output=True, text=True)
        assert done.returncode and f"`make {now}`" in done.stderr, (target, done.stderr)


def test_options_of_targets_count_where_they_are_typed_and_not_in_the_environment():
    def planned(*words):
        done = subprocess.run([*MAKE.split(), "-n", *words], cwd=ROOT, env=clean() | {"NAME": "HOST", "ALL": "1"}, capture_output=True, text=True)
        return done.stdout

    assert "--bench table" in planned("bench") and "--bench ordinary" in planned("bench", "NAME=ordinary")
    assert "ex03_endurance" in planned("endurance") and "ex04_random_parameters" in planned("endurance", "NAME=parameters")
    assert "wheelrail-all" not in planned("wheel") and "wheelrail-all" in planned("wheel", "ALL=1")
    # Arguments of one's own choose one study of locked wheels.
    assert [planned("study", "NAME=locked-wheels", *more).count("ex05_locked_wheels.py --fmu") for more in ([], ["ARGS=--jobs 1"])] == [2, 1]


def test_a_command_in_a_page_is_seen_wherever_it_stands():
    page = "Run `make new` first, or\n`python -m wheelrail\nnew`.\n\n    cargo new --x    # or `pip install new`\n\n```sh\nmake other A=1  # x\n```\n"
    lines = of_markdown(page)
    seen = {text for line in lines for text in commands(line)}
    assert seen == {"make new", "python -m wheelrail new", "cargo new --x", "pip install new", "make other A=1"}
    assert set(unknown(seen, known())) == seen
    assert of_python('"""Head.\n\n    make new\n"""\nx = f"take {1}: pip install \'a[b]\'"\n') == ["    make new", "pip install 'a[b]'"]
    assert is_part("wheelrail simulate --out", "wheelrail simulate --stop 5 --out run.csv")
    assert not is_part("wheelrail simulate --new", "wheelrail simulate --stop 5 --out run.csv")
    assert not is_part("make train", "make train SCENARIO=x")


def dry(text):
    """What make would do for a command."""
    done = subprocess.run(["bash", "-c", f"{text.replace('make', MAKE + ' -n', 1)}"], cwd=ROOT, env=clean(), capture_output=True, text=True)
    assert done.returncode == 0, f"{text}: {done.stderr}"
    return done.stdout


def check_cargo(text):
    """Programs, examples and packages that a command of cargo names exist."""
    for option, folder in (("--test", "tests"), ("--example", "examples"), ("-p", "")):
        for name in re.findall(rf"{option} ([\w-]+)", text):
            places = {"tests": [f"tests/{name}.rs", f"tests/{name}/main.rs", f"thesis/tests/{name}", f"thesis/tests/{name}.rs"], "examples": [f"examples/{name}"]}
            exists = name.isupper() or any((ROOT / place).exists() for place in places.get(folder, [name.removeprefix("wheelrail-").replace("wheelrail", "src")]))
            assert exists, f"{text}: no {option} {name}"
    alias = (ROOT / ".cargo/config.toml").read_text()
    assert text.split()[1] in ("build", "check", "test", "run", "bench") or f"\n{text.split()[1]} = " in alias, text


def check_pip(text):
    """Packages that pip is to install are this one, with extras that it has, or one that it asks for."""
    about = tomllib.loads((ROOT / "python/pyproject.toml").read_text())["project"]
    name, extra = re.search(r"install '?(?:\./)?([a-z-]+)(?:\[(\w+)\])?", text).groups()
    asked = [needed for group in about["optional-dependencies"].values() for needed in group]
    assert name in ("wheelrail", "python") or any(needed.startswith(name) for needed in asked), text
    assert extra is None or extra in about["optional-dependencies"], text


def check_script(text):
    """Options that a command names stand in the source of its script."""
    script = next(ROOT / word for word in text.split() if word.endswith((".py", "run")))
    source = script.read_text()
    assert all(option in source for option in re.findall(r"--\w[\w-]*", text) if option != "--test"), text


def test_what_is_not_run_names_what_exists():
    for text in (text for texts in NOT_RUN.values() for text in texts if text != "make TARGET"):
        if text.startswith("make "):
            planned = dry(text)
            scripts = re.findall(r"(?:^|\s)((?:examples|packaging|tools|thesis)/[\w/]+\.(?:py|m))", planned)
            assert all((ROOT / script).is_file() for script in scripts), (text, scripts)
            for line in planned.splitlines():
                for command in re.findall(r"\bcargo (?!doc|clean|tree)[a-z].*", line):
                    check_cargo(command.split(" -- ")[0])
        elif text.startswith("cargo "):
            check_cargo(text)
        elif "pip install" in text:
            check_pip(text) if "…" not in text else None
        elif re.search(r"\.py\b|\.ci/run", text):
            check_script(text)


def test_tests_that_the_makefile_names_exist():
    makefile = (ROOT / "Makefile").read_text().replace("\\\n", " ")
    names = re.search(r"^LEAK_TESTS := (.*)", makefile, re.MULTILINE)[1].split()
    assert len(names) > 5
    for name in names:
        file, test = name.split("::")
        assert f"fn {test}()" in (ROOT / f"tests/fmi/{file}.rs").read_text(), name


# What a page has before its Python blocks, and what is shortened in them.
BEFORE = {
    "docs/coupling.md": (
        "import wheelrail\nfmu = wheelrail.Fmu()\nwheel = wheelrail.Wheel(fmu, {'initial.velocity': 20.0})\n"
        "wheels, omega, h = [wheel], wheel.get('wheel.omega'), 1e-3\n"
    ),
    "docs/train.md": "class MyProtection:\n    def __init__(self, wsp, speeds):\n        self.n = len(speeds)\n    def step(self, h, speeds):\n        return ['apply'] * self.n\n",
}
SHORTER = {
    "docs/packages.md": [("stop_time=5.0", "stop_time=0.05")],
    "docs/damage.md": [("stop=0.3", "stop=0.05"), ("range(150)", "range(40)")],
    "docs/train.md": [('"speed": 20.0', '"speed": 0.5'), ("Stop(loaded, fmu)", "Stop(loaded)")],
}
NEEDS = {"docs/packages.md": "libcosimpy"}


@pytest.mark.parametrize("page", sorted(blocks()))
def test_python_blocks_of_a_page_run_in_its_order(page, empty, tmp_path):
    place, environment = empty
    if page in NEEDS:
        pytest.importorskip(NEEDS[page])
    code = "\n".join(blocks()[page])
    for longer, shorter in SHORTER.get(page, []):
        assert longer in code, f"{page} has no {longer} any more"
        code = code.replace(longer, shorter)
    subprocess.run([place / "venv/bin/python", "-m", "wheelrail.examples", "try"], cwd=tmp_path, env=environment, check=True, capture_output=True)
    if page == "docs/packages.md":
        made = ["wheelrail", "ssp", "examples/train/low_adhesion.json", "--coach", ROOT / "target/release"]
        subprocess.run([place / "venv/bin/python", "-m", *made], cwd=tmp_path / "try", env=environment, check=True, capture_output=True)
    done = subprocess.run(
        [place / "venv/bin/python", "-c", BEFORE.get(page, "") + code], cwd=tmp_path / "try", env=environment, capture_output=True, text=True
    )
    print(page, done.stdout[-500:])
    assert done.returncode == 0, f"{page}:\n{done.stderr[-3000:]}"
    if page == "README.md":
        hottest, turns = re.fullmatch(r"(\d+) °C, (\S+) rad/s\n", done.stdout).groups()
        print(f"figure: readme.hottest [°C] = {hottest} ± 0.0005\nfigure: readme.stands [rad/s] = {turns}")
