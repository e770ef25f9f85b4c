"""Inputs over time: how what a person gives is read, and what of it a communication step gets.

An input that varies is straight between its samples; a choice holds. Two samples at one time make a jump, at that time
whatever the step is: a step is divided there. What varies otherwise within a step acts as the straight line with the same
mean and the same first moment, so that no impulse is lost. Velocities and heights move to their value at the end of a step;
of those it is said how many samples are not seen. The height of a rail is a smooth curve, and has its rate at the end of a step
unless that is an input, too.
"""

from bisect import bisect_left, bisect_right
from math import ceil, floor
from numbers import Number

from .samples import samples_of
from .smooth import Spline
from .units import TIMES, agreed, beside, named
from .values import Refused, to_fmu

ROUNDING = 1e-9  # s: shorter times than this are rounding
SHORTEST = 1e-6  # s: steps are divided into no shorter ones
SEEN = 1e-6  # share of its largest value by which a value may be off the line that takes its place
UNEVEN = 1e-2  # the same of the height of a rail, off the cubic that the FMU follows
INSTANT = 1e-6  # s: distance over which a function is differentiated
FINEST = 20  # how often a step is halved to find where a function jumps
FINE = 2.5e-4  # s: a function is asked at least as often as this
MOST = 2000  # samples of a function in a step: noise has no end
PIECES = 4  # in which a function is asked at least
CLOSE = 1e-4  # share of its range in a step by which a function may be off a straight piece
HEIGHT, RATE = "rail.elevation", "rail.elevation_rate"
MOTIONS = ("drive.omega", "drive.velocity", "drive.displacement", "drive.lateral_velocity", HEIGHT, RATE)


class Constant:
    """An input that holds its value."""

    constant, end, jumps = True, 0.0, ()

    def __init__(self, value):
        self.value = value

    def at(self, time):
        """The value from `time` [s] on."""
        return self.value


class Samples:
    """An input with values at times [s]."""

    constant, seen = False, SEEN

    def __init__(self, variable, times, values):
        self.times, self.values, self.end = list(map(float, times)), values, float(times[-1])
        self.linear, self.motion = variable.type == "Real", variable.name in MOTIONS
        pairs = zip(self.times, self.times[1:], values, values[1:])
        self.jumps = [t1 for t0, t1, v0, v1 in pairs if v0 != v1 and (t0 == t1 or not self.linear)]

    def at(self, time):
        """The value from `time` [s] on."""
        return self._value(time, bisect_right(self.times, time + ROUNDING))

    def before(self, time):
        """The value up to `time` [s], another one at a jump only."""
        return self._value(time, bisect_left(self.times, time - ROUNDING))

    def _value(self, time, after):
        """The value on the piece that ends with the sample `after`."""
        if after == 0 or after == len(self.times) or not self.linear:
            return self.values[max(after - 1, 0)]
        (t0, t1), (v0, v1) = self.times[after - 1 : after + 1], self.values[after - 1 : after + 1]
        share = min(max((time - t0) / (t1 - t0), 0.0), 1.0)
        return v1 if share == 1.0 else v0 + share * (v1 - v0)

    def within(self, begin, end):
        """The jumps within a step [s]."""
        return self.jumps[bisect_right(self.jumps, begin) : bisect_left(self.jumps, end)]

    def line(self, begin, end):
        """Values at the beginning and the end of a part of a step between which the input is straight."""
        ends = self.at(begin), self.before(end)
        if not self.linear or self.motion:
            return ends
        inside = range(bisect_right(self.times, begin + ROUNDING), bisect_left(self.times, end - ROUNDING))
        points = [(self.times[k] - begin, self.values[k]) for k in inside]
        return straight([(0.0, ends[0]), *points, (end - begin, ends[1])]) if points else ends

    def rate(self, time):
        """Rate at the end of a step at `time` [s]; 0 leaves it to the FMU."""
        return 0.0

    def unseen(self, name, stop, step):
        """What a run from 0 to `stop` in steps of `step` [s] does not see of the samples, in words."""
        if self.times[0] > stop or self.end < 0.0 < stop:
            yield f"{name}: its times from {self.times[0]:g} to {self.end:g} s lie outside of the run from 0 to {stop:g} s, in which it holds"
        if self.motion and (hidden := sum(self._is_hidden(k, stop, step) for k in range(len(self.times)))):
            yield (
                f"{name}: {hidden} of {len(self.times)} samples lie within communication steps of {step:g} s and off the straight "
                "line through the ends of their step, and are not seen; take a shorter step"
            )

    def _is_hidden(self, k, stop, step):
        """True if a sample lies within a step and off the curve that the step has through its ends."""
        time = self.times[k]
        begin = step * floor((time + ROUNDING) / step)
        end = min(begin + step, stop)
        if time <= 0.0 or not begin + ROUNDING < time < end - ROUNDING:
            return False
        return abs(self._drawn(time, begin, end) - self.values[k]) > self.seen * max(map(abs, self.values))

    def _drawn(self, time, begin, end):
        """The value that a step has at `time` [s]: on the straight line through its ends."""
        low, high = self.at(begin), self.before(end)
        return low + (high - low) * (time - begin) / (end - begin)


class Heights(Samples):
    """The height of a rail, sampled over time: smooth between its samples, with rates."""

    seen = UNEVEN

    def __init__(self, variable, times, values):
        super().__init__(variable, times, values)
        self.curve = Spline(self.times, values)

    def rate(self, time):
        """Rate [m/s] up to `time` [s]."""
        return float(self.curve.at(time, before=True)[1])

    def _value(self, time, after):
        """The value on the piece that ends with the sample `after`."""
        if after == 0 or after == len(self.times):
            return self.values[max(after - 1, 0)]
        return float(self.curve.at(min(max(time, self.times[after - 1]), self.times[after]), before=True)[0])

    def _drawn(self, time, begin, end):
        """The height that a step has at `time` [s]: on the cubic through its ends."""
        heights, rates = self.line(begin, end), (self.rate(begin), self.rate(end))
        share, mean = (time - begin) / (end - begin), (heights[1] - heights[0]) / (end - begin)
        bent = share * (1.0 - share) * ((1.0 - share) * (rates[0] - mean) - share * (rates[1] - mean))
        return heights[0] + (end - begin) * (share * mean + bent)


class Function:
    """An input that is a function of the time, which is asked as often in a step as it needs to be followed."""

    constant, end = False, 0.0

    def __init__(self, variable, function, unit=None):
        self.variable, self.function, self.unit = variable, function, unit
        self.known = (None, None)

    def at(self, time):
        """The value at `time` [s]."""
        try:
            return to_fmu(self.variable, self.function(time), self.unit)
        except Refused as refused:
            raise Refused(f"at {time:g} s {refused}") from None

    def within(self, begin, end):
        """The jumps within a step [s]."""
        return self._samples(begin, end).within(begin, end)

    def line(self, begin, end):
        """Values at the beginning and the end of a part of a step between which the input is straight."""
        (first, last), samples = self.known
        samples = samples if first <= begin and end <= last else self._samples(begin, end)
        return samples.line(begin, end)

    def rate(self, time):
        """Rate up to `time` [s]: the backward difference of second order."""
        now, before, earlier = (self.at(time - k * INSTANT) for k in range(3))
        return (1.5 * now - 2.0 * before + 0.5 * earlier) / INSTANT

    def unseen(self, name, stop, step):
        """Nothing: what varies within a step is found."""
        return ()

    def _samples(self, begin, end):
        """Samples that follow the function within a step; two at one time where it jumps."""
        pieces = min(max(ceil((end - begin) / FINE), PIECES), MOST)
        points = [(time, self.at(time)) for time in (begin + (end - begin) * k / pieces for k in range(pieces))]
        points.append((end, self.at(end)))
        values = [value for _, value in points]
        off = max(CLOSE * (max(values) - min(values)), 1e-9 * max(map(abs, values)))
        found = points[:1]
        for left, right in zip(points, points[1:]):
            self._follow(left, right, off, FINEST, found)
        times, values = zip(*found)
        self.known = (begin, end), Samples(self.variable, times, list(values))
        return self.known[1]

    def _follow(self, left, right, off, depth, found):
        """Appends what follows the sample `left` up to `right`, with halves where the function is not straight."""
        (t0, v0), (t1, v1) = left, right
        middle = 0.5 * (t0 + t1)
        value = self.at(middle)
        straight_here = abs(0.5 * (v0 + v1) - value) <= off if self.variable.type == "Real" else v0 == value == v1
        if straight_here or len(found) > MOST:
            found.append(right)
        elif depth == 0:  # a jump: what is left of the step is nothing
            found += [(middle, v0), (middle, v1), right]
        else:
            self._follow(left, (middle, value), off, depth - 1, found)
            self._follow((middle, value), right, off, depth - 1, found)


def parts(courses, begin, end):
    """Ends of the parts into which a step is divided at jumps [s], `end` the last one. What jumps closer to another end than
    `SHORTEST` stays within its part."""
    ends, last = [], begin
    for jump in sorted(jump for course in courses for jump in course.within(begin, end)):
        if last + SHORTEST < jump < end - SHORTEST:
            ends.append(jump)
            last = jump
    return [*ends, end]


def straight(points):
    """Values at both ends of the straight line with the mean and the first moment of a piecewise linear course through points
    (time, value). Where the line would leave the range of the values, it is less steep."""
    length, middle = points[-1][0] - points[0][0], 0.5 * (points[0][0] + points[-1][0])
    area = moment = 0.0
    for (a, v), (b, w) in zip(points, points[1:]):
        area += 0.5 * (b - a) * (v + w)
        moment += (b - a) / 6.0 * (v * (2.0 * a + b - 3.0 * middle) + w * (a + 2.0 * b - 3.0 * middle))
    low, high = min(v for _, v in points), max(v for _, v in points)
    mean = min(max(area / length, low), high)
    most = min(mean - low, high - mean)
    half = min(max(6.0 * moment / length**2, -most), most)
    return mean - half, mean + half


def courses_of(fmu, inputs):
    """Courses of inputs by name: from constants, functions of the time, and samples in any form that `samples` knows. Names and values may
    have units beside them."""
    asked, found = {}, {}
    for text, given in inputs.items():
        name, unit = named(text, fmu.variables)
        if name in asked:
            raise Refused(f"{name} is given twice: leave one of them out")
        asked[name] = _input(fmu, name), given, unit
    for name, (variable, given, unit) in asked.items():
        if callable(given):
            found[name] = Function(variable, given, unit)
        elif is_one_value(given):
            found[name] = Constant(to_fmu(variable, given, unit))
    sampled = {name: given for name, (_, given, _) in asked.items() if name not in found}
    for name, (times, values, own) in samples_of(sampled).items():
        variable, _, unit = asked[name]
        kind, unit = Heights if name == HEIGHT else Samples, agreed(name, (unit, own))
        found[name] = kind(variable, times, [to_fmu(variable, value, unit) for value in values])
    return {name: found[name] for name in asked}


def is_one_value(given):
    """Whether an input is one value in place of a course."""
    given, _ = beside(given)
    return given is None or isinstance(given, (str, bytes, Number)) or getattr(given, "shape", None) == ()


def _input(fmu, name):
    """The variable of an input."""
    if str(name).lower() in TIMES and name not in fmu.variables:
        raise Refused(f"{name} is no input: write (times, values) for each input, or give a table, which may have a column of times")
    variable = fmu.variable(name)
    if variable.causality != "input":
        where = "give it in parameters" if variable.causality == "parameter" else "it can be recorded only"
        raise Refused(f"{name} is no input but {'an' if variable.causality[0] in 'aeiou' else 'a'} {variable.causality}: {where}")
    return variable
