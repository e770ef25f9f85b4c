"""Files of a stop: strict tables, values that look like those of another unit or zero, positions beside the track."""

import shutil
import warnings
from pathlib import Path

import pytest

from wheelrail import scenario
from wheelrail.reach import check_gap
from wheelrail.sweep import reference
from wheelrail.tables import BadFile, number_in, read_table
from wheelrail.warn import WheelrailWarning

TRAIN = Path(__file__).parent.parent / "examples" / "train"
SECTIONS = "position,condition,slope,temperature\n"


@pytest.fixture
def folder(tmp_path):
    """A copy of the example's files."""
    return Path(shutil.copytree(TRAIN, tmp_path / "train"))


def said(folder, file, old, new, changes=None):
    """Warnings of a scenario with another text in one of its files."""
    text = (folder / file).read_text()
    assert old is None or text.count(old) == 1
    (folder / file).write_text(new if old is None else text.replace(old, new))
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        scenario.load(folder / "low_adhesion.json", changes)
    texts = [str(warning.message) for warning in caught if issubclass(warning.category, WheelrailWarning)]
    print(file, new.splitlines()[-1], texts)
    return texts


DOUBTED = [
    ("disc_brake.json", '"torque": 6450', '"torque": 6.45', ["torque = 6.45 N m", "kN m are meant, write 6450"]),
    ("leaves.csv", None, SECTIONS + "0,wet,0,293\n", ["leaves.csv:2: temperature = 293 K", "0 is a rail of 20 degC", "293 K absolute"]),
    ("leaves.csv", None, SECTIONS + "0,wet,0.12,0\n", ["slope = 0.12", "rise over length", "0.12 % are meant, write 0.0012"]),
    ("leaves.csv", None, SECTIONS + "12000,wet,0,0\n12400,dry,0,0\n", ["all sections lie ahead of", "begin = 0 m to 3000 m", "12000 m"]),
    ("leaves.csv", None, SECTIONS + "-900,wet,0,0\n-400,dry,0,0\n", ["from -900 to -400 m", "only the last one, 'dry'"]),
    ("leaves.csv", None, SECTIONS + "250,wet,0,0\n", ["the sections begin ahead of", "250 m"]),
    ("leaves.csv", None, SECTIONS + "0,wet,0,0\n0.4,dry,0,0\n1.1,wet,0,0\n", ["the last section, 'wet' from 1.1 m on, has nearly all of", "in km"]),
]


@pytest.mark.parametrize("file, old, new, words", DOUBTED)
def test_what_looks_like_another_unit_or_place_is_said(folder, file, old, new, words):
    (text,) = said(folder, file, old, new)
    assert all(word in text for word in words)


KILOMETRES = ["12,wet,0,0\n12.4,dry,0,0\n13.1,wet,0,0\n", "9.8,wet,0,0\n12.4,dry,0,0\n55,wet,0,0\n113,wet,0,0\n"]


@pytest.mark.parametrize("rows", KILOMETRES)
def test_chainages_in_kilometres_are_doubted(folder, rows):
    (text,) = said(folder, "leaves.csv", None, SECTIONS + rows, {"track.begin": 12.0})
    assert "if positions are in km, call the column position [km], and write begin in m: 12000" in text
    assert said(folder, "leaves.csv", None, SECTIONS.replace("position", "position [km]") + rows, {"track.begin": 12e3}) == []


def test_falling_chainages_say_how_to_write_them(folder):
    (folder / "leaves.csv").write_text(SECTIONS + "12400,wet,0,0\n12000,dry,0,0\n")
    with pytest.raises(BadFile) as refused:
        scenario.load(folder / "low_adhesion.json")
    print(refused.value)
    assert "leaves.csv:3: position 12000 m is not beyond 12400 m" in str(refused.value)
    assert "write them negative, -12400 before -12000, and begin of the track likewise" in str(refused.value)
    # What it says is taken.
    assert said(folder, "leaves.csv", None, SECTIONS + "-12400,wet,0,0\n-12000,dry,0,0\n", {"track.begin": -12400.0}) == []


MEANT = ["0,wet,0,0", "0,wet,0.03,-20", "0,wet,-0.03,40", "0,wet,0,0\n250,dry,0,0\n251,wet,0,0", "0,wet,0,0\n60,dry,0,0"]


@pytest.mark.parametrize("row", MEANT)
def test_what_is_usual_is_not(folder, row):
    assert said(folder, "leaves.csv", None, f"{SECTIONS}{row}\n") == []


REFUSED = [
    ("low_adhesion.json", "speed", 100, "if 100 km/h are meant, write 27.7778"),
    ("low_adhesion.json", "track.slope", 12, "if 12 ‰ are meant, write 0.012"),
    ("low_adhesion.json", "vehicle.body.mass", 32, "if 32 t are meant, write 32000"),
    ("low_adhesion.json", "brake.pressure", 3.8, "if 3.8 bar are meant, write 380000"),
    ("low_adhesion.json", "track.sand.friction", 20, "if 20 % are meant, write 0.2"),
    ("low_adhesion.json", "step", 5, "if 5 ms are meant, write 0.005"),
    ("low_adhesion.json", "vehicle.wheelset.radius", 460, "if 460 mm are meant, write 0.46"),
]


@pytest.mark.parametrize("file, key, value, words", REFUSED)
def test_a_value_beyond_its_range_is_refused_with_the_one_that_may_be_meant(file, key, value, words):
    with pytest.raises(BadFile) as refused:
        scenario.load(TRAIN / file, {key: value})
    print(refused.value)
    assert words in str(refused.value)


def test_chainages_count_from_the_begin_of_the_track(folder):
    (folder / "line.csv").write_text("position,elevation\n12000,0\n12100,0.001\n")
    rows = SECTIONS + "11000,dry,0,0\n12400,wet,0.01,0\n"
    texts = said(folder, "leaves.csv", None, rows, {"track.begin": 12345.0, "track.profile": "line.csv", "track.slope": 0.005})
    assert len(texts) == 1 and "profile has no effect: its positions, 12000 to 12100 m, lie behind" in texts[0]
    loaded = scenario.load(folder / "low_adhesion.json", {"track.begin": 12050.0, "track.profile": "line.csv", "track.slope": 0.005})
    found = [scenario.section(loaded.track, x) for x in (0.0, 349.0, 351.0)]
    slopes = [scenario.slope(loaded.track, x) for x in (0.0, 351.0)]
    height, rate = scenario.elevation(scenario.heights(loaded.track), [10.0], [20.0])
    print(found, slopes, height, rate)
    assert found == [0, 0, 1] and slopes == pytest.approx([0.005, 0.015])
    # Level at both ends: 3 t^2 - 2 t^3 at 60 m of 100 m.
    assert (height[0], rate[0]) == pytest.approx((6.48e-4, 2.88e-4))


def test_a_gradient_is_swept_as_a_number_and_the_dry_stop_has_it_too(folder):
    text = (folder / "low_adhesion.json").read_text()
    assert isinstance(scenario.field_of("track.slope"), type(scenario.field_of("speed")))
    loaded = scenario.load(folder / "low_adhesion.json", {"track.slope": -0.01})
    assert loaded.track.slope == -0.01 and reference(loaded, {"track.slope": -0.01, "adhesion": 0.05}) == {"track.slope": -0.01}
    assert text == (folder / "low_adhesion.json").read_text()


def test_a_gap_in_samples_is_said_and_a_level_stretch_is_not():
    places = [0.001 * k for k in range(50)] + [0.15 + 0.001 * k for k in range(50)]
    with pytest.warns(WheelrailWarning, match="no samples between 0.049 and 0.15 m, where they usually are 0.001 m apart"):
        check_gap("rail.csv", places, [1e-6 * k for k in range(100)])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_gap("rail.csv", places, [0.0] * 100)
        check_gap("rail.csv", places[:50], [1e-6 * k for k in range(50)])


TABLES = {
    "as it is": "a,b\n1,2\n3,4",
    "blank lines": "a,b\n\n1,2\n\n3,4\n\n\n",
    "a mark and CR LF": "\ufeffa,b\r\n1,2\r\n3,4\r\n",
    "CR alone": "a,b\r1,2\r3,4\r",
    "remarks": "# what, it is\na,b\n1,2\n# more\n3,4\n",
    "quotes and blanks": '"a","b"\n"1", 2 \n3," 4"\n',
    "signs and powers": "a,b\n+1,2.\n3e0,.4E1\n",
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_is_read_however_its_lines_end(name, tmp_path):
    path = tmp_path / "table.csv"
    path.write_bytes(TABLES[name].encode())
    names, _, rows = read_table(path)
    assert names == ["a", "b"]
    assert [[number_in(path, line, "a", cell) for cell in cells] for line, cells in rows] == [[1.0, 2.0], [3.0, 4.0]]


NO_TABLES = {
    "nothing": ("", ":1: empty"),
    "a decimal comma": ("a,b\n1,0,00005\n", ":2: 3 entries, line 1 has 2; commas separate"),
    "a quoted decimal comma": ('a,b\n1,"0,5"\n', ":2: b is '0,5', not a number; write a decimal point"),
    "too few": ("a,b\n\n1\n", ":3: 1 entries"),
    "a comma at the end": ("a,b\n1,2,\n", ":2: 3 entries"),
    "one name twice": ("a,b,a\n1,2,3\n", ":1: column 'a' twice"),
    "a column without a name": ("a,,b\n1,2,3\n", ":1: column 2 has no name"),
    "no names": ("0,0\n1,2\n", ":1: 0,0 are no names"),
    "semicolons": ("a;b\n1;2\n", ":1: columns are separated by semicolons"),
    "tabs": ("a\tb\n1\t2\n", ":1: columns are separated by tabs"),
    "no number": ("a,b\n1,nan\n", ":2: b is 'nan', not a number"),
    "a grouped number": ("a,b\n1,1_000\n", ":2: b is '1_000', not a number"),
    "an open quote": ('a,b\n1,"2\n3,4\n', ":2: a quote is not closed"),
}


@pytest.mark.parametrize("name", NO_TABLES)
def test_what_is_no_table_is_refused_with_its_line(name, tmp_path):
    text, words = NO_TABLES[name]
    path = tmp_path / "table.csv"
    path.write_text(text)
    with pytest.raises(BadFile) as refused:
        names, _, rows = read_table(path)
        for line, cells in rows:
            [number_in(path, line, name, cell) for name, cell in zip(names, cells)]
    print(refused.value)
    assert words in str(refused.value)


ENCODINGS = {
    "utf-16": ["UTF-16", "PowerShell", "Unicode Text", "save it as UTF-8"],
    "utf-16-le": ["zero bytes", "UTF-16", "save it as UTF-8"],
    "utf-16-be": ["zero bytes", "UTF-16", "save it as UTF-8"],
    "latin-1": ["line 3", "0xfc", "Latin-1", "save it as UTF-8"],
}


@pytest.mark.parametrize("encoding", ENCODINGS)
def test_text_in_another_encoding_is_refused_with_what_wrote_it_and_how_to_save_it(tmp_path, encoding):
    (tmp_path / "a.csv").write_bytes("position,height\n0,1\n# M\u00fcller\n".encode(encoding))
    with pytest.raises(BadFile) as refused:
        read_table(tmp_path / "a.csv")
    print(refused.value)
    assert all(word in str(refused.value) for word in ENCODINGS[encoding])


COMMAS = {
    "8,000": "write 8000 if the comma separates thousands, 8.000 if it is a decimal comma",
    "-1,250": "write -1250 if the comma separates thousands, -1.250 if it is a decimal comma",
    "8,000.5": "write 8000.5: thousands are not separated",
    "1,250,000": "write 1250000: thousands are not separated",
    "0,375": "write a decimal point in the place of the comma",
    "0,3": "write a decimal point in the place of the comma",
    "8,00": "write a decimal point in the place of the comma",
}


@pytest.mark.parametrize("cell", COMMAS)
def test_the_advice_on_a_comma_does_not_make_eight_of_eight_thousand(cell):
    with pytest.raises(BadFile) as refused:
        number_in("a.csv", 3, "load", cell)
    assert str(refused.value) == f"a.csv:3: load is {cell!r}, not a number; {COMMAS[cell]}"
