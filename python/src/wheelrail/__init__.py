"""Python side of wheelrail.fmu: wheels by name, runs and records, rails that remember, a coach that brakes."""

from .fmu import Fmu, Refused, Wheel
from .records import celsius, load, save, table
from .runs import simulate
from .team import Team
from .warn import WheelrailWarning

__all__ = ["Fmu", "Refused", "Team", "Wheel", "WheelrailWarning", "celsius", "load", "save", "simulate", "table"]
__version__ = "0.9.0"
