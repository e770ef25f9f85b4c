"""A smooth curve through samples: the height of a rail, whose straight pieces would ring a wheel on its contact at each sample.

It is the cubic spline, level at both ends and beyond: two samples at one position are a step, with a spline on either side.
"""

import numpy as np
import scipy  # whose modules are loaded when they are used


class Spline:
    """Cubic spline through heights at positions that ascend; both are sequences of equal length."""

    def __init__(self, positions, heights):
        x, y = np.asarray(positions, float), np.asarray(heights, float)
        after = np.flatnonzero(np.diff(x) == 0.0) + 1
        self.steps = x[after]
        self.pieces = [_piece(*part) for part in zip(np.split(x, after), np.split(y, after))]

    def at(self, positions, before=False):
        """Heights at positions and their derivatives; at a step those behind it, or `before` it."""
        positions = np.asarray(positions, float)
        piece = np.searchsorted(self.steps, positions, side="left" if before else "right")
        heights, slopes = np.empty(positions.shape), np.empty(positions.shape)
        for k in np.unique(piece):
            here, spline = piece == k, self.pieces[k]
            place = np.clip(positions[here], spline.x[0], spline.x[-1])
            heights[here], slopes[here] = spline(place), spline(place, 1)
        return heights, slopes


def _piece(x, y):
    """The spline between two steps; a single sample is level."""
    x, y = (x, y) if len(x) > 1 else (np.append(x, x + 1.0), np.append(y, y))
    return scipy.interpolate.CubicSpline(x, y, bc_type="clamped")
