"""Thirteen height laws: plain and given by samples, bounded and not, with light and heavy tails."""

import numpy as np
import scipy.stats

from analytic import ExponentialHeights, Gaussian, HeightTable, MeasuredHeights, Nayak, ScipyHeights, Weibull

SAMPLE = np.random.default_rng(1).weibull(1.6, size=300)
LAWS = {
    "gaussian": Gaussian(), "exponential": ExponentialHeights(), "weibull 1.5": Weibull(1.5),
    "weibull 3.6": Weibull(3.6), "nayak": Nayak(2.0), "table": HeightTable.of(SAMPLE),
    "measured": MeasuredHeights(SAMPLE), "uniform": ScipyHeights(scipy.stats.uniform()),
    "beta": ScipyHeights(scipy.stats.beta(2, 3)), "lognormal": ScipyHeights(scipy.stats.lognorm(0.3)),
    "gamma": ScipyHeights(scipy.stats.gamma(4)), "t": ScipyHeights(scipy.stats.t(5)),
    "triangle": ScipyHeights(scipy.stats.triang(0.3)),
}  # fmt: skip
