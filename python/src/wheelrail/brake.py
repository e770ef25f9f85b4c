"""Brake of a coach: cylinders, wheel slide protection, sanding.

A driver's demand builds up in the control pressure (`Distributor`); each axle has a cylinder behind a valve of the wheel
slide protection, which follows the control pressure, holds, or vents (`Cylinder`). `SlideProtection` sees peripheral speeds
only, as a real one does, and sets the valves.
"""

import numpy as np

from .controllers import OwnProtection, OwnSanding, Valve


class Distributor:
    """Control pressure: 95 % of the full one in `fill_time`, down to 5 % in `release_time`, linearly, after a delay."""

    def __init__(self, brake):
        self.brake, self.pressure, self.waited = brake, 0.0, 0.0

    def step(self, h, demand):
        """Pressure [Pa] after `h` [s] under a demand of 0 to 1."""
        b = self.brake
        target = demand * b.pressure
        self.waited = self.waited + h if target > 0.0 else 0.0
        if 0.0 < target and self.waited <= b.delay:
            return self.pressure
        rise, fall = 0.95 * b.pressure / b.fill_time, 0.95 * b.pressure / b.release_time
        self.pressure += float(np.clip(target - self.pressure, -fall * h, rise * h))
        return self.pressure


class Cylinder:
    """Pressure in the cylinder of an axle. Valves flow exponentially: what is left to go falls with a time constant."""

    def __init__(self, brake):
        self.brake, self.pressure, self.air = brake, 0.0, 0.0

    def step(self, h, supply, valve):
        """Pressure [Pa] after `h` [s]; `air` counts what was let in, at ambient pressure [m3]."""
        w, before = self.brake.wsp, self.pressure
        if valve is Valve.VENT:
            self.pressure *= np.exp(-h / w.vent_time)
        elif valve is Valve.APPLY or supply < self.pressure:
            self.pressure += (supply - self.pressure) * -np.expm1(-h / w.fill_time)
        self.air += self.brake.cylinder_volume * max(self.pressure - before, 0.0) / 101325.0
        return self.pressure

    def torque(self):
        """Brake torque of the axle [N m]."""
        return self.brake.torque * self.pressure / self.brake.pressure


class SlideProtection:
    """Slide and deceleration thresholds, and a reference speed from the axles themselves.

    The reference is the fastest axle, but falls no faster than `reference_deceleration` [m/s2]. An axle is vented when its
    slide exceeds `slide_high`, or when it slides more than `slide_low` and slows down faster than `deceleration`; held
    while it slides more than `slide_low`, or comes back faster than `recovery` [m/s2]; otherwise its valve follows the
    control pressure. The thresholds are shares of the reference speed, but at least `least_slide` [m/s]. Below `off_speed`
    nothing is controlled.

    When all axles slide, the reference would sink with them. So while the protection acts, one axle after the other is
    vented every `sounding` seconds until it has stopped gaining speed, at most `longest_sounding`: it rolls, and the
    reference is the speed of the train again.
    """

    def __init__(self, wsp, speeds):
        self.wsp, self.reference = wsp, max(speeds)
        self.waited, self.before = 0.0, np.array(speeds, float)
        self.valves = [Valve.APPLY] * len(speeds)
        self.since_sounding, self.sounded, self.sounding_for = 0.0, 0, None

    def step(self, h, speeds):
        """Valves after `h` [s], decided every `period`; `speeds` are peripheral [m/s]."""
        w = self.wsp
        if not w.active:
            return self.valves
        self.waited += h
        if self.waited < w.period - 1e-9:
            return self.valves
        speeds = np.array(speeds, float)
        self.reference = max(self.reference - w.reference_deceleration * self.waited, speeds.max())
        rates = (speeds - self.before) / self.waited
        self.valves = [self._decide(*pair) for pair in zip(speeds, rates)]
        self._sound(self.waited, rates)
        self.before, self.waited = speeds, 0.0
        return self.valves

    def _decide(self, speed, rate):
        """The valve of one axle from its peripheral speed [m/s] and its acceleration [m/s2]."""
        w = self.wsp
        if self.reference < w.off_speed:
            return Valve.APPLY
        slide = self.reference - speed
        low = max(w.slide_low * self.reference, w.least_slide)
        high = max(w.slide_high * self.reference, 2.0 * w.least_slide)
        returning = rate > w.recovery
        if not returning and (slide > high or (slide > low and rate < -w.deceleration)):
            return Valve.VENT
        if slide > low or (returning and slide > 0.5 * low):
            return Valve.HOLD
        return Valve.APPLY

    def _sound(self, h, rates):
        """Vents the axle whose turn it is to find the speed of the train."""
        w = self.wsp
        acting = any(valve is not Valve.APPLY for valve in self.valves)
        if self.sounding_for is None:
            self.since_sounding = self.since_sounding + h if acting else 0.0
            if self.since_sounding < w.sounding:
                return
            self.sounding_for = 0.0
        self.sounding_for += h
        rolls = self.sounding_for > 2.0 * w.vent_time and rates[self.sounded] < 0.5 * w.recovery
        if rolls or self.sounding_for > w.longest_sounding or self.reference < w.off_speed:
            self.sounded, self.sounding_for, self.since_sounding = (self.sounded + 1) % len(rates), None, 0.0
        else:
            self.valves[self.sounded] = Valve.VENT


class Sander:
    """Sand in front of chosen axles at `rate` [kg/s] per rail, above `off_speed` [m/s], in bursts.

    A burst is called for by an axle that is vented. It reaches the rail `delay` [s] later, lasts `minimum_time` [s] at least, and
    ends `run_on` [s] after the last axle was vented. Below `off_speed` it ends at once.
    """

    def __init__(self, sander):
        self.sander, self.used = sander, 0.0
        self.called, self.laid, self.calm = None, None, 0.0  # s, since the call, of the burst, since an axle was vented

    def step(self, h, speeds, valves):
        """Mass [kg] laid on each rail in front of each of the sander's axles in `h` [s]."""
        s = self.sander
        if not s.active or max(speeds) <= s.off_speed:
            self.called = self.laid = None
            return 0.0
        sliding = Valve.VENT in valves
        self.calm = 0.0 if sliding else self.calm + h
        if self.laid is None:
            self.called = (0.0 if sliding else None) if self.called is None else self.called + h
            if self.called is None or self.called < s.delay - 1e-9:
                return 0.0
            self.called, self.laid = None, 0.0
        elif self.calm > s.run_on and self.laid >= s.minimum_time - 1e-9:
            self.laid = None
            return 0.0
        self.laid += h
        self.used += 2.0 * s.rate * h * len(s.axles)
        return s.rate * h


class Brakes:
    """The brake of a coach: what a demand and the speeds of its axles make of torques and sand. Slide protection and sanding are
    those that `brake.protection` and `brake.sanding` name, or the ones of this file."""

    def __init__(self, brake, speeds, of=""):
        """`brake`: the values of its file; `speeds`: of the axles at the start [m/s]; `of` says in messages of which coach."""
        self.distributor, self.protection = Distributor(brake), SlideProtection(brake.wsp, speeds)
        self.sander = Sander(brake.sander)
        if brake.protection:
            self.protection = OwnProtection(brake.protection, brake.wsp, speeds, brake.protection_parameters, of)
        if brake.sanding:
            self.sander = OwnSanding(brake.sanding, brake.sander, brake.sanding_parameters, of)
        self.cylinders = [Cylinder(brake) for _ in speeds]
        self.valves = self.protection.valves
        self.sanded = {axle - 1 for axle in brake.sander.axles}

    def step(self, h, demand, speeds):
        """Torques [N m] after `h` [s], and the sand [kg] laid on each rail in front of each axle meanwhile."""
        supply = self.distributor.step(h, demand)
        self.valves = self.protection.step(h, speeds)
        for cylinder, valve in zip(self.cylinders, self.valves):
            cylinder.step(h, supply, valve)
        mass = self.sander.step(h, speeds, self.valves)
        sand = [mass if axle in self.sanded else 0.0 for axle in range(len(speeds))]
        return [cylinder.torque() for cylinder in self.cylinders], sand

    def air(self):
        """Air let into the cylinders so far, at ambient pressure [m3]."""
        return sum(cylinder.air for cylinder in self.cylinders)
