"""Balances of a run at its end: energy, heat, momentum along the rail and angular momentum, with what they mean."""

from dataclasses import dataclass

import numpy as np

from .units import number, shown

HELD, SAMPLED = "held", "sampled"


@dataclass
class Balance:
    """Rows of (text, value) in a unit of SI; the last one is what is missing. `meaning` says how to read it."""

    title: str
    unit: str
    rows: list
    meaning: str


def of_run(run):
    """All balances for which the run has the quantities."""
    return [b for b in (energy(run), heat(run), momentum(run), rotation(run)) if b]


def energy(run):
    """Work against what is stored and dissipated, all counted by the FMU since the start."""
    names = ("hub_work", "stored", "friction", "damping")
    if not run.has(*(f"energy.{name}" for name in names)):
        return None
    end = lambda name: float(run.get(f"energy.{name}")[-1]) if run.has(f"energy.{name}") else 0.0
    brake = end("brake")
    into = [
        ("work of hub forces and moment, without the brake", end("hub_work") + brake),
        ("work of gravity on slopes", end("gravity")),
        ("work of a rail that rises", end("rail_work")),
        ("work of wheel and hot layers that grow with their temperature", end("thermal_work")),
    ]
    out = [
        ("growth of kinetic and elastic energy", end("stored")),
        ("taken by the brake", brake),
        ("friction in the contact", end("friction")),
        ("damping and radiation", end("damping")),
        ("flattening and wear", end("plastic")),
    ]
    missing = sum(v for _, v in into) - sum(v for _, v in out)
    rows = [(f"+ {text}", v) for text, v in into if v] + [(f"− {text}", v) for text, v in out if v] + [("= unaccounted", missing)]
    meaning = "What went in less what is stored or has left. Nothing should be missing."
    if run.has("solver.energy_residual"):
        last = run.get("solver.energy_residual")
        meaning += (
            f" Over the energy dissipated since the start (at least the elastic energy of the loaded contact) it is"
            f" {_percent(last[-1])} at the end, {_percent(np.nanmax(np.abs(last)))} at most: below 1 % is sound, more says that"
            " steps are too long for what happens."
        )
    return Balance("Energy", "J", rows, meaning)


def heat(run):
    """Heat of friction against what went into wheel and rail, and what the wheel passed on."""
    if not run.has("heat.friction_power", "heat.to_wheel", "heat.to_rail"):
        return None
    into = lambda name: _integral(run, name, HELD)[0] if run.has(name) else 0.0
    made = float(run.get("energy.friction")[-1]) if run.has("energy.friction") else into("heat.friction_power")
    wheel, rail = into("heat.to_wheel"), into("heat.to_rail")
    rows = [
        ("+ heat of friction", made), ("− into the wheel", wheel), ("− into the rail", rail),
        ("= not put into wheel and rail", made - wheel - rail),
    ]  # fmt: skip
    meaning = (
        "Powers are means over the steps, summed up over the samples: exact where every step was recorded. What is left is zero"
        " if thermal.heat_ratio is 1."
    )
    ways = (
        ("by conduction from the wheel", "heat.conduction"),
        ("from the wheel to the hub", "heat.to_hub"),
        ("to the air", "heat.to_air"),
    )
    passed = [(text, into(name)) for text, name in ways if run.has(name)]
    rows[3:3] = [(f"   {text}", v) for text, v in passed if v]
    if run.has("solver.heat_residual"):
        meaning += (
            f" The FMU's own audit of both temperature fields misses {_percent(run.get('solver.heat_residual')[-1])} of all heat"
            " that has flowed: round-off."
        )
    return Balance("Heat", "J", rows, meaning)


def momentum(run):
    """Impulse of contact and hub along the rail against the change of momentum, where the masses are known."""
    if not run.has("wheel.velocity", "contact.force_x", "hub.force_x", "wheel.mass"):
        return None
    if run.has("energy.gravity") and np.any(run.get("energy.gravity")):
        return None  # The weight on a slope acts besides and is not recorded.
    vehicle = run.about.get("vehicle_mass", (run.about.get("parameters") or {}).get("vehicle.mass"))
    change = float(run.get("wheel.velocity")[-1] - run.get("wheel.velocity")[0])
    wheel = float(run.get("wheel.mass")[0])
    found = _motion(
        run, "Momentum along the rail", "N.s", ("contact.force_x", "hub.force_x"), ("force", "force"), (wheel + float(vehicle or 0.0)) * change,
        "(wheel.mass + vehicle.mass) × change of speed", "Impulses are integrals of the samples by the trapezoidal rule.",
    )  # fmt: skip
    if vehicle is None:
        if abs(change) < 0.1:
            return None
        impulse = sum(value for _, value in found.rows[:2])
        found.rows[2:] = [("= change of momentum", impulse)]
        found.meaning = (
            f"The impulse over the change of speed is {impulse / change:.6g} kg, the mass that moves: wheel"
            f" ({wheel:.5g} kg) and its share of the vehicle (vehicle.mass), which this record does not name."
        )
    return found


def rotation(run):
    """Impulse of the moments of contact and hub against the change of angular momentum."""
    if not run.has("wheel.omega", "contact.moment", "hub.moment", "wheel.inertia"):
        return None
    turned = float(run.get("wheel.inertia")[0] * (run.get("wheel.omega")[-1] - run.get("wheel.omega")[0]))
    return _motion(
        run, "Angular momentum of the wheel", "N.m.s", ("contact.moment", "hub.moment"), ("moment", "moment, the brake's included"), turned,
        "wheel.inertia × change of angular velocity",
        "The rim that turns against the hub by its elasticity counts with the hub's velocity.",
    )  # fmt: skip


def _motion(run, title, unit, names, words, moved, change, meaning):
    """Impulses of contact and hub against what a motion has gained."""
    (contact, _), (hub, blur) = _integral(run, names[0], SAMPLED), _integral(run, names[1], HELD)
    missing = contact + hub - moved
    rows = [(f"+ impulse of the {of} {what}", value) for of, what, value in zip(("contact", "hub"), words, (contact, hub))]
    share = _percent(abs(missing) / max(1e-9, abs(contact), abs(hub)))
    if blur:
        meaning += f" Between samples the hub's value counts as held, which leaves ±{shown(unit, [blur]).text(blur)} open."
    return Balance(title, unit, [*rows, (f"− {change}", moved), ("= missing", missing)], f"Missing is {share} of the larger impulse. {meaning}")


def _integral(run, name, kind):
    """Integral over the run, and how far the other rule is from it: a held value counts back to the sample before."""
    values, steps = run.get(name), np.diff(run.time)
    sampled = float(np.sum(0.5 * steps * (values[1:] + values[:-1])))
    held = float(np.sum(steps * values[1:]))
    return (held if kind == HELD else sampled), abs(held - sampled)


def _percent(value):
    return f"{number(100.0 * float(value), 2)} %"
