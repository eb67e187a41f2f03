"""Drawn surfaces of random scenes against their exact laws.

Of each scene of `random_scenes` one quantity at one separation is taken by lot; 400 surfaces then give 400
values of their distribution function, even ones between 0 and 1 at random where it jumps, and the test of
Kolmogorov and Smirnov one p-value. Those of all scenes are uniform if the laws are right: the statistic of
Anderson and Darling says so. Each fault is put into the law of the same values.
"""

import sys

import numpy as np
from scipy import stats

import mcgw
from analytic import Exponential, quantity_of
from oracles.inside import promise_of
from oracles.random_scenes import asked
from oracles.scenes import scene_by

SURFACES, NEAR, UNSURE = 400, 1e-6, 5e-3
ROOTED = {"area": "conductance", "conductance": "area"}  # of Hertz's law: an approach, and its root


def stiffer(scene, name, h, law):
    """The grading factor is half a percent larger."""
    if not isinstance(scene.grading, Exponential):
        return None
    return scene.replace(grading=Exponential(1.005 * scene.grading.gamma)).theory.distribution(name, h).cdf


def miscounted(scene, name, h, law):
    """A fixed number of asperities for a Poisson one, or the other way round."""
    other = "fixed" if scene.count == "poisson" else "poisson"
    return scene.replace(count=other).theory.distribution(name, h).cdf


def rootless(scene, name, h, law):
    """The root of a law is missing, its mean is right."""
    if name not in ROOTED or not law.mean() > 0:
        return None
    other = scene.theory.distribution(ROOTED[name], h)
    return lambda x: other.cdf(x * (other.mean() / law.mean()))


def right(scene, name, h, law):
    """As it is."""
    return law.cdf


def p_values(seed, faults, surfaces=SURFACES, **more):
    """Of one scene, one for each of the faults, nan where it has no such; or why there is none."""
    values = asked(seed)
    dice = np.random.default_rng([seed, 35])
    values |= {"keep": "sums", "n_surfaces": surfaces, **more}
    if values["sampler"] == "aggregate":
        values["sampler"] = "auto"
    if isinstance(values["heights"], mcgw.MeasuredHeights):
        return "measured"
    try:
        scene = scene_by(**values)
    except mcgw.SceneError:
        return "refused"
    names = list(scene.quantities)
    name, k = str(dice.choice(names)), int(dice.integers(len(scene.separations)))
    h = scene.separations[k]
    try:
        law = scene.theory.distribution(name, h)
    except ValueError as error:
        return f"no law: {str(error)[:60]}"
    if not law.error < UNSURE:  # jumps that are smoothed, values over forty decades
        return "its law says that it is too far off for this test"
    ensemble = mcgw.simulate(scene)
    assert promise_of(ensemble.sampler).one_by_one
    x = ensemble.values(name)[:, k]
    lot = dice.random(x.size)
    off = 1e-9 * np.abs(x)  # values that are alike on many surfaces are so to the last digits
    jumps = quantity_of(name).counts
    below, above = (x - 1, x) if jumps else (x - off, x + off)

    def p(fault):
        cdf = fault(scene, name, h, law)
        if cdf is None:
            return np.nan
        low, high = cdf(below), cdf(above)
        low = np.where((x == 0) & (not jumps), 0.0, low)
        return stats.kstest(low + lot * (high - low), "uniform").pvalue

    return [p(fault) for fault in faults]


def even(p, seed=1):
    """Probability of so large a statistic of Anderson and Darling, from 4000 uniform samples."""

    def statistic(u):
        u, n = np.sort(np.clip(u, 1e-300, 1 - 1e-16), axis=-1), u.shape[-1]
        weights = 2 * np.arange(1, n + 1) - 1
        return -n - (weights * (np.log(u) + np.log1p(-u[..., ::-1]))).mean(axis=-1)

    if not len(p):
        return 1.0
    known = statistic(np.random.default_rng(seed).random((4000, len(p))))
    return (1 + np.count_nonzero(known >= statistic(np.asarray(p)))) / 4001


def judged(seeds, faults, **more):
    """Probability of the p-values of these scenes by each fault, how many there are, and what is left out."""
    rows, left = [], []
    for seed in seeds:
        try:
            found = p_values(seed, faults, **more)
        except Exception as error:  # whatever it is, the scene has no verdict
            found = f"FAILED {seed}: {error!r}"
        (left if isinstance(found, str) else rows).append(found)
        if not isinstance(found, str) and found[0] < 1e-4:
            sys.stderr.write(f"{seed}: p = {found[0]:.2g}\n")
    columns = [np.array(column)[~np.isnan(column)] for column in zip(*rows, strict=True)]
    return [even(column) for column in columns], [column.size for column in columns], left
