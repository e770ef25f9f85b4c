"""What a stop consists of, as files: scenario, vehicle, brake, track. `load` reads and checks all of them, `changed` gives a copy
with other values."""

from bisect import bisect_right
from copy import deepcopy
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from .controllers import Driving, Protection, Sanding
from .files import BadFile, Named, Setting, Swept, doubt_of, meant, number, read_csv, read_json
from .own import find
from .rail_map import RailLaw, RailMap
from .reach import check_gap, check_reach
from .schemas import BRAKE, PROFILE, SCENARIO, SECTIONS, TRACK, VEHICLE
from .smooth import Spline
from .tables import nearest
from .units import headed
from .values import Refused, to_fmu
from .warn import warn

MOST_CELLS = 5e6  # of the map of the rail, which keeps values of every axle for each of them
PARTS = {"vehicle": VEHICLE, "brake": BRAKE, "track": TRACK}
# Short names of swept keys beside dotted paths.
SHORT = {"slide_high": "brake.wsp.slide_high"}
# Classes of one's own by the key that names them, with what they must have.
OWN = {"brake.protection": Protection, "brake.sanding": Sanding, "driver": Driving}


def fields():
    """Fields by their dotted paths; one whose names are free stands for all that is below it."""

    def below(schema, prefix=""):
        for name, field in schema.items():
            yield from below(field, f"{prefix}{name}.") if isinstance(field, dict) else [(prefix + name, field)]

    found = dict(below({name: field for name, field in SCENARIO.items() if name not in ("name", "sweep")}))
    found |= (entry for part, schema in PARTS.items() for entry in below(schema, f"{part}."))
    return found | {short: found[path] for short, path in SHORT.items()}


def field_of(path):
    """The field of a dotted path, such as `speed`, `vehicle.body.mass` or `wheel.friction.falling_ratio`; a text about what is
    wrong with it, if there is none."""
    known, names = fields(), path.split(".")
    if names[:2] == ["track", "sections"] and len(names) > 2:
        return _of_section(names[2:])
    for k in range(1, len(names)):
        if isinstance(free := known.get(".".join(names[:k])), Named):
            if not isinstance(free.item, dict):
                return free.item  # whose names may have dots
            known |= {".".join((*names[: k + 1], key)): field for key, field in free.item.items()}
    if path in known and not isinstance(known[path], Named):
        return known[path]
    below = [other for other in known if other.startswith(f"{path}.")]
    if path in known or below:
        return f"is no value but a group{meant(path, below) if below else ''}"
    if headed(path)[0] != path and not isinstance(field := field_of(headed(path)[0]), str):
        return f"has a unit in its name: write {headed(path)[0]!r}, and its values in {getattr(field, 'unit', '') or 'no unit'}"
    return "is unknown" + (nearest(path, known) or "; it is a key of the scenario, or vehicle, brake, track or wheel, a dot and a key of that file")


def _of_section(names):
    """The field of a value of a section, `2.slope` or `all.temperature`; a text about what is wrong with it."""
    which, column = (*names, "")[:2]
    if len(names) != 2 or not (which == "all" or which.isdigit() and int(which) > 0):
        return "is no value of a section; write track.sections, the number of the section from 1 or all, and the column"
    if column not in SECTIONS:
        return f"is no column of the sections{meant(column, SECTIONS)}; they have {', '.join(SECTIONS)}"
    return SECTIONS[column]


# Last, since it knows all the others.
SCENARIO["sweep"] = Swept(
    field_of, "lists of values by key: of this file, or of another one, such as vehicle.body.mass",
    {"wheel": Named(Setting("value"), "parameters of the FMU in a sweep, before those of wheel", {})},
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
    if not changes:
        check_reach(scenario.track, scenario.paths["track"])
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
    known = track.conditions

    def wrong(row, before):
        strange = f"condition {row['condition']!r} is none of {', '.join(known)}" if row["condition"] not in known else None
        return strange or _beyond(row, before)

    track.sections = SimpleNamespace(**read_csv(track.path, SECTIONS, wrong))


def _read_profile(scenario, name):
    """Reads the height profile of the track from a file beside the scenario, if there is one."""
    scenario.track.profile = name
    if name:
        path = scenario.paths["scenario"].parent / name
        profile = scenario.track.profile = SimpleNamespace(**read_csv(path, PROFILE, _beyond))
        check_gap(path, profile.position, profile.elevation)


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
    if {"track", "track.sections", "track.profile", "track.begin", "track.length"} & set(changes):
        check_reach(copy.track, copy.paths["track"])
    return copy


def _put(scenario, path, value):
    """Puts a value where a dotted path says."""
    field = field_of(path)
    wrong = field if isinstance(field, str) else field.check(value)
    if wrong:
        raise BadFile(f"{path} {wrong}")
    if doubt := doubt_of(field, value):
        warn(f"{path} {doubt}")
    path, value = SHORT.get(path, path), number(value, field)
    if path in PARTS:
        return _read_part(scenario, path, value)
    if path.startswith("track.sections."):
        return _put_in_sections(scenario.track, path, value)
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


def _put_in_sections(track, path, value):
    """Puts a value into one section, by its number from 1, or into all."""
    which, column = path.split(".")[2:]
    values, count = getattr(track.sections, column), len(track.sections.position)
    if which != "all" and int(which) > count:
        raise BadFile(f"{path}: the track has {count} sections, the last one {count}")
    if column == "condition" and value not in track.conditions:
        raise BadFile(f"{path} = {value!r} is none of {', '.join(track.conditions)}")
    for k in range(count) if which == "all" else (int(which) - 1,):
        values[k] = value
    positions = track.sections.position
    if any(b <= a for a, b in zip(positions, positions[1:])):
        raise BadFile(f"{path} = {value:g} m: positions of the sections must ascend")


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
    if scenario.temperatures and of_two_kinds(scenario):
        raise BadFile(f"{path}: temperatures are of a wheel beside two equal ones; with right_wheel or right_friction each wheel has its own")
    for owner, key in ((scenario.brake, "protection"), (scenario.brake, "sanding"), (scenario, "driver")):
        if getattr(owner, f"{key}_parameters") and not getattr(owner, key):
            file = scenario.paths["scenario" if owner is scenario else "brake"]
            raise BadFile(f"{file}: {key}_parameters are given, but no {key}: module:Class")


def of_two_kinds(scenario):
    """Whether the wheels of an axle, or their rails, differ."""
    return bool(scenario.right_wheel) or scenario.right_friction != 1.0


def check_wheel(scenario, known):
    """The parameters of the wheels, those that are swept too, are among those that are `known`, variables by name, and have values of
    their types."""
    given = [*scenario.sweep.wheel.items()]
    for part in ("wheel", "right_wheel", "temperatures"):
        swept = ((key, values) for key, values in vars(scenario.sweep).items() if key.startswith(f"{part}."))
        given += getattr(scenario, part).items()
        given += [(key.removeprefix(f"{part}."), value) for key, values in swept for value in values]
    for name, value in given:
        if name not in known:
            raise BadFile(f"{scenario.paths['scenario']}: wheel: {name} is no parameter of the FMU{nearest(name, known)}")
        try:
            to_fmu(known[name], value)
        except Refused as error:
            raise BadFile(f"{scenario.paths['scenario']}: wheel: {error}") from None


def _beyond(row, before):
    """What is wrong with the position of a row after another one."""
    if not before or row["position"] > before["position"]:
        return None
    place, last = row["position"], before["position"]
    advice = f"; they rise in the direction of travel: where chainages fall, write them negative, {-last:g} before {-place:g}, and begin of the track likewise"
    return f"position {place:g} m is not beyond {last:g} m{advice if place < last else ''}"


def heights(track):
    """Smooth curve through the heights of the rail over positions from the start [m]; None where the rail is even."""
    return Spline(np.array(track.profile.position) - track.begin, track.profile.elevation) if track.profile else None


def elevation(curve, positions, velocities):
    """Height [m] of the rail at positions [m] from the start by its curve, and its rate [m/s] for who moves there."""
    if curve is None:
        return np.zeros((2, len(positions)))
    height, slope = curve.at(positions)
    return np.array([height, slope * velocities])


def section(track, position):
    """Index of the section at a position [m] from the start; the first one reaches back."""
    return max(bisect_right(track.sections.position, position + track.begin) - 1, 0)


def slope(track, position):
    """Gradient at a position [m] from the start, rising positive."""
    return track.slope + track.sections.slope[section(track, position)]


def rail_map(track, behind, axles, dry=None):
    """The rail of a track, from `behind` [m] before the first axle on; everywhere at the friction `dry`, if given."""
    begin = -behind - 10.0
    positions = np.arange(begin, track.length, track.cell) + 0.5 * track.cell
    conditions = [track.conditions[track.sections.condition[section(track, x)]] for x in positions]
    degraded = [c.friction if dry is None else dry for c in conditions]
    recovered = [c.recovered if dry is None else dry for c in conditions]
    law = RailLaw(track.cleaning_energy, track.sand.friction, track.sand.mass, track.contact_width, track.effusivity)
    return RailMap(begin, track.cell, degraded, recovered, law, axles)
