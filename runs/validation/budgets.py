"""Whether what a budget says of a surface's parameters holds: maps of known spectra, fitted and loaded.

    python runs/validation/budgets.py [--maps 200]     (three seconds a map; goes on where it was stopped)

Each map is a Gaussian one, half of them drawn by SurfaceTopography. The truth is what the same model says of
the spectrum itself, whose moments are sums over the wave vectors of the map. For each load: how often the
interval of the parameters alone holds it, and that with specimens and drawn surfaces. Of 200 maps
(budgets.csv) the parameters alone hold 88.5 to 93.5 % of answers, all but the model 98.5 to 100 %.
"""

import argparse
import csv
import math
from pathlib import Path

import numpy as np
from SurfaceTopography.Generation import fourier_synthesis

import mcgw
from mcgw.ensemble.at_load import mean_surface
from mcgw.maps.synthetic import Spectrum, gaussian_map
from mcgw.maps.topography import Topography

POINTS, PIXEL, RMS, MODULUS = 256, 1e-6, 1e-6, 1e9
SPECTRA = tuple((long, hurst) for long in (32.0, 64.0, 128.0) for hurst in (0.5, 0.8))  # pixels, H
PATH = Path(__file__).with_name("budgets.csv")
LINES = ("parameters", "specimens", "drawn surfaces")
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


def held(number):
    """Rows of one map: how far off its answers are, and by the parameters' line and all without the model."""
    long, hurst = SPECTRA[(number // 2) % len(SPECTRA)]
    power, q = power_of(long, hurst)
    m0, m2, m4 = (c * float(np.sum(power * q**k)) for c, k in ((1, 0), (1 / 2, 2), (3 / 8, 4)))
    z = map_of(number, long, hurst)
    fit = mcgw.fit(Topography(z, (PIXEL, PIXEL)), cutoff=None, form="none")
    fitted = mcgw.fitted_scene(fit, heights="nayak", E_star=MODULUS, separations=[1.0], n_surfaces=30)
    surface = mcgw.SpectralSurface(m0, m2, m4, fit.area, MODULUS)
    true = mcgw.Scene(
        surface, separations=[1.0], n_surfaces=2, contact=mcgw.Contact(quantities=fitted.quantities), seed=1
    )
    solved = mcgw.solve(fitted, pressure=[load * MODULUS * math.sqrt(2 * m2) for load in LOADS])
    for load, said in zip(LOADS, solved, strict=True):
        right, budget = mean_surface(true, "load", said.value), said.budget()
        for name in SHOWN:
            k = budget.quantities.index(name)
            shares = [float(budget.shares[line][k]) for line in LINES]
            off = abs(right[name] / said.theory[name] - 1)
            yield {"map": number, "p": load, "quantity": name, "off": off, "parameters": shares[0],
                   "without model": math.hypot(*shares)}  # fmt: skip


def read():
    """Rows of whole maps, as texts."""
    if not PATH.exists():
        return []
    with PATH.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return rows[: len(rows) - len(rows) % (len(LOADS) * len(SHOWN))]


def write(rows):
    """All of them, at once."""
    unfinished = PATH.with_suffix(".part")
    with unfinished.open("w", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    unfinished.replace(PATH)


def shares_of(rows):
    """By load and quantity: maps, and the shares that both lines hold."""
    held_by = {}
    for row in rows:
        off = float(row["off"])
        hits = [off <= float(row[key]) for key in ("parameters", "without model")]
        held_by.setdefault((float(row["p"]), row["quantity"]), []).append(hits)
    return {key: (len(hits), *np.mean(hits, axis=0)) for key, hits in held_by.items()}


def main():
    """Go on with the maps that the file lacks, and print shares."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--maps", type=int, default=0, help="up to which number; what is there is kept")
    parser.add_argument("--first", type=int, default=0, help="from which number on")
    asked, rows = parser.parse_args(), read()
    known = {int(row["map"]) for row in rows}
    for number in (k for k in range(asked.first, asked.maps) if k not in known):
        rows += [{key: f"{x:.5g}" if isinstance(x, float) else x for key, x in row.items()}
                 for row in held(number)]  # fmt: skip
        write(rows)
    print("held by the parameters alone, and by the budget without the model")
    for (load, name), (maps, alone, both) in shares_of(rows).items():
        print(f"p/(E* g) = {load:g}  {name:12s} {alone:7.1%} {both:7.1%} of {maps}")


if __name__ == "__main__":
    main()
