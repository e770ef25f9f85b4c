"""Files are written beside what is there and put in its place when they are whole: what fails, costs the new file only."""

import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import numpy as np
import pytest

import wheelrail
from test_own_controllers import TRAIN
from wheelrail import output, page, plots, report, ssp, sweep_table
from wheelrail.output import Unwritten, fresh, write

FULL = 96 * 1024  # bytes of a small disk
pytest.importorskip("xarray", reason="xarray is not installed (requirements/records.txt)")


@pytest.fixture
def disk(tmp_path):
    """A disk of `FULL` bytes."""
    place = tmp_path / "disk"
    place.mkdir()
    options = ["-t", "tmpfs", "-o", f"size={FULL}", "tmpfs", str(place)]
    if shutil.which("mount") is None or subprocess.run(["mount", *options], capture_output=True).returncode:
        pytest.skip("no small disk can be mounted here")
    yield place
    subprocess.run(["umount", str(place)], check=True)


@pytest.fixture(scope="module")
def run(fmu):
    """A record of more than a small disk holds."""
    return wheelrail.simulate({"initial.velocity": 20.0}, stop=0.05, profiles=True, fmu=fmu)


def names(folder):
    """What lies in a folder."""
    return sorted(path.name for path in folder.iterdir())


def figure(path):
    """A picture."""
    drawing, axis = plots.subplots(figsize=(8, 8))
    axis.imshow(np.random.default_rng(1).random((900, 900)), cmap="viridis")
    plots.save(path, drawing)


WRITERS = {
    "run.nc": lambda path, run: wheelrail.save(run, path),
    "run.parquet": lambda path, run: wheelrail.save(run.isel(time=np.arange(400) % run.sizes["time"]), path),
    "run.html": lambda path, run: page.write(path, run),
    "table.csv": lambda path, run: report.write_columns(path, [("a" * 200, "m", "b" * 200)] * 1000),
    "picture.png": lambda path, run: figure(path),
    "package.ssp": lambda path, run: ssp.archive(path, {"noise": os.urandom(2 * FULL)}),
    "text.json": lambda path, run: write(path, json.dumps(list(range(50000)))),
}


@pytest.mark.parametrize("name", WRITERS)
def test_a_full_disk_costs_the_new_file_only(name, disk, run):
    pytest.importorskip({"nc": "h5py", "parquet": "pyarrow", "html": "plotly"}.get(name.split(".")[1], "numpy"))
    (disk / name).write_bytes(b"what was there")
    with pytest.raises(Unwritten, match="No space left on device; the file that was there is unchanged") as failed:
        WRITERS[name](disk / name, run)
    print(failed.value)
    assert str(failed.value).startswith(f"{disk / name} cannot be written: ") and "\n" not in str(failed.value)
    assert (disk / name).read_bytes() == b"what was there" and names(disk) == [name]


@pytest.mark.parametrize("name", ["run.nc", "run.parquet"])
def test_python_survives_a_record_that_does_not_fit(name, disk, packed):
    pytest.importorskip({"nc": "h5py", "parquet": "pyarrow"}[name.split(".")[1]])
    script = f"""
import os, wheelrail
run = wheelrail.simulate(stop=0.05, profiles=True)
big = run.isel(time=[k % run.sizes["time"] for k in range(400)])
try:
    wheelrail.save(big, {str(disk / name)!r})
except OSError as error:
    print(error)
print(os.listdir({str(disk)!r}))
"""
    environment = os.environ | {"WHEELRAIL_FMU": str(packed.resolve())}
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=environment)
    print(done.stdout)
    assert done.returncode == 0 and done.stderr == "" and done.stdout.splitlines()[1:] == ["[]"]
    assert "cannot be written: No space left on device" in done.stdout


def test_commands_end_with_one_line_on_a_full_disk(disk, tmp_path):
    (tmp_path / "run.csv").write_text("time,contact.force_y\n" + "".join(f"{0.001 * k},{k % 7}\n" for k in range(9000)))
    (disk / "spectrum.csv").write_text("old\n")
    command = [sys.executable, "-m", "wheelrail", "spectrum", "run.csv", "--out", str(disk)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    print(done.stderr)
    assert done.returncode == 1 and done.stderr.count("\n") == 1 and done.stderr.startswith(f"error: {disk}/spectrum.csv cannot")
    assert (disk / "spectrum.csv").read_text() == "old\n" and names(disk) == ["spectrum.csv"]
    if os.path.exists("/dev/full"):
        with open("/dev/full", "w") as full:
            done = subprocess.run([*command[:-1], "out"], cwd=tmp_path, stdout=full, stderr=subprocess.PIPE, text=True)
        assert done.returncode == 1 and done.stderr.startswith("error: ") and "Traceback" not in done.stderr


def test_results_of_a_train_are_replaced_together_or_not_at_all(disk, tmp_path):
    shutil.copytree(TRAIN, tmp_path / "train")
    values = json.loads((TRAIN / "low_adhesion.json").read_text()) | {"speed": 0.5, "step": 0.01, "hold": 0.0}
    (tmp_path / "train" / "mine.json").write_text(json.dumps(values))
    (disk / "mine").mkdir()
    old = ["train_columns.csv", "train_dry.csv", "train_wsp_off.csv"]
    for name in old:
        (disk / "mine" / name).write_text("old\n")
    command = [sys.executable, "-m", "wheelrail", "train", "train/mine.json", "--rigid", "--force", "--out", str(disk)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    print(done.stderr)
    assert done.returncode == 1 and done.stderr.splitlines()[-1].startswith(f"error: {disk}/mine/train")
    assert "No space left" in done.stderr and "Traceback" not in done.stderr
    assert names(disk / "mine") == old and all((disk / "mine" / name).read_text() == "old\n" for name in old)


def test_a_row_that_does_not_fit_leaves_the_rows_before_it(disk):
    table = sweep_table.Table(disk / "sweep.csv", "mine", ["name"], ["distance"])
    with pytest.raises(Unwritten, match="No space left"):
        for _ in range(10000):
            table.add({"name": "x" * 5000, "distance": 1.0})
    (disk / "sweep.csv").read_bytes().decode()
    with open(disk / "sweep.csv", newline="") as file:
        rows = list(csv.reader(file))
    print(f"{len(rows) - 1} rows fit")
    assert len(rows) - 1 == len(table.rows) > 5 and {len(row) for row in rows} == {3}
    with pytest.raises(Unwritten):
        table.rewrite()
    assert len((disk / "sweep.csv").read_text().splitlines()) == len(rows) and names(disk) == ["sweep.csv"]


def test_a_limit_of_the_size_of_files_is_like_a_full_disk(tmp_path):
    resource = pytest.importorskip("resource")
    (tmp_path / "a.csv").write_text("old\n")
    usual = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, usual[1]))
    try:
        with pytest.raises(Unwritten, match="a.csv cannot be written: File too large; the file that was there is unchanged"):
            report.write_columns(tmp_path / "a.csv", [("a", "m", "b" * 80)] * 1000)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, usual)
    assert names(tmp_path) == ["a.csv"] and (tmp_path / "a.csv").read_text() == "old\n"


def test_a_file_keeps_its_rights_and_a_link_its_target(tmp_path):
    (tmp_path / "old.csv").write_text("old\n")
    (tmp_path / "old.csv").chmod(0o640)
    (tmp_path / "link.csv").symlink_to("old.csv")
    write(tmp_path / "link.csv", "new\n")
    assert (tmp_path / "link.csv").is_symlink() and (tmp_path / "old.csv").read_text() == "new\n"
    assert (tmp_path / "old.csv").stat().st_mode & 0o777 == 0o640
    write(tmp_path / "deep" / "er" / "a.csv", "a\n")
    usual = os.umask(0)
    os.umask(usual)
    assert (tmp_path / "deep" / "er" / "a.csv").stat().st_mode & 0o777 == 0o666 & ~usual
    with pytest.raises(Unwritten, match="deep cannot be written: Is a directory"):
        write(tmp_path / "deep", "a\n")


def test_an_interrupted_file_is_not_there(tmp_path):
    write(tmp_path / "a.csv", "old\n")
    with pytest.raises(KeyboardInterrupt), fresh(tmp_path / "a.csv") as new:
        new.write_text("half of")
        raise KeyboardInterrupt
    assert names(tmp_path) == ["a.csv"] and (tmp_path / "a.csv").read_text() == "old\n"


def test_a_path_has_one_owner_at_a_time(tmp_path):
    (tmp_path / "link.csv").symlink_to("a.csv")
    refused, inside, done = [], threading.Event(), threading.Event()

    def first():
        with fresh(tmp_path / "a.csv") as new:
            new.write_text("first\n")
            inside.set()
            done.wait(10.0)

    thread = threading.Thread(target=first)
    thread.start()
    inside.wait(10.0)
    for path in (tmp_path / "a.csv", tmp_path / "link.csv", Path(os.path.relpath(tmp_path / "a.csv"))):
        with pytest.raises(Unwritten, match=f"{path} cannot be written: another run in this process is writing it now") as error:
            write(path, "second\n")
        refused.append(str(error.value))
    done.set()
    thread.join()
    assert (tmp_path / "a.csv").read_text() == "first\n" and len(refused) == 3 and output._owned == set()
    write(tmp_path / "a.csv", "second\n")
    assert (tmp_path / "a.csv").read_text() == "second\n" and names(tmp_path) == ["a.csv", "link.csv"]


def test_an_fmu_that_does_not_fit_on_the_disk_is_still_called_an_fmu(disk, packed, monkeypatch):
    monkeypatch.setattr(tempfile, "tempdir", str(disk))
    with pytest.raises(wheelrail.Refused) as refused:
        wheelrail.Fmu(packed)
    text = str(refused.value)
    print(text)
    assert f"{packed} cannot be unpacked into {disk}: No space left on device" in text and "TMPDIR" in text and "no FMU" not in text
    assert names(disk) == []
    monkeypatch.setattr(tempfile, "tempdir", str(disk / "none"))
    with pytest.raises(wheelrail.Refused, match="cannot be unpacked into a temporary folder: No such file or directory"):
        wheelrail.Fmu(packed)
