"""A rail that remembers: what the first axle leaves is what the second one meets.

The rail is divided into cells. Each keeps its condition (friction before any wheel and after cleaning), and for every axle
that passed the friction energy, the sand and the heat it left there. An axle meets what the axles *ahead* of it left,
never its own.

    mu(W) = mu_r + (mu_d - mu_r) exp(-W/W_c)                                     [1]     (1)
    mu    = mu(W) + max(mu_s - mu(W), 0) (1 - exp(-s/s_c))                       [1]     (2)
    T     = sum_k q_k / (w b sqrt(pi (t - t_k)))                                 [K]     (3)

(1) is the recovery law of Allotta, Meli, Ridolfi and Rindi (Tribology International 2014; Meccanica 49 (2014) 919-937):
degraded friction mu_d becomes recovered friction mu_r with the specific friction energy W [J/m], here that spent on each
metre of one rail by the axles ahead. Its form is published; the energy W_c that cleans was not found, its value is a
judgement. (2) is derived from the same idea for the sand s [kg/m] on the rail: a judgement. (3) is the surface
temperature that the heat q_k [J/m], left at t_k on the contact width w [m] of a half-space of thermal effusivity
b = sqrt(conductivity density heat capacity) [J/(m2 K sqrt(s))], has left at t (Carslaw and Jaeger, Conduction of Heat in
Solids, 10.3).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

SHORTEST = 1e-3  # s: equation (3) does not hold while the wheel is still there


class OffTheMap(ValueError):
    """A position that the map does not have."""


@dataclass(frozen=True)
class RailLaw:
    """Numbers of equations (1) to (3)."""

    cleaning_energy: float  # W_c, J/m
    sand_friction: float  # mu_s, 1
    sand_mass: float  # s_c, kg/m
    width: float  # w, m
    effusivity: float  # b, J/(m2 K sqrt(s))

    def friction(self, degraded: ArrayLike, recovered: ArrayLike, energy: ArrayLike, sand: ArrayLike) -> np.ndarray:
        """Friction [1] by equations (1) and (2): degraded and recovered friction [1], energy [J/m], sand [kg/m], arrays of one shape."""
        cleaned = recovered + (degraded - recovered) * np.exp(-energy / self.cleaning_energy)
        return cleaned + np.maximum(self.sand_friction - cleaned, 0.0) * -np.expm1(-sand / self.sand_mass)

    def temperature(self, heat: ArrayLike, age: ArrayLike) -> np.ndarray:
        """Excess temperature [K] by equation (3) for each passage: heat [J/m], age [s], arrays of one shape."""
        return heat / (self.width * self.effusivity * np.sqrt(np.pi * np.maximum(age, SHORTEST)))


class RailMap:
    """One rail from `begin` [m] on, in cells of `cell` [m], for `axles` axles counted from the front.

    `degraded` and `recovered` are the friction coefficients of the cells before any wheel and after cleaning [1].
    """

    def __init__(self, begin: float, cell: float, degraded: ArrayLike, recovered: ArrayLike, law: RailLaw, axles: int) -> None:
        self.begin, self.cell, self.law = begin, cell, law
        self.degraded, self.recovered = np.asarray(degraded, float), np.asarray(recovered, float)
        shape = (axles, len(self.degraded))
        self.energy = np.zeros(shape)  # J per cell, by the axle that spent it
        self.heat = np.zeros(shape)  # J per cell
        self.time = np.full(shape, -np.inf)  # s, of the passage
        self.sand = np.zeros(shape)  # kg per cell, by the axle in front of which it was laid

    def centres(self) -> np.ndarray:
        """Positions of the middle of the cells, (cells,) [m]."""
        return self.begin + self.cell * (np.arange(len(self.degraded)) + 0.5)

    def friction(self, position: float, axle: int) -> float:
        """Friction coefficient [1] that an axle meets at a position [m]; linear between the middles of cells."""
        cells, shares = self._around(position)
        energy = self.energy[:axle, cells].sum(axis=0) / self.cell
        sand = self.sand[: axle + 1, cells].sum(axis=0) / self.cell
        return float(shares @ self.law.friction(self.degraded[cells], self.recovered[cells], energy, sand))

    def temperature(self, position: float, axle: int, time: float) -> float:
        """Excess temperature [K] of the rail that arrives under an axle at a time [s]."""
        cells, shares = self._around(position)
        age = time - self.time[:axle, cells]
        return float(shares @ self.law.temperature(self.heat[:axle, cells] / self.cell, age).sum(axis=0))

    def leave(self, axle: int, start: float, end: float, time: float, energy: float, heat: float = 0.0) -> None:
        """An axle that moved from `start` to `end` [m] leaves friction energy and heat [J] there, spread evenly."""
        cells, shares = self._between(start, end)
        self.energy[axle, cells] += shares * energy
        self.heat[axle, cells] += shares * heat
        self.time[axle, cells] = time

    def lay_sand(self, axle: int, start: float, end: float, mass: float) -> None:
        """Sand of a mass [kg] falls evenly in front of an axle that moved from `start` to `end` [m]."""
        cells, shares = self._between(start, end)
        self.sand[axle, cells] += shares * mass

    def _around(self, position):
        """The two cells next to a position and their weights."""
        place = (position - self.begin) / self.cell - 0.5
        last = len(self.degraded) - 1
        if not -0.5 <= place <= last + 0.5:
            end = self.begin + self.cell * len(self.degraded)
            raise OffTheMap(f"position {position:g} m is off the rail map, {self.begin:g} to {end:g} m")
        left = min(max(math.floor(place), 0), max(last - 1, 0))
        share = min(max(place - left, 0.0), 1.0)
        return np.array([left, min(left + 1, last)]), np.array([1.0 - share, share])

    def _between(self, start, end):
        """The cells that a movement crosses and the share of it in each."""
        low, high = ((min(start, end) - self.begin) / self.cell, (max(start, end) - self.begin) / self.cell)
        if low < 0.0 or high > len(self.degraded):
            raise OffTheMap(f"movement from {start:g} to {end:g} m leaves the rail map")
        first, last = int(low), min(int(high), len(self.degraded) - 1)
        cells = np.arange(first, last + 1)
        if high <= low:
            return cells[:1], np.ones(1)
        covered = np.minimum(cells + 1, high) - np.maximum(cells, low)
        return cells, covered / (high - low)
