"""Forty exact laws against drawn surfaces.

Some of `exact_law_grid` that have few asperities. A surface is drawn as its touching asperities: their
number, their heights by inversion, what they add. Shares beyond quantiles at 1e-1 to 1e-4 are binomial.
"""

from dataclasses import replace

import numpy as np

import analytic
from oracles.exact_law_grid import laws

SHARES = np.array([1e-1, 1e-2, 1e-3, 1e-4])
AT_ONCE = 2_000_000


def some():
    """40 laws with up to 3000 asperities, spread over all of each number in turn."""
    few = [[each for each in laws() if each[0][3] == n] for n in (100, 1000, 3000)]
    return [few[k % 3][len(few[k % 3]) * k // 40] for k in range(40)]


def drawn(model, h, surfaces, seed, quantity="load"):
    """Sums over random surfaces, in the unit of the quantity."""
    rng, n = np.random.default_rng(seed), round(model.number)
    rule, added = model.asperities(quantity, h)
    share, found = float(model.heights.sf(np.array(h))), np.zeros(surfaces)
    size = max(1, int(AT_ONCE / max(1.0, n * share)))
    for first in range(0, surfaces, size):
        m = min(size, surfaces - first)
        counts = rng.poisson(n * share, m) if model.count == "poisson" else rng.binomial(n, share, m)
        s = model.heights.isf(share * (1 - rng.random(counts.sum())))
        one = added(replace(rule, heights=np.maximum(s, np.nextafter(h, 9e9)), probabilities=0 * s))
        found[first : first + m] = np.bincount(np.repeat(np.arange(m), counts), one, m)
    return found * analytic.quantity_of(quantity).scale(model.surface)


def scores(model, h, surfaces, seed, quantity="load", of=None):
    """Of the numbers of drawn surfaces beyond quantiles; nan where a value has a probability of its own.

    The law is that of another model `of`, if one is given.
    """
    law, values = (of or model).distribution(quantity, h), drawn(model, h, surfaces, seed, quantity)
    found = []
    for x, beyond in ((law.isf(SHARES), np.greater), (law.ppf(SHARES), np.less_equal)):
        for y, share in zip(x, SHARES, strict=True):
            p = float(law.sf(y) if beyond is np.greater else law.cdf(y))
            seen = np.count_nonzero(beyond(values, y + 1e-12 * abs(y) * (beyond is np.greater)))
            known = abs(p / share - 1) < 1e-3
            found.append((seen - surfaces * p) / np.sqrt(surfaces * p * (1 - p)) if known else np.nan)
    return np.array(found)
