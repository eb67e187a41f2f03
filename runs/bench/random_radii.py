"""What a radius for each summit costs, beside one radius for all: ``python runs/bench/random_radii.py``.

10^5 asperities, 41 separations from 0 to 4: time of set-up and of one surface, of one radius alone and as a
multiple of it; medians of nine rounds, all cases in turn. Then the same sums by NumPy over the very summits.
"""

from statistics import median
from time import perf_counter

import numpy as np

import mcgw
from mcgw.sampling.asperities import summits_drawn
from mcgw.sampling.radius_table import radius_table
from mcgw.sampling.samplers import cells_of

SEPARATIONS, SURFACES, ROUNDS = np.linspace(0, 4, 41), 64, 9
SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")


def cases():
    """What is compared, one radius and Gaussian heights first."""
    asked = {"separations": SEPARATIONS, "n_asperities": 10**5, "seed": 1}
    return {
        "one radius, Gaussian": mcgw.Scene(SPECTRAL.surface, **asked),
        "one radius, Nayak": mcgw.Scene(SPECTRAL, curvature="mean", **asked),
        "own radii": mcgw.Scene(SPECTRAL, **asked),
        "own radii, load alone": mcgw.Scene(SPECTRAL, quantities=["load"], **asked),
        "own radii, contacts alone": mcgw.Scene(SPECTRAL, quantities=["contacts"], **asked),
    }


def by_numpy(scene, sampler):
    """Sums of one surface whose summits are given, separation by separation."""
    s, c = summits_drawn(scene, sampler, 0)
    start = perf_counter()
    for h in SEPARATIONS:
        d = s[s > h] - h
        root = np.sqrt(c[s > h] * d)
        _ = (root * d).sum(), (c[s > h] * d).sum(), root.sum()
    return perf_counter() - start


def main():
    """Measure and print."""
    scenes = cases()
    samplers = {name: cells_of(scene) for name, scene in scenes.items()}
    for sampler in samplers.values():
        sampler.block(0, SURFACES)
    setup, drawing = ({name: [] for name in scenes} for _ in range(2))
    for k in range(1, ROUNDS + 1):
        for name, sampler in samplers.items():
            radius_table.cache_clear()
            start = perf_counter()
            cells_of(scenes[name])
            drawn = perf_counter()
            sampler.block(k * SURFACES, SURFACES)
            setup[name].append(drawn - start)
            drawing[name].append((perf_counter() - drawn) / SURFACES)
    first = next(iter(scenes))
    one = median(setup[first]), median(drawing[first])
    print(f"{first}: set-up {1e3 * one[0]:.0f} ms, {1e6 * one[1]:.0f} us a surface")
    for name in list(scenes)[1:]:
        ratio = median(setup[name]) / one[0], median(drawing[name]) / one[1]
        print(f"{name:28s} set-up x {ratio[0]:5.2f}, drawing x {ratio[1]:5.2f}")
    numpy = median([by_numpy(scenes["own radii"], samplers["own radii"]) for _ in range(5)])
    print(f"NumPy over the same summits, without drawing them: x {numpy / median(drawing['own radii']):.1f}")


if __name__ == "__main__":
    main()
