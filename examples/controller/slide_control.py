"""The brake of slide_control.c in Python, for the package PythonFMU, whose command `pythonfmu build -f slide_control.py` packs it."""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

CYCLE, TIME_CONSTANT = 0.01, 0.15  # s
SLIDE_TO_VENT, SLIDE_TO_APPLY, OFF = 0.15, 0.08, 1.0  # 1, 1, m/s: below it the brake only applies


class slide_control(Fmi2Slave):  # noqa: N801: the name of the FMU
    """Speeds of the vehicle and of the wheel in, strength of the brake out."""

    def __init__(self, **arguments):
        super().__init__(**arguments)
        self.velocity, self.omega, self.demand, self.radius, self.torque = 0.0, 0.0, 8000.0, 0.46, 0.0
        self.until, self.valve = 0.0, "apply"
        for name in ("velocity", "omega"):
            self.register_variable(Real(name, causality=Fmi2Causality.input))
        for name in ("demand", "radius"):
            self.register_variable(Real(name, causality=Fmi2Causality.parameter, variability=Fmi2Variability.fixed))
        self.register_variable(Real("torque", causality=Fmi2Causality.output))

    def choice(self):
        """What the valve does until the next cycle."""
        slide = 1.0 - abs(self.radius * self.omega) / max(abs(self.velocity), 1e-3)
        if abs(self.velocity) < OFF or slide < SLIDE_TO_APPLY:
            return "apply"
        return "vent" if slide > SLIDE_TO_VENT else "hold"

    def do_step(self, current_time, step_size):
        """Moves on by a communication step, in parts that end with a cycle."""
        while step_size > 1e-9:
            if self.until < 1e-9:
                self.valve, self.until = self.choice(), CYCLE
            part, target = min(step_size, self.until), self.demand if self.valve == "apply" else 0.0
            if self.valve != "hold":
                self.torque = target + (self.torque - target) * math.exp(-part / TIME_CONSTANT)
            step_size, self.until = step_size - part, self.until - part
        return True
