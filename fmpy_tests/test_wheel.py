"""The wheel: installed away from any checkout it brings FMU, examples and licences; the sdist brings no FMU and says what to do."""

import os
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
BUILDER = ROOT / "packaging" / "wheel.py"


def run(*command, cwd, path=None, **variables):
    """A command of this Python away from the checkout, with packages of a folder before others."""
    plain = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "WHEELRAIL", "COV"))}
    environment = plain | ({"PYTHONPATH": str(path)} if path else {}) | variables
    return subprocess.run([sys.executable, *map(str, command)], cwd=cwd, env=environment, capture_output=True, text=True)


def succeed(*command, **options):
    """Standard output of a command that must succeed."""
    done = run(*command, **options)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.fixture(scope="module")
def installed(tmp_path_factory, packed):
    """Folder of the installed wheel with the packed FMU."""
    place = tmp_path_factory.mktemp("installed")
    succeed(BUILDER, packed, "--out", place, cwd=place)
    (wheel,) = place.glob("*.whl")
    options = ("--quiet", "--disable-pip-version-check", "--no-deps", "--no-compile", "--no-index")
    succeed("-m", "pip", "install", *options, "--target", place / "packages", wheel, cwd=place)
    return place / "packages"


def test_the_first_example_runs_from_the_wheel_alone(installed, tmp_path):
    where = succeed("-c", "import wheelrail; print(wheelrail.__file__)", cwd=tmp_path, path=installed)
    assert Path(where.strip()).is_relative_to(installed)
    text = succeed("-m", "wheelrail.examples", "try", cwd=tmp_path, path=installed)
    assert "python examples/ex00_minimal.py" in text
    rows = succeed("examples/ex00_minimal.py", cwd=tmp_path / "try", path=installed).splitlines()
    speeds = [float(row.split()[1]) for row in rows[1:]]
    assert len(speeds) == 11 and speeds[0] == 27.8 and 26.0 < speeds[-1] < 26.2
    again = run("-m", "wheelrail.examples", "try", cwd=tmp_path, path=installed)
    assert again.returncode == 1 and again.stderr == "error: try is not an empty folder: name another one\n"


def test_the_wheel_has_licences_examples_and_the_fmu_byte_for_byte(installed, packed):
    (information,) = installed.glob("wheelrail-*.dist-info")
    names = {path.name for path in (information / "licenses").iterdir()}
    assert names == {"LICENSE-MIT", "LICENSE-APACHE", "LICENSE-THIRD-PARTY"}
    assert (installed / "wheelrail" / "wheelrail.fmu").read_bytes() == packed.read_bytes()
    examples = {path.name for path in (installed / "wheelrail" / "examples" / "files").iterdir()}
    assert {"ex00_minimal.py", "ex01_braking_stop.py", "ex12_own_vehicle.py", "train"} <= examples


def test_the_fmu_and_with_it_the_wheel_brings_its_bill_of_materials(installed, tmp_path):
    succeed(ROOT / "packaging" / "sbom.py", "--out", tmp_path / "bill.json", cwd=tmp_path)
    with zipfile.ZipFile(installed / "wheelrail" / "wheelrail.fmu") as archive:
        assert archive.read("documentation/licenses/wheelrail.cdx.json") == (tmp_path / "bill.json").read_bytes()


def test_a_wheel_bears_the_platforms_of_its_fmu(packed, tmp_path):
    """An FMU of two platforms, made of the packed one, whose second library is no library: only names count here."""
    both = tmp_path / "both.fmu"
    with zipfile.ZipFile(packed) as archive, zipfile.ZipFile(both, "w") as copy:
        for name in archive.namelist():
            if not name.startswith("binaries/"):
                copy.writestr(name, archive.read(name))
        for name in ("linux64/wheelrail.so", "win64/wheelrail.dll"):
            copy.writestr(f"binaries/{name}", b"")
    name = Path(succeed(BUILDER, both, "--out", tmp_path, cwd=tmp_path).split(":")[0]).name
    assert name.endswith("-py3-none-manylinux2014_x86_64.manylinux_2_17_x86_64.win_amd64.whl")


def test_the_sdist_brings_no_fmu_and_says_what_to_do(tmp_path):
    succeed(BUILDER, "--sdist", "--out", tmp_path, cwd=tmp_path)
    (made,) = tmp_path.glob("*.tar.gz")
    with tarfile.open(made) as archive:
        archive.extractall(tmp_path, filter="data")
    source = made.with_name(made.name.removesuffix(".tar.gz"))
    assert not list(source.rglob("*.fmu")) and "Other platforms" in (source / "README.md").read_text()
    refused = run("-c", "from wheelrail import Fmu; Fmu()", cwd=tmp_path, path=source / "src")
    assert refused.returncode == 1 and "WHEELRAIL_FMU" in refused.stderr.splitlines()[-1]


SOURCES = """
import csv, sys
import wheelrail
from wheelrail import report, scenario
from wheelrail.train import Stop

run = wheelrail.simulate({"preset": "railway_wet", "initial.velocity": 20.0}, {"brake.torque": 8000.0}, stop=0.1, every=5, profiles=True)
wheelrail.save(run, "record.nc")
wheelrail.save(run[["wheel.velocity", "contact.force_x"]], "few.nc")
frame = wheelrail.table(run)[["wheel.velocity", "contact.force_x", "contact.creepage"]]
frame.to_csv("plain.csv")
frame.rename(columns={"contact.force_x": "contact.force_x [N]"}).to_csv("units.csv")
stop = Stop(scenario.load(sys.argv[1], {"speed": 1.0, "step": 0.01, "hold": 0.0}), dry=0.3)
report.write_csv("stops/train_dry.csv", stop.run())
report.write_csv("stop.csv", stop.run())
"""


@pytest.mark.parametrize("source", ["record.nc", "few.nc", "plain.csv", "units.csv", "stop.csv", "stops"])
@pytest.mark.parametrize("named", ["no FMU", "the FMU of the package", "an FMU by its path"])
def test_the_page_of_every_source_is_written_from_the_installed_package(source, named, sources, installed, packed):
    command = ["-m", "wheelrail", "report", source, "--out", f"{source}-{named[:2]}.html"]
    options = {"WHEELRAIL_FMU": str(sources / "none.fmu")} if named == "no FMU" else {}
    command += ["--fmu", packed.resolve()] if named == "an FMU by its path" else []
    text = succeed(*command, cwd=sources, path=installed, **options)
    print(text)
    page = (sources / f"{source}-{named[:2]}.html").read_text(encoding="utf-8")
    assert text.startswith("written: ") and page.startswith("<!") and len(page) > 1e6
    # The balance of momentum knows the mass of the vehicle, which is that of the preset in an FMU.
    if source == "record.nc":
        assert ("the mass that moves" in page) == (named == "no FMU")


@pytest.fixture(scope="module")
def sources(installed, tmp_path_factory):
    """A folder with files of every kind that a page is made of."""
    for name in ("plotly", "h5netcdf", "pandas"):
        pytest.importorskip(name, reason=f"{name} is not installed")
    place = tmp_path_factory.mktemp("sources")
    succeed("-c", SOURCES, ROOT / "examples" / "train" / "low_adhesion.json", cwd=place, path=installed)
    return place


def test_the_commands_of_the_package_say_their_version_and_which_are_not_theirs(installed, tmp_path):
    version = succeed("-c", "import wheelrail; print(wheelrail.__version__)", cwd=tmp_path, path=installed).strip()
    (information,) = installed.glob("wheelrail-*.dist-info")
    declared = dict(line.replace(" ", "").split("=") for line in (information / "entry_points.txt").read_text().splitlines() if "=" in line)
    assert declared == dict.fromkeys(("wheelrail", "wheelrail-train"), "wheelrail.__main__:main")
    for name in declared:
        script = installed / "bin" / name
        for command in (["--version"], ["train", "--version"], ["report", "--version"]):
            assert succeed(script, *command, cwd=tmp_path, path=installed) == f"wheelrail {version}\n"
        assert succeed(script, "--help", cwd=tmp_path, path=installed).startswith(f"usage: {name} ")
        for theirs in (["pack"], ["export", "--creepage", "2e-3"]):
            refused = run(script, *theirs, cwd=tmp_path, path=installed)
            assert refused.returncode == 2 and "cargo" in refused.stderr
    for module in ("wheelrail", "wheelrail.examples"):
        assert succeed("-m", module, "--version", cwd=tmp_path, path=installed) == f"wheelrail {version}\n"
