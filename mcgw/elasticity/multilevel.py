"""The mean of a dear level by few solves: means of cheaper ones and of differences (Giles 2008).

    <dear> = <cheap> + <dearer - cheap on the same map> + ...

Each term has maps of its own. How many is fixed by a pilot, whose maps are not used again, so that the
estimate has no bias; its interval is Student's, with the degrees of freedom of Welch and Satterthwaite.
M. B. Giles, Oper. Res. 56 (2008) 607.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

import numpy as np
from scipy.stats import t as student

from analytic.arrays import Array

FEWEST = 4  # maps a term: fewer tell no variance


@dataclass(frozen=True)
class Design:
    """Which levels to use, on how many maps."""

    chain: tuple[int, ...]  # levels that are used, from cheap to dear
    maps: tuple[int, ...]  # of each term: the first level's mean, then differences
    cost: float  # what they are expected to cost together, in the unit of the levels' costs
    plain: float  # what the dearest level alone would cost for the same error


def terms_of(chain: tuple[int, ...]) -> list[tuple[int, ...]]:
    """Levels of each term, of which the second is taken off the first."""
    return [chain[:1], *((dear, cheap) for cheap, dear in pairwise(chain))]


def difference(values: Array) -> Array:
    """First of a term's levels, shape (maps, levels, quantities), less the second if there is one."""
    return np.asarray(values[:, 0] - values[:, 1:].sum(axis=1))


def design(pilot: Array, costs: Sequence[float], rel_err: float, solves: int | None = None) -> Design:
    """Find the chain that costs least.

    The `pilot` has the shape (maps, levels, quantities), the dearest level last; `costs` are those of one map
    at each level; `rel_err` is half the width of the 95 % interval over the mean, which no quantity is to
    exceed; or there may be so many `solves` of the dearest level.
    """
    top = pilot.shape[1] - 1
    scale = np.abs(pilot[:, top].mean(axis=0)) * rel_err / student.ppf(0.975, 20)

    def spread(term: tuple[int, ...]) -> float:
        x = difference(pilot[:, term])
        return float(((x - x[0]).var(axis=0, ddof=min(len(x) - 1, 1)) / scale**2).max())

    def planned(chain: tuple[int, ...]) -> Design:
        terms = terms_of(chain)
        of_terms = [sum(costs[level] for level in term) for term in terms]
        spreads = [spread(term) for term in terms]
        total = sum(math.sqrt(v * c) for v, c in zip(spreads, of_terms, strict=True))
        ideal = [math.sqrt(v / c) * total for v, c in zip(spreads, of_terms, strict=True)]
        many, base = (solves, ideal[-1]) if solves is not None and ideal[-1] > 0 else (1, 1.0)
        maps = tuple(max(math.ceil(many * (n / base)), FEWEST) for n in ideal)
        cost = sum(n * c for n, c in zip(maps, of_terms, strict=True))
        return Design(chain, maps, cost, max(many * spread((top,)) / base, FEWEST) * costs[top])

    chains = [(*some, top) for k in range(top + 1) for some in combinations(range(top), k)]
    return max(map(planned, chains), key=lambda one: one.plain / one.cost)


@dataclass(frozen=True)
class Mean:
    """Means with their uncertainty, arrays of shape (quantities,)."""

    mean: Array
    stderr: Array  # standard errors
    degrees: Array  # of freedom of Student's distribution

    def interval(self, level: float = 0.95) -> tuple[Array, Array]:
        """Return the ends of the confidence interval."""
        half = student.ppf((1 + level) / 2, self.degrees) * self.stderr
        return self.mean - half, self.mean + half


def mean_of(samples: Sequence[Array], population: int | None = None) -> Mean:
    """Sum of the terms' means, of samples of shape (maps, quantities) each.

    Those of a term may be chosen without replacement from a `population` of maps.
    """
    variances = []
    for x in samples:
        left = 1.0 if population is None else 1 - len(x) / population
        variances.append(left * x.var(axis=0, ddof=1) / len(x) if len(x) > 1 else np.zeros(x.shape[1]))
    total = np.sum(variances, axis=0)
    with np.errstate(invalid="ignore", divide="ignore"):
        parts = sum(v**2 / max(len(x) - 1, 1) for v, x in zip(variances, samples, strict=True))
        degrees = np.where(total > 0, total**2 / parts, 1.0)
    return Mean(np.sum([x.mean(axis=0) for x in samples], axis=0), np.sqrt(total), degrees)
