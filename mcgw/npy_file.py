"""NumPy's own files of real numbers, opened without trust."""

import warnings
from pathlib import Path
from tokenize import TokenError
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["open_npy"]


def open_npy(path: Path) -> NDArray[Any]:
    """Map an array of real numbers into memory; nothing is allocated or unpickled.

    Parameters
    ----------
    path : Path
        A ``.npy`` file.

    Returns
    -------
    ndarray
        Integers or floats of any shape, read-only.

    Raises
    ------
    ValueError
        If it is damaged, or holds anything else.
    OSError
        If it cannot be read.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a header in the style of Python 2 is as good
            array = np.load(path, mmap_mode="r", allow_pickle=False)
    except (EOFError, MemoryError, OverflowError, SyntaxError, TokenError, TypeError, ValueError) as error:
        reason = (str(error).splitlines() or ["damaged"])[0]
        raise ValueError(f"{path}: is no sound .npy file: {reason}") from None
    if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiu":
        raise ValueError(f"{path}: holds no array of real numbers")
    return array
