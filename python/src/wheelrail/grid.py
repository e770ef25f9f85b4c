"""The contact patch on a regular grid over x, z and time: what its lines have, interpolated by their own laws.

A record with `patch=True` has the profiles of every line of the patch, `patch.*` over `time`, `line` and `node`, as the FMU computes
them. `patch` lays them on a grid:

- Lines are ends of a shape. Between its edges each line is seen over ξ from -1 at the trailing to 1 at the leading edge, its
  pressure as a share of its largest one. At a fixed ξ, shares and ratios change linearly from line to line.
- Squares of half-lengths and of largest pressures are quadratic in z between three neighbouring lines and zero at the sides of the
  patch: both are exact for Hertz's ellipse, whose pressure comes out as it is.
- Shear is a ratio to the pressure. The border of stick and slip is where their signed distance in ξ changes its sign, so that it runs
  straight from line to line.
- Temperatures beside the contact are those at the same distance from its edge.

A patch of constant width is the same everywhere across it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy

from .records import OF_PATCH, library
from .units import in_si

if TYPE_CHECKING:
    import xarray

STICKS = 1e-6  # m/s: a place that slips less sticks
SHAPE = np.linspace(-1.0, 1.0, 121)  # ξ of the shapes of lines
MARGIN = 1.08  # of the grid over the largest patch
STATE = {"units": "1", "long_name": "0 where nothing touches, 1 where the surfaces stick, 2 where they slip"}


class NoPatch(ValueError):
    """A record without the profiles of the lines of a patch."""


def patch(run: xarray.Dataset, *, along: int = 81, across: int = 41) -> xarray.Dataset:
    """The patch of a record made with `patch=True` on a regular grid.

    A Dataset over `time` [s], `z` [m], `across` places from the middle of the patch to the right, and `x` [m], `along` places, ahead
    positive: `pressure` and `shear` [Pa], `slip` [m/s], `state` (0 apart, 1 sticks, 2 slips), `temperature_wheel` and
    `temperature_rail` [K], and with lateral creepage `shear_z` and `slip_z`. Tractions and slip are zero where nothing touches;
    temperatures beside the patch, where z is beyond its sides, are nan. The grid is the same at all times.
    """
    xarray = library("xarray")
    if "patch.pressure" not in run or "line.position" not in run:
        raise NoPatch("the record has no patch: make it with patch=True")
    run = in_si(run)
    source = {name: run[f"patch.{name}"].values for name in OF_PATCH if f"patch.{name}" in run}
    nodes, position, half = run["x"].values, run["line.position"].values, run["line.half_length"].values
    side = edges(position, run["contact.width"].values if "contact.width" in run else None)[:, [0, -1]]
    reach = MARGIN * max(float(np.max(half)), 2.0 * float(nodes[1] - nodes[0]))
    centre, width = float(np.mean(side)), MARGIN * 0.5 * float(np.max(side[:, 1] - side[:, 0]))
    x, z = np.linspace(-reach, reach, along), centre + np.linspace(-width, width, across)
    found = [
        laid({name: values[k] for name, values in source.items()}, nodes, position[k], half[k], side[k], x, z)
        for k in range(run.sizes["time"])
    ]
    data = {
        name: (("time", "z", "x"), np.array([frame[name] for frame in found]), run[f"patch.{name}"].attrs if name in source else STATE)
        for name in found[0]
    }
    coordinates = {
        "time": run["time"],
        "z": ("z", z, {"units": "m", "long_name": "Across the rail, from the middle of the patch to the right"}),
        "x": ("x", x, {"units": "m", "long_name": "Along the rail, ahead positive"}),
    }
    return xarray.Dataset(data, coordinates, {"title": run.attrs.get("title", "")})


def edges(position: np.ndarray, width: np.ndarray | None) -> np.ndarray:
    """Where strips of lines at `position` (time, line) meet [m], an array (time, line + 1): half way between them. The outermost edges are
    as far apart as the patch is wide, `width` over time [m], if that is known, else as far from their lines as the next ones."""
    gaps = np.diff(position, axis=1) if position.shape[1] > 1 else np.zeros_like(position)
    first, last = position[:, :1] - 0.5 * gaps[:, :1], position[:, -1:] + 0.5 * gaps[:, -1:]
    if width is not None:
        # Positions may begin anywhere, as those of a table of rows do.
        beyond = 0.5 * (width[:, None] - (last - first))
        first, last = np.minimum(first - beyond, position[:, :1]), np.maximum(last + beyond, position[:, -1:])
    return np.hstack([first, position[:, :-1] + 0.5 * gaps, last])


def laid(
    lines: dict[str, np.ndarray],
    nodes: np.ndarray,
    position: np.ndarray,
    half: np.ndarray,
    side: np.ndarray,
    x: np.ndarray,
    z: np.ndarray,
    rim: np.ndarray | None = None,
) -> dict[str, np.ndarray]:
    """Quantities of lines at an instant, each (line, node), on a grid: name to array (z, x).

    `nodes` [m] along the lines; `position` and `half` [m] of every line, its place and half its length; `side` [m], both ends of
    the patch across; `x` and `z` [m] of the grid. For places `rim` [m] across, `rim` has the trailing and leading edges there, an
    array (place, 2) [m], which are equal where nothing touches.
    """
    shapes = [_shape({name: values[k] for name, values in lines.items()}, nodes, half[k]) for k in range(len(position))]
    found = {name: np.full((len(z), len(x)), np.nan if name.startswith("temperature") else 0.0) for name in lines}
    found["state"] = np.zeros((len(z), len(x)))
    if not any(shape["half"] > 0.0 for shape in shapes):
        return found | ({} if rim is None else {"rim": np.zeros((len(rim), 2))})
    # What is quadratic across the patch.
    of = lambda name: np.array([shape[name] for shape in shapes])
    length, peak = (_rooted(position, of(name), side, z) for name in ("half", "peak"))
    middle = _between(position, of("middle")[:, None], z)[:, 0]
    mixed = {name: _between(position, np.array([shape[name] for shape in shapes]), z) for name in shapes[0] if name not in ("half", "peak", "middle")}
    for row in np.flatnonzero((z >= side[0]) & (z <= side[1])):
        _fill(found, row, x - middle[row], length[row], peak[row], {name: values[row] for name, values in mixed.items()})
    if rim is not None:
        reach = np.where((rim >= side[0]) & (rim <= side[1]), _rooted(position, of("half"), side, rim), 0.0)
        found["rim"] = _between(position, of("middle")[:, None], rim) + reach[:, None] * [-1.0, 1.0]
    return found


def _fill(found: dict[str, np.ndarray], row: int, place: np.ndarray, length: float, peak: float, shape: dict[str, np.ndarray]) -> None:
    """Fills a row of the grid from a shape; `place` [m] from the middle of the line there."""
    if length > 0.0:
        xi = place / length
        touches = np.abs(xi) < 1.0
        at = lambda name: np.interp(xi[touches], SHAPE, shape[name])
        pressure = peak * np.sqrt(np.maximum(at("share"), 0.0))
        found["pressure"][row, touches] = pressure
        for name in ("shear", "shear_z"):
            if name in found:
                found[name][row, touches] = pressure * at(name)
        for name in ("slip", "slip_z"):
            if name in found:
                found[name][row, touches] = at(name)
        found["state"][row, touches] = np.where(at("slips") > 0.0, 2.0, 1.0)
    for name in ("temperature_wheel", "temperature_rail"):
        if name in found:
            # Beyond an edge by the distance from it; `beside` has a line's own half-length as unit of that distance.
            own = np.where(np.abs(place) <= length, place / max(length, 1e-9), np.sign(place) * (1.0 + (np.abs(place) - length) / shape["unit"][0]))
            found[name][row] = np.interp(own, shape["wide"], shape[name])


def _shape(line: dict[str, np.ndarray], nodes: np.ndarray, half: float) -> dict[str, np.ndarray | float]:
    """One line over ξ: `share`, the square of its pressure over the largest one; ratios and slip; temperatures over `wide`."""
    pressure = line["pressure"]
    low, high = _edges(nodes, pressure)
    length = 0.5 * (high - low) if half <= 0.0 else half
    middle = 0.5 * (low + high)
    touches = pressure > 0.0
    if not touches.any() or length <= 0.0:
        length, middle = 0.0, 0.0
    unit = length or float(nodes[-1] - nodes[0]) / 6.0
    place = middle + SHAPE * length
    squares = np.interp(place, *_ended(nodes, pressure**2, middle - length, middle + length))
    peak = float(np.sqrt(squares.max())) if touches.any() else 0.0
    found: dict[str, np.ndarray | float] = {"half": length, "peak": peak, "middle": middle, "share": squares / max(peak**2, 1e-300)}
    for name in ("shear", "shear_z"):
        if name in line:
            ratio = np.divide(line[name], pressure, out=np.zeros_like(pressure), where=touches)
            found[name] = np.interp(place, nodes[touches], ratio[touches]) if touches.any() else np.zeros_like(SHAPE)
    for name in ("slip", "slip_z"):
        if name in line:
            found[name] = np.interp(place, nodes[touches], line[name][touches]) if touches.any() else np.zeros_like(SHAPE)
    amount = np.hypot(found.get("slip", 0.0), found.get("slip_z", 0.0)) * np.ones_like(SHAPE)
    found["slips"] = _signed_distance(amount > STICKS)
    wide = np.linspace(-4.0, 4.0, 401)
    found["wide"], found["unit"] = wide, np.array([unit])
    for name in ("temperature_wheel", "temperature_rail"):
        if name in line:
            found[name] = np.interp(middle + wide * unit, nodes, line[name])
    return found


def _edges(nodes: np.ndarray, pressure: np.ndarray) -> tuple[float, float]:
    """Ends of the contact [m]: where the square of the pressure, which is straight there, would reach zero beyond the last nodes
    with pressure, and no farther than the next ones."""
    inside = np.flatnonzero(pressure > 0.0)
    if not len(inside):
        return 0.0, 0.0
    first, last = inside[0], inside[-1]

    def end(k: int, inward: int) -> float:
        beyond = k - inward
        rise = pressure[k + inward] ** 2 - pressure[k] ** 2 if 0 <= k + inward < len(pressure) else 0.0
        step = nodes[k] - nodes[k + inward] if 0 <= k + inward < len(nodes) else 0.0
        free = nodes[k] + (step * pressure[k] ** 2 / rise if rise > 0.0 else step)
        if 0 <= beyond < len(nodes):
            return float(np.clip(free, *sorted((nodes[k], nodes[beyond]))))
        return float(nodes[k])

    return end(first, 1), end(last, -1)


def _ended(nodes: np.ndarray, squares: np.ndarray, low: float, high: float) -> tuple[np.ndarray, np.ndarray]:
    """Squares of the pressure at nodes, with zeros at the ends of the contact."""
    inside = (squares > 0.0) & (nodes > low) & (nodes < high)
    places = np.concatenate([[low], nodes[inside], [high]])
    values = np.concatenate([[0.0], squares[inside], [0.0]])
    return places, values


def _signed_distance(true: np.ndarray) -> np.ndarray:
    """Distance in ξ from the nearest border, positive where it is true; 2 all over where there is no border."""
    borders = np.flatnonzero(np.diff(true.astype(int)))
    if not len(borders):
        return np.where(true, 2.0, -2.0)
    places = 0.5 * (SHAPE[borders] + SHAPE[borders + 1])
    distance = np.abs(SHAPE[:, None] - places[None, :]).min(axis=1)
    return np.where(true, distance, -distance)


def _between(position: np.ndarray, values: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Values of lines, (line, place), at other lateral positions: linear between lines, those of the outermost ones beyond."""
    if len(position) == 1:
        return np.repeat(values, len(z), axis=0)
    return scipy.interpolate.make_interp_spline(position, values, k=1)(np.clip(z, position[0], position[-1]))


def _rooted(position: np.ndarray, values: np.ndarray, side: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Roots of squares that are quadratic over three neighbouring lines, zero at both sides; a single line has its own value."""
    if len(position) == 1:
        return np.full(len(z), values[0])
    places, kept = np.unique(np.concatenate([[side[0]], position, [side[1]]]), return_index=True)
    squares = np.concatenate([[0.0], values**2, [0.0]])[kept]
    # The parabolas through both triples that contain an interval, mixed linearly within it, are the cubic with their slopes.
    curve = scipy.interpolate.CubicHermiteSpline(places, squares, np.gradient(squares, places, edge_order=2))
    return np.sqrt(np.where((z > side[0]) & (z < side[1]), np.maximum(curve(z), 0.0), 0.0))
