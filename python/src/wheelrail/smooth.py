"""A smooth curve through samples: the height of a rail, whose straight pieces would ring a wheel on its contact at each sample.

It is the cubic spline, level at both ends and beyond: two samples at one position are a step, with a spline on either side.
"""

import numpy as np


class Spline:
    """Cubic spline through heights at positions that ascend; both are sequences of equal length."""

    def __init__(self, positions, heights):
        self.x, self.y = np.asarray(positions, float), np.asarray(heights, float)
        steps = np.flatnonzero(np.diff(self.x) == 0.0) + 1
        pieces = zip(np.split(self.x, steps), np.split(self.y, steps))
        self.slopes = np.concatenate([_slopes(x, y) for x, y in pieces])

    def at(self, positions, before=False):
        """Heights at positions and their derivatives; at a step those behind it, or `before` it."""
        positions = np.asarray(positions, float)
        end = np.searchsorted(self.x, positions, side="left" if before else "right")
        inside = (end > 0) & (end < len(self.x))
        if len(self.x) < 2:
            return np.full(positions.shape, self.y[0]), np.zeros(positions.shape)
        end = np.clip(end, 1, len(self.x) - 1)
        k, width = end - 1, self.x[end] - self.x[end - 1]
        width = np.where(width > 0.0, width, 1.0)
        t = np.clip((positions - self.x[k]) / width, 0.0, 1.0)
        mean, first, last = (self.y[end] - self.y[k]) / width, self.slopes[k], self.slopes[end]
        bent = t * (1.0 - t) * ((1.0 - t) * (first - mean) - t * (last - mean))
        heights = np.where(t == 1.0, self.y[end], self.y[k] + width * (t * mean + bent))
        slopes = first + t * (2.0 * (3.0 * mean - 2.0 * first - last) + 3.0 * t * (first + last - 2.0 * mean))
        outside = np.where(positions < self.x[0], self.y[0], self.y[-1])
        return np.where(inside, heights, outside), np.where(inside, slopes, 0.0)


def _slopes(x, y):
    """Derivatives at the samples: 0 at both ends, and such that the curvature is continuous between them."""
    slopes = np.zeros(len(x))
    if len(x) < 3:
        return slopes
    h, mean = np.diff(x), np.diff(y) / np.diff(x)
    right = 3.0 * (mean[1:] / h[1:] + mean[:-1] / h[:-1])
    middle, beside = 2.0 / h[:-1] + 2.0 / h[1:], 1.0 / h[1:]
    # Elimination of the tridiagonal, symmetric and dominant equations.
    for k in range(1, len(middle)):
        factor = beside[k - 1] / middle[k - 1]
        middle[k] -= factor * beside[k - 1]
        right[k] -= factor * right[k - 1]
    for k in range(len(middle) - 1, -1, -1):
        slopes[k + 1] = (right[k] - beside[k] * slopes[k + 2]) / middle[k]
    return slopes


def between(at, x, y):
    """Values `y` at ascending `x`, many of them, between which a curve is wanted at positions `at`: cubics with the slopes of differences."""
    slopes = np.gradient(y, x)
    k = np.clip(np.searchsorted(x, at) - 1, 0, len(x) - 2)
    width = x[k + 1] - x[k]
    t = (at - x[k]) / width
    mean = (y[k + 1] - y[k]) / width
    return y[k] + width * t * (mean + (1.0 - t) * ((1.0 - t) * (slopes[k] - mean) - t * (slopes[k + 1] - mean)))
