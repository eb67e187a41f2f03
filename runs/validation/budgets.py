"""Whether what a budget says of a surface's parameters holds: maps of known spectra, fitted and loaded.

    python runs/validation/budgets.py [--maps 200]

Each map is a Gaussian one, half of them drawn by SurfaceTopography. The truth is what the same model says of
the spectrum itself, whose moments are sums over the wave vectors of the map. For each load: how often the
interval of the parameters alone holds it, and that with specimens and drawn surfaces.
"""

import argparse
import math

import numpy as np
from SurfaceTopography.Generation import fourier_synthesis

import mcgw
from mcgw.maps.synthetic import Spectrum, gaussian_map
from mcgw.maps.topography import Topography

POINTS, PIXEL, RMS, MODULUS = 256, 1e-6, 1e-6, 1e9
SPECTRA = tuple((long, hurst) for long in (32.0, 64.0, 128.0) for hurst in (0.5, 0.8))  # pixels, H
SHORTEST, LOADS, SHOWN = 16.0, (1e-3, 1e-2, 3e-2), ("area", "stiffness", "conductance")


def power_of(long, hurst):
    """Expected share of the variance at each wave vector of the map, and these."""
    q = 2 * math.pi * np.hypot(*np.meshgrid(*[np.fft.fftfreq(POINTS, PIXEL)] * 2))
    power = Spectrum(RMS, long * PIXEL, SHORTEST * PIXEL, hurst).density(q)
    return RMS**2 * power / power.sum(), q


def map_of(number, long, hurst):
    """Heights; every second map is drawn by the other program."""
    if number % 2:
        spectrum = Spectrum(RMS, long * PIXEL, SHORTEST * PIXEL, hurst)
        rng = np.random.default_rng([2026, number])
        return gaussian_map(spectrum, (POINTS, POINTS), (PIXEL, PIXEL), rng).heights
    size = POINTS * PIXEL
    lowest, highest = 2 * math.pi / (long * PIXEL), 2 * math.pi / (SHORTEST * PIXEL)

    def density(q):
        inside = (q >= lowest * (1 - 1e-9)) & (q <= highest * (1 + 1e-9))
        return np.where(inside, np.where(inside, q, 1.0) ** (-2 - 2 * hurst), 0.0)

    q = 2 * math.pi * np.hypot(*np.meshgrid(*[np.fft.fftfreq(POINTS, PIXEL)] * 2))
    factor = RMS**2 * size**2 / density(q).sum()
    drawn = fourier_synthesis(
        (POINTS, POINTS), (size, size), psd=lambda q: factor * density(q),
        short_cutoff=SHORTEST * PIXEL, rng=np.random.default_rng([2027, number]),
    )  # fmt: skip
    return np.asarray(drawn.heights())


def main():
    """Print shares."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--maps", type=int, default=200)
    hits = {(load, name): np.zeros(2) for load in LOADS for name in SHOWN}
    parser.add_argument("--first", type=int, default=0)
    asked = parser.parse_args()
    maps = asked.maps
    for number in range(asked.first, asked.first + maps):
        long, hurst = SPECTRA[(number // 2) % len(SPECTRA)]
        power, q = power_of(long, hurst)
        m0, m2, m4 = (c * float(np.sum(power * q**k)) for c, k in ((1, 0), (1 / 2, 2), (3 / 8, 4)))
        z = map_of(number, long, hurst)
        fit = mcgw.fit(Topography(z, (PIXEL, PIXEL)), cutoff=None, form="none")
        fitted = mcgw.fitted_scene(fit, heights="nayak", E_star=MODULUS, separations=[1.0], n_surfaces=30)
        surface = mcgw.SpectralSurface(m0, m2, m4, fit.area, MODULUS)
        true = mcgw.Scene(surface, separations=[1.0], n_surfaces=2, quantities=fitted.quantities, seed=1)
        for load in LOADS:
            pressure = load * MODULUS * math.sqrt(2 * m2)
            said, right = (mcgw.solve(scene, pressure=pressure) for scene in (fitted, true))
            budget = said.budget()
            for name in SHOWN:
                k = budget.quantities.index(name)
                off = abs(said.theory[name] - right.theory[name]) / said.theory[name]
                shares = np.array(
                    [budget.shares[line][k] for line in ("parameters", "specimens", "drawn surfaces")]
                )
                hits[load, name] += off <= shares[0], off <= math.hypot(*shares)
    print(f"{maps} maps; held by the parameters alone, and by the budget without the model")
    for (load, name), (alone, all_of_them) in hits.items():
        print(f"p/(E* g) = {load:g}  {name:12s} {alone / maps:7.1%} {all_of_them / maps:7.1%}")


if __name__ == "__main__":
    main()
