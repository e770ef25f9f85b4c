"""A locked wheel, in small: what examples/ex05_locked_wheels.py reads off its runs, and that a short slide keeps its limits."""

import argparse
import math

import ex05_locked_wheels as example
import pytest
from ex05_locked_wheels import crossing, figures, galton, sign_changes, unaccounted

COLUMNS = (
    "contact.force_x", "contact.force_y", "contact.pressure_max", "temperature.wheel_max", "temperature.rail_max",
    "energy.friction", "energy.plastic", "energy.damping", "energy.stored", "energy.hub_work", "energy.thermal_work",
)  # fmt: skip
# A run that keeps every limit.
KEPT = {
    "preset": "railway", "by": "speed", "speed": 40.0, "step": 1e-3, "elements": 10, "p max": 1e9, "p mean": 1e9, "T max": 1200.0,
    "force": 6e3, "mu": 0.06, "signs": 0.0, "energy": 1e-4, "Ac1": 0.009, "halved": 0.0, "end": 2.0, "error": "", "liquidus": 1530.0,
    "wall": 1.0,
}  # fmt: skip


def test_figures_are_read_off_as_their_names_say():
    held = [1e5] * 5
    assert sign_changes([0, 1, 2, 3, 4], 0.0, held, 2e-3) == 0.0
    assert sign_changes([0, 1, 0, 1, 0], 0.0, held, 2e-3) == 1.0
    # Changes have no sign that solver.tolerance of the rise, or of 100 K, lets pass, nor while the load jumps.
    assert sign_changes([0, 0.15, 0, 0.15, 0], 0.0, held, 2e-3) == 0.0
    assert sign_changes([1000, 1001, 1000, 1001, 1000], 300.0, held, 2e-3) == 0.0
    assert sign_changes([0, 1, 0, 1, 0], 0.0, [1e5, 2e5, 1e5, 2e5, 1e5], 2e-3) == 0.0
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
    found = figures(table, wheel.get("thermal.austenitisation"), wheel.get("solver.tolerance"))
    assert all(math.isfinite(value) for value in found.values())
    assert 1e-3 < found["Ac1"] < 0.03
    # The floor of the softening, and what a cold rail gives.
    assert 0.03 < found["mu"] < 0.15
    assert abs(found["energy"]) < 0.01
    # Where friction brakes, what has flowed is what was dissipated, or little more.
    audit = wheel.get("solver.energy_residual")
    print(f"missing over what has flowed {found['energy']:.2e}, over what was dissipated {audit:.2e}")
    assert found["energy"] == pytest.approx(audit, rel=0.5, abs=1e-6)
    assert found["p max"] < 2.97 * 550e6


def test_energy_is_related_to_what_has_flowed_also_where_nothing_is_dissipated():
    table = {f"energy.{name}": [0.0, 0.0] for name in ("friction", "plastic", "damping", "thermal_work")}
    table |= {"energy.stored": [0.0, -2e3], "energy.hub_work": [0.0, -1.99e3]}
    assert unaccounted(table) == pytest.approx(10.0 / 2e3)
    assert unaccounted(table | {"energy.friction": [0.0, 4e3], "energy.hub_work": [0.0, 2.02e3]}) == pytest.approx(20.0 / 4e3)


@pytest.mark.parametrize(
    ("change", "limit"),
    [
        ({"p max": 1.64e9}, "peak pressure"),
        ({"T max": 1590.0}, "temperature above 1580"),
        ({"signs": 0.11}, "sign changes"),
        ({"energy": -0.011}, "energy audit"),
        ({"error": "fmi2DoStep: discarded"}, "a discarded step"),
        ({"speed": 60.0, "Ac1": None}, "Ac1 not within"),
    ],
)
def test_a_study_that_prints_a_broken_limit_ends_with_one(change, limit, packed, tmp_path, monkeypatch, capsys):
    results = []

    class Fixed:
        """In the place of wheels: their runs are known."""

        def __init__(self, fmu, options, preset):
            pass

        def slide(self, speed, step, elements, by):
            return results[-1]

    monkeypatch.setattr(example, "Preset", Fixed)
    options = argparse.Namespace(
        fmu=packed, presets=["railway"], meshes=[10], speeds=[40.0], steps=[1e-3], by=["speed"], jobs=1, keep=tmp_path, out=tmp_path,
        name="locked", stop=2.0,
    )  # fmt: skip
    for row, code in ((KEPT, 0), (KEPT | change, 1)):
        results.append(row)
        assert example.study(options) == code
        printed = capsys.readouterr().out
        assert f"{code} broken limits in 1 runs" in printed and (limit in printed) == bool(code)
