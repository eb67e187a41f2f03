"""Gradings in a unit of their own, where their values would leave double precision.

``exp(-s)``, the softest exponential grading, underflows from s = 745 on, its integrals over that of the
homogeneous surface do not.
"""

import numpy as np
from numpy.typing import NDArray

from analytic.gradings import Clipped, Exponential, Grading, Squared

__all__ = ["log_unit", "over_unit"]

Array = NDArray[np.float64]

_ORDINARY = 345.0  # logarithms up to here, 1e150, need no unit
_LARGEST = 700.0


def log_unit(grading: Grading, h: Array) -> Array:
    """Logarithm of a unit for the grading at heights next to `h`: 0 where it is of an ordinary size."""
    with np.errstate(divide="ignore"):
        match grading:
            case Exponential(gamma=gamma):
                size = np.maximum(np.log(np.abs(gamma)), np.log(np.abs(gamma - 1)) - h)
            case Clipped(grading=inner):
                return log_unit(inner, h)
            case Squared(grading=inner):
                return 2 * log_unit(inner, h)
            case _:
                size = np.log(np.maximum(np.abs(grading(h)), np.abs(grading(h + 1 / (1 + np.abs(h))))))
                size = np.where(np.isfinite(size), np.clip(size, -_LARGEST, _LARGEST), 0.0)
    return np.asarray(np.where(np.abs(size) > _ORDINARY, size, 0.0))


def over_unit(grading: Grading, s: Array, unit: Array) -> Array:
    """Values of a grading divided by ``exp(unit)``, which need not be a number of double precision."""
    if not unit.any():
        return grading(s)
    match grading:
        case Exponential(gamma=gamma):
            with np.errstate(divide="ignore"):
                tips, slope = np.log(np.abs([gamma, gamma - 1]))
            tip = np.sign(gamma) * np.exp(tips - unit)
            return np.asarray(tip - np.sign(gamma - 1) * np.exp(slope - unit - s))
        case Clipped(grading=inner):
            return np.maximum(over_unit(inner, s, unit), 0.0)
        case Squared(grading=inner):
            return np.square(over_unit(inner, s, unit / 2))
    return np.asarray(grading(s) * np.exp(-unit))
