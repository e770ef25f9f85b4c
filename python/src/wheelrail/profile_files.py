"""Profiles of wheels and rails from files: SIMPACK (`.prw`, `.prr`), MiniProf, and two columns.

Whatever a file has, a `Profile` has metres, lateral positions that are positive to the field side, and heights upwards. A file of
SIMPACK says itself what it has: the key `units.len.f` (units per metre), and after its keys `mirror.y` and `mirror.z` positions to the
field side and heights downwards. What contradicts that is refused. The others say nothing: millimetres or metres, up or down, and
the side of a flange are found by the shape, and told. A rail of theirs has positions to the field side.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .tables import NUMBER, BadFile, comma, text_of

FEWEST = 20  # points
WIDE = {"wheel": (0.06, 0.2), "rail": (0.03, 0.2)}  # m, widths of the two
UNITS = {"metres": 1.0, "millimetres": 1e-3, "inches": 0.0254}
FLANGE, HEAD = 0.015, 0.004  # m, by which a flange reaches below a tread at least, and the sides of a head below its top
CLOSE = 1e-7  # m, nearer points count as one
SIDES = 0.0141  # m, below the top of a rail
AWAY = 0.008  # slope, from which on a head leans
STEEP = 1.7  # slope, from which on a profile may turn back: a side of a rail, the back of a flange
TAPING = 0.07  # m, from the back of a flange to the taping circle
ENTRY = re.compile(r"([\w.]+)\s*=\s*(.*)")


class Profile(NamedTuple):
    """A profile, and words on what its file had."""

    u: np.ndarray  # lateral positions from the taping circle of a wheel, or the origin of the file of a rail, to the field side, ascending [m]
    z: np.ndarray  # heights above the tread at the taping circle, or the top of the rail [m]
    words: str


def read(path: str | Path, kind: str) -> Profile:
    """The profile of a `kind`, "wheel" or "rail"; what is wrong in a file is refused with its line and what to do."""
    text = text_of(path)
    begin = re.search(r"^[ \t]*point\.begin", text, re.I | re.M)
    simpack, first = begin is not None, 1 + text.count("\n", 0, begin.start()) if begin else 1
    if not simpack and Path(path).suffix.lower() in (".prw", ".prr"):
        raise BadFile(f"{path}:1: no line point.begin, behind which a file of SIMPACK has its points; export the profile anew")
    keys, points, lines = _parts(path, text, simpack)
    if len(points) < FEWEST:
        raise BadFile(f"{path}:{lines[-1] if lines else first}: {len(points)} points; a profile has {FEWEST} or more: export it with all of them")
    if simpack:
        mirrors = [1.0 if _key(path, keys, name, "0") > 0.0 else -1.0 for name in ("mirror.y", "mirror.z")]
        units = _key(path, keys, "units.len.f", "1000")
        if not units > 0.0:
            raise BadFile(f"{path}:{keys['units.len.f'][0]}: units.len.f = {units:g} is not above 0; write 1000 for millimetres")
        unit = np.array([-mirrors[0], mirrors[1]]) / units
        told = f"{units:g} units per metre, heights {'upwards' if mirrors[1] > 0.0 else 'downwards'}{', mirrored' if mirrors[0] > 0.0 else ''}"
    else:
        width, (low, high) = np.ptp(np.array(points)[:, 0]), WIDE[kind]
        told = next((name for name in ("millimetres", "metres") if low <= UNITS[name] * width <= high), None)
        if not told:
            raise BadFile(f"{path}: {_too_wide(kind, width, simpack)}")
        unit = UNITS[told]
    return _placed(path, kind, _ascending(path, lines, unit * np.array(points)), told, simpack)


def _parts(path, text, simpack):
    """Keys with lines and values, points, and their lines: of a file of SIMPACK; of MiniProf, which has lines with `=` before its points;
    or of two columns below at most one line of names."""
    keys, points, lines, inside = {}, [], [], not simpack
    for line, text in enumerate(text.split("\n"), start=1):
        text = re.split("[#!%]", text)[0].strip()
        if simpack and re.match(r"point\.(begin|end)", text, re.I):
            inside = text.lower().startswith("point.begin")
        elif entry := ENTRY.match(text) if not (inside and simpack) else None:
            keys[entry[1]] = line, entry[2].strip(" '\"")
        elif inside and text and (points or simpack or re.match(r"[-+.\d]|nan|inf", text, re.I)):
            points.append(_point(path, line, re.sub(r"(?<=[\d.])[dD](?=[-+\d])", "E", text)))
            lines.append(line)
    return keys, points, lines


def _key(path, keys, name, default):
    """The number of a key of SIMPACK."""
    line, text = keys.get(name, (0, default))
    if not NUMBER.fullmatch(text):
        raise BadFile(f"{path}:{line}: {name} = {text!r} is no number; write {default} unless you mean another one")
    return float(text)


def _point(path, line, text):
    """The first two numbers of a line."""
    cells = [cell for cell in re.split(r"[\s;,]+", text) if cell]
    if len(cells) < 2 or "," in text and len(cells) > 2 and not re.search(r"\.\d|,\s|\s,", text):
        raise BadFile(f"{path}:{line}: {text!r} is no pair of position and height; write two numbers with decimal points")
    for cell in cells[:2]:
        if not NUMBER.fullmatch(cell):
            raise BadFile(f"{path}:{line}: {cell!r} is not a finite number{comma(cell)}; correct the line, or leave the point out")
    return float(cells[0]), float(cells[1])


def _too_wide(kind, width, simpack):
    """Words on a width in millimetres that no profile has, and what to do."""
    low, high = WIDE[kind]
    meant = next((name for name, size in UNITS.items() if low <= size * width <= high), None)
    advice = f"set units.len.f to {1.0 / UNITS[meant or 'millimetres']:.6g}" if simpack else "write them in millimetres"
    seem = f"its numbers seem to be {meant}: " if meant else "if its numbers are no millimetres, "
    return f"the {kind} is {width:g} mm wide, outside {1e3 * low:g} to {1e3 * high:g} mm; {seem}{advice}"


def _ascending(path, lines, points):
    """The part of the points in which positions run one way, turned so that they ascend."""
    if points[-1, 0] < points[0, 0]:
        points, lines = points[::-1], lines[::-1]
    ahead = np.diff(points[:, 0])
    back = np.flatnonzero((ahead < 0.0) & (np.abs(np.diff(points[:, 1])) < STEEP * -ahead))
    if len(back):
        first, second = (points[k, 0] for k in (back[0], back[0] + 1))
        line = max(lines[back[0]], lines[back[0] + 1])
        raise BadFile(f"{path}:{line}: positions turn back, {1e3 * second:g} mm beside {1e3 * first:g} mm; sort the points along the profile")
    part = _one_way(points[:, 0])
    kept = points[part]
    if len(kept) < FEWEST:
        raise BadFile(f"{path}:{lines[part[0]]}: {len(kept)} points run one way; a profile has {FEWEST} or more: sort them along the profile")
    return kept


def _one_way(u):
    """Numbers of the points about the middle whose positions ascend."""
    turns = np.flatnonzero(np.diff(u) < 0.0) + 1
    middle = int(np.argmin(np.abs(u - 0.5 * (u[0] + u[-1]))))
    begin, end = max(turns[turns <= middle], default=0), min(turns[turns > middle], default=len(u))
    return begin + np.flatnonzero(np.diff(u[begin:end], prepend=-np.inf) > CLOSE)


def _placed(path, kind, points, told, simpack):
    """A profile in its place: checked for size, orientation and kind."""
    if not WIDE[kind][0] <= np.ptp(points[:, 0]) <= WIDE[kind][1]:
        raise BadFile(f"{path}: {_too_wide(kind, 1e3 * np.ptp(points[:, 0]), simpack)}")
    sign, inner, outer = _shape(points)
    other = {"wheel": "rail", "rail": "wheel"}[kind]
    if (kind == "rail") != (max(inner, outer) < -HEAD):
        raise BadFile(f"{path}: this is no {kind}, but has the shape of a {other}: give the file of the wheel first, then that of the rail")
    if kind == "wheel" and min(inner, outer) > -FLANGE:
        raise BadFile(f"{path}: no flange reaches {1e3 * FLANGE:g} mm below the tread; give the whole wheel, or the files in the order wheel, rail")
    mirrored = kind == "wheel" and outer < inner
    if simpack and (sign < 0.0 or mirrored):
        wrong, key = ("upside down", "mirror.z") if sign < 0.0 else ("mirrored, its flange on the field side", "mirror.y")
        raise BadFile(f"{path}: the {kind} is {wrong}; change {key} in the file from 0 to 1, or from 1 to 0")
    points = (points * [-1.0 if mirrored else 1.0, sign])[:: -1 if mirrored else 1]
    told = [told, *([] if simpack else ["heights downwards: turned" if sign < 0.0 else "heights upwards"]), *(["flange at positive positions: mirrored"] if mirrored else [])]
    return _origin(kind, *points.T, told)


def _shape(points):
    """1 if heights are upwards, else -1; how far both ends reach above the middle height then [m]."""
    u = np.linspace(points[0, 0], points[-1, 0], 400)
    height = np.interp(u, *points.T)
    height -= np.median(height)
    sign = -float(np.sign(height[np.argmax(np.abs(height))]))
    third = len(u) // 3
    return sign, np.min(sign * height[:third]), np.min(sign * height[-third:])


def _origin(kind, u, z, told):
    """A profile about its origin."""
    if kind == "rail":
        return Profile(u, z - np.max(z), f"rail: {len(u)} points; " + ", ".join(told))
    if not u[0] < -0.5 * TAPING or u[-1] < 0.3 * TAPING:
        told.append(f"taping circle {1e3 * TAPING:g} mm from the end at the flange")
        u = u - u[0] - TAPING
    return Profile(u, z - np.interp(0.0, u, z), f"wheel: {len(u)} points; " + ", ".join(told))


def lean(profile: Profile) -> float:
    """How a rail leans [1]: the slope of its head between places 3/4 of the way to its sides at `SIDES`; to the middle of the track positive."""
    above = profile.u[profile.z > -SIDES]
    middle, half = 0.5 * (above[0] + above[-1]), 0.15 * (above[-1] - above[0])
    low, high = np.interp([middle - half, middle + half], profile.u, profile.z)
    return float((high - low) / (2.0 * half))


def inclined(profile: Profile, inclination: float, path: str | Path = "") -> Profile:
    """A rail turned to the middle of the track by an inclination [1] such as 1/40; one that leans the other way then is refused."""
    cosine = 1.0 / np.hypot(1.0, inclination)
    sine = cosine * inclination
    u, z = cosine * profile.u - sine * profile.z, sine * profile.u + cosine * profile.z
    part = _one_way(u)
    made = Profile(u[part], z[part] - np.max(z), profile.words)
    slope = lean(made)
    if slope < -AWAY:
        advice = "exchange the signs of its positions, which go to the field side, or give --inclination"
        raise BadFile(f"{path}: the rail is mirrored: its head leans away from the track by 1:{-1.0 / slope:.0f}; {advice}")
    leans = f"leans to the track by about 1:{1.0 / slope:.0f}" if slope > AWAY else "upright; --inclination 1:40 would turn it"
    return made._replace(words=f"{made.words}; {leans}")
