"""Where a quadrature over the heights must be cut so that terms of a contact law are smooth in between."""

import numpy as np
from numpy.typing import NDArray

from analytic.gradings import Grading
from analytic.laws.law import ContactLaw
from analytic.laws.regimes import regimes_of
from analytic.towards import NEAREST, towards

__all__ = ["cuts_of"]

Array = NDArray[np.float64]


def cuts_of(law: ContactLaw, grading: Grading, separations: Array, low: float, high: float) -> list[float]:
    """Ends of the law's regimes, and heights that shrink towards every separation from the first of them.

    Beyond its first end a law is made of powers of s - h, which are smooth on pieces that are no wider than
    some times their distance from h. Below it, it is smooth in the root of s - h, or shrinking goes on.

    Parameters
    ----------
    law : ContactLaw
        In reduced units.
    grading : Grading
        E*(s)/E*.
    separations : ndarray
        Reduced separations.
    low, high : float
        Range of reduced heights.

    Returns
    -------
    list of float
        In no order, some perhaps outside the range.
    """
    regimes = regimes_of(law, grading, separations, low, high)
    first = np.flatnonzero(np.diff(regimes.separation, prepend=-1))
    cuts: list[float] = regimes.limits.tolist()
    for i in first:
        h = float(separations[regimes.separation[i]])
        smooth = law.root and regimes.piece[i] == 0
        cuts += towards(h, min(law.finest, regimes.high[i] - h if smooth else NEAREST))
    return cuts
