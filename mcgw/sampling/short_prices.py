"""What asperities cost where less than the last digit is asked (`mcgw.sampling.short_sums`).

Found by ``runs/bench/prices.py --short`` on one core, in asperities that give ten moments of 32-bit uniforms.
"""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from mcgw.sampling.few_bits import bits_for
from mcgw.sampling.spacing import EXACTLY, Pricing

__all__ = ["PLAIN", "ROOTED", "of_bits", "short_price", "short_pricing"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_CELL = 290.0
_WORDS = {32: 0.83, 16: 0.67, 8: 0.49}  # a uniform of so many bits, and its first five moments
PLAIN, ROOTED = (5, 8, 10, 12, 16), (0, 4, 6, 11)
# Up to so many plain moments (rows) and rooted ones (columns) cost so much; beyond, five more as below.
_MOMENTS = np.array(
    [
        [0.00, 0.39, 0.70, 1.34],
        [0.13, 0.42, 0.72, 1.31],
        [0.25, 0.60, 0.69, 1.27],
        [0.41, 0.96, 0.91, 1.46],
        [0.67, 1.28, 1.34, 1.79],
    ]
)
_FIVE_MORE, _FIVE_ROOTS_MORE = 0.33, 0.6
_FEWEST_DIGITS = 0.3  # fewer would be no moment at all


def short_pricing(accuracy: float, asked: float) -> Pricing:
    """Prices for series of this accuracy, and uniforms of as few bits as what is `asked` allows."""
    digits = EXACTLY.digits - np.log10(accuracy / 1e-13)
    asperity = partial(short_price, accuracy=asked)
    return Pricing(float(digits), _CELL, asperity, fewest=_FEWEST_DIGITS)


def short_price(plain: Array, rooted: Array, expected: Array, *, accuracy: float) -> Array:
    """Price of an asperity in cells that give so many moments and hold so many of them."""
    return of_bits(plain, rooted, bits_for(expected, accuracy))


def of_bits(plain: Array | Ints, rooted: Array | Ints, bits: Ints) -> Array:
    """Price of an asperity of uniforms of so many bits."""
    word = np.select([bits == 8, bits == 16], [_WORDS[8], _WORDS[16]], _WORDS[32])
    row, more = _place(plain, PLAIN)
    column, more_roots = _place(rooted, ROOTED)
    return np.asarray(word + _MOMENTS[row, column] + _FIVE_MORE * more + _FIVE_ROOTS_MORE * more_roots)


def _place(moments: Array | Ints, known: tuple[int, ...]) -> tuple[Ints, Array]:
    """Where so many stand among those whose price is known, and how many fives there are beyond."""
    place = np.minimum(np.searchsorted(known, moments), len(known) - 1)
    return np.asarray(place), np.ceil(np.clip(moments - np.array(known[-1]), 0, 100) / 5)
