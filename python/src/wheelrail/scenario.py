"""What a stop consists of, as files: scenario, vehicle, brake, track. `load` reads and checks all of them, `changed` gives a copy
with other values."""

import difflib
from bisect import bisect_right
from copy import deepcopy
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from .controllers import Driving, Protection, Sanding
from .files import BadFile, Flag, Named, Real, Several, Swept, Text, meant, number, read_csv, read_json
from .own import find
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
        "delay": Real(0, 60, "s", "between an axle that is vented and sand on the rail", 0.3),
        "minimum_time": Real(0, 60, "s", "that sand is laid at least", 1.0),
        "run_on": Real(0, 60, "s", "that sand is laid on after the last axle was vented", 2.0),
    },
    "protection": Text("slide protection of one's own, module:Class; the built-in one if empty", ""),
    "protection_parameters": Named(Real(-1e12, 1e12, "", "value"), "numbers that its class is made with, by name", {}),
    "sanding": Text("sanding of one's own, module:Class; the built-in one if empty", ""),
    "sanding_parameters": Named(Real(-1e12, 1e12, "", "value"), "numbers that its class is made with, by name", {}),
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
    "driver": Text("driver of one's own, module:Class; a constant demand if empty", ""),
    "driver_parameters": Named(Real(-1e12, 1e12, "", "value"), "numbers that its class is made with, by name", {}),
}
MOST_CELLS = 5e6  # of the map of the rail, which keeps values of every axle for each of them
PARTS = {"vehicle": VEHICLE, "brake": BRAKE, "track": TRACK}
# Short names of swept keys beside dotted paths.
SHORT = {"slide_high": "brake.wsp.slide_high"}
# Classes of one's own by the key that names them, with what they must have.
OWN = {"brake.protection": Protection, "brake.sanding": Sanding, "driver": Driving}


def field_of(path):
    """The field of a dotted path, such as `speed`, `vehicle.body.mass` or `wheel.friction.falling_ratio`; a text about what is
    wrong with it, if there is none."""
    names, schema = SHORT.get(path, path).split("."), {k: v for k, v in SCENARIO.items() if k not in ("name", "sweep")}
    for k, name in enumerate(names):
        rest = names[k + 1 :]
        if isinstance(schema, Named):  # names are free; those of numbers may have dots
            schema, rest = schema.item, rest if isinstance(schema.item, dict) else []
            if not rest:
                break
        elif not isinstance(schema, dict) or name not in schema:
            close = difflib.get_close_matches(path, paths(), n=1)
            known = "it is a key of the scenario, or vehicle, brake, track or wheel, a dot and a key of that file"
            return f"is unknown; {f'did you mean {close[0]!r}?' if close else known}"
        else:
            schema = PARTS[name] if k == 0 and rest and name in PARTS else schema[name]
    if isinstance(schema, dict | Named):
        below = [other for other in paths() if other.startswith(f"{path}.")]
        return f"is no value but a group{meant(path, below) if below else ''}"
    return schema


def paths():
    """Dotted paths of all fields whose names are not free."""

    def below(schema, prefix):
        for name, field in schema.items():
            if isinstance(field, dict):
                yield from below(field, f"{prefix}{name}.")
            else:
                yield prefix + name

    own = {name: field for name, field in SCENARIO.items() if name not in ("name", "sweep")}
    return [*SHORT, *below(own, ""), *(path for part, schema in PARTS.items() for path in below(schema, f"{part}."))]


# Last, since it knows all the others.
SCENARIO["sweep"] = Swept(
    field_of, "lists of values by key: of this file, or of another one, such as vehicle.body.mass",
    {"wheel": Named(Real(-1e12, 1e12, "", "value"), "parameters of the FMU in a sweep, before those of wheel", {})},
    ("speed", "adhesion", "payload", "slide_high"),
)  # fmt: skip
SCHEMAS = {"scenario": SCENARIO, **PARTS}


def load(path, changes=None):
    """Reads a scenario and the files it names, which lie beside it. Values of `changes`, dotted path to value, take the place of
    those in the files: `load("low_adhesion.json", {"vehicle.body.mass": 40e3})`."""
    path = Path(path)
    scenario = read_json(path, SCENARIO)
    scenario.paths = {"scenario": path}
    for part in PARTS:
        _read_part(scenario, part, getattr(scenario, part))
    if scenario.driver:
        scenario.driver = find(scenario.driver, path.parent, f"{path}: driver", Driving)
    settle(scenario)
    check(scenario)
    return changed(scenario, changes) if changes else scenario


def _read_part(scenario, part, name):
    """Reads vehicle, brake or track from a file beside the scenario, with what that names."""
    path = scenario.paths[part] = scenario.paths["scenario"].parent / name
    values = read_json(path, PARTS[part])
    setattr(scenario, part, values)
    if part == "track":
        _read_sections(scenario, values.sections)
        _read_profile(scenario, values.profile)
    if part == "brake":
        for key in ("protection", "sanding"):
            if getattr(values, key):
                _find(scenario, f"brake.{key}", getattr(values, key))


def _read_sections(scenario, name):
    """Reads the sections of the track from a file beside the scenario."""
    track = scenario.track
    track.path = scenario.paths["scenario"].parent / name
    track.sections = SimpleNamespace(**read_csv(track.path, SECTIONS))
    check_sections(track)


def _read_profile(scenario, name):
    """Reads the height profile of the track from a file beside the scenario, if there is one."""
    scenario.track.profile = name
    if name:
        path = scenario.paths["scenario"].parent / name
        scenario.track.profile = SimpleNamespace(**read_csv(path, PROFILE))
        check_profile(scenario.track.profile, path)


def _find(scenario, path, name):
    """Puts a class of one's own where a dotted path says, found beside the file that has the key."""
    part, _, key = path.rpartition(".")
    file = scenario.paths[part or "scenario"]
    setattr(getattr(scenario, part) if part else scenario, key, find(name, file.parent, f"{file}: {key}", OWN[path]))


def changed(scenario, changes):
    """A copy of a scenario with other values: dotted path to value, checked as in files. A file's name takes the place of all
    that was read from another one; values within it go before it."""
    copy = deepcopy(scenario)
    longer = lambda path: path not in SCENARIO or path in OWN
    for path in sorted(changes, key=lambda path: (longer(path), path.count("."))):
        if longer(path):
            continue
        _put(copy, path, changes[path])
    if {"vehicle", "track", "payload", "adhesion"} & set(changes):
        settle(copy)
    for path in filter(longer, changes):
        _put(copy, path, changes[path])
    check(copy)
    return copy


def _put(scenario, path, value):
    """Puts a value where a dotted path says."""
    field = field_of(path)
    wrong = field if isinstance(field, str) else field.check(value)
    if wrong:
        raise BadFile(f"{path} {wrong}")
    path, value = SHORT.get(path, path), number(value, field)
    if path in PARTS:
        return _read_part(scenario, path, value)
    if path in ("track.sections", "track.profile"):
        return {"track.sections": _read_sections, "track.profile": _read_profile}[path](scenario, value)
    if path in OWN and value:
        return _find(scenario, path, value)
    place, names = scenario, path.split(".")
    while not isinstance(place, dict) and len(names) > 1:
        place = getattr(place, names.pop(0))
        if isinstance(place, dict) and len(names) > 1 and names[0] in place and isinstance(place[names[0]], SimpleNamespace):
            place = place[names.pop(0)]
    if isinstance(place, dict) and path.startswith("track.conditions"):
        raise BadFile(f"{path}: the track has no condition {names[0]!r}; known: {', '.join(place)}")
    if isinstance(place, dict):
        place[".".join(names)] = value
    else:
        setattr(place, names[0], value)


def settle(scenario):
    """Puts the scenario's payload and adhesion in place of those of vehicle and track, where they are given."""
    if scenario.payload is not None:
        scenario.vehicle.body.payload = scenario.payload
    if scenario.adhesion is not None:
        conditions = scenario.track.conditions
        if "contaminated" not in conditions:
            raise BadFile(f"adhesion is given, but {scenario.paths['track']} has no condition named contaminated")
        conditions["contaminated"].friction = scenario.adhesion
        conditions["contaminated"].recovered = max(scenario.adhesion, conditions["contaminated"].recovered)


def check(scenario):
    """Values fit those of other keys and files."""
    wsp, path = scenario.brake.wsp, scenario.paths["scenario"]
    if wsp.slide_high < wsp.slide_low:
        raise BadFile(
            f"{scenario.paths['brake']}: wsp.slide_high = {wsp.slide_high:g} is below wsp.slide_low = {wsp.slide_low:g}: "
            "an axle is held before it is vented"
        )
    track = scenario.track
    if track.length > MOST_CELLS * track.cell:
        cells = f"{track.length / track.cell:g} cells, more than {MOST_CELLS:g}"
        raise BadFile(f"{scenario.paths['track']}: length = {track.length:g} m in cells of cell = {track.cell:g} m makes {cells}")
    for coach in scenario.fmu_coaches:
        if coach > scenario.coaches:
            raise BadFile(f"{path}: fmu_coaches entry = {coach} is outside 1 to {scenario.coaches}, the number of coaches")
    for owner, key in ((scenario.brake, "protection"), (scenario.brake, "sanding"), (scenario, "driver")):
        if getattr(owner, f"{key}_parameters") and not getattr(owner, key):
            file = scenario.paths["scenario" if owner is scenario else "brake"]
            raise BadFile(f"{file}: {key}_parameters are given, but no {key}: module:Class")


def check_wheel(scenario, known):
    """The parameters of the wheels, those that are swept too, are among those that are `known`."""
    swept = [key.removeprefix("wheel.") for key in vars(scenario.sweep) if key.startswith("wheel.")]
    for name in [*scenario.wheel, *scenario.sweep.wheel, *swept]:
        if name not in known:
            close = difflib.get_close_matches(name, known, n=1)
            hint = "".join(f"; did you mean {other}?" for other in close)
            raise BadFile(f"{scenario.paths['scenario']}: wheel: {name} is no parameter of the FMU{hint}")


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
