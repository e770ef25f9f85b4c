"""Exported fields are what readers of others make of them: a binary series holds what the text of one moment holds."""

import os
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

ROOT = Path(__file__).parent.parent
BINARY = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release" / "wheelrail"
COARSE = ["mesh.elements_per_half_width=4", "rail.length=0.5", "wheel.hub_radius=0.36", "initial.velocity=15"]
COARSE = [part for setting in COARSE for part in ("--set", setting)]
RUN = ["--stop", "2e-3", "--step", "1e-3"]
PARTS = ["wheel", "rail", "wheel_temperature", "rail_temperature"]


def export(*arguments):
    """The finished command."""
    if not BINARY.is_file():
        pytest.skip(f"{BINARY} does not exist: build it with `make fmu`")
    command = [BINARY, "export", "--resources", ROOT / "resources", "--cache", ROOT / "target", *arguments]
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)


@pytest.fixture(scope="module")
def series(tmp_path_factory):
    """The directory of a series of three moments under a growing load, and that of its last one as text."""
    film, last = (tmp_path_factory.mktemp(name) for name in ("film", "last"))
    (last / "load.csv").write_text("time,drive.load,brake.torque\n0,1e5,4000\n0.002,1.3e5,4000\n")
    run = [*COARSE, *RUN, "--scenario", last / "load.csv"]
    for done in (export(*run, "--every", "1e-3", "--out", film), export(*run, "--out", last)):
        assert done.returncode == 0, done.stderr
    return film, last


def test_a_series_names_its_times_and_files(series):
    film, _ = series
    sets = ElementTree.parse(film / "fields.pvd").findall("Collection/DataSet")
    assert [(s.get("timestep"), s.get("file")) for s in sets] == [
        (time, f"{part}_{k:04}.vtu") for k, time in enumerate(["0.0", "0.001", "0.002"]) for part in PARTS
    ]
    assert all((film / s.get("file")).is_file() for s in sets)


def test_meshio_reads_the_same_numbers_from_both_forms(series):
    meshio = pytest.importorskip("meshio", reason="meshio is not installed (requirements/records.txt)")
    film, last = series
    for part in PARTS:
        binary, text = meshio.read(film / f"{part}_0002.vtu"), meshio.read(last / f"{part}.vtu")
        np.testing.assert_array_equal(binary.points, text.points)
        np.testing.assert_array_equal(binary.cells_dict["quad"], text.cells_dict["quad"])
        assert set(binary.point_data) == set(text.point_data) and len(binary.points) > 1000
        for name, values in binary.point_data.items():
            np.testing.assert_array_equal(values, text.point_data[name])
    assert (film / "wheel_0002.vtu").stat().st_size < 0.7 * (last / "wheel.vtu").stat().st_size
    largest = [meshio.read(film / f"rail_{k:04}.vtu").point_data["von_mises"].max() for k in range(3)]
    assert largest[0] < largest[1] - 1e6 and largest[1] < largest[2] - 1e6


def test_pyvista_reads_the_series(series):
    pyvista = pytest.importorskip("pyvista", reason="pyvista is not installed")
    reader = pyvista.get_reader(str(series[0] / "fields.pvd"))
    assert reader.time_values == [0.0, 1e-3, 2e-3]
    reader.set_active_time_value(2e-3)
    blocks = reader.read()
    assert len(blocks) == 4 and "von_mises" in blocks[0].point_data and "temperature" in blocks[3].point_data
    surface = blocks[2].point_data["temperature"]
    assert surface.max() > surface.min() + 1.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--every", "0", "--stop", "1"], "--every = 0 is outside its range: finite, at least --step = 0.001 s"),
        (["--every", "1e-4", "--stop", "1"], "at least --step = 0.001 s"),
        (["--every", "nan", "--stop", "1"], "--every = NaN is outside its range"),
        (["--every", "often"], "often"),
        (["--every", "0.1", "--creepage", "0"], "does not change: --every needs a run"),
        (["--every", "0.1", "--set", "solver.response=reduced"], "solver.response is decided by the command"),
        (["--every", "0.1", "--scenario", "no.csv"], "no.csv"),
    ],
)
def test_a_series_that_cannot_be_is_refused_before_anything_is_written(tmp_path, arguments, words):
    done = export(*arguments, "--out", tmp_path / "film")
    assert done.returncode == 2 and words in done.stderr and "panicked" not in done.stderr, done.stderr
    assert not (tmp_path / "film").exists()


def test_a_directory_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    done = export(*COARSE, *RUN, "--every", "1e-3", "--out", tmp_path / "file")
    assert done.returncode == 1 and "cannot be written" in done.stderr
