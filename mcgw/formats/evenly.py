"""Some of many rows, evenly, with the first and the last."""

import numpy as np
from numpy.typing import NDArray

__all__ = ["evenly"]


def evenly(n: int, most: int) -> NDArray[np.int64]:
    """Numbers of at most so many of `n` rows, rising."""
    return np.unique(np.linspace(0, n - 1, min(n, most)).round().astype(np.int64))
