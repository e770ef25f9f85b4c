"""Times of communication points: the numbers that a person writes.

Sums of steps in floating point miss them: 9 steps of .001 s are .009000000000000001 s. Who looks a time up, or lays two runs over each
other, means .009 s. A time and a step are therefore what their shortest decimals say, or a simple fraction such as a third, and are
added as such.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

DIGITS = 17  # characters of a decimal that a person may have written; a float that is none has more
SIMPLE = 10**6  # largest denominator of a fraction that is meant by such a float


@lru_cache(16)
def meant(number: float) -> Fraction:
    """What a float stands for."""
    text = repr(number)
    simple = Fraction(number).limit_denominator(SIMPLE) if len(text) > DIGITS else None
    return simple if simple is not None and float(simple) == number else Fraction(text)


def at(count: int, step: float) -> float:
    """Time [s] after `count` steps of `step` [s]."""
    return float(count * meant(float(step)))


def after(time: float, step: float) -> float:
    """Time [s] of a step of `step` [s] that begins at `time` [s]."""
    return float(meant(float(time)) + meant(float(step)))
