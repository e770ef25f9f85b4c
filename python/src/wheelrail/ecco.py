"""Step control by the energy that a coupling creates; no step is repeated.

Sadjina, Kyllingstad, Skjong and Pedersen, Energy conservation and power bonds in co-simulations: non-iterative adaptive
step size control and error estimation, Engineering with Computers 33 (2017) 607-620. A power bond joins two sides by an
effort e (force, moment) and a flow f (velocity, angular velocity) whose product is the power between them. Sides that step
with what they know of each other do not agree about it. The energy

    dE = int (e_B f_B - e_A f_A) dt                                                             [J]     (1)

that B takes over a step beyond what A gives is created by the coupling. It is known as soon as the step is done, and sets
the next one:

    eps = sqrt(mean of (dE/(E_0 + r |E|))^2 over the bonds)                                     [1]     (2)
    h'  = s h eps^-(k_I + k_P) eps_before^k_P,     k_I = 0.3/p, k_P = 0.4/p                     [s]     (3)

with E, the energy that passes the bond in the step, the energy E_0 and the share r of it that are tolerated, a safety
factor s, and p, the power of h with which dE falls. (3) is the PI controller of Gustafsson, Lundh and Soederlind (BIT 28
(1988) 270-287).

A force that both sides do not agree about creates energy in proportion to a velocity, so that (1) depends on who looks on
unless momentum is kept. Where both ends of a suspension feel the same force, as in `wheelrail.train`, momentum is kept, and
the bond to take is that between what its ends feel and what it is, with the rate of its elongation as flow: `Suspension`.

What (3) cannot know is an event that comes: a step that has grown while nothing happened jumps over the standstill, and
that one step spoils the result. Its time is easily foreseen: `next` keeps steps below a share of a horizon (added here).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

LEAST = 1e-6  # eps: what falls below says nothing


def work(h, effort, flow):
    """Integral of effort times flow over a step of `h` [s]; values at its beginning, its middle and its end: Simpson's rule,
    or at beginning and end: both linear between them [J]."""
    if len(effort) == 3:
        return h / 6.0 * (effort[0] * flow[0] + 4.0 * effort[1] * flow[1] + effort[2] * flow[2])
    (a, b), (c, d) = effort, flow
    return h / 6.0 * (2.0 * a * c + a * d + b * c + 2.0 * b * d)


class Bond(NamedTuple):
    """What a bond did in a step [J]."""

    created: float  # by the coupling, equation (1); negative: lost
    passed: float  # from one side to the other


def bond(h, given, taken):
    """A `Bond` from the (efforts, flows) of the side that gives and of the one that takes, as `work` has them."""
    passed = work(h, *given)
    return Bond(work(h, *taken) - passed, passed)


@dataclass(frozen=True)
class Suspension:
    """A spring and a damper between two bodies that step apart [N/m, N s/m]."""

    stiffness: float
    damping: float

    def force(self, elongation, rate):
        """Force that shortens it [N]: elongation [m] and its rate [m/s]."""
        return self.stiffness * elongation + self.damping * rate

    def course(self, h, before, after):
        """Elongations and rates at beginning, middle and end of a step, from pairs of both at its ends: a cubic."""
        (u, w), (v, z) = before, after
        middle = 0.5 * (u + v) + 0.125 * h * (w - z)
        return (u, middle, v), (w, 1.5 * (v - u) / h - 0.25 * (w + z), z)

    def residual(self, h, before, after, felt):
        """The `Bond` of a step in which both ends `felt` a force that changed linearly between a pair of values [N], while
        (elongation, rate) went from `before` to `after`."""
        elongation, rate = self.course(h, before, after)
        force = [self.force(*pair) for pair in zip(elongation, rate)]
        return bond(h, ((felt[0], 0.5 * (felt[0] + felt[1]), felt[1]), rate), (force, rate))

    def dissipated(self, h, before, after):
        """Energy that the damper takes in a step [J]."""
        rate = self.course(h, before, after)[1]
        return work(h, [self.damping * w for w in rate], rate)


class StepControl:
    """Equations (2) and (3): steps [s] between `smallest` and `largest` for an `energy` [J] and a `share` [1] of what passes
    the bond that a step may create."""

    def __init__(self, energy, order, smallest, largest, share=0.0, safety=0.8, change=(0.2, 1.5), ahead=0.1):
        """`order` is p of (3), `change` the range of h'/h, `ahead` the share of the horizon that a step may take."""
        if not (energy > 0.0 and order > 0.0 and 0.0 < smallest <= largest and share >= 0.0):
            raise ValueError(
                f"energy = {energy!r} J, order = {order!r}, steps = {smallest!r} to {largest!r} s, share = {share!r}: "
                "energy, order and steps must be positive, share at least 0"
            )
        self.energy, self.share, self.safety, self.change, self.ahead = energy, share, safety, change, ahead
        self.smallest, self.largest = smallest, largest
        self.integral, self.proportional = 0.3 / order, 0.4 / order
        self.before = 1.0

    def error(self, bonds):
        """Equation (2)."""
        return float(np.sqrt(np.mean([(b.created / (self.energy + self.share * abs(b.passed))) ** 2 for b in bonds])))

    def next(self, h, bonds, horizon=np.inf):
        """The step after one of `h` [s] in which the bonds did what they did; `horizon` [s] is the time to the next event that
        the master foresees."""
        error = max(self.error(bonds), LEAST)
        factor = self.safety * error ** -(self.integral + self.proportional) * self.before**self.proportional
        self.before = error
        wanted = min(h * float(np.clip(factor, *self.change)), self.ahead * horizon)
        return float(np.clip(wanted, self.smallest, self.largest))
