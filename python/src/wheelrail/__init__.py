"""Python side of wheelrail.fmu: wheels by name, rails that remember, a coach that brakes."""

from .fmu import Fmu, Refused, Wheel
from .team import Team

__all__ = ["Fmu", "Refused", "Team", "Wheel"]
__version__ = "0.3.0"
