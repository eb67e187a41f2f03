"""NumPy's own files of real numbers, opened without trust."""

import os
import warnings
from pathlib import Path
from tokenize import TokenError
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from mcgw.errors import StoreError
from mcgw.formats.plain_file import open_regular

__all__ = ["open_npy"]

_UNSOUND = (EOFError, KeyError, MemoryError, OverflowError, SyntaxError, TokenError, TypeError, ValueError)
_HEADERS = {(1, 0): np.lib.format.read_array_header_1_0, (2, 0): np.lib.format.read_array_header_2_0}


def open_npy(path: Path) -> NDArray[Any]:
    """Map integers or floats of any shape into memory, read-only; nothing is allocated or unpickled.

    Raises
    ------
    ValueError
        If the file cannot be read, is damaged, or holds anything else.
    """
    try:
        with os.fdopen(open_regular(path), "rb") as file, warnings.catch_warnings():
            warnings.simplefilter("ignore")  # a header in the style of Python 2 is as good
            version = np.lib.format.read_magic(file)
            shape, by_columns, dtype = _HEADERS[version](file)
            if dtype.kind not in "fiu":
                raise ValueError("its numbers are not real")
            order: Literal["F", "C"] = "F" if by_columns else "C"
            return np.memmap(file, dtype, "r", file.tell(), shape, order)
    except StoreError:
        raise
    except _UNSOUND as error:
        reason = (str(error).splitlines() or ["damaged"])[0]
        raise ValueError(f"{path}: is not a sound .npy file: {reason}") from None
