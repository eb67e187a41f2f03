"""Arrays that begin with a line of the cache."""

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["aligned"]

_LINE = 8  # words


def aligned(*shape: int) -> NDArray[np.float64]:
    """Memory for an array of this shape, not filled: its first word begins a line of the cache.

    A full vector that straddles two lines takes twice as long to load.
    """
    words = math.prod(shape)
    memory = np.empty(words + _LINE)
    start = -(memory.ctypes.data // memory.itemsize) % _LINE
    return memory[start : start + words].reshape(shape)
