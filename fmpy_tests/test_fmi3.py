"""FMI 3.0: its description beside that of FMI 2.0, and runs through both, which must be equal bit for bit."""

import re
import shutil
import struct
import sys
import zipfile
from pathlib import Path

import fmpy
import pytest
from conftest import ROOT
from fmpy.validation import validate_fmu
from lxml import etree
from wheelrail import Refused, Wheel
from wheelrail.calls import Calls
from wheelrail.instances import loaded

SIGNATURES = ROOT / "slave" / "src" / "c_abi" / "v3" / "export.rs"
HEADER = Path(fmpy.__file__).parent / "c-code" / "fmi3FunctionTypes.h"
STEP = 1e-3  # s


def declared():
    """Functions of the header: name to the names and types of their arguments, as Rust writes them."""
    text = re.sub(r"/\*.*?\*/", "", HEADER.read_text(), flags=re.DOTALL)
    functions = {}
    for name, arguments in re.findall(r"typedef\s+[^;()]*?(fmi3\w+)TYPE\s*\(([^;]*?)\)\s*;", text, re.DOTALL):
        functions[name] = []
        for argument in " ".join(arguments.split()).split(","):
            if argument.strip() == "void":
                continue
            const, kind, star, word, array = re.fullmatch(r"(const )?(\w+) ?(\*)? ?(\w+)(\[\])?", argument.strip()).groups()
            pointer = ("*const " if const else "*mut ") if star or array else ""
            functions[name].append((word, pointer + {"size_t": "usize"}.get(kind, kind)))
    return functions


def exported():
    """The same of the library's own list."""
    text = SIGNATURES.read_text().split("($Slave:ty) => {")[1]
    text = re.sub(r"pub (unsafe )?extern \"C\" fn ", "", re.sub(r"//.*", "", text))
    functions = {}
    for name, arguments in re.findall(r"\b(fmi3\w+)\(([^(){}]*)\)\s*(?:->[^;{]*)?[;{]", text):
        pairs = [pair.split(":") for pair in " ".join(arguments.replace(";", ",").split()).split(",") if pair.strip()]
        functions[name] = [(word.strip(), kind.strip()) for word, kind in pairs]
    return functions


def test_every_function_has_the_arguments_of_the_header():
    ours, theirs = exported(), declared()
    assert len(theirs) == 75 and sorted(ours) == sorted(theirs)
    wrong = {name: (ours[name], theirs[name]) for name in theirs if ours[name] != theirs[name]}
    assert wrong == {}


def test_description_follows_the_schema_of_the_standard(packed3):
    schema = etree.XMLSchema(file=str(Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3ModelDescription.xsd"))
    with zipfile.ZipFile(packed3) as archive:
        description = archive.read("modelDescription.xml")
        names = set(archive.namelist())
    assert schema.validate(etree.fromstring(description)), schema.error_log
    assert not schema.validate(etree.fromstring(description.replace(b'causality="output"', b'causality="outcome"', 1)))
    assert validate_fmu(str(packed3)) == []
    expected = {"binaries/x86_64-linux/wheelrail.so", "documentation/index.html", "documentation/diagram.png"}
    assert expected | {"terminalsAndIcons/terminalsAndIcons.xml", "resources/railway.json"} <= names


def test_both_versions_have_the_same_variables(fmu, fmu3):
    assert fmu.description.fmiVersion == "2.0" and fmu3.description.fmiVersion == "3.0"
    assert sorted(fmu.variables) == sorted(fmu3.variables)
    for name, two in fmu.variables.items():
        three = fmu3.variables[name]
        assert (two.valueReference, two.type, two.causality, two.variability, two.initial) == (
            three.valueReference, three.type, three.causality, three.variability, three.initial,
        ), name  # fmt: skip
        assert (two.unit, two.displayUnit, two.min, two.max, two.start) == (
            three.unit, three.displayUnit, three.min, three.max, three.start,
        ), name  # fmt: skip
    roots = [etree.parse(str(Path(f.directory, "modelDescription.xml"))).getroot() for f in (fmu, fmu3)]
    two, three = [etree.tostring(root.find("UnitDefinitions"), with_tail=False) for root in roots]
    assert two == three
    assert fmu.retired == fmu3.retired
    rows = [v for v in fmu3.description.modelVariables if v.dimensions]
    assert len(fmu3.description.modelVariables) < 330 and len(rows) == 29
    assert [v.name for v in fmu3.description.modelVariables if v.causality == "independent"] == ["time"]


def dependencies(root, path, elements):
    """Declared dependencies by name, `None` for all; `elements` names what an entry of the structure stands for."""
    return {name: entry.get("dependencies") for entry in root.findall(f"ModelStructure/{path}") for name in elements(entry)}


def test_both_versions_declare_the_same_dependencies(fmu, fmu3):
    """FMI 3.0 with whole arrays, whose elements are no outputs of FMI 2.0."""
    two, three = (etree.parse(str(Path(f.directory, "modelDescription.xml"))).getroot() for f in (fmu, fmu3))
    names = [v.get("name") for v in two.find("ModelVariables")]
    elements = {}
    for name, variable in fmu3.variables.items():
        elements.setdefault(fmu3.places[variable.valueReference].reference, []).append(name)
    for old, new in (("Outputs", "Output"), ("InitialUnknowns", "InitialUnknown")):
        before = dependencies(two, f"{old}/Unknown", lambda entry: [names[int(entry.get("index")) - 1]])
        now = dependencies(three, new, lambda entry: elements[int(entry.get("valueReference"))])
        arrays = {name for name in now if "[" in name}
        assert before == {name: now[name] for name in now.keys() - arrays} and len(before) > 100 and len(arrays) > 900
    assert set(now.values()) == {None, ""}


def outputs_of(wheel):
    """All outputs and points of profiles of a wheel, bit for bit."""
    names = sorted(v.name for v in wheel.fmu.variables.values() if v.causality in ("output", "local"))
    return struct.pack(f"{len(names)}d", *map(float, wheel.get(*names)))


def driven(parameters=None, inputs=None, drive=None, steps=12):
    """A run: `drive` gives the inputs of a step."""

    def run(fmu):
        with Wheel(fmu, parameters, inputs) as wheel:
            rows = [outputs_of(wheel)]
            for k in range(steps):
                wheel.set(drive(k) if drive else {"drive.moment": -300.0 * (k % 5)})
                wheel.step(STEP)
                rows.append(outputs_of(wheel))
            return rows

    return run


def controlled(rotation, translation, vertical):
    """A run in one of the modes of control."""
    modes = {"control.rotation": rotation, "control.translation": translation, "control.vertical": vertical}
    prescribed = [
        (rotation, {"moment": ("drive.moment", 0.0, -200.0), "velocity": ("drive.omega", 60.38, -0.01)}),
        (translation, {"force": ("drive.force", 0.0, 50.0), "velocity": ("drive.velocity", 27.77, -0.002)}),
        (vertical, {"force": ("drive.load", 1e5, 100.0), "displacement": ("drive.displacement", -1.3e-4, 0.0)}),
    ]
    inputs = [choice[mode] for mode, choice in prescribed]
    return driven(inputs=modes, drive=lambda k: {name: first + k * by for name, first, by in inputs})


def rolled_back(fmu):
    """Steps, of which some are taken back and done again."""
    with Wheel(fmu) as wheel:
        wheel.step(STEP)
        saved, rows = wheel.save(), []
        for moment in (-500.0, -500.0, 400.0):
            wheel.restore(saved)
            for _ in range(4):
                wheel.set({"drive.moment": moment})
                wheel.step(STEP)
            rows.append(outputs_of(wheel))
        wheel.forget(saved)
        assert rows[0] == rows[1] != rows[2]
        return rows


def eight_wheels(fmu):
    """Eight wheels of one process, in turn."""
    wheels = [Wheel(fmu, {"initial.velocity": 10.0 + k}) for k in range(8)]
    try:
        for k in range(4):
            for i, wheel in enumerate(wheels):
                wheel.set({"drive.moment": -50.0 * k * i})
                wheel.step(STEP)
        return [outputs_of(wheel) for wheel in wheels]
    finally:
        for wheel in wheels:
            wheel.close()


RUNS = {
    "moment, force, force": controlled("moment", "force", "force"),
    "velocity, force, force": controlled("velocity", "force", "force"),
    "moment, velocity, force": controlled("moment", "velocity", "force"),
    "velocity, velocity, force": controlled("velocity", "velocity", "force"),
    "moment, force, displacement": controlled("moment", "force", "displacement"),
    "velocity, force, displacement": controlled("velocity", "force", "displacement"),
    "moment, velocity, displacement": controlled("moment", "velocity", "displacement"),
    "velocity, velocity, displacement": controlled("velocity", "velocity", "displacement"),
    "brake": driven(drive=lambda k: {"brake.torque": 500.0 * k}),
    "lock": driven({"preset": "railway_dry", "initial.velocity": 3.0}, drive=lambda k: {"brake.torque": 6e4}, steps=30),
    "rollback": rolled_back,
    "rough rail": driven({"rail.profile": "roughness(spectrum = EN_ISO_3095, seed = 3)"}),
    "ellipse": driven({"preset": "railway_ellipse"}),
    "rows": driven({"preset": "railway_s1002_3mm"}),
    "eight wheels": eight_wheels,
}


@pytest.mark.filterwarnings("ignore::wheelrail.warn.WheelrailWarning")
@pytest.mark.parametrize("name", RUNS)
def test_runs_through_both_versions_are_equal_bit_for_bit(name, fmu, fmu3):
    two, three = RUNS[name](fmu), RUNS[name](fmu3)
    assert len(set(two)) == len(two) or name == "rollback"
    assert two == three


def test_the_wheel_locks_in_both_versions(fmu3):
    with Wheel(fmu3, {"preset": "railway_dry", "initial.velocity": 3.0}) as wheel:
        for _ in range(25):
            wheel.set({"brake.torque": 6e4})
            wheel.step(STEP)
        assert abs(wheel.get("wheel.omega")) < 0.1 and wheel.get("brake.locked")


def ramped(wheel, give):
    """Steps of 5 ms under a moment that grows and a load that swings within them; `give` takes their rates. The work of the hub."""
    with wheel:
        rows = []
        for k in range(20):
            rates = {"drive.moment": -1e5, "drive.load": 1e6 * (1 if k % 2 else -1)}
            give(wheel, rates)
            wheel.step(5e-3)
            rows.append(outputs_of(wheel))
        return rows, wheel.get("energy.hub_work")


def test_ramps_as_inputs_are_those_of_input_derivatives(fmu, fmu3):
    derivatives = [ramped(Wheel(opened), lambda wheel, rates: wheel.set_rates(rates)) for opened in (fmu, fmu3)]
    inputs = [
        ramped(Wheel(opened), lambda wheel, rates: wheel.set({f"{name}_rate": rate for name, rate in rates.items()}))
        for opened in (fmu, fmu3)
    ]
    assert derivatives[0] == derivatives[1] == inputs[0] == inputs[1]
    value = {"drive.moment": 0.0, "drive.load": 1e5}

    def hold(wheel, rates):
        wheel.set(value)
        value.update({name: value[name] + 5e-3 * rate for name, rate in rates.items()})

    _, held = ramped(Wheel(fmu), hold)
    print(f"work of the hub: {inputs[0][1]:.1f} J with rates, {held:.1f} J with held values")
    assert abs(held / inputs[0][1] - 1.0) > 0.01


def test_ramps_by_intermediate_update_are_those_of_input_derivatives(fmu, fmu3):
    """Through fmpy's own functions: the master is asked for moment and load within steps of 5 ms."""
    h, steps = 5e-3, 20
    names, work = ["drive.moment", "drive.load"], fmu3.variables["energy.hub_work"].valueReference
    references = [fmu3.variables[name].valueReference for name in names]
    slave, asked = loaded(fmu3, "wheel", Calls("wheel")), []
    present, rates = [0.0, 1e5], [-1e5, 0.0]

    def answer(environment, time, *_):
        asked.append(time)
        since = time - h * ((len(asked) - 1) // 4)
        slave.setFloat64(references, [value + since * rate for value, rate in zip(present, rates)])

    slave.instantiate(intermediateUpdate=answer, requiredIntermediateVariables=references)
    try:
        slave.setupExperiment()
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        for k in range(steps):
            rates[1] = 1e6 * (1 if k % 2 else -1)
            slave.doStep(k * h, h)
            present = [value + h * rate for value, rate in zip(present, rates)]
            assert slave.getFloat64(references) == pytest.approx(present, rel=1e-12)
        (found,) = slave.getFloat64([work])
    finally:
        slave.freeInstance()
    _, expected = ramped(Wheel(fmu), lambda wheel, rates: wheel.set_rates(rates))
    print(f"work of the hub: {found!r} J by intermediate update, {expected!r} J by derivatives of FMI 2.0")
    assert asked == pytest.approx([h * (k + share) for k in range(steps) for share in (0.25, 0.5, 0.75, 1.0)], abs=1e-12)
    assert found == pytest.approx(expected, rel=1e-9)


def test_inputs_that_can_be_given_within_steps_are_those_with_ramps(fmu3):
    declared = etree.parse(str(Path(fmu3.directory, "modelDescription.xml"))).getroot()
    assert declared.find("CoSimulation").get("providesIntermediateUpdate") == "true"
    rows = declared.findall("ModelVariables/*[@intermediateUpdate='true']")
    names = {row.get("name") for row in rows}
    inputs = [name for name, variable in fmu3.variables.items() if variable.causality == "input"]
    assert names == {name for name in inputs if f"{name}_rate" in inputs and name != "rail.elevation" and not name.startswith("wheelset.")}
    assert {row.get("causality") for row in rows} == {"input"} and {row.get("variability") for row in rows} == {"continuous"}


def test_motions_move_to_the_same_ends_in_both_versions(fmu, fmu3):
    runs = []
    for opened in (fmu, fmu3):
        with Wheel(opened, inputs={"control.translation": "velocity", "control.rotation": "velocity"}) as wheel:
            for _ in range(5):
                wheel.set_rates({"drive.velocity": -3.0, "drive.omega": -6.5})
                wheel.step(5e-3)
            runs.append(outputs_of(wheel))
    assert runs[0] == runs[1]


def test_both_ways_to_give_a_rate_are_refused_together(fmu):
    with Wheel(fmu) as wheel:
        wheel.set({"drive.moment_rate": 5.0})
        with pytest.raises(Refused, match="drive.moment_rate"):
            wheel.set_rates({"drive.moment": 1.0})
        wheel.set({"drive.moment_rate": 0.0})
        wheel.set_rates({"drive.moment": 1.0})
        with pytest.raises(Refused, match="drive.moment_rate"):
            wheel.set({"drive.moment_rate": 5.0})


def test_states_cross_between_the_versions(fmu, fmu3):
    with Wheel(fmu) as two, Wheel(fmu3) as three:
        two.set({"drive.moment": -400.0})
        two.step(STEP)
        (state, _) = two.save()
        three.slave.setFMUstate(three.slave.deSerializeFMUstate(two.slave.serializeFMUstate(state)))
        three.time = two.time
        for wheel in (two, three):
            wheel.step(STEP)
        assert outputs_of(two) == outputs_of(three)


def test_refusals_and_warnings_have_the_same_words(fmu, fmu3):
    said = []
    for opened in (fmu, fmu3):
        with Wheel(opened) as wheel:
            with pytest.raises(Refused) as refusal:
                wheel.set({"drive.load": -1.0})
            with pytest.raises(Refused) as discarded:
                wheel.set({"drive.load": 1e9})
                wheel.step(STEP)
            said.append((str(refusal.value), str(discarded.value)))
    assert said[0] == said[1] and "drive.load" in said[0][0]


def test_a_master_in_c_gets_the_same_digits_from_both_versions(fmu, fmu3, tmp_path):
    """The host of `make fmu ALL=1 CHECK=1`: 2,000 steps with a wheel that slides, a state saved and restored."""
    if not shutil.which("cc"):
        pytest.skip("no C compiler")
    sys.path.insert(0, str(ROOT / "packaging"))
    import check

    printed = []
    for opened in (fmu, fmu3):
        folder = Path(opened.directory)
        version, identity, names, references = check.outputs(folder / "modelDescription.xml")
        host = check.compiled("cc", version, tmp_path / f"host{version}", "-ldl")
        resources = ("file://" if version == "2.0" else "") + str(folder / "resources")
        printed.append((names, check.output(host, folder / check.BINARIES[version][0], identity, resources, *references)))
    assert printed[0] == printed[1] and len(printed[0][1].splitlines()) == 100


def test_the_library_comes_and_goes_hundreds_of_times(fmu3):
    """Loaded, used and unloaded; every hundredth time for a short run."""
    memory = []
    for k in range(301):
        slave = loaded(fmu3, f"wheel{k}", Calls("wheel"))
        slave.start([])
        if k % 100 == 0:
            slave.setupExperiment()
            slave.enterInitializationMode()
            slave.exitInitializationMode()
            slave.doStep(0.0, STEP)
        slave.freeInstance()
        if k % 100 == 0:
            lines = Path("/proc/self/status").read_text().splitlines()
            memory.append(int(next(line for line in lines if line.startswith("VmRSS:")).split()[1]))
    print(f"resident memory every hundred rounds: {memory} kB")
    assert str(fmu3.directory) not in Path("/proc/self/maps").read_text()
    assert memory[-1] - memory[1] < 200 * 10


def test_fmpy_simulates_it(fmu3, packed3):
    result = fmpy.simulate_fmu(
        str(packed3), stop_time=0.02, output_interval=1e-3, start_values={"drive.moment": -100.0}, output=["wheel.velocity", "profile.pressure"]
    )
    assert len(result) == 21 and result["profile.pressure"].shape == (21, 61)
    assert result["profile.pressure"].max() > 1e8 and result["wheel.velocity"][-1] < result["wheel.velocity"][0]
