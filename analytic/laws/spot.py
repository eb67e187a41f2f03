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
    return _added(quantity, law, piece, y, e)


def of_unloading(
    quantity: str, unloading: Unloading, piece: int, y: Array, deepest: Array, e: Array
) -> Array:
    """As `of_spot`, on the way back from `deepest`; y is the root of the penetration left to lift-off."""
    return _added(quantity, unloading, piece, y, deepest, e)


def _added(quantity: str, formulas: Any, piece: int, *at: Array) -> Array:
    """A quantity by the formulas of load, radius, stiffness and slope, on either way."""
    shape = np.broadcast_shapes(*map(np.shape, at))
    known: dict[str, Any] = {
        "load": lambda: formulas.load(piece, *at),
        "area": lambda: formulas.radius(piece, *at) ** 2,
        "stiffness": lambda: formulas.stiffness(piece, *at),
        "contacts": lambda: np.ones(shape),
        "conductance": lambda: formulas.radius(piece, *at),
        "load_slope": lambda: formulas.slope(piece, *at) * (2 / 3),
        "yielded": lambda: np.full(shape, float(piece > 0)),
    }
    return np.asarray(known[quantity]())


def piece_of(law: ContactLaw, penetration: Array, e: Array) -> NDArray[np.int64]:
    """Which piece of the law holds at these penetrations, in the shape of both."""
    penetration, e = np.broadcast_arrays(penetration, e)
    with np.errstate(divide="ignore", over="ignore"):  # without a modulus nothing yields
        limits = law.limits(e)
    return np.asarray((limits <= penetration).sum(axis=0), dtype=np.int64)
