"""Normal contact of two equal elastic half-spaces on rectangular tiles that see each other.

Every tile has a pressure `p >= 0` and sinks under all of them (Love 1929): `A p = approach lean - gap` where it carries something. The
pressures are found by conjugate gradients in the manner of Polonsky and Keer (Wear 231 (1999) 206-219); products `A p` are convolutions.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

CLOSE = 1e-5  # of the approach, by which surfaces in contact may miss each other
ROUNDS = 400


class Pressed(NamedTuple):
    """Two bodies pressed together."""

    pressure: np.ndarray  # of each tile [Pa]
    approach: float  # m


class Tiles:
    """Tiles of `step` [m, m] in as many rows and columns as `shape` says. `modulus` [Pa] is that of contact, E/(2 (1 - nu^2)) of equal bodies."""

    def __init__(self, shape: tuple[int, int], step: tuple[float, float], modulus: float) -> None:
        self.shape, self.step = shape, step
        self.padded = tuple(2 * count for count in shape)
        corners = [(np.fft.fftfreq(count, 1.0 / count)[:, None] + [-0.5, 0.5]) * size for count, size in zip(self.padded, step)]
        signs = [1, -1, -1, 1]
        x, y = ([part[:, k] for k in (1, 0)] for part in corners)
        places = ((x[i][:, None], y[j][None, :]) for i in (0, 1) for j in (0, 1))
        kernel = sum(sign * _corner(a, b) for sign, (a, b) in zip(signs, places)) / (np.pi * modulus)
        self.kernel = np.fft.rfft2(kernel)

    def sunk(self, pressure: np.ndarray) -> np.ndarray:
        """How deep both surfaces together give way under pressures [Pa] on the tiles [m]."""
        spectrum = np.fft.rfft2(pressure, self.padded) * self.kernel
        return np.fft.irfft2(spectrum, self.padded)[: self.shape[0], : self.shape[1]]

    def press(self, gap: np.ndarray, lean: np.ndarray, load: float) -> Pressed:
        """Presses bodies with a `gap` [m] together until their pressures sum up to `load` [N]; `lean` [1] is the share of the approach
        that closes the gap at each column of tiles, the cosine of its angle to the direction of approach."""
        lean = np.broadcast_to(lean, self.shape)
        area = self.step[0] * self.step[1]
        pressure = np.where(gap < np.quantile(gap, 0.3), 1.0, 0.0)
        pressure = pressure * load / (area * np.sum(pressure))
        force = area * np.sum(pressure * lean)
        for _ in range(6):  # the force in the direction of approach that belongs to the load
            pressure, approach = self._held(gap, lean, force, pressure)
            found = area * np.sum(pressure)
            if abs(found / load - 1.0) < 1e-6:
                break
            force *= load / found
        return Pressed(pressure * load / found, approach)

    def _held(self, gap, lean, force, pressure):
        """Pressures with a force [N] in the direction of approach, and the approach, from other pressures on."""
        area = self.step[0] * self.step[1]
        move, before, restart = np.zeros(self.shape), 1.0, True
        for _ in range(ROUNDS):
            touching = pressure > 0.0
            share = np.where(touching, lean, 0.0)
            weight = np.sum(share * lean)
            open_ = self.sunk(pressure) + gap
            approach = float(np.sum(share * open_) / weight)
            open_ -= approach * lean
            rest = np.where(touching, open_, 0.0)
            if np.max(np.abs(rest)) < CLOSE * abs(approach) and not np.any(open_[~touching] < -CLOSE * abs(approach)):
                break
            now = np.sum(rest**2)
            move = np.where(touching, rest + (0.0 if restart else now / before) * move, 0.0)
            before, restart = now, False
            answer = self.sunk(move)
            answer -= np.sum(share * answer) / weight * lean
            length = np.sum(rest * move) / np.sum(np.where(touching, answer, 0.0) * move)
            pressure = np.maximum(pressure - length * move, 0.0)
            late = (pressure == 0.0) & (open_ < 0.0)
            if np.any(late):
                restart = True
                pressure = np.where(late, -length * open_, pressure)
            pressure *= force / (area * np.sum(pressure * lean))
        return pressure, approach


def _corner(x, y):
    """The integral of 1/r over the rectangle between the origin and a corner."""
    with np.errstate(divide="ignore", invalid="ignore"):
        first, second = x * np.arcsinh(y / np.abs(x)), y * np.arcsinh(x / np.abs(y))
    return np.where(x == 0.0, 0.0, first) + np.where(y == 0.0, 0.0, second)
