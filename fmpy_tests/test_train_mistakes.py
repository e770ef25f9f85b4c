"""What goes wrong with scenario files and the commands `train` and `sweep`: one line on the error stream, an exit code, nothing
computed, no traceback. 2 is for wrong arguments and files, 1 for runs that fail."""

import re
import shutil
import sys
from pathlib import Path

import dask
import distributed
import pytest

from wheelrail import compare, sweep_command
from wheelrail.__main__ import main

TRAIN = Path(__file__).parent.parent / "examples" / "train"
RUN, SCENARIO = ["train", "low_adhesion.json", "--rigid"], "low_adhesion.json"
MANY = ["sweep", "low_adhesion.json", "--rigid"]
OWN = ["train", "own_controllers.json", "--rigid"]
GOOD = "class P:\n    def step(self, h, speeds):\n        pass\n"


def wrong(file, old, new, words, run=RUN, code=2):
    """A mistake in a file: in place of `old`, or as the whole text."""
    return run, {file: (old, new)}, code, words


def swept(keys, words, run=MANY):
    """A mistake in what is swept."""
    return wrong(SCENARIO, re.compile(r'"sweep": \{.*\}\s*\}', re.DOTALL), '"sweep": ' + keys + "\n}", words, run)


def module(text, words):
    """A mistake in a module of one's own."""
    run, files, code, words = wrong("own_brake.json", "own_controllers:OneThreshold", "mine:P", words, OWN)
    return run, files | {"mine.py": (None, text)}, code, words


def spoken(arguments, words, code=2):
    """A mistake on the command line."""
    return arguments, {}, code, words


MISTAKES = [
    # Command line.
    spoken(["train"], "the following arguments are required: scenario"),
    spoken(["trane", SCENARIO], "invalid choice: 'trane'"),
    spoken(["train", "none.json", "--rigid"], "error: none.json: cannot be read: .*No such file"),
    spoken(["train", ".", "--rigid"], "error: .: cannot be read: .*Is a directory"),
    spoken([*RUN, "--step", "0"], "error: --step = 0 s is outside 1e-05 to 0.01 s"),
    spoken([*RUN, "--step", "nan"], "error: --step is nan, not a number"),
    spoken([*RUN, "--step", "small"], "argument --step: invalid float value: 'small'"),
    spoken([*RUN, "--fmu", "a.fmu"], "argument --fmu: not allowed with argument --rigid"),
    spoken(["train", SCENARIO, "--fmu", "none.fmu"],
        "error: none.fmu does not exist: build it with `make fmu`, .*or take --rigid"),
    spoken(["sweep", SCENARIO, "--fmu", "none.fmu"],
        "error: none.fmu does not exist: build it with `make fmu`, .*or take --rigid"),
    spoken(["train", SCENARIO, "--fmu", "."], r"error: \. is a folder and no FMU: name the file, such as wheelrail.fmu, .*or take --rigid"),
    spoken(["train", SCENARIO, "--fmu", "leaves.csv"], "error: leaves.csv is no FMU: "),
    spoken(["train", SCENARIO, "--fmu", "empty.zip"], "error: empty.zip is no FMU: .*modelDescription.xml"),
    spoken([*RUN, "--out", "leaves.csv"], "error: --out: nothing can be written to leaves.csv/low_adhesion: "),
    spoken([*RUN, "--out", "full"],
        r"error: full/low_adhesion holds results already \(train_dry.csv\): add --force to overwrite"),
    spoken([*MANY, "--out", "full"], "error: full/low_adhesion/sweep.csv:1: not the columns of this sweep but a, b; add --force"),
    spoken([*MANY, "--workers", "0"], "error: --workers = 0 is below 1"),
    spoken([*MANY, "--workers", "two"], "argument --workers: invalid int value: 'two'"),
    spoken([*MANY, "--limit", "-1"], r"error: --limit = -1 s is not 0 \(no limit\) or more"),
    spoken([*MANY, "--limit", "nan"], r"error: --limit = nan s is not 0 \(no limit\) or more"),
    spoken([*RUN, "--workers", "2"], "unrecognized arguments: --workers 2"),
    spoken(["schema", "rail"], "argument kind: invalid choice: 'rail'"),
    spoken(["ssp", SCENARIO, "--step", "-1"], "error: --step = -1 s is no time above zero"),
    spoken(["ssp", SCENARIO, "--stop", "nan"], "error: --stop = nan s is no time above zero"),
    # The scenario.
    wrong(SCENARIO, '"step": 0.005,', '"step": 0.005,,', "error: low_adhesion.json:8: not JSON: "),
    wrong(SCENARIO, None, "", "error: low_adhesion.json:1: not JSON: "),
    wrong(SCENARIO, None, "[]", r"error: low_adhesion.json:1: the file is \[\], not an object"),
    wrong(SCENARIO, None, b"\xff\xfe\x00", "error: low_adhesion.json: cannot be read: it is text in UTF-16, .*save it as UTF-8"),
    wrong(SCENARIO, '"step": 0.005,', '"step": 0.005, "step": 0.001,', "error: low_adhesion.json: step twice in one object"),
    wrong(SCENARIO, '"step": 0.005,', '"step": Infinity,', "error: low_adhesion.json: Infinity is not a number"),
    wrong(SCENARIO, '"speed": 38.8889', '"sped": 38.8889', "error: low_adhesion.json:7: sped is unknown; did you mean speed"),
    wrong(SCENARIO, '"speed": 38.8889,', "", r"error: low_adhesion.json:1: speed is missing \(at the start\)"),
    wrong(SCENARIO, '"speed": 38.8889', '"speed": "38.9 m/s"', "error: low_adhesion.json:7: speed is '38.9 m/s', not a number"),
    wrong(SCENARIO, '"speed": 38.8889', '"speed": 140', "error: low_adhesion.json:7: speed = 140 m/s is outside 0.5 to 60 m/s"),
    wrong(SCENARIO, '"speed": 38.8889', '"speed": true', "error: low_adhesion.json:7: speed is True, not a number"),
    wrong(SCENARIO, '"step": 0.005', '"step": 0.05', "error: low_adhesion.json:8: step = 0.05 s is outside 1e-05 to 0.01 s"),
    wrong(SCENARIO, '"hold": 2.0', '"demand": 80', "error: low_adhesion.json:9: demand = 80 is outside 0 to 1"),
    wrong(SCENARIO, '"hold": 2.0', '"coaches": 1.5', "error: low_adhesion.json:9: coaches is 1.5, not a whole number"),
    wrong(SCENARIO, None, "[" * 200000, "error: low_adhesion.json: nested too deeply"),
    wrong(SCENARIO, '"hold": 2.0', '"fmu_coaches": [2]', "error: low_adhesion.json: fmu_coaches entry = 2 is outside 1 to 1"),
    wrong(SCENARIO, '"coach.json"', "5", "error: low_adhesion.json:4: vehicle is 5, not a text"),
    wrong(SCENARIO, '"disc_brake.json"', '"drum_brake.json"', "error: drum_brake.json: cannot be read"),
    wrong(SCENARIO, '"solver.tolerance": 0.02', '"solver.tolerance": ["fine"]', r"wheel.solver.tolerance is \['fine'\], no number, text or flag"),
    wrong(SCENARIO, '"hold": 2.0', '"adhesion": 0.1, "track": "dry.json"', "error: low_adhesion.json: track twice"),
    wrong(SCENARIO, '"friction.falling_ratio"', '"friction.limit"',
        "error: rigid wheelsets do not know friction.limit, only", code=1),
    # The sweep.
    swept("[1, 2]", r"error: low_adhesion.json:11: sweep is \[1, 2\], not an object"),
    swept('{ "vehicle.body.mas": [1] }', "sweep.vehicle.body.mas is unknown; did you mean vehicle.body.mass"),
    swept('{ "gradient": [0] }', "sweep.gradient is unknown; it is a key of the scenario, or vehicle, brake, track or wheel"),
    swept('{ "vehicle.body": [1] }', "sweep.vehicle.body is no value but a group; did you mean vehicle.body.mass"),
    swept('{ "wheel": [1] }', r"sweep.wheel is \[1\], not an object"),
    swept('{ "speed": 20 }', "error: low_adhesion.json:11: sweep.speed is 20, not a list with entries"),
    swept('{ "speed": [] }', r"sweep.speed is \[\], not a list with entries"),
    swept('{ "speed": [20, 200] }', "sweep.speed entry = 200 m/s is outside 0.5 to 60 m/s"),
    swept('{ "vehicle.body.mass": ["heavy"] }', "sweep.vehicle.body.mass entry is 'heavy', not a number"),
    swept('{ "brake.wsp.active": [0, 1] }', "sweep.brake.wsp.active entry is 0, neither true nor false"),
    swept('{ "speed": [20, 30, 20] }', "sweep.speed entry 20.0 is there twice"),
    swept('{ "track.conditions.ice.friction": [0.02] }', "has no condition 'ice'; known: dry, wet, contaminated"),
    swept('{ "slide_high": [0.1], "brake.wsp.slide_high": [0.2] }', "slide_high and brake.wsp.slide_high are the same key"),
    swept('{ "speed": [9], "slide_high": [0.01] }', "sweep, speed 9, slide_high 0.01: disc_brake.json: wsp.slide_high = 0.01 is"),
    swept('{ "track": ["leaves.json", "none.json"] }', "sweep, track none.json: none.json: cannot be read"),
    swept('{ "brake.protection": ["", "none:P"] }', "brake.protection none:P: disc_brake.json: protection: no module none"),
    swept('{ "coaches": [2, 2.5] }', "sweep.coaches entry is 2.5, not a whole number"),
    # Controllers of one's own.
    wrong("own_brake.json", "own_controllers:OneThreshold", "own.OneThreshold",
        "protection = 'own.OneThreshold' is not of the form", OWN),
    wrong("own_brake.json", "own_controllers:OneThreshold", "none:P", "protection: no module none: there is no none.py in", OWN),
    wrong("own_brake.json", ":OneThreshold", ":OneThresold",
        "own_controllers.py has no class OneThresold; did you mean OneThresh", OWN),
    wrong("own_brake.json", '"own_controllers:OneThreshold"', "7", "own_brake.json:10: protection is 7, not a text", OWN),
    wrong("own_brake.json", '"protection": "own_controllers:OneThreshold",', "",
        "protection_parameters are given, but no protection", OWN),
    wrong("own_brake.json", '"threshold": 0.1', '"threshold": "low"',
        "protection_parameters.threshold is 'low', not a number", OWN),
    wrong("own_brake.json", ":SandAtSpeed", ":SoftStop",
        r"own_controllers:SoftStop: step\(.*\) is not step\(h, speeds, valves\)", OWN),
    wrong("own_controllers.json", ":SoftStop", ":Soft",
        "own_controllers.json: driver: .*own_controllers.py has no class Soft", OWN),
    module("P = 5\n", "protection: mine:P is a int, not a class"),
    module("class P:\n    pass\n", r"protection: mine:P has no method step\(h, speeds\)"),
    module(GOOD.replace("speeds", "speed, valve, mass"),
        r"mine:P: step\(self, h, speed, valve, mass\) is not step\(h, speeds\): missing"),
    module("class P\n", r"mine.py:1: not Python: expected ':'"),
    module(GOOD + "\nimport nowhere_at_all\n", r"importing mine failed: ModuleNotFoundError: .*nowhere_at_all.* \(mine.py:5 in <module>: import nowhere_at_all\)"),
    module("x = 1 / 0\n" + GOOD, r"importing mine failed: ZeroDivisionError: division by zero \(mine.py:1 in <module>: "),
    module("raise SystemExit('enough')\n" + GOOD, r"importing mine failed: SystemExit: enough \(mine.py:1 in <module>: "),
    # Brake and track.
    wrong("disc_brake.json", re.compile(r'"sander": \{.*?\}'), '"sander": "mine:P"',
        "disc_brake.json:10: sander is 'mine:P', not an object"),
    wrong("disc_brake.json", '"rate": 0.008', '"rate": 0.008, "delay": -1', "sander.delay = -1 s is outside 0 to 60 s"),
    wrong("disc_brake.json", '"torque": 6450', '"torque": "6450"', "disc_brake.json:5: torque is '6450', not a number"),
    wrong("leaves.csv", "400,wet", "400,ice", "error: leaves.csv:3: condition 'ice' is none of dry, wet, contaminated"),
    wrong("leaves.csv", "400,wet", "\n# wet\n400,ice", "error: leaves.csv:5: condition 'ice' is none of"),
    wrong("leaves.csv", None, "position,condition\n", "error: leaves.csv:2: no line of values"),
    wrong("leaves.csv", "400,wet", "4" * 200000 + ",wet", "error: leaves.csv:3: position is inf, not a number"),
    wrong("leaves.json", '"cell": 0.25', '"cell": 0.0001', "error: leaves.json:5: cell = 0.0001 m is outside 0.01 to 100 m"),
    wrong("leaves.json", '"length": 3000, "cell": 0.25', '"length": 1e6, "cell": 0.1',
        "leaves.json: length = 1e.06 m in cells .* 1e.07 cells, more"),
    wrong("leaves.json", '"length": 3000', '"length": 3', "error: leaves.json:5: length = 3 m is outside 10 to 1e.06 m"),
]  # fmt: skip


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A copy of the examples, where commands are run; whatever would be computed is a failure."""
    for path in TRAIN.glob("*.*"):
        shutil.copy(path, tmp_path)
    (tmp_path / "full" / "low_adhesion").mkdir(parents=True)
    (tmp_path / "full" / "low_adhesion" / "train_dry.csv").write_text("results of a long night\n")
    (tmp_path / "full" / "low_adhesion" / "sweep.csv").write_text("a,b\n1,2\n")
    shutil.make_archive(tmp_path / "empty", "zip", tmp_path / "full")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("WHEELRAIL_FMU", raising=False)
    monkeypatch.setattr(compare, "side_by_side", lambda *_: pytest.fail("something was computed"))
    monkeypatch.setattr(sweep_command, "_computed", lambda *_: pytest.fail("something was computed"))
    return tmp_path


def said(capsys, arguments):
    """Exit code and error stream of a command."""
    with pytest.raises(SystemExit) as ended:
        main(arguments)
    captured = capsys.readouterr()
    assert "Traceback" not in captured.err + captured.out
    return ended.value.code, captured.err


@pytest.mark.parametrize("arguments, files, code, words", MISTAKES, ids=range(len(MISTAKES)))
def test_a_mistake_is_one_line_and_an_exit_code(folder, capsys, arguments, files, code, words):
    for name, (old, new) in files.items():
        if old is None:
            (folder / name).write_bytes(new if isinstance(new, bytes) else new.encode())
            continue
        text = (folder / name).read_text()
        changed = old.sub(lambda _: new, text) if isinstance(old, re.Pattern) else text.replace(old, new)
        assert changed != text
        (folder / name).write_text(changed)
    found, errors = said(capsys, arguments)
    *before, last = errors.strip().splitlines()
    assert found == code and re.search(words, last), errors
    # Beside it only argparse's usage, or what rigid wheelsets leave out.
    assert not before or before[0].startswith(("usage:", "rigid wheelsets know")), errors
    assert (folder / "full" / "low_adhesion" / "train_dry.csv").read_text() == "results of a long night\n"


def test_a_parameter_of_the_wheel_that_the_fmu_does_not_know_is_said_before_anything_is_computed(folder, capsys, packed):
    mistakes = (
        ("train", "falling_ratio", "faling_ratio"), ("sweep", '"speed": [11', '"wheel.mesh.element": [5], "speed": [11'),
    )  # fmt: skip
    for command, old, new in mistakes:
        (folder / SCENARIO).write_text((TRAIN / SCENARIO).read_text().replace(old, new))
        code, errors = said(capsys, [command, SCENARIO, "--fmu", str(packed.resolve())])
        assert code == 2 and re.search(r"low_adhesion.json: wheel: \S+ is no parameter of the FMU; did you mean ", errors)


def test_a_missing_package_is_named_with_what_brings_it(folder, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    code, errors = said(capsys, MANY)
    assert code == 2 and "error: sweep needs the package distributed: python -m pip install 'wheelrail[sweep]'" in errors


def test_a_scheduler_that_does_not_answer_is_said_within_ten_seconds(folder, capsys, monkeypatch):
    monkeypatch.undo()
    monkeypatch.chdir(folder)
    monkeypatch.setattr(sweep_command, "PATIENCE", 1.0)
    unknown = {"127.0.0.1:9": "no scheduler answers at tcp://127.0.0.1:9 within 1 s", "nonsense": "missing port number"}
    for address, words in unknown.items():
        code, errors = said(capsys, [*MANY, "--out", "elsewhere", "--scheduler", address])
        assert code == 1 and words in errors and "`dask scheduler`" in errors
    with pytest.raises(ValueError, match="No global client found"):
        distributed.get_client()
    assert "scheduler" not in dask.config.config, "what failed here would compute for others in this process"


def test_a_track_that_is_shorter_than_the_stop_is_named_and_stops_that_fit_are_kept(folder, capsys, monkeypatch):
    monkeypatch.undo()
    monkeypatch.chdir(folder)
    for file, old, new in (
        ("leaves.json", '"length": 3000', '"length": 20'), ("leaves.json", '"friction": 0.08', '"friction": 0.002'),
        (SCENARIO, '"speed": 38.8889', '"speed": 4.0, "longest": 30'), (SCENARIO, '"step": 0.005', '"step": 0.01'),
        ("leaves.json", '"recovered": 0.15', '"recovered": 0.002'),
    ):  # fmt: skip
        (folder / file).write_text((folder / file).read_text().replace(old, new))
    code, errors = said(capsys, RUN)
    last = "the stop is longer than the track: after 5.\\d s and [12][09] m still 3.\\d+ m/s; raise length = 20 m in leaves.json"
    assert code == 1 and re.fullmatch(f"error: WSP on: {last}; WSP off: {last}", errors.strip().splitlines()[-1]), errors
    there = {path.name for path in (folder / "results" / "low_adhesion").iterdir()}
    assert there == {"train_dry.csv", "train_columns.csv", "train.png", "train.html"}
