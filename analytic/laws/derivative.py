"""Derivatives of formulas that take complex numbers: exact to the last digit, as nothing is subtracted."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["derivative", "slope_in_root"]

Array = NDArray[np.float64]

_STEP = 1e-30  # of the variable, into the complex plane


def derivative(formula: Callable[[Any], Any], x: Array) -> Array:
    """``d formula/dx`` where x is not 0."""
    step = _STEP * np.abs(x)
    return np.asarray(np.imag(formula(x + 1j * step)) / step)


def slope_in_root(formula: Callable[[Any], Any], y: Array) -> Array:
    """``d formula/d(y^2)`` where y is not 0."""
    return derivative(formula, y) / (2 * np.asarray(y))
