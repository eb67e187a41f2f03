"""Whether one sub-area carries the whole map."""

from dataclasses import dataclass

import numpy as np

from mcgw.maps.summit_sums import SUMS, SummitSums

__all__ = ["Alone", "alone_of"]

_HALF = 0.5


@dataclass(frozen=True, slots=True)
class Alone:
    """A sub-area without which a mean square is less than half.

    Parameters
    ----------
    moment : {"m0", "m2", "m4"}
        Of heights, slopes or second derivatives.
    left : float
        Share of it that is left without this sub-area.
    column, row : int
        Which sub-area, from 0.
    across : int
        Sub-areas along each axis.
    """

    moment: str
    left: float
    column: int
    row: int
    across: int


def alone_of(counted: SummitSums) -> Alone | None:
    """The sub-area that most of a mean square stands on, if there is one; m4 before m2 before m0."""
    sums = dict(zip(SUMS, counted.sums, strict=True))
    points = sums["points"]
    if np.count_nonzero(points) == 1:
        return None
    mean = sums["z"].sum() / points.sum()
    squares = {
        "m4": sums["bend"],
        "m2": sums["slope_x"] + sums["slope_y"],
        "m0": sums["z2"] - 2 * mean * sums["z"] + mean**2 * points,
    }
    across = round(counted.parts**0.5)
    for moment, square in squares.items():
        part = int(np.argmax(square))
        rest = (square.sum() - square[part]) / (points.sum() - points[part])
        left = float(rest / (square.sum() / points.sum()))
        if left < _HALF:
            return Alone(moment, left, part % across, part // across, across)
    return None
