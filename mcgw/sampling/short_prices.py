"""What asperities cost where less than the last digit is asked (`mcgw.sampling.short_sums`).

Found by ``runs/bench/prices.py --short`` on one core, in asperities that give ten moments of 32-bit uniforms.
"""

from functools import partial

import numpy as np
from numpy.typing import NDArray

from mcgw.sampling.few_bits import bits_for
from mcgw.sampling.spacing import EXACTLY, Pricing

__all__ = ["of_bits", "short_price", "short_pricing"]

Array = NDArray[np.float64]

_CELL = 260.0
_WORD, _HALF, _BYTE = 0.70, 0.47, 0.27  # a uniform of 32, 16 and 8 bits
# Up to so many moments cost so much; beyond, five more as `_FIVE_MORE`.
_PLAIN = ((5, 0.18), (8, 0.25), (10, 0.33), (12, 0.47), (16, 0.62))
_ROOTED = ((0, 0.0), (4, 0.37), (6, 0.45), (11, 0.75))
_FIVE_MORE = 0.25
_FEWEST_DIGITS = 0.3  # fewer would be no moment at all


def short_pricing(accuracy: float, asked: float) -> Pricing:
    """Prices for series of this accuracy, and uniforms of as few bits as what is `asked` allows."""
    digits = EXACTLY.digits - np.log10(accuracy / 1e-13)
    asperity = partial(short_price, accuracy=asked)
    return Pricing(float(digits), _CELL, asperity, fewest=_FEWEST_DIGITS)


def short_price(plain: Array, rooted: Array, expected: Array, *, accuracy: float) -> Array:
    """Price of an asperity in cells that give so many moments and hold so many of them."""
    return of_bits(plain, rooted, bits_for(expected, accuracy))


def of_bits(plain: Array, rooted: Array, bits: NDArray[np.int64]) -> Array:
    """Price of an asperity of uniforms of so many bits."""
    word = np.select([bits == 8, bits == 16], [_BYTE, _HALF], _WORD)
    return np.asarray(word + _of_moments(plain, _PLAIN) + _of_moments(rooted, _ROOTED))


def _of_moments(moments: Array, known: tuple[tuple[int, float], ...]) -> Array:
    most, price = known[-1]
    beyond = price + _FIVE_MORE * np.ceil(np.clip(moments - most, 0, 100) / 5)
    return np.asarray(np.select([moments <= number for number, _ in known], [p for _, p in known], beyond))
