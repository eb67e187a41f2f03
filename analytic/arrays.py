"""Types of arrays, how frozen objects come to hold their values, and numbers that must be positive."""

import math
from numbers import Real
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


def is_positive(value: Any) -> bool:
    """Tell whether a value is a finite number > 0; texts, which only scene files read, are none."""
    return isinstance(value, Real) and 0 < float(value) < math.inf


def check_positive(unit: str, **values: Any) -> None:
    """Refuse values that are no finite numbers > 0."""
    for name, value in values.items():
        if value is not None and not is_positive(value):
            raise ValueError(f"{name} = {value!r}: give a finite number > 0{unit and f', in {unit}'}")
