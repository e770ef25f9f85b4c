"""A coach on four wheelsets as packages that other masters open: SSP 1.0 (`.ssp`) and the system structure of libcosim (OSP).

Both hold `coach.fmu` (vehicle, brakes, slide protection; made by the crate in `coach/`), `wheelrail.fmu` four times, and the
parameters of a scenario. In the `.ssp` lie

    SystemStructure.ssd         components and connections, with coach.ssv and wheelset.ssv bound to them
    resources/train.ssv         the same values for the whole system, for masters that want one set (fmpy)
    resources/presets/*.ssv     every preset of the wheel, as far as it differs from the default: for one wheel

Such a master steps everything at once, with inputs that hold what came out of the last step. Forces of the beginning of a step, held,
would swing up in a stiff primary suspension: the coach looks one step further ahead, and the wheels hold the mean of its forces over the
step that comes. In the first step wheels roll at the initial speed without force.
"""

import subprocess
import zipfile
from pathlib import Path
from types import SimpleNamespace
from xml.sax.saxutils import quoteattr

from .files import BadFile
from .origin import preset_values
from .output import fresh
from .output import write as write_file
from .scenario import of_two_kinds
from .values import Refused
from .vehicle import AXLES, Coach
from .wheelset import whole_wheelset

STEP = 1e-3  # s
# Output of the coach to input of the wheel, and back.
TO_WHEEL = {"force": "drive.force", "load_change": "drive.load_change", "torque": "brake.torque"}
TO_COACH = {
    "wheel.distance": "distance", "wheel.velocity": "velocity", "wheel.omega": "omega", "contact.force_x": "contact_force",
    "brake.torque_actual": "brake_torque",
}  # fmt: skip
# Outputs that are connectors so that masters record them.
WATCHED = ("coach.speed", "coach.distance", "brake.control_pressure", "brake.reference_speed")
# What a single coach on rails without sand does not need.
LEFT_OUT = ("sander.", "coupler.", "length")
SPACES = {
    "ssc": "http://ssp-standard.org/SSP1/SystemStructureCommon",
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "osp": "http://opensimulationplatform.com/SSP/OSPAnnotations",  # libcosim wants it declared on the root element
}
HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'


def coach_values(scenario):
    """Parameters of the coach: names of the vehicle's file, those of the brake's under `brake`."""
    values = {"initial.speed": scenario.speed, "demand": scenario.demand}
    if scenario.brake.sander.active:
        raise BadFile("the coach of a system package has no sander: set sander.active to false")
    if scenario.brake.protection or scenario.brake.sanding or scenario.driver:
        raise BadFile("the coach of a system package brakes by its own code: leave out protection, sanding and driver")
    if scenario.coaches > 1:
        raise BadFile(f"a system package holds one coach: coaches = {scenario.coaches} is outside its range, 1")
    for prefix, group in (("", scenario.vehicle), ("brake.", scenario.brake)):
        values |= {prefix + name: value for name, value in _flat(group) if not name.startswith(LEFT_OUT)}
    return values


def _flat(group, prefix=""):
    """Names and numbers of nested groups."""
    for name, value in vars(group).items():
        if isinstance(value, SimpleNamespace):
            yield from _flat(value, f"{prefix}{name}.")
        elif not isinstance(value, str | dict):
            yield prefix + name, float(value) if not isinstance(value, list | tuple) else value


def wheelset_values(scenario, fmu):
    """Parameters and constant inputs of a wheelset in the wheel's FMU."""
    if of_two_kinds(scenario):
        raise Refused("right_wheel, right_friction: a wheelset of a package is one FMU, and both its wheels are equal")
    values = whole_wheelset(fmu, scenario.vehicle.wheelset, dict(scenario.wheel))
    load, damping = Coach(scenario.vehicle).static_load, scenario.vehicle.primary.vertical_damping
    values |= {"initial.velocity": scenario.speed, "vehicle.mass": 0.0, "vehicle.damping": damping}
    return values | {"drive.load": load, "rail.friction": friction(scenario)}


def friction(scenario):
    """Friction [1] of the first section of the track, which a package has everywhere."""
    track = scenario.track
    return track.conditions[track.sections.condition[0]].friction


def presets(fmu):
    """What every preset changes of the default one: name of the preset to names, types and values."""
    default = preset_values(fmu, "railway")
    names = sorted(path.stem for path in (Path(fmu.directory) / "resources").glob("*.json"))
    changed = {name: preset_values(fmu, name).items() - default.items() for name in names}
    return {name: typed(fmu.variables, dict(sorted(values))) for name, values in changed.items()}


def typed(variables, values):
    """Values with their types."""
    return {name: (variables[name].type, _plain(variables[name], value)) for name, value in values.items()}


def _plain(variable, value):
    """A value as text: choices by their names."""
    match variable.type:
        case "Enumeration" | "String":
            return value
        case "Boolean":
            return "true" if value else "false"
    return repr(int(value) if variable.type == "Integer" else float(value))


def ssv(name, values):
    """A parameter set; `values` are name to (type, text)."""
    rows = "".join(
        f"    <ssv:Parameter name={quoteattr(key)}><ssv:{kind} value={quoteattr(text)}/></ssv:Parameter>\n"
        for key, (kind, text) in values.items()
    )
    spaces = " ".join(f'xmlns:{key}="{SPACES[key]}"' for key in ("ssc", "ssv"))
    head = f'<ssv:ParameterSet {spaces} version="1.0" name={quoteattr(name)}>\n'
    return f"{HEAD}{head}  <ssv:Parameters>\n{rows}  </ssv:Parameters>\n</ssv:ParameterSet>\n"


def connections():
    """Pairs of (component, connector): from an output to an input."""
    for axle in range(1, AXLES + 1):
        for output, to in TO_WHEEL.items():
            yield ("coach", f"axle{axle}.{output}"), (f"wheelset{axle}", to)
        for output, to in TO_COACH.items():
            yield (f"wheelset{axle}", output), ("coach", f"axle{axle}.{to}")


def _connectors(component, variables):
    """Connectors of a component: those of its connections, and outputs to be recorded."""
    kinds = {}
    for (source, output), (target, name) in connections():
        kinds |= {output: "output"} if source == component else {}
        kinds |= {name: "input"} if target == component else {}
    kinds |= dict.fromkeys(WATCHED, "output") if component == "coach" else {}
    return [
        f'<ssd:Connector name="{name}" kind="{kind}"><ssc:Real unit="{variables[name].unit}"/></ssd:Connector>'
        for name, kind in kinds.items()
    ]


def ssd(scenario, coach, fmu, stop_time, step):
    """The system structure; `coach` and `fmu` are the opened FMUs."""
    lines, used = [], set()
    for component, source in components():
        variables = (coach if component == "coach" else fmu).variables
        rows = _connectors(component, variables)
        used |= {row.split('unit="')[1].split('"')[0] for row in rows}
        values = "coach" if component == "coach" else "wheelset"
        lines += [
            f'      <ssd:Component name="{component}" type="application/x-fmu-sharedlibrary" source="resources/{source}">',
            "        <ssd:Connectors>", *(f"          {row}" for row in rows), "        </ssd:Connectors>",
            f'        <ssd:ParameterBindings><ssd:ParameterBinding source="resources/{values}.ssv"/></ssd:ParameterBindings>',
            "      </ssd:Component>",
        ]  # fmt: skip
    wires = [
        f'      <ssd:Connection startElement="{a}" startConnector="{output}" endElement="{b}" endConnector="{name}"/>'
        for (a, output), (b, name) in connections()
    ]
    spaces = " ".join(f'xmlns:{key}="{address}"' for key, address in SPACES.items())
    units = [f"    {_unit(unit)}" for unit in fmu.description.unitDefinitions if unit.name in used]
    return HEAD + "\n".join([
        f'<ssd:SystemStructureDescription {spaces} version="1.0" name={quoteattr(scenario.name)} '
        'generationTool="wheelrail" license="MIT OR Apache-2.0">',
        f'  <ssd:System name="train" description={quoteattr(scenario.vehicle.name)}>',
        "    <ssd:Elements>", *lines, "    </ssd:Elements>",
        "    <ssd:Connections>", *wires, "    </ssd:Connections>",
        "  </ssd:System>",
        "  <ssd:Units>", *units, "  </ssd:Units>",
        f'  <ssd:DefaultExperiment startTime="0.0" stopTime="{stop_time!r}">',
        '    <ssd:Annotations><ssc:Annotation type="com.opensimulationplatform"><osp:Algorithm>'
        f'<osp:FixedStepAlgorithm baseStepSize="{step!r}"/></osp:Algorithm></ssc:Annotation></ssd:Annotations>',
        "  </ssd:DefaultExperiment>",
        "</ssd:SystemStructureDescription>",
        "",
    ])  # fmt: skip


def _unit(unit):
    """A unit with its exponents."""
    base = unit.baseUnit
    exponents = {name: getattr(base, name) for name in ("kg", "m", "s", "rad", "K")}
    powers = "".join(f' {name}="{power}"' for name, power in exponents.items() if power)
    return f'<ssc:Unit name="{unit.name}"><ssc:BaseUnit{powers}/></ssc:Unit>'


def components():
    """Names of the components and of their files."""
    return [("coach", "coach.fmu"), *((f"wheelset{axle}", "wheelrail.fmu") for axle in range(1, AXLES + 1))]


def osp(values, step):
    """The system structure for libcosim; `values` are component to (name to (type, text))."""
    simulators, wires = [], []
    for component, source in components():
        initial = "".join(
            f'        <InitialValue variable="{name}"><{kind} value="{text}"/></InitialValue>\n'
            for name, (kind, text) in values[component].items()
        )
        simulators.append(
            f'    <Simulator name="{component}" source="{source}" stepSize="{step!r}">\n      <InitialValues>\n'
            f"{initial}      </InitialValues>\n    </Simulator>\n"
        )
    for (a, output), (b, name) in connections():
        ends = f'<Variable simulator="{a}" name="{output}"/><Variable simulator="{b}" name="{name}"/>'
        wires.append(f"    <VariableConnection>{ends}</VariableConnection>\n")
    return (
        f'{HEAD}<OspSystemStructure xmlns="http://opensimulationplatform.com/MSMI/OSPSystemStructure" version="0.1">\n'
        f"  <StartTime>0.0</StartTime>\n  <BaseStepSize>{step!r}</BaseStepSize>\n  <Algorithm>fixedStep</Algorithm>\n"
        f"  <Simulators>\n{''.join(simulators)}  </Simulators>\n  <Connections>\n{''.join(wires)}  </Connections>\n"
        "</OspSystemStructure>\n"
    )


def archive(path, entries):
    """Writes a zip file; equal entries give equal bytes."""
    with fresh(path) as new, zipfile.ZipFile(new, "w", zipfile.ZIP_DEFLATED) as file:
        for name, content in entries.items():
            info = zipfile.ZipInfo(name)
            info.compress_type, info.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            file.writestr(info, content)


PLATFORMS = {"2": "linux64", "3": "x86_64-linux"}  # where a library for Linux lies, by the version of FMI


def pack_coach(program, library, out, licences=(), fmi="2"):
    """Writes coach.fmu of FMI 2.0 or 3.0; `program` prints its model description."""
    for path in map(Path, (program, library)):
        if not path.is_file():
            raise FileNotFoundError(f"{path} does not exist: `make ssp` builds it; --coach names its directory")
    described = subprocess.run([str(program), fmi], check=True, capture_output=True).stdout
    texts = {f"documentation/licenses/{path.name}": path.read_bytes() for path in map(Path, licences)}
    # Some masters name a directory of resources that does not exist unless something is in it.
    texts["resources/README.txt"] = b"The coach has no resources.\n"
    archive(out, {"modelDescription.xml": described, f"binaries/{PLATFORMS[fmi]}/coach.so": Path(library).read_bytes()} | texts)


def write(scenario, fmu, coach, paths, out, stop_time=10.0, step=STEP):
    """Writes `coach_and_wheels.ssp` and `osp/` to a directory and returns their paths. `fmu` and `coach` are the opened FMUs,
    `paths` those of their files: of the wheel, of the coach. With FMUs of FMI 3.0, which libcosim does not run, there is no
    `osp/`, and the second path is None."""
    values = {"coach": typed(coach.variables, coach_values(scenario))}
    wheelset = typed(fmu.variables, wheelset_values(scenario, fmu))
    values |= {name: wheelset for name, _ in components()[1:]}
    whole = {f"{component}.{name}": value for component, of in values.items() for name, value in of.items()}
    sets = {"coach": values["coach"], "wheelset": wheelset, "train": whole}
    sets |= {f"presets/{name}": changed for name, changed in presets(fmu).items() if changed}
    files = {"wheelrail.fmu": Path(paths[0]).read_bytes(), "coach.fmu": Path(paths[1]).read_bytes()}
    entries = {"SystemStructure.ssd": ssd(scenario, coach, fmu, stop_time, step)}
    entries |= {f"resources/{name}": content for name, content in files.items()}
    entries |= {f"resources/{name}.ssv": ssv(name.split("/")[-1], of) for name, of in sets.items()}
    package, system = Path(out) / "coach_and_wheels.ssp", Path(out) / "osp"
    archive(package, entries)
    if fmu.places:
        return package, None
    for name, content in files.items():
        write_file(system / name, content)
    structure = system / "OspSystemStructure.xml"
    write_file(structure, osp(values, step))
    return package, structure
