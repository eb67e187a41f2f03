"""Types of the arrays that everything here takes and gives, and how frozen objects come to hold theirs."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]
Ints = NDArray[np.int64]
Marks = NDArray[np.bool_]


def hold(frozen: Any, **values: Any) -> None:
    """Give fields of a frozen object their values while it is made: the one place that can."""
    for name, value in values.items():
        object.__setattr__(frozen, name, value)


def some_of(values: Any, which: NDArray[Any]) -> Any:
    """Return some of the values, by a mask of any shape that they broadcast to, or by numbers.

    Numbers beyond the last begin again with the first; a single value is that of all.
    """
    if np.ndim(values) == 0:
        return values
    if which.dtype == np.bool_:
        return np.asarray(np.broadcast_to(values, which.shape)[which])
    return np.asarray(values[which % len(values)])
