"""Controllers of one's own: named in own_brake.json and own_controllers.json, found beside these files.

What such a class must have, in full: `wheelrail.controllers`. Units are SI.
"""


class OneThreshold:
    """Slide protection with one threshold: vents above it, holds while an axle comes back, applies otherwise."""

    def __init__(self, wsp, speeds, threshold=0.1):
        self.wsp, self.threshold, self.before = wsp, threshold, speeds
        self.reference = max(speeds)  # m/s, recorded as the column reference_speed

    def step(self, h, speeds):
        """A valve per axle: "apply", "hold" or "vent"."""
        fall = self.wsp.reference_deceleration * h
        self.reference = max(max(speeds), self.reference - fall)
        returning = [now > before for now, before in zip(speeds, self.before)]
        self.before = speeds
        if self.reference < self.wsp.off_speed:
            return ["apply"] * len(speeds)
        slides = [1.0 - speed / self.reference for speed in speeds]
        return [
            "vent" if slide > self.threshold else "hold" if back and slide > 0.02 else "apply"
            for slide, back in zip(slides, returning)
        ]


class SandAtSpeed:
    """Sanding: as much per metre at every speed, while any axle is vented."""

    def __init__(self, sander, per_metre=4e-4):
        self.sander, self.per_metre = sander, per_metre

    def step(self, h, speeds, valves):
        """Sand [kg/s] on each rail in front of each of the sander's axles."""
        sliding = any(valve.name == "VENT" for valve in valves)
        return min(self.per_metre * max(speeds), self.sander.rate) if sliding else 0.0


class SoftStop:
    """Driver: the scenario's demand, and half of it below `soft_speed`, so that the stop ends without a jerk."""

    def __init__(self, scenario, soft_speed=3.0):
        self.demand, self.soft_speed = scenario.demand, soft_speed

    def step(self, h, time, speed, travelled):
        """Share of the full brake pressure."""
        return self.demand if speed > self.soft_speed else 0.5 * self.demand
