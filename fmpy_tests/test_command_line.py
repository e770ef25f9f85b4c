"""The command `wheelrail` of the Python package: what was meant, completion, stationary states, units of its files, its log; and types."""

import csv
import inspect
import logging
import subprocess
import sys
import typing
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

import wheelrail
from wheelrail import completion
from wheelrail.__main__ import arguments, main, parser

ROOT = Path(__file__).resolve().parent.parent
# Modules whose functions people call, with full annotations.
TYPED = (
    "fmu", "runs", "records", "operating", "run_commands", "team", "values", "warn", "output", "tables", "signals", "surfaces", "rail_map", "vehicle",
    "wheelset", "train", "compare", "page", "completion", "grid", "damage", "paraview",
    "profile_files", "contact_geometry", "half_space", "contact_patch", "patch_table", "patch_picture",
)  # fmt: skip


@pytest.mark.parametrize(
    "line, meant",
    [
        (["trian", "x.json"], "did you mean train?"),
        (["schema", "scenaro"], "did you mean scenario?"),
        (["train", "x.json", "--forec"], "did you mean --force?"),
        (["steady", "--velocty=3"], "did you mean --velocity?"),
        (["report", "x.nc", "--scheduler", "a"], ""),
    ],
)
def test_a_refused_word_names_the_nearest_one_of_its_command(line, meant, capsys):
    with pytest.raises(SystemExit) as ended:
        arguments(line)
    said = capsys.readouterr().err
    assert ended.value.code == 2 and said.count("did you mean") == bool(meant) and meant in said, said


def test_bash_completes_commands_and_the_options_of_each(tmp_path):
    options = completion.options_of(parser())
    (tmp_path / "wheelrail.bash").write_text(completion.script(parser(), "bash"))

    def completed(*words):
        line = " ".join(f"'{word}'" for word in ("wheelrail", *words))
        ask = f"source wheelrail.bash; COMP_WORDS=({line}); COMP_CWORD={len(words)}; _shtab_wheelrail; echo ${{COMPREPLY[@]}}"
        return subprocess.run(["bash", "-c", ask], cwd=tmp_path, capture_output=True, text=True, check=True).stdout.split()

    assert completed("s") == [name for name in options if name.startswith("s")] and len(completed("s")) >= 4
    assert completed("train", "--f") == ["--force", "--fmu"]
    assert completed("schema", "sc") == ["scenario"]
    assert {*completed("report", "--")} == {word for word in options["report"] if word.startswith("--")}
    fish = completion.script(parser(), "fish")
    assert all(f" -a {name} " in fish for name in options if name)


def test_a_stationary_curve_has_its_creepage_as_coordinate_and_refuses_what_it_decides_itself(fmu):
    pytest.importorskip("xarray")
    curve = wheelrail.steady({"preset": "paper_d"}, creepage=[-1e-3, 1e-3], outputs=["contact.force_x", "contact.creepage"], fmu=fmu)
    assert curve["contact.force_x"].dims == ("creepage",) and curve["contact.force_x"].attrs["units"] == "N"
    np.testing.assert_allclose(curve["contact.creepage"], curve["creepage"], rtol=1e-9)
    # The curve is odd where both slip fully.
    assert curve["contact.force_x"][0] == pytest.approx(-float(curve["contact.force_x"][1]), rel=1e-9) and curve["contact.force_x"][0] > 0.0
    default = wheelrail.steady({"preset": "paper_d"}, outputs="contact.utilisation", fmu=fmu)
    assert default.sizes["creepage"] == 16 and default["contact.utilisation"][-1] == pytest.approx(1.0, abs=1e-9)
    with pytest.raises(wheelrail.Refused, match="drive.omega follows from velocity and creepage"):
        wheelrail.steady(inputs={"drive.omega": 1.0}, creepage=0.0, fmu=fmu)
    for creepage in (3.0, "a", []):
        with pytest.raises(ValueError, match="creepage = "):
            wheelrail.steady(creepage=creepage, fmu=fmu)


def test_files_of_the_commands_have_their_units_beside_them(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    time = np.arange(0.0, 1.0, 1e-2)
    rows = [("time", "contact.force_y [N]"), *zip(time, 1e5 + 1e3 * np.sin(20.0 * time))]
    with open(tmp_path / "run.csv", "w", newline="") as file:
        csv.writer(file).writerows(rows)
    for command in ("force", "spectrum", "octaves"):
        main([command, str(tmp_path / "run.csv"), "--out", str(tmp_path)])
        with open(tmp_path / f"{command}.csv") as file:
            header = next(csv.reader(file))
        with open(tmp_path / f"{command}_columns.csv") as file:
            told = list(csv.DictReader(file))
        assert [row["column"] for row in told] == header and all(row["unit"] and row["description"] for row in told)
    assert {row["column"]: row["unit"] for row in told} == {"frequency": "1/(s)", "level": "dB"}


def test_runs_messages_and_files_are_logged_and_nothing_is_said_unasked(fmu, tmp_path, caplog):
    pytest.importorskip("xarray")
    with caplog.at_level(logging.INFO, "wheelrail"):
        run = wheelrail.simulate(stop=2e-3, fmu=fmu, progress=False)
        wheelrail.save(run, tmp_path / "run.nc")
        with pytest.warns(wheelrail.WheelrailWarning):
            wheelrail.simulate({}, {"rail.temperature": 20.0}, stop=1e-3, fmu=fmu, progress=False)
    said = [(record.name, record.levelno, record.getMessage()) for record in caplog.records]
    assert ("wheelrail.runs", logging.INFO, "run of 0.002 s in steps of 0.001 s") in said
    assert ("wheelrail.output", logging.INFO, f"written: {tmp_path / 'run.nc'}") in said
    assert any(name == "wheelrail.fmu" and level == logging.WARNING for name, level, _ in said), said
    silent = subprocess.run([sys.executable, "-c", "import wheelrail, logging; logging.getLogger('wheelrail.fmu').error('x')"], capture_output=True, text=True)
    assert silent.stderr == "" and silent.returncode == 0


def functions(module):
    """Public functions and methods that a module defines, by their names."""
    for name, found in vars(module).items():
        if name.startswith("_") or getattr(found, "__module__", "") != module.__name__:
            continue
        if inspect.isfunction(found):
            yield name, found
        elif inspect.isclass(found):
            yield from ((f"{name}.{key}", value) for key, value in vars(found).items() if inspect.isfunction(value) and not key.startswith("_"))


def test_public_functions_of_the_package_say_their_types_which_are_marked_for_type_checkers():
    assert Path(wheelrail.__file__).with_name("py.typed").is_file()
    missing, count = [], 0
    for name in TYPED:
        for where, function in functions(import_module(f"wheelrail.{name}")):
            count += 1
            asked = {key for key in inspect.signature(function).parameters if key not in ("self", "cls")} | {"return"}
            missing += [f"{name}.{where}: {key}" for key in sorted(asked - set(function.__annotations__))]
            assert function.__doc__, f"{name}.{where} says nothing"
    assert not missing and count > 100, (count, missing)
    hints = typing.get_type_hints(wheelrail.Wheel.step)
    assert hints == {"h": float, "end": float | None, "return": type(None)}
