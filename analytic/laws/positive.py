"""Whether a constant of a law is a finite number above 0."""

import math
from numbers import Real
from typing import Any

__all__ = ["is_positive"]


def is_positive(value: Any) -> bool:
    """False also for texts, which only scene files read."""
    return isinstance(value, Real) and 0 < float(value) < math.inf
