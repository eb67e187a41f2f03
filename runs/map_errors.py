"""Do the errors that `mcgw fit` states hold? Gaussian maps of known spectra, 200 a case.

Usage: python runs/map_errors.py [maps]; about half an hour for 200 on one core. What was done is kept in
runs/out/map_errors/ and not done again. Prints a table of all cases: by estimate the share of intervals of
95 % that do not hold the truth (at most 8 % is asked for), and the standard deviation of z, the error of
the logarithm over the stated one (0.8 to 1.3 is asked for).

The truth is what the spectrum is expected to give. "alone": the map is one period of its own. "cut": it is a
quarter of a larger map, so that waves do not fit on it. Shortest waves have 12 pixels or more.
"""

import math
import sys
import time
from pathlib import Path

import numpy as np

from analytic import SpectralMoments
from mcgw.maps.fit import Fit, fit_prepared
from mcgw.maps.preparation import Preparation, prepared
from mcgw.maps.synthetic import Spectrum, gaussian_map, moments_on_grid
from mcgw.maps.topography import Topography

FOLDER = Path(__file__).parent / "out" / "map_errors"
PIXEL = (1e-6, 1e-6)
HURST = {2: -0.8, 5: 0.5, 10: 0.8}  # so that the map holds some summits for small alpha too
POINTS = {
    (2, 1): 96, (2, 3): 224, (2, 10): 640,
    (5, 1): 192, (5, 3): 320, (5, 10): 1080,
    (10, 1): 192, (10, 3): 512, (10, 10): 1700,
}  # fmt: skip
MOMENTS = ("m0", "m2", "m4", "alpha")
PARAMETERS = ("eta", "radius", "sigma")
NAMES = (*MOMENTS, *(f"{m} {p}" for m in ("moments", "summits") for p in PARAMETERS))


def spectrum_of(alpha: int, waves: int) -> Spectrum:
    """With this alpha, and so many of its longest wave on the map."""
    shape = Spectrum.with_moments(SpectralMoments(1e-12, 1e-3, alpha * 1e6), HURST[alpha])
    long = POINTS[alpha, waves] * PIXEL[0] / waves
    return Spectrum(1e-6, long * (1 + 1e-12), long * shape.short / shape.long, HURST[alpha])


def numbers(fit: Fit, truth: SpectralMoments) -> list[tuple[float, float, float]]:
    """Error of the logarithm, the stated one, whether the interval holds the truth; nan: no estimate."""
    found = {name: (getattr(fit, name), getattr(truth, name)) for name in MOMENTS}
    for method, e in fit.estimates.items():
        found |= {f"{method} {p}": (getattr(e, p), getattr(truth, p)) for p in PARAMETERS}
    rows = []
    for name in NAMES:
        if name not in found:
            rows.append((math.nan, math.nan, math.nan))
            continue
        x, true = found[name]
        rows.append((math.log(x.value / true), x.error / x.value, float(x.low <= true <= x.high)))
    return rows


def case(alpha: int, waves: int, cut: bool, maps: int) -> np.ndarray:
    """Numbers of all maps of a case, shape (maps, estimates, 3): kept ones, and the others now."""
    path = FOLDER / f"alpha-{alpha}-waves-{waves}-{'cut' if cut else 'alone'}.npy"
    done = list(np.load(path)) if path.exists() else []
    n, spectrum = POINTS[alpha, waves], spectrum_of(alpha, waves)
    size = 2 * n if cut else n
    truth = moments_on_grid(spectrum, (size, size), PIXEL)
    for seed in range(len(done), maps):
        whole = gaussian_map(spectrum, (size, size), PIXEL, np.random.default_rng(seed))
        part = Topography(np.ascontiguousarray(whole.heights[:n, :n]), PIXEL)
        done.append(np.array(numbers(fit_prepared(prepared(part, Preparation(None))), truth)))
        if seed % 20 == 19 or seed == maps - 1:
            np.save(path, np.array(done))
    return np.array(done[:maps])


def main() -> None:
    """All cases, and the table."""
    maps = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    FOLDER.mkdir(parents=True, exist_ok=True)
    start = time.perf_counter()
    heads = [*MOMENTS, "eta", "R", "sigma", "eta", "R", "sigma"]
    print(f"{'':30}" + "".join(f"{h:>10}" for h in heads))
    print(f"{'alpha, longest wave, map':30}{'':40}{'from moments':^30}{'counted':^30}")
    for cut in (False, True):
        for alpha, waves in POINTS:
            if cut and waves == 10:
                continue  # as the other
            found = case(alpha, waves, cut, maps)
            z = found[..., 0] / found[..., 1]
            share = 100 * (1 - np.nanmean(found[..., 2], axis=0))
            cells = (f"{s:5.1f} {d:4.2f}" for s, d in zip(share, np.nanstd(z, axis=0), strict=True))
            label = f"{alpha}, L/{waves}, {'cut' if cut else 'alone'}"
            print(f"{label:30}" + "".join(f"{c:>10}" for c in cells), flush=True)
    print(f"{maps} maps a case: outside in %, sd of z; {time.perf_counter() - start:.0f} s")


if __name__ == "__main__":
    main()
