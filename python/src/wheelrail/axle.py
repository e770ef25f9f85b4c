"""An axle with two different wheels, each an FMU of its own with a patch of its own.

Each wheel is half of the axle: half of its mass and inertia, half of load, pull and brake. What makes them one is the force
and the moment between them, equal and opposite, held over a step, with which both have the same speed and angular velocity
at its end. They are found by Newton's method on repeated steps, with the derivatives of the FMUs; as they cancel, momentum
is that of the axle however well they are known. Each half bounces for itself, and the axle does not turn about its
vertical or its longitudinal direction.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from types import SimpleNamespace

import numpy as np

from .fmu import Fmu
from .warn import collected, warn
from .wheelset import Drive, FmuWheelset, Seen

ATTEMPTS = 10
SAME = 1e-7  # of the speed, by which those of both wheels differ where that is possible
APART = 1e-4  # of the speed, from which it is said that they do
CRAWL = 0.1  # m/s, the least speed to which that refers
BETWEEN = re.compile(r"drive\.(force|moment) = .* is of an unusual size")  # of the FMU, about what is between the wheels


class TwoWheels:
    """Wheelset of two wheels that differ in `parameters`, a pair of mappings, or in the friction of their rails: that of the
    right one is `right_friction` times the other's."""

    wheels = 2

    def __init__(
        self,
        fmu: Fmu,
        wheelset: SimpleNamespace,
        load: float,
        speed: float,
        damping: float,
        parameters: tuple[Mapping[str, object], Mapping[str, object]],
        right_friction: float = 1.0,
    ) -> None:
        """As of `FmuWheelset`."""
        self.radius, self.frictions = wheelset.radius, (1.0, right_friction)
        self.sides, self.between, self.attempts = [], np.zeros(2), 0  # N, N m: from the right wheel on the left one
        try:
            for side in parameters:
                self.sides.append(FmuWheelset(fmu, wheelset, load, speed, damping, side, alone=True))
        except BaseException:
            self.close()
            raise

    def step(self, h: float, drive: Drive) -> Seen:
        """Advances by `h` seconds. Warnings about the size of what is between the wheels are none of the user's."""
        before = [side.save() for side in self.sides]
        try:
            with collected() as texts:
                seen, apart = self._together(h, drive, before)
        finally:
            for side, state in zip(self.sides, before):
                side.forget(state)
        if apart > APART:
            texts.append(f"speeds of the two wheels of an axle differ by {apart:.1e} of the speed after {ATTEMPTS} attempts")
        for text in texts:
            if not BETWEEN.search(text):
                warn(text)
        return seen

    def _together(self, h, drive, before):
        """The axle after its step, and how far the speeds of its wheels are apart, over the speed."""
        change, least, best = np.zeros(2), np.inf, self.between
        for self.attempts in range(1, ATTEMPTS + 1):
            seen = [self._half(k, h, drive) for k in range(2)]
            apart = np.array([seen[1].velocity - seen[0].velocity, self.radius * (seen[1].omega - seen[0].omega)])
            scale = max(CRAWL, *(abs(value) for one in seen for value in (one.velocity, self.radius * one.omega)))
            found = np.abs(apart).max() / scale
            if found <= SAME or self.attempts == ATTEMPTS:
                return united(*seen), found
            if found < least:
                # Locked wheels do not turn whatever the moment: least squares leave it as it is.
                answers = sum(side.answers() for side in self.sides)
                least, best, change = found, self.between, np.linalg.lstsq(answers, apart, rcond=1e-9)[0]
            else:
                # Beyond a point where a wheel begins to slide, or locks, it was too far.
                change = 0.5 * change
            # Where an FMU takes other internal steps from some moment on, speeds jump there, and none makes them equal.
            self.between = best + change if self.attempts < ATTEMPTS - 1 else best
            for side, state in zip(self.sides, before):
                side.restore(state)

    def _half(self, k, h, drive):
        """A wheel after its step, as if both were like it."""
        friction = self.frictions[k] * drive.friction
        return self.sides[k].step(h, drive._replace(friction=friction), tuple((1 - 2 * k) * self.between))

    def close(self) -> None:
        """Frees the instances."""
        for side in self.sides:
            side.close()


def united(left: Seen, right: Seen) -> Seen:
    """An axle of which each wheel has been seen as if both were like it: halves of forces and energies add up, temperatures
    and depths are those of the hotter wheel."""
    means = [0.5 * (a + b) for a, b in zip(left[:8], right[:8])]
    return Seen(*means, *map(max, left[8:], right[8:]))
