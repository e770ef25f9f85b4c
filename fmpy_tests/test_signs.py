"""Signs of the figure `docs/signs.svg`, all at once: impulses and works from the outputs alone, forward and backward."""

import numpy as np
import pytest

GRAVITY, VEHICLE, STEP, STEPS = 9.81, 9872.0, 1e-3, 300
SEEN = (
    "wheel.velocity", "wheel.omega", "contact.force_x", "contact.moment", "hub.force_x", "hub.moment", "brake.torque_actual",
    "brake.power", "drive.force", "drive.moment", "rail.slope", "contact.force_y", "hub.force_y",
)  # fmt: skip


@pytest.mark.parametrize("travel", [1.0, -1.0], ids=["forward", "backward"])
def test_force_moment_brake_load_and_slope_with_their_rates_change_momentum_and_energy_by_their_impulse_and_work(start, travel):
    """Everything ramps at once while the wheel brakes. A wrong sign or a factor of any of them misses the balance by its own share."""
    parameters = {"preset": "railway", "initial.velocity": 20.0 * travel, "vehicle.mass": VEHICLE, "thermal.enabled": False, "physics.yielding": False}
    wheel = start(parameters, {})
    wheel.set({
        "drive.force_rate": 4e3 * travel, "drive.moment_rate": 3e3 * travel, "brake.torque_rate": 1.5e4, "drive.load_rate": -5e4,
        "drive.load_change_rate": 3e4, "rail.slope_rate": 0.03 * travel,
    })  # fmt: skip
    rows = [wheel.get(*SEEN)]
    for _ in range(STEPS):
        wheel.step(STEP)
        rows.append(wheel.get(*SEEN))
    seen = dict(zip(SEEN, np.array(rows).T))
    mass, inertia = wheel.get("wheel.mass", "wheel.inertia")
    mass += VEHICLE
    whole = lambda values: STEP * (values.sum() - 0.5 * (values[0] + values[-1]))
    weight = mass * GRAVITY * seen["rail.slope"] / np.sqrt(1.0 + seen["rail.slope"] ** 2)
    gained = [size * (seen[name][-1] - seen[name][0]) for size, name in ((mass, "wheel.velocity"), (inertia, "wheel.omega"))]
    impulses = [whole(seen["hub.force_x"] + seen["contact.force_x"] - weight), whole(seen["hub.moment"] + seen["contact.moment"])]
    parts = [whole(seen[name]) for name in ("drive.force", "contact.force_x", "drive.moment", "brake.torque_actual", "contact.moment")]
    missed = [impulse / value - 1.0 for impulse, value in zip(impulses, gained)]
    print(f"figure: signs.momentum = {missed[0]:.2e}, {missed[1]:.2e}")
    print(f"momentum {gained} of {impulses}; parts {np.round(parts, 2)}, weight {whole(weight):.2f}")
    assert impulses == pytest.approx(gained, rel=2e-3) and all(travel * value < 0.0 for value in gained)
    # The brake opposes the rotation, whichever way the wheel turns, and takes power.
    np.testing.assert_allclose(seen["brake.torque_actual"][1:], -travel * 15.0 * np.arange(1, STEPS + 1), rtol=1e-9)
    np.testing.assert_allclose(seen["hub.moment"], seen["drive.moment"] + seen["brake.torque_actual"], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(seen["hub.force_x"], seen["drive.force"], rtol=1e-9, atol=1e-9)
    assert (seen["brake.power"][1:] > 0.0).all() and (travel * seen["contact.force_x"][-1]) < 0.0
    assert seen["hub.force_y"][-1] == pytest.approx(-1e5 + 0.3 * 2e4, rel=1e-9) and seen["contact.force_y"][-1] == pytest.approx(9.4e4, rel=1e-2)
    work, brake, stored, gravity = wheel.get("energy.hub_work", "energy.brake", "energy.stored", "energy.gravity")
    hub = whole(seen["hub.force_x"] * seen["wheel.velocity"] + seen["hub.moment"] * seen["wheel.omega"])
    print(f"work of the hub {hub:.1f} J, {work:.1f} J; gravity {-whole(weight * seen['wheel.velocity']):.1f} J, {gravity:.1f} J; brake {brake:.1f} J")
    assert work == pytest.approx(hub, rel=2e-3, abs=20.0) and gravity == pytest.approx(-whole(weight * seen["wheel.velocity"]), rel=2e-3)
    assert brake == pytest.approx(STEP * seen["brake.power"][1:].sum(), rel=1e-9) and stored < 0.0 < brake


@pytest.mark.parametrize("travel", [1.0, -1.0], ids=["forward", "backward"])
def test_the_hub_is_the_approach_below_the_rail_that_rises_and_the_rail_lifts_the_load(start, travel):
    parameters = {"preset": "railway", "initial.velocity": 20.0 * travel, "thermal.enabled": False, "physics.yielding": False}
    wheel = start(parameters, {})
    begin = wheel.get("hub.height")
    for k in range(1, 201):
        phase = np.pi * k / 200.0
        wheel.set({"rail.elevation": 5e-4 * (1.0 - np.cos(phase)), "rail.elevation_rate": 5e-4 * np.sin(phase) * np.pi / 0.2})
        wheel.step(STEP)
    names = ("hub.height", "rail.elevation", "contact.approach", "energy.rail_work", "drive.load")
    height, elevation, approach, work, load = wheel.get(*names)
    print(f"hub {1e3 * height:.4f} mm, rail {1e3 * elevation:.4f} mm, approach {1e3 * approach:.4f} mm; work {work:.2f} J of {load * (height - begin):.2f} J")
    assert elevation == pytest.approx(1e-3) and height == pytest.approx(elevation - approach, rel=1e-12)
    assert work == pytest.approx(load * (height - begin), rel=2e-2)
