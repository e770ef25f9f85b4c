"""Fields of the whole bodies are what readers of others make of them; what they are is tested in tests/wheel/body_fields.rs."""

import subprocess
from xml.etree import ElementTree

import pytest
from conftest import ROOT

COARSE = ["mesh.elements_per_half_width=4", "rail.length=0.5", "wheel.hub_radius=0.36", "initial.velocity=15"]
COARSE = [part for setting in COARSE for part in ("--set", setting)]
PARTS = ["wheel", "rail", "wheel_temperature", "rail_temperature"]


def fields(*options):
    """The finished example."""
    command = ["cargo", "run", "--release", "--locked", "--quiet", "--example", "fields", "--", *map(str, options)]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True)


@pytest.fixture(scope="module")
def film(tmp_path_factory):
    """The folder of a series of three moments under a brake."""
    film = tmp_path_factory.mktemp("film")
    done = fields(*COARSE, "--torque", "4000", "--stop", "2e-3", "--every", "1e-3", "--out", film)
    assert done.returncode == 0, done.stderr
    return film


def test_a_series_names_its_times_and_files(film):
    sets = ElementTree.parse(film / "fields.pvd").findall("Collection/DataSet")
    assert [(s.get("timestep"), s.get("file")) for s in sets] == [
        (time, f"{part}_{k:04}.vtu") for k, time in enumerate(["0.0", "0.001", "0.002"]) for part in PARTS
    ]


def test_meshio_reads_it(film):
    meshio = pytest.importorskip("meshio", reason="meshio is not installed (requirements/records.txt)")
    for part in PARTS:
        grid = meshio.read(film / f"{part}_0002.vtu")
        assert len(grid.points) > 1000 and grid.cells_dict["quad"].max() == len(grid.points) - 1
        assert all(len(values) == len(grid.points) for values in grid.point_data.values())
    shears = [abs(meshio.read(film / f"rail_{k:04}.vtu").point_data["sigma_xy"]).max() for k in (0, 2)]
    assert shears[1] > 1.001 * shears[0]


def test_pyvista_reads_it(film):
    pyvista = pytest.importorskip("pyvista", reason="pyvista is not installed")
    reader = pyvista.get_reader(str(film / "fields.pvd"))
    assert reader.time_values == [0.0, 1e-3, 2e-3]
    reader.set_active_time_value(2e-3)
    blocks = reader.read()
    assert len(blocks) == 4 and "von_mises" in blocks[0].point_data and "temperature" in blocks[3].point_data


@pytest.mark.parametrize(
    "options, words",
    [
        (["--stop", "1", "--every", "1e-4"], "--every are more than 0"),
        (["--set", "drive.load=1"], "drive.load is unknown"),
        (["--preset", "tram"], "tram.json"),
        (["--set", "mesh"], "expected GROUP.NAME=VALUE"),
    ],
)
def test_what_cannot_be_is_refused(options, words, tmp_path):
    done = fields(*options, "--out", tmp_path / "film")
    assert done.returncode != 0 and words in done.stderr and not (tmp_path / "film").exists(), done.stderr
