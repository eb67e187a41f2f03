"""A number with its standard error and an interval, whose arms are unequal: errors are in the logarithm."""

import math
from dataclasses import dataclass
from typing import NamedTuple

__all__ = ["Spread", "Uncertain", "uncertain"]


class Uncertain(NamedTuple):
    """A positive number that a map tells.

    Parameters
    ----------
    value, error : float
        ``error/value`` is the standard error of its logarithm.
    low, high : float
        Interval that holds the truth 95 times of 100.
    """

    value: float
    error: float
    low: float
    high: float


@dataclass(frozen=True, slots=True)
class Spread:
    """How far the truth may lie from an estimate, in logarithms.

    Parameters
    ----------
    error : float
        Standard error.
    down, up : float
        How far below and above the estimate an interval of 95 % reaches.
    """

    error: float
    down: float
    up: float


def uncertain(value: float, error: float, waves: Spread) -> Uncertain:
    """Put together an error seen between sub-areas, two of which hold 95 %, and that of few long waves.

    The larger one counts: sub-areas see the short waves twice and the long ones not at all.
    """
    relative = error / value
    down, up = max(2 * relative, waves.down), max(2 * relative, waves.up)
    return Uncertain(value, value * max(relative, waves.error), value * math.exp(-down), value * _exp(up))


def _exp(x: float) -> float:
    """Infinite, where an arm has no end."""
    return math.exp(x) if x < 700 else math.inf
