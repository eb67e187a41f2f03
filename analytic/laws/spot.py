"""What one contact adds to each quantity, over the quantity's scale, under any law of contact."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.laws.law import ContactLaw
from analytic.laws.unloading import Unloading

__all__ = ["of_spot", "of_unloading", "piece_of"]

Array = NDArray[np.float64]


def of_spot(quantity: str, law: ContactLaw, piece: int, y: Array, e: Array) -> Array:
    """What a contact of this piece of the law adds, as the piece's formula goes on beyond its ends.

    Parameters
    ----------
    quantity : str
        Its name: one of `analytic.QUANTITIES` or `analytic.LAW_QUANTITIES`.
    law : ContactLaw
        In reduced units.
    piece : int
        Which formula.
    y, e : ndarray
        Root of the penetration and modulus E*(s)/E*, of any shapes that broadcast.

    Returns
    -------
    ndarray
        In their common shape.

    Raises
    ------
    KeyError
        If there is no such quantity.
    """
    known: dict[str, Any] = {
        "load": lambda: law.load(piece, y, e),
        "area": lambda: law.radius(piece, y, e) ** 2,
        "stiffness": lambda: law.stiffness(piece, y, e),
        "contacts": lambda: np.ones(np.broadcast_shapes(np.shape(y), np.shape(e))),
        "conductance": lambda: law.radius(piece, y, e),
        "load_slope": lambda: law.slope(piece, y, e) * (2 / 3),
        "yielded": lambda: np.full(np.broadcast_shapes(np.shape(y), np.shape(e)), float(piece > 0)),
    }
    return np.asarray(known[quantity]())


def of_unloading(
    quantity: str, unloading: Unloading, piece: int, y: Array, deepest: Array, e: Array
) -> Array:
    """As `of_spot`, on the way back from `deepest`; y is the root of the penetration left to lift-off."""
    known: dict[str, Any] = {
        "load": lambda: unloading.load(piece, y, deepest, e),
        "area": lambda: unloading.radius(piece, y, deepest, e) ** 2,
        "stiffness": lambda: unloading.stiffness(piece, y, deepest, e),
        "contacts": lambda: np.ones(np.broadcast_shapes(np.shape(y), np.shape(e))),
        "conductance": lambda: unloading.radius(piece, y, deepest, e),
        "load_slope": lambda: unloading.slope(piece, y, deepest, e) * (2 / 3),
    }
    return np.asarray(known[quantity]())


def piece_of(law: ContactLaw, penetration: Array, e: Array) -> NDArray[np.int64]:
    """Which piece of the law holds at these penetrations, in the shape of both."""
    penetration, e = np.broadcast_arrays(penetration, e)
    with np.errstate(divide="ignore", over="ignore"):  # without a modulus nothing yields
        limits = law.limits(e)
    return np.asarray((limits <= penetration).sum(axis=0), dtype=np.int64)
