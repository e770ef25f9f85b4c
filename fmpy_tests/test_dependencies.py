"""The dependencies that the description declares are true: what is not declared has no effect, by perturbation."""

import pytest

DEFAULT = {"control.rotation": "moment", "control.translation": "force", "control.vertical": "force", "control.lateral": "force"}
SWITCHED = {
    "control.rotation": "velocity", "control.translation": "velocity", "control.vertical": "displacement", "control.lateral": "velocity",
}  # fmt: skip
V = 20.0  # m/s
# A contact in which all of them act.
START = {"preset": "railway_ellipse", "contact.lateral": True, "contact.lines": 3, "initial.velocity": V}
# A value of every real input, and another one.
VALUES = {
    "drive.omega": (V / 0.46, 0.9995 * V / 0.46),
    "drive.moment": (0.0, -3000.0),
    "drive.velocity": (V, 1.0005 * V),
    "drive.force": (0.0, 2000.0),
    "drive.load": (1e5, 1.1e5),
    "drive.load_change": (0.0, 5e3),
    "drive.displacement": (-1.78e-4, -1.80e-4),
    "drive.lateral_velocity": (0.0, 0.01),
    "drive.lateral_force": (0.0, 1e3),
    "drive.spin": (0.0, 0.05),
    "drive.contact_angle": (0.0, 0.02),
    "drive.tread_heat": (0.0, 1e3),
    "rail.friction": (0.3, 0.05),
    "rail.temperature": (293.0, 303.0),
    "rail.slope": (0.0, 0.01),
    "rail.elevation": (0.0, 1e-6),
    "rail.elevation_rate": (0.0, 1e-3),
    "brake.torque": (0.0, 500.0),
    "drive.moment_rate": (0.0, -3e6),
    "drive.force_rate": (0.0, 2e6),
    "drive.lateral_force_rate": (0.0, 1e6),
    "drive.spin_rate": (0.0, 50.0),
    "drive.contact_angle_rate": (0.0, 20.0),
    "drive.load_rate": (0.0, 1e7),
    "drive.load_change_rate": (0.0, 5e6),
    "drive.tread_heat_rate": (0.0, 1e6),
    "rail.friction_rate": (0.0, -200.0),
    "rail.temperature_rate": (0.0, 1e4),
    "rail.slope_rate": (0.0, 10.0),
    "brake.torque_rate": (0.0, 5e5),
}
# Those of a host that knows the wheelset.
POSE = {
    "wheelset.lateral": (0.0, 1e-4),
    "wheelset.yaw": (0.0, 1e-3),
    "wheelset.roll": (0.0, 1e-2),
    "wheelset.lateral_rate": (0.0, 0.01),
    "wheelset.yaw_rate": (0.0, 0.01),
    "wheelset.roll_rate": (0.0, 0.01),
}
# Inputs that act where forces are prescribed, besides their rates.
FORCES = ["drive.moment", "drive.force", "drive.load", "drive.load_change", "drive.lateral_force", "brake.torque"]
# Inputs that act whatever is prescribed.
ALWAYS = {"rail.friction", "rail.temperature", "rail.slope", "rail.elevation", "drive.tread_heat"}
ALWAYS |= {f"{name}_rate" for name in ALWAYS - {"rail.elevation"}} | {"drive.spin", "drive.contact_angle", "drive.spin_rate", "drive.contact_angle_rate"}
# Parameters that need no new basis.
PARAMETERS = {"initial.velocity": 15.0, "initial.creepage": 2e-4, "vehicle.mass": 5e3, "thermal.wheel_excess": 5.0}


@pytest.fixture(scope="module")
def unknowns(fmu):
    """Declared knowns of every output: at communication points and in Initialization Mode; None stands for all."""

    def declared(entries):
        return {
            entry.variable.name: None if entry.dependencies is None else {known.name for known in entry.dependencies}
            for entry in entries
        }

    return declared(fmu.description.outputs), declared(fmu.description.initialUnknowns)


def values(wheel):
    """All outputs, by name."""
    found = {}
    for kind in ("Real", "Integer", "Boolean"):
        of_kind = [v for v in wheel.fmu.description.modelVariables if v.causality == "output" and v.type == kind]
        names = [variable.name for variable in of_kind]
        got = wheel.get(*names)
        found |= dict(zip(names, got if len(names) > 1 else [got]))
    return found


def changed(before, after):
    return {name for name in before if before[name] != after[name]}


def undeclared(known, names, declared):
    """Outputs that a known has changed although they do not declare it."""
    return {name for name in names if declared[name] is not None and known not in declared[name]}


def those_that_act(wheel, perturbations, declared):
    """Inputs that change outputs of the next step; at once they change only those that declare them."""
    here = wheel.save()
    before = values(wheel)
    wheel.step(1e-3)
    unperturbed = values(wheel)
    acted = set()
    for perturbation in perturbations:
        (name,) = perturbation
        wheel.restore(here)
        wheel.set(perturbation)
        assert not undeclared(name, changed(before, values(wheel)), declared), name
        wheel.step(1e-3)
        if changed(unperturbed, values(wheel)):
            acted.add(name)
    wheel.forget(here)
    return acted


def test_every_input_and_output_is_covered(fmu, unknowns):
    inputs = {v.name for v in fmu.description.modelVariables if v.causality == "input"}
    outputs = {v.name for v in fmu.description.modelVariables if v.causality == "output"}
    assert inputs == set(VALUES) | set(POSE) | set(DEFAULT)
    assert outputs == set(unknowns[0]) == set(unknowns[1])


@pytest.mark.parametrize("control", [DEFAULT, SWITCHED], ids=["forces", "motion"])
def test_between_steps_inputs_change_only_what_is_declared_and_act_in_the_next_step(start, unknowns, control):
    inputs = control | {name: pair[0] for name, pair in VALUES.items()}
    perturbations = [{name: pair[1]} for name, pair in VALUES.items()]
    perturbations += [{name: (SWITCHED if control is DEFAULT else DEFAULT)[name]} for name in control]
    wheel = start(START, inputs)
    for _ in range(5):
        wheel.step(1e-3)
    acted = those_that_act(wheel, perturbations, unknowns[0])
    prescribed = {
        "forces": {*FORCES, *(f"{name}_rate" for name in FORCES)},
        "motion": {"drive.omega", "drive.velocity", "drive.displacement", "drive.lateral_velocity"},
    }["forces" if control is DEFAULT else "motion"]
    assert acted >= prescribed | set(DEFAULT) | ALWAYS
    partners = set(VALUES) - prescribed - ALWAYS
    assert not acted & partners, "the partner that is not prescribed has no effect"


def test_the_pose_of_a_wheelset_changes_only_what_is_declared_and_acts_in_the_next_step(start, unknowns):
    wheel = start(START | {"wheelset.side": "right"}, SWITCHED | {"drive.omega": V / 0.46, "drive.velocity": V} | {name: pair[0] for name, pair in POSE.items()})
    for _ in range(5):
        wheel.step(1e-3)
    acted = those_that_act(wheel, [{name: pair[1]} for name, pair in POSE.items()], unknowns[0])
    # An ellipse is the same wherever the wheelset stands.
    assert acted == set(POSE) - {"wheelset.lateral"}


@pytest.mark.parametrize("control", [DEFAULT, SWITCHED], ids=["forces", "motion"])
def test_initial_outputs_change_only_with_declared_knowns(start, unknowns, control):
    inputs = control | {name: pair[0] for name, pair in VALUES.items()}
    before = values(start(START, inputs))
    moved = set()
    for name, (_, other) in VALUES.items():
        names = changed(before, values(start(START, inputs | {name: other})))
        assert not undeclared(name, names, unknowns[1]), name
        moved |= names
    for name, other in PARAMETERS.items():
        names = changed(before, values(start(START | {name: other}, inputs)))
        assert not undeclared(name, names, unknowns[1]), name
        moved |= names
    assert {"contact.force_x", "contact.force_y", "wheel.velocity", "hub.moment", "temperature.wheel_bulk"} <= moved
