"""One braking scenario gives the same numbers in every master: the FMU does not care who steps it.

The brake moment is constant over each communication step, so that masters that interpolate inputs and masters that hold
them set the same values. It starts from zero, because some masters set inputs in Initialization Mode and others do not.
"""

import ctypes
from types import SimpleNamespace

import fmpy
import numpy as np
import pytest

import wheelrail
from wheelrail import Wheel

STEP = 1e-3  # s
STEPS = 500
MOMENTS = [-8000.0 * min(1.0, k / 200) for k in range(STEPS)]  # N m, during step k
START = {"initial.velocity": 20.0}
OUTPUTS = (
    "wheel.velocity", "wheel.omega", "wheel.distance", "contact.force_x", "contact.force_y", "contact.creepage",
    "contact.half_width", "heat.friction_power", "temperature.wheel_max", "hub.moment",
)  # fmt: skip
TOLERANCE = 1e-9  # relative; times of masters differ by rounding


def in_steps(fmu, start, moments):
    """fmpy's FMU2Slave, step by step: the outputs after each step."""
    with Wheel(fmu, start) as wheel:
        rows = []
        for moment in moments:
            wheel.set({"drive.moment": moment})
            wheel.step(STEP)
            rows.append(wheel.get(*OUTPUTS))
    return np.array(rows)


def in_fmpy(fmu, start, moments):
    """fmpy's own loop, which interpolates the input between its samples and sets it before each step."""
    times = STEP * np.arange(len(moments))
    signal = np.array(list(zip(times, moments)), dtype=[("time", float), ("drive.moment", float)])
    result = fmpy.simulate_fmu(
        fmu.directory, stop_time=STEP * len(moments), output_interval=STEP, start_values=start, input=signal,
        output=OUTPUTS,
    )  # fmt: skip
    return np.array([result[name] for name in OUTPUTS]).T[1:]


def in_libcosim(fmu, start, moments):
    """DNV's libcosim: integer nanoseconds, its own FMI library, fixed-step algorithm."""
    pytest.importorskip("libcosimpy", reason="libcosimpy has no wheel for this platform")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    execution = CosimExecution.from_step_size(round(STEP * 1e9))
    slave = CosimLocalSlave(str(fmu.path), "wheel")
    index = execution.add_local_slave(slave)
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    assert index >= 0 and execution.add_observer(observer) and execution.add_manipulator(manipulator)
    for name, value in start.items():
        initial = execution.string_initial_value if isinstance(value, str) else execution.real_initial_value
        assert initial(index, fmu.reference(name), value)
    references = [fmu.reference(name) for name in OUTPUTS]
    rows = []
    for moment in moments:
        assert manipulator.slave_real_values(index, [fmu.reference("drive.moment")], [moment])
        assert execution.step()
        rows.append(observer.last_real_values(index, references))
    return np.array(rows)


def in_ecos(fmu, start, moments):
    """Ecos: accumulated times, parameter sets, its own FMI library."""
    pytest.importorskip("ecospy.lib", exc_type=ImportError, reason="ecospy has no wheel for this platform")
    from ecospy import EcosSimulation, EcosSimulationStructure

    with EcosSimulationStructure() as structure:
        structure.add_model("wheel", str(fmu.path))
        structure.add_parameter_set("start", {f"wheel::{name}": value for name, value in start.items()})
        with EcosSimulation(structure=structure, step_size=STEP) as simulation:
            assert simulation.init(parameter_set="start")
            rows = []
            for moment in moments:
                simulation.set_real("wheel::drive.moment", moment)
                simulation.step()
                rows.append([simulation.get_real(f"wheel::{name}") for name in OUTPUTS])
            simulation.terminate()
    return np.array(rows)


def in_wheelrail(fmu, start, moments):
    """The project's own master: inputs as a scenario with a jump at every step."""
    times = [k * STEP for k in range(len(moments) + 1)]
    course = np.repeat(times, 2)[1:-1], np.repeat(moments, 2)
    run = wheelrail.simulate(start, {"drive.moment": course}, stop=times[-1], step=STEP, outputs=OUTPUTS, fmu=fmu.path, progress=False)
    return wheelrail.table(run)[list(OUTPUTS)].to_numpy()[1:]


def need_tbb():
    """Ecos links to the system's TBB, which its wheel does not contain."""
    try:
        ctypes.CDLL("libtbb.so.12")
    except OSError:
        pytest.skip("ecospy needs libtbb.so.12 (Debian: apt-get install libtbb12)")


@pytest.fixture(scope="module")
def unit(fmu, packed):
    """The FMU as masters want it: packed, extracted, described."""
    references = {name: variable.valueReference for name, variable in fmu.variables.items()}
    parts = {"directory": fmu.directory, "description": fmu.description, "variables": fmu.variables, "places": fmu.places}
    return SimpleNamespace(path=packed, reference=references.__getitem__, variable=fmu.variable, settings=fmu.settings, **parts)


@pytest.fixture(scope="module")
def braking(unit):
    """The scenario in FMU2Slave; it must contain something to compare."""
    rows = in_steps(unit, START, MOMENTS)
    final = dict(zip(OUTPUTS, rows[-1]))
    assert final["wheel.velocity"] < 19.5 and final["contact.force_x"] < -1e4 and final["temperature.wheel_max"] > 294.0
    return rows


def assert_same(rows, expected):
    assert rows.shape == expected.shape
    for name, values, reference in zip(OUTPUTS, rows.T, expected.T):
        worst = np.max(np.abs(values - reference)) / np.max(np.abs(reference))
        assert worst <= TOLERANCE, f"{name} differs by {worst:.1e}"


@pytest.mark.parametrize("master", [in_fmpy, in_libcosim, in_ecos, in_wheelrail])
def test_every_master_computes_the_same_braking(unit, braking, master):
    if master is in_ecos:
        need_tbb()
    assert_same(master(unit, START, MOMENTS), braking)


@pytest.mark.parametrize("master", [in_fmpy, in_libcosim, in_ecos, in_wheelrail])
def test_every_master_reaches_the_presets(unit, master):
    """Presets are files in the resources, which not every master points to in the same way."""
    if master is in_ecos:
        need_tbb()
    start = {"preset": "paper_d", "initial.velocity": 10.0}
    moments = [-500.0 * k for k in range(20)]
    expected = in_steps(unit, start, moments)
    assert expected[-1, OUTPUTS.index("wheel.omega")] == pytest.approx(10.0 / 0.5, rel=1e-2)
    assert_same(master(unit, start, moments), expected)
