"""A slide protection that is an FMU of FMI 2.0, for "protection": "fmu_protection:FmuProtection" in the brake's file.

`speed[1]` … `speed[4]` [m/s] are inputs of the FMU, `valve[1]` … `valve[4]` its outputs: 0 apply, 1 hold, 2 vent.
"""

import fmpy


class FmuProtection:
    """Steps the FMU `file` with the speeds of the axles."""

    def __init__(self, wsp, speeds, file="protection.fmu"):
        description = fmpy.read_model_description(file)
        self.number = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.fmu, self.time = fmpy.instantiate_fmu(fmpy.extract(file), description, "CoSimulation"), 0.0
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def step(self, h, speeds):
        """A valve per axle."""
        axles = range(1, len(speeds) + 1)
        self.fmu.setReal([self.number[f"speed[{axle}]"] for axle in axles], speeds)
        self.fmu.doStep(self.time, h)
        self.time += h
        return [("apply", "hold", "vent")[round(valve)] for valve in self.fmu.getReal([self.number[f"valve[{axle}]"] for axle in axles])]
