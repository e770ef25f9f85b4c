"""A locked wheel, in small: what examples/ex05_locked_wheels.py reads off its runs, and that a short slide keeps its limits."""

import math

import pytest

from ex05_locked_wheels import crossing, figures, galton, sign_changes

COLUMNS = (
    "contact.force_x", "contact.force_y", "contact.pressure_max", "temperature.wheel_max", "temperature.rail_max",
    "solver.energy_residual",
)  # fmt: skip


def test_figures_are_read_off_as_their_names_say():
    assert sign_changes([0, 1, 2, 3, 4]) == 0.0
    assert sign_changes([0, 1, 0, 1, 0]) == 1.0
    # Changes below a tenth of a kelvin have no sign.
    assert sign_changes([0, 0.05, 0, 0.05, 0]) == 0.0
    assert crossing([0.0, 1.0, 2.0], [0.0, 10.0, 30.0], 20.0) == pytest.approx(1.5)
    assert crossing([0.0, 1.0], [0.0, 10.0], 20.0) is None
    assert galton(41 * 1.609344) == pytest.approx(0.057) and galton(160.0) is None


def test_a_locked_wheel_slides_with_softened_friction_and_is_austenitic_within_30_ms(start):
    speed = 60.0 / 3.6
    wheel = start(
        {"initial.velocity": speed},
        {"control.rotation": "velocity", "control.translation": "velocity", "drive.velocity": speed},
    )
    omega, table = wheel.get("wheel.omega"), {"time": [], "solver.internal_steps": []}
    table |= {name: [] for name in COLUMNS}
    while wheel.time < 0.1:
        wheel.set({"drive.omega": omega * max(0.0, 1.0 - (wheel.time + 1e-3) / 0.02)})
        wheel.step(1e-3)
        table["time"].append(wheel.time)
        table["solver.internal_steps"].append(1)
        for name, value in zip(COLUMNS, wheel.get(*COLUMNS)):
            table[name].append(value)
    found = figures(table, wheel.get("thermal.austenitisation"))
    assert all(math.isfinite(value) for value in found.values())
    assert 1e-3 < found["Ac1"] < 0.03
    # The floor of the softening, and what a cold rail gives.
    assert 0.03 < found["mu"] < 0.15
    assert abs(found["energy"]) < 0.01
    assert found["p max"] < 2.97 * 550e6
