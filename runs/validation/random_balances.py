"""Random balances of summits at their places: how many are found with the whole interaction.

    python runs/validation/random_balances.py [--cases 500]     (3 minutes)

Summits of Gaussian maps of random spectra, alpha from 2 to 50, H from 0.2 to 1, one to three longest waves
wide; with the surface around them, or as paraboloids. Each under a load p/(E* g) of 1e-5 to 0.02, even in its
logarithm, and under one of 0.02 to 0.1.
"""

import argparse
import collections
import math
import time

import numpy as np

from analytic import SpectralMoments
from mcgw.elasticity.levels import Pressed
from mcgw.elasticity.located import balanced
from mcgw.maps.synthetic import Spectrum, gaussian_map

SEED, M2, MODULUS = 20261124, 0.01, 1e11


def case(number, most_points=768):
    """Words; of two loads, light and heavy, p/(E* g), and by what `balanced` finds its balance."""
    rng = np.random.default_rng([SEED, number])
    paraboloids = bool(rng.integers(2))
    while True:
        alpha, hurst = math.exp(rng.uniform(math.log(2), math.log(50))), rng.uniform(0.2, 1)
        spectrum = Spectrum.with_moments(SpectralMoments(1e-12, M2, alpha * M2**2 / 1e-12), hurst)
        points = math.ceil(8 * rng.uniform(1, 3) * spectrum.long / spectrum.short)
        if 48 <= points <= most_points:
            break
    pixel = spectrum.short / 8
    heights = gaussian_map(spectrum, (points, points), (pixel, pixel), rng).heights
    heights, size = heights - heights.mean(), (points * pixel, points * pixel)
    shape = "paraboloids" if paraboloids else "surfaces"
    words = f"alpha = {alpha:.1f}, H = {hurst:.2f}, {points}^2, {shape}"
    shares, found = (math.exp(rng.uniform(math.log(1e-5), math.log(0.02))), rng.uniform(0.02, 0.1)), []
    for p in shares:
        pressed = Pressed(heights, size, MODULUS, p * MODULUS * math.sqrt(2 * M2))
        spots, places = pressed.touching(fits=0 if paraboloids else 2)
        found.append((p, (spots, places, pressed.grid, pressed.plane(spots), pressed.load)))
    return words, found


def main():
    """Print what was not found whole, and shares by load."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--cases", type=int, default=500, metavar="N")
    parser.add_argument("--first", type=int, default=0, metavar="K")
    asked = parser.parse_args()
    tried, whole = collections.Counter(), collections.Counter()
    begun = time.process_time()
    for number in range(asked.first, asked.first + asked.cases):
        words, loads = case(number)
        for which, (p, given) in zip(("up to 0.02", "0.02 to 0.1"), loads, strict=True):
            kind = f"{which}, {words.split(', ')[-1]}"
            tried[kind] += 1
            share = balanced(*given).share
            whole[kind] += share == 1
            if share < 1:
                print(f"{number}: {words}, p/(E* g) = {p:.2g}: {share:g} of the interaction", flush=True)
    for kind, many in sorted(tried.items()):
        print(f"{kind:24} {whole[kind]} of {many} found with the whole interaction")
    print(f"{time.process_time() - begun:.0f} s")


if __name__ == "__main__":
    main()
