"""How far the law of a value is from the exact one if crowds count as Gaussian: from two transforms, no draw.

A cell of n asperities adds a sum with the transform ``phi^n``; a crowd one with that of a normal law of the
same mean and variance. The difference of the distribution functions is an integral over the difference of
the transforms (Gil-Pelaez 1951), where nothing cancels. A fixed number of asperities is a Poisson number
given its value: an integral over the circle ``z = exp(i alpha)`` of the generating function.

``python -m oracles.law_of_crowds`` prints the table of `runs/ACCURACY.md`.
"""

import sys
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.special import ndtr
from scipy.stats import norm, poisson

import analytic
import mcgw
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.crowds import crowding
from oracles.scenes import scene_by

X, W = (1 + leggauss(24)[0]) / 2, leggauss(24)[1] / 2
AT_ONCE = 256  # points of the transform
CLOSE = 1e-13
PLACES = np.linspace(-8, 10, 400)  # standard deviations from the mean
ANGLES = np.arange(-7.0, 8.0)  # of the circle, over the root of the number


def one_in_cell(scene, quantity, h, low, high):
    """What an asperity between two heights adds, reduced, with probabilities."""
    q, start = analytic.quantity_of(quantity), max(low, h)
    if start >= high:
        return np.zeros(1), np.ones(1)
    first, last = np.sqrt(start - h), np.sqrt(high - h)
    v = first + (last - first) * X  # the root of the approach: no cusp at h
    s = h + v * v
    value = v ** (2 * q.exponent) * (scene.grading(s) if q.modulus else 1.0)
    share = W * (last - first) * 2 * v * norm.pdf(s)
    missed = ndtr(-low) - ndtr(-start)
    return np.append(value, 0.0), np.append(share, missed) / (ndtr(-low) - ndtr(-high))


def transforms(scene, quantity, h, threshold, t, z):
    """Of the sums of crowds, and of all asperities; z of each asperity is that of its number."""
    edges, n = mesh_of(scene, split=False).edges, scene.n_asperities
    steps = np.append(edges, edges[-1] + np.arange(1, 13) / 2)
    crowds = exact = n * (z - 1) * ndtr(edges[0]) + 0j
    factor = 1.0 + 0j
    for low, high in pairwise(steps):
        value, share = one_in_cell(scene, quantity, h, low, high)
        expected = n * (ndtr(-low) - ndtr(-high))
        mean = share @ value
        one = z * (np.exp(1j * np.outer(t, value)) @ share)
        cell = expected * (one - 1)
        gauss = 1j * t * mean - t * t * (share @ (value - mean) ** 2) / 2
        exact = exact + cell
        spread = 14 * np.sqrt(expected) + 60
        fewest, most = max(threshold, int(expected - spread)), int(expected + spread)
        if low >= edges[-1] or most < threshold:
            crowds = crowds + cell
        elif fewest > threshold:
            crowds = crowds + expected * (z * np.exp(gauss) - 1)
        else:
            k = np.arange(fewest, most + 1)
            own = (z * np.exp(gauss))[:, None] ** k - one[:, None] ** k
            factor = factor * (np.exp(cell) + own @ poisson.pmf(k, expected))
    return np.exp(crowds) * factor, np.exp(exact)


def distance(scene, quantity, h, threshold):
    """Largest difference of the two distribution functions of a value of a Hertzian scene."""
    model = analytic.Model(
        scene.surface, grading=scene.grading, n_asperities=scene.n_asperities, count=scene.count
    )
    unit, n = analytic.quantity_of(quantity).scale(scene.surface), scene.n_asperities
    mean, std = float(model.mean(quantity, h)) / unit, float(model.std(quantity, h)) / unit
    circle = ANGLES / np.sqrt(n) if scene.count == "fixed" else np.zeros(1)
    weights = np.exp(-1j * n * circle) / np.sum(np.exp(n * (np.exp(1j * circle) - 1 - 1j * circle)))
    step = 2 * np.pi / (24 * std + 6**1.5)
    below = np.zeros(PLACES.size)
    for first in range(0, 1 << 16, AT_ONCE):
        t, apart = (first + np.arange(AT_ONCE) + 0.5) * step, 0j
        for alpha, weight in zip(circle, weights, strict=True):
            crowds, exact = transforms(scene, quantity, h, threshold, t, np.exp(1j * alpha))
            apart = apart + weight * (crowds - exact)
        places = mean + std * PLACES
        below -= step / np.pi * (np.exp(-1j * np.outer(places, t)) @ (apart / t)).imag
        if np.abs(apart).max() < CLOSE and t[0] * std > 6:
            return float(np.abs(below).max())
    raise AssertionError("the transforms have not died away")


def farthest(scene, threshold):
    """Of all values that are not counted."""
    names = [name for name in scene.quantities if name != "contacts"]
    return max(distance(scene, name, h, threshold) for name in names for h in scene.separations)


def table():
    """A line for each number of asperities and each law error."""
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
    asked = {"separations": np.linspace(0, 4, 9), "grading": mcgw.Exponential(2.0), "count": "poisson"}
    sys.stdout.write("| asperities | `accuracy` | a crowd | promised | measured |\n|---|---|---|---|---|\n")
    for n in (10**3, 10**4, 10**6, 10**8):
        for accuracy in (1e-3, 1e-4, 1e-5):
            scene = scene_by(surface, n_asperities=n, accuracy=accuracy, **asked)
            found = crowding(scene, mesh_of(scene, split=False))
            seen = farthest(scene, found.threshold)
            sys.stdout.write(
                f"| {n:.0e} | {accuracy:g} | {found.threshold} | {found.distance:.1e} | {seen:.1e} |\n"
            )


if __name__ == "__main__":
    table()
