"""Gauss-Legendre on [0, 1], made once."""

from functools import cache

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray

__all__ = ["gauss_legendre"]

Array = NDArray[np.float64]


@cache
def gauss_legendre(nodes: int) -> tuple[Array, Array]:
    """Points and weights, read-only."""
    x, w = leggauss(nodes)
    x, w = (1 + x) / 2, w / 2
    x.flags.writeable = w.flags.writeable = False
    return x, w
