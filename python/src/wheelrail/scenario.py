"""What a stop consists of, as files: scenario, vehicle, brake, track. `load` reads and checks all of them."""

import difflib
from bisect import bisect_right
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from .files import BadFile, Flag, Named, Real, Several, Text, read_csv, read_json
from .rail_map import RailLaw, RailMap

VEHICLE = {
    "name": Text("what it is"),
    "body": {
        "mass": Real(100, 1e6, "kg", "car body, empty"),
        "payload": Real(0, 1e6, "kg", "load, spread like the body", 0.0),
        "pitch_inertia": Real(10, 1e9, "kg m2", "of the empty body about its centre of gravity"),
        "height": Real(0.1, 10, "m", "centre of gravity above the rail"),
    },
    "bogie": {
        "mass": Real(10, 1e5, "kg", "frame of one bogie"),
        "pitch_inertia": Real(1, 1e6, "kg m2", "about its centre of gravity"),
        "height": Real(0.1, 5, "m", "centre of gravity above the rail"),
    },
    "wheelset": {
        "mass": Real(50, 2e4, "kg", "one wheelset"),
        "inertia": Real(1, 1e4, "kg m2", "about its axle"),
        "radius": Real(0.1, 2, "m", "of the wheels"),
    },
    "bogie_half_distance": Real(0.5, 50, "m", "between bogie centre and middle of the body"),
    "axle_half_distance": Real(0.1, 5, "m", "between axle and bogie centre"),
    "primary": {
        "longitudinal_stiffness": Real(1e4, 1e10, "N/m", "of one wheelset, both boxes"),
        "longitudinal_damping": Real(0, 1e8, "N s/m", "of one wheelset, both boxes"),
        "vertical_stiffness": Real(1e4, 1e10, "N/m", "of one wheelset, both boxes"),
        "vertical_damping": Real(0, 1e8, "N s/m", "of one wheelset, both boxes"),
    },
    "secondary": {
        "longitudinal_stiffness": Real(0, 1e9, "N/m", "of one bogie, both sides"),
        "longitudinal_damping": Real(0, 1e8, "N s/m", "of one bogie, both sides"),
        "vertical_stiffness": Real(1e3, 1e9, "N/m", "of one bogie, both sides"),
        "vertical_damping": Real(0, 1e8, "N s/m", "of one bogie, both sides"),
        "height": Real(0, 5, "m", "of its shear above the rail"),
    },
    "traction_rod": {
        "stiffness": Real(1e3, 1e10, "N/m", "between one bogie and the body"),
        "damping": Real(0, 1e8, "N s/m", "of its bushes"),
        "height": Real(0, 5, "m", "above the rail"),
    },
    "length": Real(1, 100, "m", "over couplers", 26.0),
    "coupler": {
        "stiffness": Real(1e3, 1e10, "N/m", "of the draft gears between two bodies", 10e6),
        "damping": Real(0, 1e8, "N s/m", "of the draft gears between two bodies", 250e3),
        "height": Real(0, 5, "m", "above the rail", 1.05),
    },
    "resistance": {
        "constant": Real(0, 0.1, "1", "running resistance over weight", 0.0),
        "quadratic": Real(0, 0.01, "s2/m2", "running resistance over weight and speed squared", 0.0),
    },
}

BRAKE = {
    "name": Text("what it is"),
    "torque": Real(0, 1e6, "N m", "of one axle at full pressure"),
    "pressure": Real(1e4, 2e6, "Pa", "full cylinder pressure over ambient"),
    "delay": Real(0, 60, "s", "between demand and first pressure", 0.0),
    "fill_time": Real(0.01, 120, "s", "in which 95 % of the full pressure builds up"),
    "release_time": Real(0.01, 240, "s", "in which it falls to 5 %"),
    "cylinder_volume": Real(0, 1, "m3", "cylinders and pipes of one axle", 0.0),
    "wsp": {
        "active": Flag("whether wheels are protected", True),
        "period": Real(1e-3, 1, "s", "between decisions", 0.02),
        "slide_low": Real(0, 1, "1", "slide from which an axle is held", 0.05),
        "slide_high": Real(0, 1, "1", "slide from which an axle is vented", 0.15),
        "least_slide": Real(0, 5, "m/s", "no slide below this counts", 0.3),
        "deceleration": Real(0, 100, "m/s2", "of a sliding axle, from which it is vented", 3.0),
        "recovery": Real(0, 100, "m/s2", "acceleration of an axle that comes back", 1.0),
        "reference_deceleration": Real(0.01, 10, "m/s2", "largest fall of the reference speed", 1.5),
        "sounding": Real(0.1, 1e6, "s", "after which an axle is released to find the train's speed", 2.0),
        "longest_sounding": Real(0.1, 60, "s", "that it is released", 2.0),
        "off_speed": Real(0, 20, "m/s", "below which nothing is controlled", 1.0),
        "vent_time": Real(0.01, 10, "s", "time constant of venting", 0.25),
        "fill_time": Real(0.01, 10, "s", "time constant of filling through the valve", 0.3),
    },
    "sander": {
        "active": Flag("whether sand is laid while an axle is vented", False),
        "axles": Several(Real(1, 4, "", "axle from the front", whole=True), "axles behind a sander", (1,)),
        "rate": Real(0, 1, "kg/s", "on each rail", 0.008),
        "off_speed": Real(0, 100, "m/s", "below which none is laid", 2.0),
    },
}

CONDITION = {
    "friction": Real(1e-3, 1, "1", "before any wheel"),
    "recovered": Real(1e-3, 1, "1", "after cleaning"),
}

TRACK = {
    "name": Text("what it is"),
    "sections": Text("CSV file with position, condition, slope, temperature"),
    "profile": Text("CSV file with position, elevation: height profile of the rail for irregularities; none if empty", ""),
    "length": Real(10, 1e6, "m", "of the map ahead of the first axle"),
    "cell": Real(0.01, 100, "m", "of the map", 0.25),
    "conditions": Named(CONDITION, "conditions by name"),
    "cleaning_energy": Real(1e-3, 1e12, "J/m", "friction energy per metre of one rail that cleans it to 1/e"),
    "sand": {
        "friction": Real(1e-3, 1, "1", "with plenty of sand", 0.2),
        "mass": Real(1e-9, 100, "kg/m", "sand that gains 63 %", 0.0005),
    },
    "contact_width": Real(1e-4, 0.2, "m", "on which a wheel leaves its heat", 0.014),
    "effusivity": Real(10, 1e6, "J/(m2 K sqrt(s))", "of the rail", 13580.0),
}

SECTIONS = {
    "position": Real(-1e6, 1e6, "m", "where the section begins"),
    "condition": Text("a name of the track's conditions"),
    "slope": Real(-0.2, 0.2, "1", "rising positive", 0.0),
    "temperature": Real(-100, 500, "K", "of the rail over the reference", 0.0),
}

PROFILE = {
    "position": Real(-1e6, 1e6, "m", "along the track"),
    "elevation": Real(-0.1, 0.1, "m", "of the rail, linear between positions and level beyond"),
}

SCENARIO = {
    "name": Text("what it shows"),
    "vehicle": Text("file"),
    "coaches": Real(1, 20, "", "coupled to a set", 1, whole=True),
    "fmu_coaches": Several(
        Real(1, 20, "", "coach from the front", whole=True),
        "coaches whose wheelsets are in the FMU, those of the others are rigid; unless given, all", (),
    ),
    "brake": Text("file"),
    "track": Text("file"),
    "speed": Real(0.5, 60, "m/s", "at the start"),
    "demand": Real(0, 1, "1", "share of the full brake pressure", 1.0),
    "payload": Real(0, 1e6, "kg", "in place of the vehicle's", optional=True),
    "adhesion": Real(1e-3, 1, "1", "of contaminated rail, in place of the track's", optional=True),
    "step": Real(1e-5, 0.01, "s", "communication step; longer ones do not resolve the primary suspension", 0.005),
    "hold": Real(0, 60, "s", "watched after standstill", 2.0),
    "longest": Real(0.01, 3600, "s", "a stop may take", 240.0),
    "dry": Real(1e-3, 1, "1", "friction of the dry stop that the others are compared with", 0.3),
    "wheel": Named(Real(-1e12, 1e12, "", "value"), "parameters of the FMU, of one wheel", {}),
    "sweep": {
        "speed": Several(Real(0.5, 60, "m/s", "at the start"), "speeds", (27.8, 38.9)),
        "adhesion": Several(Real(1e-3, 1, "1", "contaminated rail"), "friction", (0.05, 0.1)),
        "payload": Several(Real(0, 1e6, "kg", "load"), "loads", (0.0,)),
        "slide_high": Several(Real(0, 1, "1", "threshold"), "thresholds of the slide protection", (0.15,)),
        "wheel": Named(Real(-1e12, 1e12, "", "value"), "parameters of the FMU in a sweep, before those of wheel", {}),
    },
}

SCHEMAS = {"scenario": SCENARIO, "vehicle": VEHICLE, "brake": BRAKE, "track": TRACK}


def load(path):
    """Reads a scenario and the files it names, which lie beside it."""
    path = Path(path)
    scenario = read_json(path, SCENARIO)
    brake = path.parent / scenario.brake
    for kind in ("vehicle", "brake", "track"):
        setattr(scenario, kind, read_json(path.parent / getattr(scenario, kind), SCHEMAS[kind]))
    track = scenario.track
    track.path = path.parent / track.sections
    track.sections = SimpleNamespace(**read_csv(track.path, SECTIONS))
    check_sections(track)
    if track.profile:
        profile = path.parent / track.profile
        track.profile = SimpleNamespace(**read_csv(profile, PROFILE))
        check_profile(track.profile, profile)
    check_thresholds(scenario, path, brake)
    for coach in scenario.fmu_coaches:
        if coach > scenario.coaches:
            raise BadFile(f"{path}: fmu_coaches entry = {coach} is outside 1 to {scenario.coaches}, the number of coaches")
    settle(scenario)
    return scenario


def settle(scenario):
    """Puts the scenario's payload and adhesion in place of those of vehicle and track, where they are given."""
    if scenario.payload is not None:
        scenario.vehicle.body.payload = scenario.payload
    if scenario.adhesion is not None:
        conditions = scenario.track.conditions
        if "contaminated" not in conditions:
            raise BadFile("adhesion is given, but the track has no condition named contaminated")
        conditions["contaminated"].friction = scenario.adhesion
        conditions["contaminated"].recovered = max(scenario.adhesion, conditions["contaminated"].recovered)


def check_thresholds(scenario, path, brake):
    """Axles are held before they are vented."""
    low = scenario.brake.wsp.slide_low
    thresholds = [(brake, "wsp.slide_high", scenario.brake.wsp.slide_high)]
    thresholds += [(path, "sweep.slide_high entry", high) for high in scenario.sweep.slide_high]
    for file, name, high in thresholds:
        if high < low:
            raise BadFile(f"{file}: {name} = {high:g} is below wsp.slide_low = {low:g}: an axle is held before it is vented")


def check_wheel(scenario, known):
    """The parameters of the wheels are among those that are `known`."""
    for name in scenario.wheel | scenario.sweep.wheel:
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            raise BadFile(f"wheel: {name} is no parameter of the FMU" + "".join(f"; did you mean {other}?" for other in close))


def check_sections(track):
    """Sections begin one after the other, and their conditions exist."""
    s = track.sections
    for line, (position, condition) in enumerate(zip(s.position, s.condition), start=2):
        if condition not in track.conditions:
            known = ", ".join(track.conditions)
            raise BadFile(f"{track.path}:{line}: condition {condition!r} is none of {known}")
        if line > 2 and position <= s.position[line - 3]:
            raise BadFile(f"{track.path}:{line}: position {position:g} m is not beyond {s.position[line - 3]:g} m")


def check_profile(profile, path):
    """Positions rise."""
    pairs = zip(profile.position, profile.position[1:])
    for line, (before, position) in enumerate(pairs, start=3):
        if position <= before:
            raise BadFile(f"{path}:{line}: position {position:g} m is not beyond {before:g} m")


def elevation(track, positions, velocities):
    """Height [m] of the rail at positions [m], and its rate [m/s] for who moves there."""
    if not track.profile:
        return np.zeros((2, len(positions)))
    place, height = np.array(track.profile.position), np.array(track.profile.elevation)
    if len(place) < 2:
        return np.array([np.full(len(positions), height[0]), np.zeros(len(positions))])
    piece = np.clip(np.searchsorted(place, positions, side="right") - 1, 0, len(place) - 2)
    inside = (np.asarray(positions) >= place[0]) & (np.asarray(positions) < place[-1])
    rise = np.where(inside, (np.diff(height) / np.diff(place))[piece], 0.0)
    return np.array([np.interp(positions, place, height), rise * velocities])


def section(track, position):
    """Index of the section at a position [m]; the first one reaches back."""
    return max(bisect_right(track.sections.position, position) - 1, 0)


def rail_map(track, behind, axles, dry=None):
    """The rail of a track, from `behind` [m] before the first axle on; everywhere at the friction `dry`, if given."""
    begin = -behind - 10.0
    positions = np.arange(begin, track.length, track.cell) + 0.5 * track.cell
    conditions = [track.conditions[track.sections.condition[section(track, x)]] for x in positions]
    degraded = [c.friction if dry is None else dry for c in conditions]
    recovered = [c.recovered if dry is None else dry for c in conditions]
    law = RailLaw(track.cleaning_energy, track.sand.friction, track.sand.mass, track.contact_width, track.effusivity)
    return RailMap(begin, track.cell, degraded, recovered, law, axles)
