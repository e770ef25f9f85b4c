"""Python side of wheelrail.fmu: wheels by name, runs and records, rails that remember, a coach that brakes.

What is done is logged below the name `wheelrail` (`logging`): files that are written and runs at level INFO, and all that an FMU
says by its status.
"""

import logging

from . import damage
from .fmu import Fmu, Refused, Wheel
from .grid import patch
from .operating import steady
from .records import celsius, load, save, table
from .runs import simulate
from .team import Team
from .warn import WheelrailWarning

__all__ = ["Fmu", "Refused", "Team", "Wheel", "WheelrailWarning", "celsius", "damage", "load", "patch", "save", "simulate", "steady", "table"]
__version__ = "0.24.0"
logging.getLogger(__name__).addHandler(logging.NullHandler())  # silent unless the user asks
