"""Uniforms of 16 or 8 bits: two or four of a word of the generator, where they tell asperities well apart.

They are the centres of ``M = 2^bits`` equal intervals of (0, 1). What they change in the law of a surface,
for n asperities of a cell whose quantities are smooth functions of u, or the root of u times such a one:

============  ==========================================================================================
mean          of the root off by the share ``0.0914 M^(-3/2)`` (the midpoint rule, by zeta(-1/2)); of a
              smooth function by less than ``2 M^-2``, where its series falls as those of contact laws
variance      of the root off by 18 times the change of ``(E sqrt(u))^2``, so the share
              ``1.46 M^(-3/2)``; of u by ``M^-2``
distribution  has steps: sums of n alike lie 1/M apart with a density of at most ``sqrt(2/n)`` (K. Ball,
              "Cube slicing in R^n", 1986), so that a step has at most the probability
              ``sqrt(2/n)/M``, and nowhere is more than half of it wrong
============  ==========================================================================================

These are bounds for a surface: its variance comes mostly from the numbers in the cells, and other cells
smooth the steps.
"""

from typing import Any, NamedTuple

import numpy as np
from numba import int64, uint64
from numpy.typing import NDArray

from mcgw.machine.compiling import njit
from mcgw.sampling.lanes import number
from mcgw.sampling.philox import AT_ONCE, CELLS, centred, philox, stream_of

__all__ = ["LatticeError", "bits_for", "few_bit_uniforms", "lattice_error", "spread"]

Array = NDArray[np.float64]
Ints = NDArray[np.int64]

_SHARE = 0.5  # of what is asked that each of the three errors may take
_LOW, _32 = uint64(0xFFFFFFFF), uint64(32)


class LatticeError(NamedTuple):
    """What so few bits change: relative errors of a cell's mean and variance; distance of distributions."""

    mean: Array
    variance: Array
    distribution: Array

    @property
    def largest(self) -> Array:
        """Of the three."""
        return np.maximum(np.maximum(self.mean, self.variance), self.distribution)


def lattice_error(bits: int, asperities: Array) -> LatticeError:
    """Bounds for cells of so many asperities (see above).

    Parameters
    ----------
    bits : int
        Of a uniform.
    asperities : ndarray
        Expected in each cell.

    Returns
    -------
    LatticeError
        Each of the shape of `asperities`.
    """
    m, n = 2.0**bits, np.asarray(np.maximum(asperities, 1.0))
    alike = np.ones_like(n)
    root = m**-1.5
    return LatticeError(alike * (0.0914 * root + 2 / m**2), alike * (1.46 * root), np.sqrt(0.5 / n) / m)


def bits_for(asperities: Array, accuracy: float) -> Ints:
    """The fewest bits of a uniform whose errors stay below half of what is asked.

    Parameters
    ----------
    asperities : ndarray
        Expected in each cell.
    accuracy : float
        What is asked.

    Returns
    -------
    ndarray of int
        8, 16 or 32 for each cell.
    """
    bits = np.full(np.shape(asperities), 32)
    for fewer in (16, 8):
        bits[lattice_error(fewer, asperities).largest <= _SHARE * accuracy] = fewer
    return bits


def few_bit_uniforms(seed: int, surface: int, cell: int, n: int, bits: int) -> Array:
    """First `n` uniforms of a cell, as `mcgw.sampling.philox.uniforms` gives those of 32 bits.

    Parameters
    ----------
    seed, surface, cell : int
        Whose.
    n : int
        How many.
    bits : int
        Of each: 8, 16 or 32.

    Returns
    -------
    ndarray
        Shape (n,); never 0 or 1.
    """
    x = np.empty(n + AT_ONCE * 32 // 8)
    spread(x, np.uint64(seed), surface, cell, 0, n, bits)
    return (1 + x[:n]) / 2


@njit(nogil=True, cache=True, inline="always")
def _half(word: Any, k: Any) -> Any:
    """Give x = 2u - 1 for the lower or upper 16 bits of a word; exact (`philox` does the same with 32)."""
    twice = (word << uint64(1) if k == 0 else word >> uint64(15)) & uint64(0x1FFFE)
    return number(int64(twice | uint64(0x4230000000000001))) - (2.0**36 + 1.0)


@njit(nogil=True, cache=True, inline="always")
def _byte(word: Any, k: Any) -> Any:
    """Give x = 2u - 1 for one of the four bytes of a word; exact."""
    twice = (word << uint64(1) if k == 0 else word >> uint64(8 * k - 1)) & uint64(0x1FE)
    return number(int64(twice | uint64(0x42B0000000000001))) - (2.0**44 + 1.0)


@njit(nogil=True, cache=True)
def _halves(out: Any, seed: Any, surface: Any, cell: Any, first: Any, n: Any) -> None:
    """Uniforms of 16 bits, 128 at a time."""
    c2, c3, k0, k1 = stream_of(seed, CELLS, surface)
    for group in range((n + 127) // 128):
        block, at = uint64(first // 8 + 16 * group), 128 * group
        c0, c1 = block & _LOW, uint64(cell) | ((block >> _32) << uint64(20))
        for i in range(16):
            w0, w1, w2, w3 = philox(c0 + uint64(i), c1, c2, c3, k0, k1)
            out[at + i], out[at + 16 + i] = _half(w0, 0), _half(w0, 1)
            out[at + 32 + i], out[at + 48 + i] = _half(w1, 0), _half(w1, 1)
            out[at + 64 + i], out[at + 80 + i] = _half(w2, 0), _half(w2, 1)
            out[at + 96 + i], out[at + 112 + i] = _half(w3, 0), _half(w3, 1)


@njit(nogil=True, cache=True)
def _bytes(out: Any, seed: Any, surface: Any, cell: Any, first: Any, n: Any) -> None:
    """Uniforms of 8 bits, 256 at a time."""
    c2, c3, k0, k1 = stream_of(seed, CELLS, surface)
    for group in range((n + 255) // 256):
        block, at = uint64(first // 16 + 16 * group), 256 * group
        c0, c1 = block & _LOW, uint64(cell) | ((block >> _32) << uint64(20))
        for i in range(16):
            w0, w1, w2, w3 = philox(c0 + uint64(i), c1, c2, c3, k0, k1)
            out[at + i], out[at + 16 + i] = _byte(w0, 0), _byte(w0, 1)
            out[at + 32 + i], out[at + 48 + i] = _byte(w0, 2), _byte(w0, 3)
            out[at + 64 + i], out[at + 80 + i] = _byte(w1, 0), _byte(w1, 1)
            out[at + 96 + i], out[at + 112 + i] = _byte(w1, 2), _byte(w1, 3)
            out[at + 128 + i], out[at + 144 + i] = _byte(w2, 0), _byte(w2, 1)
            out[at + 160 + i], out[at + 176 + i] = _byte(w2, 2), _byte(w2, 3)
            out[at + 192 + i], out[at + 208 + i] = _byte(w3, 0), _byte(w3, 1)
            out[at + 224 + i], out[at + 240 + i] = _byte(w3, 2), _byte(w3, 3)


@njit(nogil=True, cache=True)
def spread(out: Any, seed: Any, surface: Any, cell: Any, first: Any, n: Any, bits: Any) -> None:
    """Uniforms `first` ... of a cell as x = 2u - 1 into ``out``, `first` a multiple of 256.

    `out` must have room for as many as are made together.
    """
    if bits == 8:
        _bytes(out, seed, uint64(surface), cell, first, n)
    elif bits == 16:
        _halves(out, seed, uint64(surface), cell, first, n)
    else:
        centred(out, seed, CELLS, surface, cell, first, n)
