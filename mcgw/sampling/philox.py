"""Philox4x32-10: the counter-based generator all draws come from.

Salmon, Moraes, Dror and Shaw, "Parallel random numbers: as easy as 1, 2, 3" (SC11). A word is a pure
function of (seed, surface, cell, index): no state, so any thread may compute any piece, in any order.

The key is the seed. The counter is laid out as

======  ==========================================================
word    contents
======  ==========================================================
c0      number of the four-word block, low 32 bits
c1      cell (low 20 bits), high 12 bits of the block number
c2      surface, low 32 bits
c3      surface, high 16 bits; purpose of the stream (high 16 bits)
======  ==========================================================

Blocks are taken 16 at a time, so that a vector unit runs over them: word 64 g + 16 w + i of a
stream is word w of block 16 g + i.
"""

from typing import Any

import numpy as np
from numba import uint64
from numpy.typing import NDArray

from mcgw.machine.compiling import njit

AT_ONCE = 64  # words that are made together

# Purposes: streams of the same surface that must not overlap.
CELLS, TAIL, EXTRAS, MOMENTS, REST, POSITIONS, RADII, RADII_LOW = range(8)

_M0, _M1 = uint64(0xD2511F53), uint64(0xCD9E8D57)
_W0, _W1 = uint64(0x9E3779B9), uint64(0xBB67AE85)
_LOW, _32 = uint64(0xFFFFFFFF), uint64(32)
_UNIT = 2.0**-31
# The words of the numbers from 2^20 on: their last digit is 2^-32, half of what tells two uniforms apart.
_BASE = 2.0**20
_WORD_OF_BASE = uint64(np.float64(_BASE).view(np.uint64))


@njit(cache=True, inline="always")
def philox(c0: Any, c1: Any, c2: Any, c3: Any, k0: Any, k1: Any) -> Any:
    """Ten rounds: counter and key to four words, all 32-bit values in uint64.

    High halves are dropped only where they would count: a vector unit multiplies low halves anyway.
    """
    for _ in range(10):
        p0, p1 = _M0 * (c0 & _LOW), _M1 * (c2 & _LOW)
        c0, c1, c2, c3 = (p1 >> _32) ^ c1 ^ k0, p1, (p0 >> _32) ^ c3 ^ k1, p0
        k0, k1 = k0 + _W0, k1 + _W1
    return c0 & _LOW, c1 & _LOW, c2 & _LOW, c3 & _LOW


@njit(cache=True, inline="always")
def _to_centred(word: Any) -> Any:
    """Give x = 2u - 1 for u at the centre of interval `word` of 2^32; exact.

    Written into the digits of a number that is larger by 1 + 2^20, which costs less than to convert it.
    """
    return np.uint64(word + word | _WORD_OF_BASE | uint64(1)).view(np.float64) - (_BASE + 1.0)


@njit(cache=True, inline="always")
def stream_of(seed: Any, purpose: Any, surface: Any) -> Any:
    """Counter words c2, c3 and key of a stream."""
    return surface & _LOW, (surface >> _32) | (uint64(purpose) << uint64(16)), seed & _LOW, seed >> _32


@njit(cache=True, inline="always")
def made_for(n: Any) -> Any:
    """How many words are written where `n` are asked for: whole groups."""
    return (n + AT_ONCE - 1) // AT_ONCE * AT_ONCE


@njit(cache=True)
def centred(out: Any, seed: Any, purpose: Any, surface: Any, cell: Any, first: Any, n: Any) -> None:
    """Uniforms `first` ... of a stream as x = 2u - 1 into ``out``, `first` a multiple of AT_ONCE.

    `out` must have room for `made_for(n)` of them.
    """
    seed, surface = uint64(seed), uint64(surface)
    c2, c3, k0, k1 = stream_of(seed, purpose, surface)
    for group in range(made_for(n) // AT_ONCE):
        block = uint64(first // 4 + 16 * group)
        c0, c1 = block & _LOW, uint64(cell) | ((block >> _32) << uint64(20))
        at = AT_ONCE * group
        for i in range(16):
            w0, w1, w2, w3 = philox(c0 + uint64(i), c1, c2, c3, k0, k1)
            out[at + i] = _to_centred(w0)
            out[at + 16 + i] = _to_centred(w1)
            out[at + 32 + i] = _to_centred(w2)
            out[at + 48 + i] = _to_centred(w3)


def uniforms(seed: int, purpose: int, surface: int, cell: int, n: int) -> NDArray[np.float64]:
    """First `n` uniforms of a stream, at the centres of 2^32 equal intervals of (0, 1).

    Parameters
    ----------
    seed : int
        0 to 2^64 - 1.
    purpose : int
        One of this module's constants.
    surface, cell : int
        Numbers of the surface (below 2^48) and of the cell (below 2^20).
    n : int
        How many.

    Returns
    -------
    ndarray
        Shape (n,); never 0 or 1.
    """
    x = np.empty(made_for(n))
    centred(x, np.uint64(seed), purpose, surface, cell, 0, n)
    return (1 + x[:n]) / 2
