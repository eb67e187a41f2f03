"""Types of the arrays that everything here takes and gives, and how frozen objects come to hold theirs."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Ints = NDArray[np.int64]
Marks = NDArray[np.bool_]


def hold(frozen: Any, **values: Any) -> None:
    """Give fields of a frozen object their values while it is made: the one place that can."""
    for name, value in values.items():
        object.__setattr__(frozen, name, value)
