"""How far down the asperities of a scene may feel the mean plane: farther than its nominal separations."""

import math

import numpy as np

from analytic import InteractingModel
from mcgw.scene.fields import Fields
from mcgw.scene.theory import model_of

__all__ = ["lowest_felt"]

_MARGIN = 12.0  # standard deviations of a surface's own balance
_ROUNDED = 16.0  # so that cells do not hang on the last digit of an integral


def lowest_felt(scene: Fields) -> float:
    """The lowest effective separation that hardly a surface goes below, a multiple of 1/16."""
    theory = model_of(scene)
    assert isinstance(theory, InteractingModel)
    h = np.array(min(scene.separations))
    margin = _MARGIN * float(theory.std("effective_separation", h))
    return math.floor(_ROUNDED * (float(theory.effective(h)) - margin)) / _ROUNDED
