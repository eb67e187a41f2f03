"""Exact laws over a grid of 630 scenes.

Ten laws of heights, three contact laws, three gradings, seven numbers of asperities. Of each: shares fall
from 1 to 1e-6 in order, the error against more points and more cells is at most the one stated, and the time.
"""

import time
from itertools import product
from unittest import mock

import numpy as np
from scipy import stats

import analytic
from analytic.distribution import of_model

HEIGHTS = {
    "t(4)": stats.t(4),
    "t(6)": stats.t(6),
    "t(12)": stats.t(12),
    "pareto(5)": stats.pareto(5),
    "lognorm(1)": stats.lognorm(1.0),
    "fisk(8)": stats.fisk(8.0),
    "uniform": stats.uniform(),
    "Gaussian": analytic.Gaussian(),
    "exponential": analytic.ExponentialHeights(),
    "Weibull(3)": analytic.Weibull(3.0),
}
LAWS = {
    "hertz": None,
    "kogut-etsion": analytic.KogutEtsion(critical=0.05),
    "jkr": analytic.JohnsonKendallRoberts(pull_off=0.01),
}
GRADINGS = {"1": analytic.Homogeneous(), "2": analytic.Exponential(2.0), "0.5": analytic.Exponential(0.5)}
NUMBERS = (100, 1000, 3000, 30_000, 10**5, 10**6, 10**7)
SHARES = np.append(1 - np.geomspace(1e-6, 0.5, 60), np.geomspace(0.5, 1e-6, 60)[1:])
FINER, CELLS = (3 * 2**15, 2**17), (30_000, 36_000)


def laws():
    """Names and models of all of them, with a separation that 1 to 10 % of the asperities exceed."""
    for k, names in enumerate(product(HEIGHTS, LAWS, GRADINGS, NUMBERS)):
        heights, law, grading, n = names
        given = HEIGHTS[heights]
        given = analytic.ScipyHeights(given) if hasattr(given, "dist") else given
        surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=n, nominal_area=1.0, E_star=1e9)
        more = {"count": ("fixed", "poisson")[k % 2], "law": LAWS[law], "grading": GRADINGS[grading]}
        yield (
            names,
            analytic.Model(surface, heights=given, **more),
            float(given.isf(np.array(0.1 if k % 3 else 0.01))),
        )


def faults(model, h, quantity="load"):
    """What is wrong with a law, its error and the stated one at worst, and the seconds it takes."""
    start = time.process_time()
    law = model.distribution(quantity, h)
    took = time.process_time() - start
    most, least = law.sf(law.x[0]), law.sf(law.x[-1])
    x = law.isf(SHARES[(least < SHARES) & (most > SHARES)])
    even = np.linspace(x[0], x[-1], 2000)
    found = []
    if not (np.isfinite(x).all() and np.all(np.diff(x) >= 0)):
        found.append("quantiles are not in order")
    if not 0 <= law.sf(law.x[-1]) <= 1e-6 or not np.all((law.sf(even) >= 0) & (law.sf(even) <= 1)):
        found.append(f"shares reach {law.sf(law.x[-1]):.1e}")
    if np.any(np.diff(law.sf(even)) > 0) or np.any(law.cdf(even) + law.sf(even) != 1):
        found.append("shares rise, or their sum is not 1")
    with mock.patch.multiple(of_model, _POINTS=FINER, _CELLS=CELLS):
        finer = model.distribution(quantity, h)
    rarer = np.minimum(law.cdf(x), law.sf(x))
    off, stated = np.abs(law.sf(x) - finer.sf(x)), law.error_at(x) * rarer
    if np.any(off > stated):
        worst = np.argmax(off / stated)
        found.append(f"off by {off[worst]:.1e} where {stated[worst]:.1e} is stated, at {SHARES[worst]:.1e}")
    return found, off.max(), stated.max(), took
