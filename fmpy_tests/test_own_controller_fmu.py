"""A controller that is an FMU in a loop with the wheel's FMU, and in the package of a coach: example 17."""

import os
import shutil
import sys
from pathlib import Path

import pytest
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssv
from fmpy.validation import validate_fmu

from conftest import ROOT
from wheelrail import Fmu, scenario, ssp

sys.path.append(str(ROOT / "examples"))
import ex17_own_controller as example  # noqa: E402

pytestmark = pytest.mark.skipif(sys.platform != "linux" or shutil.which("cc") is None, reason="compiles a library for Linux")


@pytest.fixture(scope="module")
def controller(tmp_path_factory):
    """The controller of the example, packed."""
    return example.packed(tmp_path_factory.mktemp("controller"))


def test_steps_up_to_the_cycle_of_the_controller_brake_alike_and_longer_ones_worse(packed, controller):
    forces, slides = {}, {}
    for step in (2e-3, 10e-3, 50e-3):
        samples = example.braked(packed, controller, step, 1.5)
        forces[step] = -sum(sample["contact.force_x"] for sample in samples) / len(samples)
        slides[step] = max(sample["contact.slide"] for sample in samples)
    print(forces, slides)
    assert forces[10e-3] == pytest.approx(forces[2e-3], rel=0.01)
    assert forces[50e-3] < 0.98 * forces[2e-3] and slides[50e-3] > slides[2e-3] + 0.05
    unprotected = example.braked(packed, None, 5e-3, 1.5)
    assert max(slides.values()) < 0.7 and unprotected[-1]["contact.slide"] == 1.0


@pytest.mark.parametrize("share, stable", [(1.5, True), (2.3, False)])
def test_a_moment_that_answers_the_speed_of_a_sliding_wheel_is_stable_below_twice_the_inertia_over_the_step(start, share, stable):
    wheel = start({"initial.velocity": 20.0, "friction.coefficient": 0.05, "friction.softening": 0.0}, {"control.translation": "velocity"})
    gain, radius = 1000.0, wheel.get("wheel.radius")
    step, before, speeds = share * wheel.get("wheel.inertia") / gain, 0.0, []
    wheel.set({"drive.velocity": 20.0})
    for k in range(60):
        speeds.append(wheel.get("wheel.omega"))
        # A ramp into the slide, then the friction of a wheel at 30 % slide and what brings it there.
        after = -4000.0 * (k + 1) / 3 if k < 3 else -0.05 * 1e5 * radius - gain * (speeds[-1] - 14.0 / radius)
        wheel.set({"drive.moment": before, "drive.moment_rate": (after - before) / step})
        wheel.step(step)
        before = after
    swing = max(speeds[-10:]) - min(speeds[-10:])
    print(f"K h = {share} I: {swing:.3f} rad/s in the last ten steps")
    assert swing < 0.1 if stable else swing > 5.0


def test_fmpy_simulates_the_package_of_a_coach_with_the_controller_on_every_axle(packed, fmu, controller, tmp_path):
    assert validate_fmu(controller) == []
    built = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")) / "release"
    coach, (braking, steps) = tmp_path / "coach.fmu", (scenario.load(ROOT / "examples/train/low_adhesion.json"), 200)
    ssp.pack_coach(built / "coach", built / "libcoach.so", coach)
    with Fmu(coach) as opened:
        package, _ = ssp.write(braking, fmu, opened, (packed, coach), tmp_path, steps * ssp.STEP)
    own = tmp_path / "own.ssp"
    example.inserted(package, controller, own)
    values = read_ssv(own, resource="resources/train.ssv")
    result = simulate_ssp(own, stop_time=steps * ssp.STEP, step_size=ssp.STEP, parameter_set=values)
    for axle in range(1, 5):
        torque = result[f"control{axle}.torque"]
        assert result[f"control{axle}.omega"][-1] == result[f"wheelset{axle}.wheel.omega"][-1]
        # Outputs of a step are inputs of the next one.
        assert -result[f"wheelset{axle}.brake.torque_actual"][-1] == pytest.approx(torque[-2], rel=1e-9) and torque[-1] > 1000.0
