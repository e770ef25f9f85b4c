"""Example 17: a controller of one's own that is an FMU brakes the wheel's FMU, both in one loop of fmpy.

    .venv/bin/python examples/ex17_own_controller.py
    .venv/bin/python examples/ex17_own_controller.py --controller my.fmu --step 2e-3
    .venv/bin/python examples/ex17_own_controller.py --package target/coach_and_wheels.ssp --out own.ssp

The last command puts the controller before the brakes of all axles of the coach that `make ssp` packs. Without --controller the brake
with slide protection of examples/controller/slide_control.c is compiled by `cc` and packed; slide_control.py beside it is the same in
Python. Another controller needs the variables of `TO_CONTROLLER` and `TO_WHEEL`, or changes of these two tables. Printed: what the wheel
did, for every communication step, and without protection.
"""

import argparse
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

import fmpy

SOURCE = Path(__file__).parent / "controller/slide_control.c"
TO_CONTROLLER = {"wheel.velocity": "velocity", "wheel.omega": "omega"}  # output of the wheel to input of the controller
TO_WHEEL = {"torque": "brake.torque"}  # output of the controller to input of the wheel
START = {"initial.velocity": 20.0, "friction.coefficient": 0.08, "friction.falling_ratio": 0.625, "friction.falling_decay": 0.2}
DEMAND = 8000.0  # N m on the wheel, more than twice what this rail carries
WATCHED = ("contact.slide", "contact.force_x", "temperature.wheel_max", "wheel.velocity", "wheel.distance")
# Of the controller in C, in the order of its value references: name, causality, start.
VARIABLES = (
    ("velocity", "input", 0.0),
    ("omega", "input", 0.0),
    ("demand", "parameter", DEMAND),
    ("radius", "parameter", 0.46),
    ("torque", "output", None),
)


def packed(folder):
    """The controller of this example as an FMU for this machine: what any tool that exports FMUs does."""
    library, fmu = folder / "slide_control.so", folder / "slide_control.fmu"
    subprocess.run(["cc", "-O2", "-shared", "-fPIC", "-o", library, SOURCE, "-lm"], check=True)
    variables = ""
    for number, (name, causality, start) in enumerate(VARIABLES):
        kind = "fixed" if causality == "parameter" else "continuous"
        real = "<Real/>" if start is None else f'<Real start="{start}"/>'
        head = f'name="{name}" valueReference="{number}" causality="{causality}" variability="{kind}"'
        variables += f"<ScalarVariable {head}>{real}</ScalarVariable>"
    description = (
        '<?xml version="1.0" encoding="UTF-8"?><fmiModelDescription fmiVersion="2.0" modelName="slide_control" guid="{17}">'
        '<CoSimulation modelIdentifier="slide_control" canHandleVariableCommunicationStepSize="true"/>'
        f'<ModelVariables>{variables}</ModelVariables><ModelStructure><Outputs><Unknown index="5" dependencies=""/></Outputs>'
        '<InitialUnknowns><Unknown index="5" dependencies=""/></InitialUnknowns></ModelStructure></fmiModelDescription>'
    )
    with zipfile.ZipFile(fmu, "w") as archive:
        archive.write(library, "binaries/linux64/slide_control.so")
        archive.writestr("modelDescription.xml", description)
    return fmu


class Part:
    """An FMU in the loop, its variables by their names."""

    def __init__(self, fmu, start):
        description = fmpy.read_model_description(fmu)
        self.number = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.fmu = fmpy.instantiate_fmu(fmpy.extract(fmu), description, "CoSimulation")
        self.fmu.setupExperiment(startTime=0.0)
        self.set(start)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def set(self, values):
        self.fmu.setReal([self.number[name] for name in values], list(values.values()))

    def get(self, names):
        return dict(zip(names, self.fmu.getReal([self.number[name] for name in names])))

    def close(self):
        self.fmu.terminate()
        self.fmu.freeInstance()


def braked(wheel_fmu, controller_fmu, step, seconds):
    """What the wheel did, sample by sample, under the controller; without one under `DEMAND`, built up like its brake."""
    wheel = Part(wheel_fmu, START)
    controller = Part(controller_fmu, {"demand": DEMAND, "radius": 0.46}) if controller_fmu else None
    before, samples = dict.fromkeys(TO_WHEEL.values(), 0.0), []
    for k in range(round(seconds / step)):
        time = k * step
        if controller:
            # 1. The controller sees the wheel at the beginning of the step and says what its brake does at the end.
            seen = wheel.get(TO_CONTROLLER)
            controller.set({TO_CONTROLLER[name]: value for name, value in seen.items()})
            controller.fmu.doStep(time, step)
            after = {TO_WHEEL[name]: value for name, value in controller.get(TO_WHEEL).items()}
        else:
            after = {"brake.torque": min(DEMAND, 4e4 * (time + step))}
        # 2. The wheel ramps from the value before to that one, with the impulse of the ramp.
        wheel.set({**before, **{f"{name}_rate": (after[name] - before[name]) / step for name in after}})
        wheel.fmu.doStep(time, step)
        before = after
        samples.append(wheel.get(WATCHED))
    for part in (wheel, controller) if controller else (wheel,):
        part.close()
    return samples


def inserted(package, controller, out):
    """Writes the package of a coach and wheels with a controller in the place of the coach's slide protection, on every axle."""
    with zipfile.ZipFile(package) as archive, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as written:
        structure = archive.read("SystemStructure.ssd").decode()
        for axle in range(1, structure.count('endConnector="brake.torque"') + 1):
            kinds = {**dict.fromkeys(TO_CONTROLLER.values(), "input"), **dict.fromkeys(TO_WHEEL, "output")}
            connectors = "".join(f'<ssd:Connector name="{name}" kind="{kind}"><ssc:Real/></ssd:Connector>' for name, kind in kinds.items())
            component = (
                f'<ssd:Component name="control{axle}" type="application/x-fmu-sharedlibrary" source="resources/control.fmu">'
                f"<ssd:Connectors>{connectors}</ssd:Connectors></ssd:Component>"
            )
            inputs = (("coach", "coach.speed", "velocity"), (f"wheelset{axle}", "wheel.omega", "omega"))
            connections = "".join(
                f'<ssd:Connection startElement="{part}" startConnector="{name}" endElement="control{axle}" endConnector="{to}"/>'
                for part, name, to in inputs
            )
            for old, new in (
                (f'startElement="coach" startConnector="axle{axle}.torque"', f'startElement="control{axle}" startConnector="torque"'),
                ("</ssd:Elements>", f"{component}</ssd:Elements>"),
                ("</ssd:Connections>", f"{connections}</ssd:Connections>"),
            ):
                structure = structure.replace(old, new)
        for name in archive.namelist():
            written.writestr(name, structure if name == "SystemStructure.ssd" else archive.read(name))
        written.write(controller, "resources/control.fmu")


def line(name, samples):
    """One line of the table."""
    last, mean = samples[-1], sum(sample["contact.force_x"] for sample in samples) / len(samples)
    slide, hottest = (max(sample[name] for sample in samples) for name in ("contact.slide", "temperature.wheel_max"))
    return (
        f"{name:>16}{last['wheel.velocity']:12.3f} m/s{last['wheel.distance']:10.2f} m"
        f"{-mean / 1e3:10.3f} kN{slide:9.0%}{hottest - 273:8.0f} °C"
    )


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--fmu", type=Path, default=Path("target/wheelrail.fmu"), help="the wheel")
    parser.add_argument("--controller", type=Path, help="another controller, an FMU of FMI 2.0")
    parser.add_argument("--step", type=float, action="append", help="communication step [s]; may be given several times")
    parser.add_argument("--seconds", type=float, default=3.0, help="time that is computed [s]")
    parser.add_argument("--package", type=Path, help="the package of `make ssp`: controllers are put into it, nothing is computed")
    parser.add_argument("--out", type=Path, default=Path("own.ssp"), help="package to write")
    wishes = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        controller = wishes.controller or packed(Path(folder))
        if wishes.package:
            inserted(wishes.package, controller, wishes.out)
            print(f"written: {wishes.out}")
            return 0
        print(f"{'step':>16}{'speed':>16}{'distance':>12}{'force':>13}{'slide':>9}{'hottest':>11}")
        for step in wishes.step or (1e-3, 5e-3, 10e-3, 20e-3, 50e-3):
            print(line(f"{1e3 * step:g} ms", braked(wishes.fmu, controller, step, wishes.seconds)))
        print(line("no protection", braked(wishes.fmu, None, 5e-3, wishes.seconds)))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
