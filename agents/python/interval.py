"""Intervals that hold every result: each operation is rounded outwards by one step of a double.

Only operations that IEEE 754 rounds correctly are used (+, -, *, /, sqrt), so that every machine computes the same bits.
"""

import math
from typing import NamedTuple


def below(x: float) -> float:
    return math.nextafter(x, -math.inf)


def above(x: float) -> float:
    return math.nextafter(x, math.inf)


class Interval(NamedTuple):
    """All reals from `lower` to `upper`."""

    lower: float
    upper: float

    @staticmethod
    def of(bounds: dict) -> "Interval":
        return Interval(bounds["lower"], bounds["upper"])

    @staticmethod
    def around(middle: float, error: float) -> "Interval":
        return Interval(below(middle - error), above(middle + error))

    @property
    def mid(self) -> float:
        return 0.5 * self.lower + 0.5 * self.upper

    def __add__(self, other):
        return Interval(below(self.lower + other.lower), above(self.upper + other.upper))

    def __neg__(self):
        return Interval(-self.upper, -self.lower)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        products = [a * b for a in self for b in other]
        return Interval(below(min(products)), above(max(products)))

    def __truediv__(self, other):
        assert other.lower > 0, "only divisors above zero are needed here"
        return self * Interval(below(1 / other.upper), above(1 / other.lower))

    def __and__(self, other):
        both = Interval(max(self.lower, other.lower), min(self.upper, other.upper))
        if both.lower > both.upper:
            raise ValueError(f"nothing is in both {tuple(self)} and {tuple(other)}: a stated bound is broken")
        return both

    def __or__(self, other):
        return Interval(min(self.lower, other.lower), max(self.upper, other.upper))

    def widened(self, by: float):
        return Interval(below(self.lower - by), above(self.upper + by))

    def squared(self):
        products = [a * a for a in self]
        least = 0.0 if self.lower <= 0 <= self.upper else below(min(products))
        return Interval(least, above(max(products)))

    def root(self):
        return Interval(max(0.0, below(math.sqrt(max(0.0, self.lower)))), above(math.sqrt(max(0.0, self.upper))))


def cos_sin(angle: Interval):
    """Cosine and sine of an angle in rad.

    Those of the middle come from a series for a 64th of it, doubled six times, which is good to 1e-12; from there to
    anywhere in the interval they change by |slope| e + e²/2 at most.
    """
    middle, error = angle.mid, 0.5 * (angle.upper - angle.lower)
    part = math.remainder(middle, math.tau) / 64
    square = part * part
    cos = 1 - square / 2 * (1 - square / 12 * (1 - square / 30 * (1 - square / 56)))
    sin = part * (1 - square / 6 * (1 - square / 20 * (1 - square / 42 * (1 - square / 72))))
    for _ in range(6):
        cos, sin = cos * cos - sin * sin, 2 * sin * cos
    bend = 0.5 * error * error + 1e-12 * (1 + abs(middle))
    return Interval.around(cos, abs(sin) * error + bend), Interval.around(sin, abs(cos) * error + bend)


def contract_by_distance(position, centre, distance):
    """What is left of two boxes of points at this distance from each other, and of the distance.

    From a = p - c, `a_x² + a_y² + a_z² = d²` bounds each square by what the others leave.
    """
    apart = [p - c for p, c in zip(position, centre)]
    squares = [a.squared() for a in apart]
    x, y, z = squares
    distance = distance & (x + y + z).root()
    length = distance.squared()
    left = []
    for a, others in zip(apart, (y + z, x + z, x + y)):
        root = (length - others).root()
        ahead, behind = root.lower <= a.upper, a.lower <= -root.lower
        either_way = root if ahead and not behind else -root if behind and not ahead else root | -root
        left.append(a & either_way)
    contracted = [p & (c + a) for p, c, a in zip(position, centre, left)]
    return contracted, distance
