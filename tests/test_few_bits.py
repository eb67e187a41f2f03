"""Uniforms of 16 and 8 bits: words of the published generator taken apart, and what so few bits change."""

from fractions import Fraction
from math import comb, factorial

import mpmath as mp
import numpy as np
import pytest
from scipy.stats import chi2
from test_philox import KNOWN

from mcgw.sampling.few_bits import bits_for, few_bit_uniforms, lattice_error

BITS = (8, 16)
ALARM = 1e-6  # of each chi-square, seeds fixed


def philox_by_integers(counter, key):
    """Ten rounds of Philox4x32 in Python's integers, as Salmon and others print them (SC11)."""
    (c0, c1, c2, c3), (k0, k1) = counter, key
    for _ in range(10):
        p0, p1 = 0xD2511F53 * c0, 0xCD9E8D57 * c2
        c0, c1, c2, c3 = (p1 >> 32) ^ c1 ^ k0, p1 % 2**32, (p0 >> 32) ^ c3 ^ k1, p0 % 2**32
        k0, k1 = (k0 + 0x9E3779B9) % 2**32, (k1 + 0xBB67AE85) % 2**32
    return c0, c1, c2, c3


def uniforms_by_integers(seed, surface, cell, n, bits):
    """Sixteen blocks of four words at a time; of each word its lowest bits first, one value a block."""
    found = []
    for group in range(n * bits // 2048 + 1):
        blocks = [
            philox_by_integers(
                (16 * group + i, cell, surface % 2**32, surface >> 32), (seed % 2**32, seed >> 32)
            )
            for i in range(16)
        ]
        for w in range(4):
            for part in range(32 // bits):
                found += [(block[w] >> (bits * part)) % 2**bits for block in blocks]
    return [Fraction(2 * k + 1, 2 ** (bits + 1)) for k in found[:n]]


@pytest.mark.parametrize(("counter", "key", "output"), KNOWN)
def test_the_generator_by_integers_is_the_published_one(counter, key, output):
    assert philox_by_integers(counter, key) == output


@pytest.mark.parametrize("bits", [*BITS, 32])
@pytest.mark.parametrize("where", [(0, 0, 0), (2**64 - 1, 2**40 + 5, 17), (7, 3, 2**20 - 1)])
def test_uniforms_are_centres_by_the_bits_of_the_words(bits, where):
    """Exactly, for a length that ends inside a group and a word."""
    assert few_bit_uniforms(*where, 999, bits).tolist() == uniforms_by_integers(*where, 999, bits)


def chi_square(u, bits):
    """Probability of numbers in the intervals as uneven as these."""
    seen = np.bincount((u * 2**bits).astype(int), minlength=2**bits)
    expected = u.size / 2**bits
    return chi2.sf(((seen - expected) ** 2 / expected).sum(), 2**bits - 1)


@pytest.mark.parametrize("bits", BITS)
def test_every_value_comes_equally_often(bits):
    """And with a tenth of the lower half of all values moved to the upper one, they do not."""
    u = np.concatenate([few_bit_uniforms(5, surface, 3, 2**18, bits) for surface in range(16)])
    assert ALARM < chi_square(u, bits) < 1 - ALARM
    moved = u.copy()
    moved[::10][u[::10] < 0.5] += 0.5
    assert chi_square(moved, bits) < ALARM


def means(f, bits):
    """Mean and variance of a function over the lattice and over (0, 1), in fifty digits."""
    with mp.workdps(50):
        m = 2**bits
        values = [f((mp.mpf(k) + 0.5) / m) for k in range(m)]
        mean = mp.fsum(values) / m
        exact = mp.quad(f, [0, 1])
        lattice = mean, mp.fsum((v - mean) ** 2 for v in values) / m
        return lattice, (exact, mp.quad(lambda u: (f(u) - exact) ** 2, [0, 1]))


def changes(f, bits):
    """Relative changes of mean and variance, by what is bound to them: at most 1."""
    lattice, exact = means(f, bits)
    bound = lattice_error(bits, np.array(1.0))
    return [
        float(abs(a / b - 1)) / limit
        for a, b, limit in zip(lattice, exact, (bound.mean, bound.variance), strict=True)
    ]


@pytest.mark.parametrize("bits", [8, pytest.param(16, marks=pytest.mark.slow)])
def test_mean_and_variance_of_the_root_change_by_what_is_said(bits):
    """No more, and hardly less: the bounds are the leading terms of the change."""
    lattice, exact = means(mp.sqrt, bits)
    leading = 2.0 ** (-1.5 * bits)
    assert 0.97 < abs(lattice[0] / exact[0] - 1) / (0.0914 * leading) <= 1
    assert 0.97 < abs(lattice[1] / exact[1] - 1) / (1.46 * leading) <= 1


SMOOTH = {
    "u": lambda u: u,
    "as near to the root as cells are": lambda u: mp.sqrt(1 + u),
    "load, there": lambda u: (1 + u) ** mp.mpf(1.5),
    "load at its root": lambda u: u ** mp.mpf(1.5),
    "with a modulus": lambda u: (1 + u) ** mp.mpf(1.5) * (2 - mp.exp(-u)),
    "root with a modulus": lambda u: mp.sqrt(u) * (2 - mp.exp(-u)),
    "steep": lambda u: mp.exp(3 * u),
}


@pytest.mark.parametrize("f", SMOOTH.values(), ids=SMOOTH)
def test_what_asperities_add_changes_by_less(f):
    assert max(changes(f, 8)) <= 1


def test_fewer_bits_would_change_more():
    """The companion: seven bits are not within the bounds of eight."""
    lattice, exact = means(mp.sqrt, 7)
    bound = lattice_error(8, np.array(1.0))
    assert abs(lattice[0] / exact[0] - 1) > bound.mean
    assert abs(lattice[1] / exact[1] - 1) > bound.variance


def irwin_hall(n, x):
    """Distribution function of the sum of n uniforms, exactly."""
    return Fraction(sum((-1) ** k * comb(n, k) * (x - k) ** n for k in range(n + 1) if k < x), factorial(n))


def distance(n, bits):
    """Largest difference of the distribution functions of n uniforms' sum: exact on both sides of a step."""
    m, ways = 2**bits, [1]
    for _ in range(n):
        before = np.concatenate([[0], np.cumsum(np.array(ways, dtype=object))])
        longer = len(ways) + m - 1
        ways = [before[min(i + 1, len(ways))] - before[max(i + 1 - m, 0)] for i in range(longer)]
    total, below, worst = m**n, 0, Fraction(0)
    for k, number in enumerate(ways[: len(ways) // 2 + 1]):  # symmetric
        exact = irwin_hall(n, Fraction(2 * k + n, 2 * m))
        worst = max(worst, abs(exact - Fraction(below, total)), abs(exact - Fraction(below + number, total)))
        below += number
    return worst


@pytest.mark.parametrize("n", [1, 2, 3, 4, 6, 9])
def test_distribution_of_sums_is_off_by_no_more_than_half_a_step(n):
    """Sums of n uniforms of 6 bits, all exact; the bound of two is reached (K. Ball's cube, 1986)."""
    found = float(distance(n, 6) / Fraction(float(lattice_error(6, np.array(float(n))).distribution)))
    assert found <= 1 + 1e-12
    assert found > 0.7
    if n == 2:
        assert found > 1 - 1e-12


def test_bits_are_the_fewest_that_keep_half_of_what_is_asked():
    n = np.array([0.1, 3.0, 1e3, 1e6, 1e12])
    for accuracy in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8):
        bits = bits_for(n, accuracy)
        for fewer in BITS:
            enough = lattice_error(fewer, n).largest <= accuracy / 2
            assert (bits[enough] <= fewer).all()
            assert (bits[~enough] > fewer).all()
    assert set(bits_for(n, 1e-3)) == {8, 16}
    assert set(bits_for(n, 1e-13)) == {32}
