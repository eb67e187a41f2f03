"""Whether surfaces that were drawn again are those of an ensemble."""

import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.ensemble import Ensemble

__all__ = ["check_same"]

_SAME = 1e-9  # relative difference of sums that are only rounded differently


def check_same(
    ensemble: Ensemble, first: int, sums: dict[str, NDArray[np.float64]], columns: slice = slice(None)
) -> None:
    """Compare sums of surfaces from `first` on, at some columns, with those that the ensemble holds.

    Raises
    ------
    ValueError
        If they differ.
    """
    for name, values in sums.items():
        held = ensemble.sums.read(name, first, first + len(values))[:, columns]
        same = max(_SAME, 2 * ensemble.scene.accuracy)
        if not np.allclose(values, held, rtol=same, atol=same * float(np.abs(held).mean())):
            raise ValueError(
                f"the surfaces cannot be drawn again: their {name} differs (another version of "
                'mcgw, or a run that is not finished); simulate them with keep = "moments"'
            )
