"""Random located balances: how many are found, and what is left over where one is refused.

    python runs/validation/random_balances.py [--cases 500]     (15 minutes)

Summits of Gaussian maps of random spectra, alpha from 2 to 50, H from 0.2 to 1, one to three longest waves
wide; periodic or on a free half-space; summits with the surface around them, or as paraboloids. Each under a
load p/(E* g) of 1e-5 to 0.02, even in its logarithm, and under one of 0.02 to 0.1.
"""

import argparse
import collections
import math
import time

import numpy as np

from analytic import SpectralMoments
from mcgw.elasticity.equilibrium import Located
from mcgw.elasticity.levels import Pressed
from mcgw.elasticity.spots import Grid
from mcgw.errors import RunError
from mcgw.maps.synthetic import Spectrum, gaussian_map

SEED, M2, MODULUS = 20261124, 0.01, 1e11
SHAPES = ("profiles", "paraboloids")


def case(number, most_points=768):
    """Words, located summits, and two loads in N: light and heavy."""
    rng = np.random.default_rng([SEED, number])
    periodic, shape = bool(rng.integers(2)), SHAPES[rng.integers(2)]
    while True:
        alpha, hurst = math.exp(rng.uniform(math.log(2), math.log(50))), rng.uniform(0.2, 1)
        spectrum = Spectrum.with_moments(SpectralMoments(1e-12, M2, alpha * M2**2 / 1e-12), hurst)
        points = math.ceil(8 * rng.uniform(1, 3) * spectrum.long / spectrum.short)
        if 48 <= points <= most_points:
            break
    pixel = spectrum.short / 8
    heights = gaussian_map(spectrum, (points, points), (pixel, pixel), rng).heights
    pressed = Pressed(heights - heights.mean(), (points * pixel, points * pixel), MODULUS)
    own = pressed.profiles if shape == "profiles" else pressed.summits
    grid = own.grid if periodic else Grid(own.grid.shape, own.grid.size, periodic=False)
    shares = math.exp(rng.uniform(math.log(1e-5), math.log(0.02))), rng.uniform(0.02, 0.1)
    words = f"alpha = {alpha:.1f}, H = {hurst:.2f}, {points}^2, {'periodic' if periodic else 'free'}, {shape}"
    full = MODULUS * math.sqrt(2 * M2) * grid.area
    return words, Located(own.spots, own.places, grid), [(p, p * full) for p in shares]


def main():
    """Print refusals, and shares by load and shape."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cases", type=int, default=500, metavar="N")
    parser.add_argument("--first", type=int, default=0, metavar="K")
    asked = parser.parse_args()
    tried, found, merged = (collections.Counter() for _ in range(3))
    begun = time.process_time()
    for number in range(asked.first, asked.first + asked.cases):
        words, located, loads = case(number)
        for which, (p, load) in zip(("up to 0.02", "0.02 to 0.1"), loads, strict=True):
            kinds = [which, *words.split(", ")[3:]] if which.startswith("0") else [which]
            tried.update(kinds)
            try:
                balance = located.at_load(load)
            except RunError as error:
                print(f"{number}: {words}, p/(E* g) = {p:.2g}: {error}", flush=True)
            else:
                found.update(kinds)
                merged[which] += balance.merged > 0
    for kind, many in tried.items():
        print(f"{kind:14} {found[kind]} of {many} found, {merged[kind]} of them with summits left out")
    print(f"{time.process_time() - begun:.0f} s")


if __name__ == "__main__":
    main()
