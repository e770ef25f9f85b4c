"""Files of a stop: those of the example are read, bad ones are errors with file, line, name and range."""

import json
import re
import shutil
from pathlib import Path

import pytest

from wheelrail import scenario
from wheelrail.files import BadFile, json_schema

TRAIN = Path(__file__).parent.parent / "examples" / "train"
BAD = [
    ("coach.json", '"mass": 32000', '"mass": -32000', r"coach.json:\d+: body.mass = -32000 kg is outside 100 to 1e\+06 kg"),
    ("coach.json", '"mass": 2615', '"mass": "heavy"', r"coach.json:\d+: bogie.mass is 'heavy', not a number"),
    ("coach.json", '"axle_half_distance"', '"axel_half_distance"', "axel_half_distance is unknown; did you mean axle_half"),
    ("coach.json", '"bogie_half_distance": 9.5,', "", "bogie_half_distance is missing .between bogie centre"),
    ("coach.json", '"bogie_half_distance": 9.5,', '"bogie_half_distance": 9.5', r"coach.json:\d+: not JSON"),
    ("coach.json", '"height": 1.8', '"height": NaN', "NaN is not a number"),
    ("coach.json", '"height": 1.8', '"height": 1.8, "height": 2', "height twice"),
    ("leaves.json", '"friction": 0.08', '"friction": 1.08', r"conditions.contaminated.friction = 1.08 is outside 0.001 to 1; if 1.08 % are meant, write 0.0108$"),
    ("leaves.json", '"leaves.csv"', '"trees.csv"', "trees.csv: cannot be read"),
    ("disc_brake.json", '"axles": [1]', '"axles": [5]', r"sander.axles entry = 5 is outside 1 to 4$"),
    ("disc_brake.json", '"axles": [1]', '"axles": 1', "sander.axles is 1, not a list"),
    ("disc_brake.json", '"active": true', '"active": 1', "wsp.active is 1, neither true nor false"),
    ("disc_brake.json", '"slide_low": 0.05', '"slide_low": 0.2', "disc_brake.json: wsp.slide_high = 0.15 is below wsp.slide_low = 0.2"),
    ("low_adhesion.json", '"speed": 38.8889', '"speed": 388', r"low_adhesion.json:\d+: speed = 388 m/s is outside 0.5 to 60"),
    ("low_adhesion.json", '"coach.json"', '"couch.json"', "couch.json: cannot be read"),
    ("low_adhesion.json", '"hold": 2.0', '"coaches": 2, "fmu_coaches": [3]', "fmu_coaches entry = 3 is outside 1 to 2, the number"),
    ("leaves.csv", "position,condition", "positon,condition", "leaves.csv:1: unknown column 'positon'; did you mean pos"),
    ("leaves.csv", ",condition", "", "leaves.csv:1: column 'condition' is missing"),
    ("leaves.csv", "400,wet", "400,icy", "leaves.csv:3: condition 'icy' is none of dry, wet, contaminated"),
    ("leaves.csv", "400,wet", "-400,wet", "leaves.csv:3: position -400 m is not beyond 0 m"),
    ("leaves.csv", "400,wet,0", "400,wet,0.5", r"leaves.csv:3: slope = 0.5 is outside -0.2 to 0.2; if 0.5 % are meant, write 0.005$"),
    ("leaves.csv", "400,wet,0,0", "400,wet,0", "leaves.csv:3: 3 entries, line 1 has 4"),
    ("leaves.csv", "400,wet", "far,wet", "leaves.csv:3: position is 'far', not a number"),
]


@pytest.fixture
def folder(tmp_path):
    """A copy of the example."""
    return Path(shutil.copytree(TRAIN, tmp_path / "train"))


@pytest.mark.parametrize("file, old, new, error", BAD, ids=[f"{row[0]}-{k}" for k, row in enumerate(BAD)])
def test_a_bad_file_is_an_error_with_file_line_name_and_range(folder, file, old, new, error):
    text = (folder / file).read_text()
    assert text.count(old) == 1
    (folder / file).write_text(text.replace(old, new))
    with pytest.raises(BadFile, match=error) as refused:
        scenario.load(folder / "low_adhesion.json")
    line = re.search(r"\.json:(\d+): ", str(refused.value))
    if line and "missing" not in error and "not JSON" not in error:
        name = re.match(r'"\w+"', new)
        assert not name or name.group() in (folder / file).read_text().splitlines()[int(line.group(1)) - 1]


def test_every_scenario_of_the_example_is_read():
    found = [path for path in TRAIN.glob("*.json") if "track" in json.loads(path.read_text())]
    assert found
    for path in found:
        assert scenario.load(path).track.sections.position


def test_payload_and_adhesion_of_a_scenario_take_the_place_of_those_of_vehicle_and_track(folder):
    path = folder / "low_adhesion.json"
    path.write_text(path.read_text().replace('"step"', '"payload": 12000, "adhesion": 0.04, "step"'))
    loaded = scenario.load(path)
    assert loaded.vehicle.body.payload == 12000
    assert loaded.track.conditions["contaminated"].friction == 0.04
    assert loaded.track.conditions["contaminated"].recovered == 0.15


def test_whole_numbers_are_floats_unless_they_count_something():
    loaded = scenario.load(TRAIN / "low_adhesion.json")
    numbers = loaded.vehicle.wheelset.mass, loaded.brake.torque, loaded.wheel["solver.tolerance"], loaded.sweep.payload[0]
    assert all(isinstance(number, float) for number in numbers)
    assert isinstance(loaded.coaches, int) and loaded.brake.sander.axles == [1]


def test_the_schemas_for_editors_are_those_of_the_program():
    for kind, schema in scenario.SCHEMAS.items():
        written = json.loads((TRAIN / "schema" / f"{kind}.json").read_text())
        assert written == json.loads(json.dumps(json_schema(schema))), f"python -m wheelrail schema {kind}"
