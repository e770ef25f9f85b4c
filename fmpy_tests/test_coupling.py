"""Masters that own inertia: the iterative one converges to the monolithic run, explicit ones have a stability limit."""

import numpy as np
import pytest

import ex02_masters
from ex02_masters import SPEED, Split, coupled, errors, monolithic, slip_growth

DURATION = 0.4  # s of the braking
STEPS = (2e-3, 1e-3, 5e-4)  # s


@pytest.fixture(scope="module")
def reference(fmu):
    """The FMU that owns everything, with a small step."""
    table = monolithic(fmu, 1.25e-4, DURATION)
    assert table[-1, 0] < SPEED - 0.05 and table[-1, 1] < -5e3
    return table


@pytest.mark.parametrize("owns", ["vehicle", "wheel"])
def test_iterative_master_converges_to_the_monolithic_run(fmu, reference, owns):
    coarse, middle, fine = (errors(coupled(fmu, owns, "iterative", h, DURATION), reference)[0] for h in STEPS)
    assert fine < middle < coarse < 2e-5
    assert np.log2(coarse / fine) / 2.0 > 1.2, f"errors {coarse:.2e}, {middle:.2e}, {fine:.2e} m/s"


def test_iterative_master_of_the_vehicle_repeats_the_monolithic_run(fmu):
    """With the same formula and step on both sides the split leaves no error but the tolerance of the iteration."""
    split, whole = coupled(fmu, "vehicle", "iterative", 1e-3, DURATION), monolithic(fmu, 1e-3, DURATION)
    assert errors(split, whole)[0] < 1e-7


@pytest.mark.parametrize("master", ["Jacobi", "Gauss-Seidel"])
def test_explicit_master_of_the_vehicle_converges_with_order_one(fmu, reference, master):
    coarse, fine = (errors(coupled(fmu, "vehicle", master, h, DURATION), reference)[0] for h in STEPS[:2])
    assert np.log2(coarse / fine) == pytest.approx(1.0, abs=0.2)


@pytest.mark.parametrize("speed", [10.0, 2.0])
@pytest.mark.parametrize(("master", "stable", "unstable"), [("Gauss-Seidel", 0.3, 1.5), ("Jacobi", 0.1, 0.75)])
def test_explicit_master_of_the_wheel_is_stable_only_below_carters_limit(
    fmu, monkeypatch, speed, master, stable, unstable
):
    """Steps in units of 2 m/c on Carter's slope: the limit falls with the speed, and is 1/3 as large for Jacobi.

    The rail base is fixed here: the damper of the restrained rail lies in series with the creep, and at 2 m/s it is the
    softer one of both.
    """
    rolling = ex02_masters.free_rolling
    rigid = {"rail.restraint_stiffness": 0.0, "rail.restraint_damping": 0.0}
    monkeypatch.setattr(ex02_masters, "free_rolling", lambda *arguments: rolling(*arguments) | rigid)
    split = Split(fmu, "wheel", speed)
    limit = split.rolling.carter_limit(speed)
    split.close()
    assert slip_growth(fmu, master, speed, stable * limit) < 0.99
    assert slip_growth(fmu, master, speed, unstable * limit) > 1.05


def test_iterative_master_of_the_wheel_is_stable_far_beyond_carters_limit(fmu):
    split = Split(fmu, "wheel", 2.0)
    limit = split.rolling.carter_limit(2.0)
    split.close()
    assert slip_growth(fmu, "iterative", 2.0, 20.0 * limit) < 0.99


@pytest.mark.parametrize("speed", [10.0, 2.0])
@pytest.mark.parametrize("master", ["Jacobi", "Gauss-Seidel"])
def test_explicit_masters_are_stable_with_the_step_that_the_fmu_suggests(fmu, master, speed):
    split = Split(fmu, "wheel", speed)
    suggested = split.wheel.get("solver.suggested_step")
    split.close()
    assert 1e-6 < suggested < 1e-4
    assert slip_growth(fmu, master, speed, suggested) < 0.99


def test_a_change_of_load_counts_beside_the_load(start):
    whole = start({"initial.velocity": 20.0}, {"drive.load": 1.05e5})
    parts = start({"initial.velocity": 20.0}, {"drive.load": 9.5e4, "drive.load_change": 1e4})
    names = ("contact.force_y", "contact.force_x", "wheel.omega", "hub.force_y")
    assert parts.get(*names) == pytest.approx(whole.get(*names), rel=1e-12, abs=1e-9)
    for _ in range(20):
        whole.set({"drive.load": 1.1e5, "brake.torque": 3000.0})
        parts.set({"drive.load_change": 1.5e4, "brake.torque": 3000.0})
        whole.step(1e-3)
        parts.step(1e-3)
    assert parts.get(*names) == pytest.approx(whole.get(*names), rel=1e-9)
    # A load that was never set takes over what presses when it is switched to, less the change of load.
    unset = start({"initial.velocity": 20.0}, {"drive.load_change": 1e4, "control.vertical": "displacement"})
    unset.step(1e-3)
    pressed = -unset.get("hub.force_y")
    unset.set({"control.vertical": "force"})
    assert unset.get("drive.load") == pytest.approx(pressed - 1e4, rel=1e-12) and pressed > 1.05e5
