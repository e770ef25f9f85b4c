"""What a sampled result says: distribution, exceedance, amplitudes against frequency, one-third octaves.

A signal is two arrays of the same shape (n,): positions, ascending, in seconds or metres, and values in a unit of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

MOST_SAMPLES = 10_000_000  # that a signal is resampled to
UNEVEN = 1e-6  # relative deviation of steps from their mean up to which they count as equal


class BadSignal(Exception):
    """A signal that cannot be analysed; the text says what is wrong, where, and what to do."""


def checked(positions: ArrayLike, values: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Both as arrays (n,) of finite numbers, positions ascending."""
    positions, values = np.asarray(positions, float), np.asarray(values, float)
    if positions.shape != values.shape or positions.ndim != 1 or len(positions) < 2:
        raise BadSignal(f"{positions.shape} positions and {values.shape} values: two columns of 2 or more rows are needed")
    bad = np.flatnonzero(~(np.isfinite(positions) & np.isfinite(values)))
    if len(bad):
        raise BadSignal(f"row {bad[0] + 1}: {positions[bad[0]]}, {values[bad[0]]} are no finite numbers; cut such rows out")
    back = np.flatnonzero(np.diff(positions) <= 0.0)
    if len(back):
        i = back[0] + 1
        raise BadSignal(f"row {i + 1}: {positions[i]:g} follows {positions[i - 1]:g}; time or position must ascend")
    return positions, values


def spacing(positions: np.ndarray) -> float:
    """Distance of samples (n,), which must be equal, in the unit of the positions."""
    step = (positions[-1] - positions[0]) / (len(positions) - 1)
    worst = int(np.argmax(np.abs(np.diff(positions) / step - 1.0)))
    # Positions written with few digits deviate by their rounding.
    if abs(positions[worst + 1] - positions[worst] - step) > UNEVEN * step + 4e-16 * np.max(np.abs(positions)):
        raise BadSignal(
            f"samples are {positions[worst + 1] - positions[worst]:g} apart behind {positions[worst]:g}, on average {step:g}; "
            "spectra need equal distances: `resampled` makes them"
        )
    return step


def resampled(positions: ArrayLike, values: ArrayLike, step: float) -> tuple[np.ndarray, np.ndarray]:
    """The signal at equal distances of `step`, straight between samples: positions and values, both (m,)."""
    positions, values = checked(positions, values)
    length = positions[-1] - positions[0]
    if not length / MOST_SAMPLES <= step <= length * (1.0 + 1e-12):
        raise BadSignal(f"step = {step:g} is outside {length / MOST_SAMPLES:g} to {length:g}, the length of the signal")
    count = int(length / step * (1.0 + 1e-12)) + 1
    even = positions[0] + step * np.arange(count)
    return even, np.interp(even, positions, values)


def durations(time: np.ndarray) -> np.ndarray:
    """How long each sample stands for: half of the way to its neighbours, (n,) in the unit of the times."""
    steps = np.diff(time)
    return 0.5 * (np.append(steps, 0.0) + np.insert(steps, 0, 0.0))


@dataclass(frozen=True)
class Statistics:
    """Moments over time of a signal, its extremes, and the share of time at or below zero."""

    mean: float
    deviation: float
    skewness: float
    kurtosis: float
    least: float
    largest: float
    at_zero: float


def statistics(time: ArrayLike, values: ArrayLike) -> Statistics:
    """`Statistics`, every sample weighed by its duration; kurtosis is 3 for normal deviates."""
    time, values = checked(time, values)
    share = durations(time) / (time[-1] - time[0])
    mean = float(share @ values)
    moment = lambda power: float(share @ (values - mean) ** power)
    deviation = moment(2) ** 0.5
    shape = lambda power: moment(power) / deviation**power if deviation > 0.0 else 0.0
    zero = float(share @ (values <= 0.0))
    return Statistics(mean, deviation, shape(3), shape(4), float(values.min()), float(values.max()), zero)


def density(time: ArrayLike, values: ArrayLike, classes: int = 60, limits: tuple[float, float] | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Probability density over time: edges (classes + 1,) of equal classes and the density (classes,) [1/unit] in each; its integral is
    one.

    `limits` of the classes default to the extremes; what lies outside is left out of the classes, not of the whole.
    """
    time, values = checked(time, values)
    low, high = limits or (values.min(), values.max())
    if not high > low:
        low, high = low - 0.5, low + 0.5
    time_in, edges = np.histogram(values, classes, (low, high), weights=durations(time))
    return edges, time_in / np.diff(edges) / (time[-1] - time[0])


def exceedance(time: ArrayLike, values: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
    """Levels (n,), ascending, and the share (n,) of time in which the signal is above each [1]."""
    time, values = checked(time, values)
    order = np.argsort(values, kind="stable")
    share = durations(time)[order] / (time[-1] - time[0])
    return values[order], np.clip(1.0 - np.cumsum(share), 0.0, 1.0)


def amplitudes(positions: ArrayLike, values: ArrayLike, window: str = "flattop") -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (n // 2 + 1,) [1/unit of positions] and amplitudes of the sinusoids in a signal, in its unit, without its mean. Windows
    are those of scipy; the flat top returns the amplitude of a sine wherever it lies between two lines."""
    positions, values = checked(positions, values)
    frequency, power = scipy.signal.periodogram(values, 1.0 / spacing(positions), window, scaling="spectrum")
    once = (frequency == 0.0) | (frequency > 0.499999 / spacing(positions))  # lines that have no twin of negative frequency
    return frequency, np.sqrt(np.where(once, 1.0, 2.0) * power)


def harmonic(positions: ArrayLike, values: ArrayLike, frequency: float) -> tuple[float, float]:
    """Amplitude, in the unit of the values, and phase [rad] of `A cos(2 pi f x + phase)` of a known frequency, by least squares beside a straight line."""
    positions, values = checked(positions, values)
    x = positions - positions[0]
    terms = [np.cos(2 * np.pi * frequency * positions), -np.sin(2 * np.pi * frequency * positions), np.ones_like(x), x]
    (real, imaginary, *_), *_ = np.linalg.lstsq(np.stack(terms, axis=1), values, rcond=None)
    return float(np.hypot(real, imaginary)), float(np.arctan2(imaginary, real))


def octaves(positions: ArrayLike, values: ArrayLike, reference: float = 1.0, window: str = "hann") -> tuple[np.ndarray, np.ndarray]:
    """Levels in one-third octaves (IEC 61260-1, base ten): mid-band frequencies and 20 lg(rms/reference) [dB].

    A line at the border of two bands is shared between them. Bands of less than two lines and bands beyond half the
    sampling rate are left out. For a profile over metres, frequencies are 1/wavelength and `reference` is 1e-6 m. A signal
    that repeats exactly after its length needs no window: "boxcar".
    """
    positions, values = checked(positions, values)
    count, step = len(values), spacing(positions)
    width = 1.0 / (count * step)
    squares = width * scipy.signal.periodogram(values, 1.0 / step, window)[1]
    low, high = 10.0 * np.log10(2.0 * width), 10.0 * np.log10(0.5 / step)
    numbers = np.arange(np.floor(low), np.ceil(high) + 1.0)
    below, above = 10.0 ** (0.1 * numbers - 0.05), 10.0 ** (0.1 * numbers + 0.05)
    kept = (above - below >= 2.0 * width) & (above <= 0.5 / step * (1.0 + 1e-12))
    # Energy below a frequency, linear within the width of each line.
    edges = np.append((np.arange(len(squares)) - 0.5) * width, 0.5 / step + 0.5 * width)
    energy = np.append(0.0, np.cumsum(squares))
    total = np.interp(above[kept], edges, energy) - np.interp(below[kept], edges, energy)
    with np.errstate(divide="ignore"):
        return 10.0 ** (0.1 * numbers[kept]), 10.0 * np.log10(total / reference**2)


def of_turns(time: ArrayLike, omega: ArrayLike, velocity: ArrayLike, force: ArrayLike) -> np.ndarray:
    """Turn by turn of a wheel, an array (turns, 4): mean speed of travel [m/s], largest and smallest force [N], and share of time without
    it [1]. All arguments are (n,): time [s], omega [rad/s], velocity [m/s], force [N]."""
    time, omega = checked(time, omega)
    velocity, force = checked(time, velocity)[1], checked(time, force)[1]
    angle = scipy.integrate.cumulative_trapezoid(omega, time, initial=0.0)
    turn = np.floor(np.abs(angle) / (2.0 * np.pi)).astype(int)
    rows = []
    for number in range(turn[-1]):
        inside = turn == number
        if np.count_nonzero(inside) > 1:
            rows.append((np.abs(velocity[inside]).mean(), force[inside].max(), force[inside].min(), np.mean(force[inside] <= 0.0)))
    if not rows:
        raise BadSignal(f"the wheel turns by {abs(angle[-1]):.3g} rad only; at least one whole turn is needed")
    return np.array(rows)
