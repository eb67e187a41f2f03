"""Arrays that begin with a line of the cache."""

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["aligned"]

_LINE = 8  # words


def aligned(*shape: int) -> NDArray[np.float64]:
    """Room for numbers, not filled: a full vector that straddles two lines takes twice as long to load.

    Parameters
    ----------
    *shape : int
        Of the array.

    Returns
    -------
    ndarray
        In C order, its first word at the beginning of a line.
    """
    words = math.prod(shape)
    room = np.empty(words + _LINE)
    start = -(room.ctypes.data // room.itemsize) % _LINE
    return room[start : start + words].reshape(shape)
