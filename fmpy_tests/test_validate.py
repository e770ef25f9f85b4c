"""The packed FMU is well-formed and complete."""

import zipfile

from conftest import ROOT
from fmpy import simulate_fmu
from fmpy.validation import validate_fmu


def test_fmpy_finds_no_problem(packed):
    assert validate_fmu(str(packed)) == []


def test_package_is_complete(packed):
    with zipfile.ZipFile(packed) as archive:
        names = set(archive.namelist())
        description = archive.read("modelDescription.xml")
    presets = {f"resources/{path.name}" for path in (ROOT / "resources").glob("*.json")}
    expected = {"binaries/linux64/wheelrail.so", "documentation/index.html"} | presets
    assert expected <= names
    assert description == (ROOT / "modelDescription.xml").read_bytes()


def test_every_variable_is_described_and_every_real_has_a_unit(fmu):
    for variable in fmu.description.modelVariables:
        assert variable.description, variable.name
        if variable.type == "Real":
            assert variable.unit or (variable.declaredType and variable.declaredType.unit), variable.name


def test_readme_snippet_simulates(packed):
    start = {"initial.velocity": 20.0, "drive.moment": -5000.0}
    outputs = ["wheel.velocity", "contact.creepage"]
    result = simulate_fmu(str(packed), stop_time=0.5, output_interval=1e-3, start_values=start, output=outputs)
    assert len(result) == 501
    assert result["wheel.velocity"][-1] < 19.8
    assert 1e-4 < result["contact.creepage"][-1] < 1e-2
