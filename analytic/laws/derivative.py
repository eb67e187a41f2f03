"""Derivatives of formulas that take complex numbers: exact to the last digit, as nothing is subtracted."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["derivative", "slope_in_root"]

Array = NDArray[np.float64]

_STEP = 1e-30  # of the variable, into the complex plane
_NEXT_TO_0 = 1e-60  # stands for 0: cubes of it, times a step, are still numbers


def derivative(formula: Callable[[Any], Any], x: Array) -> Array:
    """``d formula/dx`` where x is not 0."""
    step = _STEP * np.abs(x)
    return np.asarray(np.imag(formula(x + 1j * step)) / step)


def slope_in_root(formula: Callable[[Any], Any], y: Array) -> Array:
    """``d formula/d(y^2)``, at y = 0 its limit."""
    y = np.where(y == 0, _NEXT_TO_0, y)
    return derivative(formula, y) / (2 * y)
