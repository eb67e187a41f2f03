"""How far down asperities may feel the mean plane: farther than its nominal separations."""

import math
from typing import Any

import numpy as np

__all__ = ["lowest_felt"]

_MARGIN = 12.0  # standard deviations of a surface's own balance
_ROUNDED = 16.0  # so that cells do not hang on the last digit of an integral


def lowest_felt(theory: Any, lowest: float) -> float:
    """The lowest effective separation that hardly a surface goes below, a multiple of 1/16.

    Parameters
    ----------
    theory : InteractingModel
        Of the scene.
    lowest : float
        The lowest nominal separation, d/sigma.
    """
    h = np.array(lowest)
    margin = _MARGIN * float(theory.std("effective_separation", h))
    return math.floor(_ROUNDED * (float(theory.effective(h)) - margin)) / _ROUNDED
