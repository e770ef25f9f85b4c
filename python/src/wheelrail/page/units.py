"""Units that a person reads: kN, MPa, mm, °C and the like, from the SI units that the FMU gives."""

import numpy as np

from ..units import ZERO_CELSIUS

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

# Unit in SI: (from this size on, label, factor), the largest first.
SCALES = {
    "N": ((1e3, "kN", 1e-3), (0.0, "N", 1.0)),
    "N.m": ((1e3, "kN·m", 1e-3), (0.0, "N·m", 1.0)),
    "N.s": ((1e3, "kN·s", 1e-3), (0.0, "N·s", 1.0)),
    "N.m.s": ((1e3, "kN·m·s", 1e-3), (0.0, "N·m·s", 1.0)),
    "Pa": ((1e5, "MPa", 1e-6), (0.0, "Pa", 1.0)),
    "W": ((1e3, "kW", 1e-3), (0.0, "W", 1.0)),
    "J": ((1e6, "MJ", 1e-6), (1e3, "kJ", 1e-3), (0.0, "J", 1.0)),
    "J/m": ((1e3, "kJ/m", 1e-3), (0.0, "J/m", 1.0)),
    "m": ((0.5, "m", 1.0), (1e-4, "mm", 1e3), (0.0, "µm", 1e6)),
    "m/s": ((0.5, "m/s", 1.0), (1e-4, "mm/s", 1e3), (0.0, "µm/s", 1e6)),
    "kg": ((1.0, "kg", 1.0), (1e-3, "g", 1e3), (0.0, "mg", 1e6)),
    "kg/m": ((1.0, "kg/m", 1.0), (0.0, "mg/m", 1e6)),
    "m3": ((0.0, "l", 1e3),),
}
PLAIN = {"m/s2": "m/s²", "rad/s2": "rad/s²", "kg.m2": "kg·m²", "1": "", "": "", "degC": "°C", "W/(m2.K)": "W/(m²·K)"}
# Units of what varies over a patch; other quantities of it are states.
SHAPES = {"pressure": "Pa", "shear": "Pa", "slip": "m/s", "temperature_wheel": "K", "temperature_rail": "K"}


class Shown:
    """How a quantity is shown: `label` of the unit, and values as factor × value + offset."""

    def __init__(self, label, factor=1.0, offset=0.0):
        self.label, self.factor, self.offset = label, factor, offset

    def __call__(self, values):
        return self.factor * np.asarray(values, float) + self.offset

    def text(self, value):
        """A value with its unit."""
        text = number(float(self(value)))
        return text if text == "–" else f"{text} {self.label}".strip()


PERCENT, KMH, CELSIUS = Shown("%", 100.0), Shown("km/h", 3.6), Shown("°C", 1.0, -ZERO_CELSIUS)


def shown(unit, *arrays):
    """The `Shown` of quantities in a unit of SI, chosen by the size of their values."""
    if unit == "K":
        return CELSIUS
    if unit in SCALES:
        size = max((float(np.abs(a[np.isfinite(a)]).max(initial=0.0)) for a in map(np.asarray, arrays)), default=0.0)
        fits = (lambda s: size >= s[0]) if size else (lambda s: s[2] == 1.0)
        scale = next(filter(fits, SCALES[unit]), SCALES[unit][-1])
        return Shown(scale[1], scale[2])
    return Shown(PLAIN.get(unit, unit.replace(".", "·")))


def number(value, digits=4):
    """A number with so many digits, an exponent only where it must be; a dash for one that is unknown."""
    if not np.isfinite(value):
        return "–"
    if value == 0.0:
        return "0"
    if 1e-3 <= abs(value) < 1e6:
        decimals = max(0, digits - 1 - int(np.floor(np.log10(abs(value)))))
        text = f"{value:,.{decimals}f}"
        return (text.rstrip("0").rstrip(".") if "." in text else text).replace(",", "\u2009").replace("-", "−")
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"{mantissa}·10{str(int(exponent)).translate(RAISED)}".replace("-", "−")
