"""Results of a stop: directory, columns with units, nothing overwritten; progress on terminals and in logs."""

import csv
import io

import numpy as np
import pytest

from test_own_controllers import TRAIN, stopped
from wheelrail import compare, plots, report, scenario
from wheelrail.__main__ import main
from wheelrail.progress import Progress


@pytest.fixture(scope="module")
def short():
    """A stop of a second and its rail."""
    return stopped(scenario.load(TRAIN / "low_adhesion.json", {"speed": 0.5, "step": 0.01, "hold": 0.0, "brake.fill_time": 0.2}))


def test_a_table_has_columns_with_units_and_temperatures_in_celsius(short, tmp_path):
    table = short.copy()
    table[:, [report.columns().index("hottest_2"), report.columns().index("peak_2")]] = 373.15, 473.15
    report.write_csv(tmp_path / "a.csv", table)
    report.write_columns(tmp_path / "columns.csv", report.described(table))
    with open(tmp_path / "a.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(tmp_path / "columns.csv", encoding="utf-8") as file:
        columns = {row["column"]: row for row in csv.DictReader(file)}
    assert list(rows[0]) == list(columns) and len(rows) == len(table)
    assert all(row["unit"] and row["description"] for row in columns.values())
    units = [columns[name]["unit"] for name in ("contact_celsius_2", "tread_peak_celsius_2", "load_1", "travelled")]
    assert units == ["°C", "°C", "N", "m"]
    # Kelvin is left for differences only.
    assert {name.rpartition("_")[0] for name, row in columns.items() if row["unit"] == "K"} == {"rail_excess"}
    assert float(rows[-1]["contact_celsius_2"]) == pytest.approx(100.0)
    assert float(rows[0]["tread_peak_celsius_2"]) == pytest.approx(200.0)
    assert rows[0]["contact_celsius_1"] == "nan"
    assert float(rows[-1]["speed"]) == pytest.approx(table[-1, 1], rel=1e-8)
    two = np.zeros((3, len(report.columns(2))))
    assert [name for name, _, _ in report.described(two)][-1] == "coupler_1" and len(list(report.described(two))) == two.shape[1]


def test_results_lie_in_a_directory_of_their_scenario_and_are_overwritten_by_force_only(short, tmp_path, capsys, monkeypatch):
    loaded = scenario.load(TRAIN / "low_adhesion.json")
    stops = {name: (short, scenario.rail_map(loaded.track, 30.0, 4)) for name in compare.variants(loaded)}
    monkeypatch.setattr(compare, "side_by_side", lambda *_: stops)
    monkeypatch.chdir(tmp_path)
    command = ["train", str(TRAIN / "low_adhesion.json"), "--rigid"]
    main(command)
    there = tmp_path / "results" / "low_adhesion"
    names = {"train_dry.csv", "train_wsp_on.csv", "train_wsp_off.csv", "train_columns.csv", "train.png", "train.html"}
    assert {path.name for path in there.iterdir()} == names and "written to results/low_adhesion" in capsys.readouterr().out
    monkeypatch.setattr(plots, "draw_stops", lambda path, *_: path.write_bytes(b""))  # once is enough
    (there / "train_dry.csv").write_text("mine\n")
    with pytest.raises(SystemExit) as ended:
        main(command)
    assert ended.value.code == 2 and (there / "train_dry.csv").read_text() == "mine\n"
    main(["train", str(TRAIN / "own_controllers.json"), "--rigid"])
    assert {path.name for path in (tmp_path / "results" / "own_controllers").iterdir()} == names
    main([*command, "--force"])
    assert (there / "train_dry.csv").read_text().startswith("time,speed,")


class Terminal(io.StringIO):
    """A stream that says it is a terminal."""

    def isatty(self):
        return True


def test_progress_is_a_line_for_ten_per_cent_in_a_log_and_a_bar_on_a_terminal():
    log, terminal = io.StringIO(), Terminal()
    for file in (log, terminal):
        with Progress(157.0, "braking", file=file) as bar:
            for _ in range(157):
                bar.advance(1.0, "axle")
    lines = log.getvalue().splitlines()
    assert [int(line[9:12]) for line in lines] == list(range(10, 101, 10))
    assert lines[0].startswith("braking:  10 %, 00:00 so far, 00:00 left; axle") and "\r" not in log.getvalue()
    assert "\rbraking: " in terminal.getvalue() and "|" in terminal.getvalue()
    log = io.StringIO()
    with Progress(10.0, "stops", initial=5.5, file=log) as bar:
        bar.advance(0.4)
        bar.advance(9.0)
    assert [line[7:12] for line in log.getvalue().splitlines()] == ["100 %"]
