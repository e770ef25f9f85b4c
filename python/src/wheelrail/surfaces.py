"""Closed forms for irregular surfaces: contact filter, corrugation, flats, kinks. SI units, forces of the whole wheel.

Arguments that may be arrays give arrays of their shape.
"""

from __future__ import annotations

import numpy as np
import scipy
from numpy.typing import ArrayLike

# Contact filter of CNOSSOS-EU for 100 kN and a wheel of 920 mm: wavelength [m] and level [dB]. Directive (EU) 2015/996
# as amended by (EU) 2021/1226, Table G-2.
CNOSSOS = (
    (0.1, -0.3), (0.08, -0.6), (0.063, -1.0), (0.05, -1.8), (0.04, -3.2), (0.0315, -5.4), (0.025, -8.7), (0.02, -12.2),
)  # fmt: skip
# First zero of J0 over 2 pi: the wavelength of the first null is the half-width over this.
FIRST_NULL = 2.404825557695773 / (2.0 * np.pi)
# Limit of rail roughness of EN ISO 3095:2013 [dB re 1e-6 m] by number of the one-third octave, 10 lg(wavelength/1 m):
# as in the profiles of the FMU (Directive (EU) 2015/996 as amended by (EU) 2021/1226, Table G-1, network E).
EN_ISO_3095 = dict(
    zip(
        range(3, -32, -1),
        (17.1,) * 8
        + (15.0, 13.0, 11.0, 9.0, 7.0, 4.9, 2.9, 0.9, -1.1, -3.2, -5.0, -5.6, -6.2, -6.8, -7.4, -8.0, -8.6, -9.2, -9.8)
        + (-10.4, -11.0, -11.6, -12.2, -12.8, -13.4, -14.0, -14.0),
    )
)


def contact_filter(half_width: float, wavelength: ArrayLike) -> np.ndarray:
    """Share [1] of a sinusoid of a wavelength [m] that a Hertzian line contact of this half-width [m] feels, of first order: J0(2 pi a/lambda)."""
    return scipy.special.j0(2.0 * np.pi * half_width / np.asarray(wavelength, float))


def contact_filter_level(half_width: float, wavelength: ArrayLike) -> np.ndarray:
    """Level [dB] of `contact_filter`, arguments in metres."""
    with np.errstate(divide="ignore"):
        return 20.0 * np.log10(np.abs(contact_filter(half_width, wavelength)))


def cnossos_filter(wavelength: ArrayLike) -> np.ndarray:
    """Contact filter of CNOSSOS-EU [dB], between the entries of its table by the logarithm of the wavelength."""
    lengths, levels = np.array(CNOSSOS[::-1]).T
    wavelength = np.asarray(wavelength, float)
    inside = (wavelength >= lengths[0]) & (wavelength <= lengths[-1])
    return np.where(inside, np.interp(np.log(wavelength), np.log(lengths), levels), np.nan)


def corrugation_force(
    speed: ArrayLike,
    amplitude: float,
    wavelength: float,
    half_width: float,
    stiffness: float,
    mass: float,
    retardation: float = 0.0,
    damper: float = 0.0,
) -> np.ndarray:
    """Amplitude of the force [N] of a mass that rolls on its contact spring over a sinusoid.

    `speed` [m/s], `amplitude` [m], `wavelength` [m], `half_width` [m], `stiffness` K [N/m], `mass` m [kg], `retardation` [s] of the
    spring, `damper` c [N s/m] that holds the mass: `A J0 |K* M/(K* - M)|` with `K* = K (1 + i w retardation)` and `M = m w2 - i w c`: first order in the amplitude, rail on a fixed base.
    """
    omega = 2.0 * np.pi * np.asarray(speed, float) / wavelength
    spring, inertia = stiffness * (1.0 + 1j * omega * retardation), mass * omega**2 - 1j * omega * damper
    return amplitude * np.abs(contact_filter(half_width, wavelength) * spring * inertia / (spring - inertia))


def flat_depth(length: ArrayLike, radius: float, shape: str = "fresh") -> np.ndarray:
    """Depth [m] of a wheel flat of a length [m] on a radius [m]: of the chord `r (1 - cos)`, close to L2/8r, or of a rounded one, L2/16r."""
    if shape not in ("fresh", "rounded"):
        raise ValueError(f"shape = {shape!r} is neither fresh nor rounded")
    fresh = radius * (1.0 - np.sqrt(1.0 - (0.5 * np.asarray(length) / radius) ** 2))
    return fresh if shape == "fresh" else np.asarray(length) ** 2 / (16.0 * radius)


def kink_force(speed: ArrayLike, angle: float, stiffness: float, mass: float) -> np.ndarray:
    """Additional force [N] at a kink of the path, at a speed [m/s], with an angle [rad], a stiffness [N/m] and a mass [kg]: `v angle sqrt(K m)`, a mass on its contact spring that changes direction.

    The P1 force of a dipped joint on a rigid track (Jenkins 1974) with the angle between both ends; of a wheel that follows a
    fresh flat of length L, with the angle L/r.
    """
    return np.asarray(speed) * angle * np.sqrt(stiffness * mass)
