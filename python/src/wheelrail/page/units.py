"""Units that a person reads: kN, MPa, mm, °C and the like, from the SI units that the FMU gives."""

import numpy as np

KELVIN = 273.15  # K at 0 °C
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


class Shown:
    """How a quantity is shown: `label` of the unit, and values as factor × value + offset."""

    def __init__(self, label, factor=1.0, offset=0.0):
        self.label, self.factor, self.offset = label, factor, offset

    def __call__(self, values):
        return self.factor * np.asarray(values, float) + self.offset

    def text(self, value):
        """A value with its unit."""
        if not np.isfinite(value):
            return "–"
        return f"{number(float(self(value)))} {self.label}".strip()


PERCENT, KMH, CELSIUS = Shown("%", 100.0), Shown("km/h", 3.6), Shown("°C", 1.0, -KELVIN)


def largest(arrays):
    """Largest finite amount of some arrays, 0 of nothing."""
    found = [np.abs(a[np.isfinite(a)]).max() for a in map(np.asarray, arrays) if np.isfinite(a).any()]
    return float(max(found, default=0.0))


def shown(unit, *arrays):
    """The `Shown` of quantities in a unit of SI, chosen by the size of their values."""
    if unit == "K":
        return CELSIUS
    if unit in SCALES:
        size = largest(arrays)
        fits = (lambda s: size >= s[0]) if size else (lambda s: s[2] == 1.0)
        scale = next(filter(fits, SCALES[unit]), SCALES[unit][-1])
        return Shown(scale[1], scale[2])
    return Shown(PLAIN.get(unit, unit.replace(".", "·")))


def number(value, digits=4):
    """A number with so many digits, an exponent only where it must be."""
    if value == 0.0:
        return "0"
    if 1e-3 <= abs(value) < 1e6:
        decimals = max(0, digits - 1 - int(np.floor(np.log10(abs(value)))))
        text = f"{value:,.{decimals}f}"
        return (text.rstrip("0").rstrip(".") if "." in text else text).replace(",", "\u2009").replace("-", "−")
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"{mantissa}·10{str(int(exponent)).translate(RAISED)}".replace("-", "−")


# Units in the first line of a CSV, in brackets: SI unit, factor, offset.
READ = {
    "°C": ("K", 1.0, KELVIN), "degC": ("K", 1.0, KELVIN), "km/h": ("m/s", 1.0 / 3.6, 0.0), "mm/s": ("m/s", 1e-3, 0.0),
    "%": ("1", 0.01, 0.0), "kN": ("N", 1e3, 0.0), "kN m": ("N.m", 1e3, 0.0), "N m": ("N.m", 1.0, 0.0), "kN·m": ("N.m", 1e3, 0.0),
    "N·m": ("N.m", 1.0, 0.0), "MPa": ("Pa", 1e6, 0.0), "kPa": ("Pa", 1e3, 0.0), "bar": ("Pa", 1e5, 0.0), "kW": ("W", 1e3, 0.0),
    "kJ": ("J", 1e3, 0.0), "MJ": ("J", 1e6, 0.0), "mm": ("m", 1e-3, 0.0), "km": ("m", 1e3, 0.0), "ms": ("s", 1e-3, 0.0),
    "l": ("m3", 1e-3, 0.0), "g": ("kg", 1e-3, 0.0), "t": ("kg", 1e3, 0.0), "rpm": ("rad/s", np.pi / 30.0, 0.0),
    "deg": ("rad", np.pi / 180.0, 0.0),
    "m³": ("m3", 1.0, 0.0), "m/s²": ("m/s2", 1.0, 0.0),
}  # fmt: skip
