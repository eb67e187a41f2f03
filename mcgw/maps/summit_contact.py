"""Summits as they are against a flat: Hertz's sums over a list of heights and radii, term by term."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["SummitContact", "summit_contact"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class SummitContact:
    """Sums over the summits that touch; arrays of shape (tiles, separations).

    Parameters
    ----------
    load, area, stiffness : ndarray
        N, m^2, N/m.
    contacts : ndarray of int
        Summits that touch.
    """

    load: Array
    area: Array
    stiffness: Array
    contacts: NDArray[np.int64]


def summit_contact(
    heights: ArrayLike,
    radii: ArrayLike,
    E_star: float,
    separations: ArrayLike,
    *,
    tile: ArrayLike | None = None,
) -> SummitContact:
    """Load, area, stiffness and number of contacts of measured summits, each a Hertzian one by itself.

    Parameters
    ----------
    heights, radii : array_like
        Of the summits, m, shape (summits,).
    E_star : float
        Composite modulus, Pa.
    separations : array_like
        Of the flat above the zero of the heights, m, shape (separations,).
    tile : array_like of int, optional
        Which tile each summit stands on, from 0; left out: all on one.

    Returns
    -------
    SummitContact
        Of each tile: the mean over them is that of the whole map over their number.

    Raises
    ------
    ValueError
        If the lists have not one length, or a radius or the modulus is not positive.

    Notes
    -----
    With the approach u = z - d: load 4/3 E* sqrt(R) u^1.5, area pi R u, stiffness 2 E* sqrt(R u)
    (Hertz 1882; the deterministic model of Greenwood and Williamson 1966, their Eqs. 8 to 10).

    Examples
    --------
    >>> found = summit_contact([1e-6, 2e-6], [1e-5, 1e-5], 1e11, [0.0, 1.5e-6])
    >>> found.contacts.tolist()
    [[2, 1]]
    """
    z, radius = np.asarray(heights, dtype=np.float64), np.asarray(radii, dtype=np.float64)
    part = np.zeros(z.shape, dtype=np.int64) if tile is None else np.asarray(tile, dtype=np.int64)
    if not (z.ndim == 1 and z.shape == radius.shape == part.shape):
        raise ValueError(f"heights {z.shape}, radii {radius.shape}, tile {part.shape}: give one list each")
    if not (np.all(radius > 0) and E_star > 0):
        raise ValueError("radii and E_star: give numbers > 0")
    tiles = int(part.max()) + 1 if part.size else 1
    separation = np.atleast_1d(np.asarray(separations, dtype=np.float64))
    sums = np.zeros((3, tiles, separation.size))
    contacts = np.zeros((tiles, separation.size), dtype=np.int64)
    for k, d in enumerate(separation):
        touch = z > d
        u, R, here = z[touch] - d, radius[touch], part[touch]
        load = 4 / 3 * E_star * np.sqrt(R) * u * np.sqrt(u)
        terms = (load, math.pi * R * u, 2 * E_star * np.sqrt(R * u))
        for total, term in zip(sums, terms, strict=True):
            total[:, k] = np.bincount(here, term, minlength=tiles)
        contacts[:, k] = np.bincount(here, minlength=tiles)
    load, area, stiffness = sums
    return SummitContact(load, area, stiffness, contacts)
