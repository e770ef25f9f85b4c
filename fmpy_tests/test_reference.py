"""The run in examples/reference, made by the project's own master, comes out of fmpy as well; what else is in the FMU."""

import subprocess
import zipfile
from pathlib import Path

import fmpy
import numpy as np
from conftest import ROOT
from fmpy.util import read_csv, read_ref_opt_file
from lxml import etree

REFERENCE = ROOT / "examples" / "reference"


def test_fmpy_reproduces_the_reference_run(fmu):
    options = read_ref_opt_file(str(REFERENCE / "wheelrail_ref.opt"))
    expected = read_csv(str(REFERENCE / "wheelrail_ref.csv"))
    outputs = list(expected.dtype.names[1:])
    result = fmpy.simulate_fmu(
        fmu.directory, start_time=options["StartTime"], stop_time=options["StopTime"], output_interval=options["StepSize"],
        input=read_csv(str(REFERENCE / "wheelrail_in.csv")), output=outputs,
    )  # fmt: skip
    assert len(result) == len(expected) > 500 and len(outputs) > 5
    for name in outputs:
        worst = np.max(np.abs(result[name] - expected[name])) / np.max(np.abs(expected[name]))
        print(f"{name}: {worst:.1e}")
        assert worst <= 1e-6, name  # 1e-11 on the machine that made it
    # It is a run in which something happens.
    assert expected["wheel.velocity"][-1] < 27.5 and expected["contact.creepage"].max() > 0.01
    assert np.ptp(expected["contact.force_y"]) > 9e3 and expected["temperature.wheel_max"].max() > 350.0


def test_the_reference_run_is_inside_the_fmu(packed):
    with zipfile.ZipFile(packed) as archive:
        for path in REFERENCE.glob("wheelrail_*"):
            assert archive.read(f"documentation/reference/{path.name}") == path.read_bytes()


def test_terminals_follow_the_schema_and_their_pictures_are_there(packed, fmu):
    schema = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"))
    with zipfile.ZipFile(packed) as archive:
        root = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
        assert schema.validate(root), schema.error_log
        icons = {node.get("iconBaseName") for node in root.iter("TerminalGraphicalRepresentation")} | {"icon"}
        for name in icons:
            assert archive.read(f"terminalsAndIcons/{name}.png").startswith(b"\x89PNG")
        assert b"MIT" in archive.read("documentation/licenses/license.txt")
    terminals = {node.get("name"): [m.get("variableName") for m in node] for node in root.iter("Terminal")}
    assert {"hub_x", "hub_rotation", "hub_vertical", "brake"} <= terminals.keys()
    assert all(name in fmu.variables for members in terminals.values() for name in members if name)


def test_metadata_is_complete(fmu):
    d = fmu.description
    assert all((d.author, d.copyright, d.license, d.generationDateAndTime, d.version, d.description))
    assert d.defaultExperiment.tolerance and d.defaultExperiment.stepSize
    for variable in d.modelVariables:
        if variable.type == "Real":
            assert variable.declaredType.unit == variable.unit and variable.declaredType.quantity


def test_an_fmu_without_profiles_is_the_same_but_for_their_names(packed, fmu, tmp_path):
    binary = ROOT / "target" / "release" / "wheelrail-pack"
    slim = tmp_path / "slim.fmu"
    command = [binary, "pack", "--no-profiles", "--out", slim, "--library", ROOT / "target/release/libwheelrail.so"]
    subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
    description = fmpy.read_model_description(str(slim))
    listed = {v.name: v.valueReference for v in description.modelVariables}
    everything = {v.name: v.valueReference for v in fmu.description.modelVariables}
    assert everything.keys() - listed.keys() == {name for name in everything if name.startswith(("profile.", "line."))}
    assert all(everything[name] == reference for name, reference in listed.items())
    runs = [
        fmpy.simulate_fmu(str(path), stop_time=0.02, output_interval=1e-3, output=["contact.force_y", "wheel.omega"])
        for path in (slim, packed)
    ]
    assert np.array_equal(*runs)
