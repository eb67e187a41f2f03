"""How finite surfaces differ from each other."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr

from analytic import quantity_of
from mcgw.ensemble.simulation import simulate
from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series
from mcgw.figures.samples import Samples

__all__ = ["distribution", "fluctuations", "law_of_load"]

Array = NDArray[np.float64]

_FINE = 2048  # steps of the exact law in a bin: rounding each contact to a step shifts the mean by 1e-4


def fluctuations(samples: Samples) -> FigureData:
    """Standard deviation over mean, from a hundred asperities to a million."""
    h, line = np.linspace(0, 4, 9), np.linspace(0, 4, 41)
    scene = replace(
        samples.base.scene, keep="sums", separations=tuple(h), quantities=("load", "area", "stiffness")
    )
    sizes = {n: min(2000, 400_000_000 // n) for n in (100, 10_000, 1_000_000)}
    drawn = {n: simulate(replace(scene, n_asperities=n, n_surfaces=m)) for n, m in sizes.items()}
    panels = []
    for key, name in zip("abc", scene.quantities, strict=True):
        series = []
        for n in (100, 1000, 10_000, 100_000, 1_000_000):
            points = _spread_points(drawn[n].values(name), h, name, n, samples) if n in drawn else None
            series.append(Series(f"N = {_power(n)}", line, _exact_spread(name, line, n, samples), points))
        room = float(series[-1].theory.min()) / 2, 50 * float(series[0].theory.max())  # for the legend
        panels.append(
            Panel(f"{key}  {name}", SEPARATION, "std / mean", tuple(series), ("linear", "log"), 1.0, room)
        )
    return FigureData(
        "fluctuations",
        "How far finite surfaces differ from each other",
        f"N asperities a surface; 2000 surfaces (400 of N = 10⁶), seed {samples.seed}. Markers, with "
        "95 % intervals, where the ensemble has 400 contacts or more.",
        tuple(panels),
    )


def _power(n: int) -> str:
    return "10" + "⁰¹²³⁴⁵⁶"[len(str(n)) - 1]


def _exact_spread(name: str, h: Array, n: int, samples: Samples) -> Array:
    c = replace(samples.base.scene, n_asperities=n).theory.cumulants(name, h)
    return np.asarray(np.sqrt(c.variance) / c.mean)


def _spread_points(x: Array, h: Array, name: str, n: int, samples: Samples) -> Points:
    """std/mean where enough asperities touch, with the standard error of its influence function."""
    known = x.shape[0] * n * samples.base.scene.heights.above(h) >= 400
    x, h = x[:, known], h[known]
    mean, std = x.mean(axis=0), x.std(axis=0, ddof=1)
    z = (x - mean) / std
    influence = std / mean * ((z**2 - 1) / 2 - z * std / mean)
    return Points(h, std / mean, influence.std(axis=0) / np.sqrt(len(x)), _exact_spread(name, h, n, samples))


def law_of_load(n: int, h: float, step: float, bins: int) -> Array:
    """Exact law of the load of a finite homogeneous surface, by Fourier transform.

    Parameters
    ----------
    n : int
        Asperities.
    h : float
        Reduced separation.
    step : float
        Width of a bin of load, over that of one asperity at unit approach.
    bins : int
        How many; the load must hardly ever exceed ``step * bins``.

    Returns
    -------
    ndarray
        Probability of a load within half a step of ``k step``, shape (bins,).
    """
    edges = (np.arange(bins) + 0.5) * step
    below = ndtr(-(h + edges ** (2 / 3)))  # of an approach beyond the edge
    one = -np.diff(below, prepend=1.0)
    return np.fft.irfft(np.fft.rfft(one) ** n, bins)


def distribution(samples: Samples) -> FigureData:
    """The law of the load at light contact: exact, Gaussian, drawn."""
    panels = tuple(
        _load_panel(samples, key, contacts) for key, contacts in (("a", 5.0), ("b", 50.0), ("c", 500.0))
    )
    return FigureData(
        "distribution",
        "Load of one finite surface at light contact (d/σ = 2.5)",
        f"Homogeneous; 100 000 surfaces, seed {samples.seed}. Gaussian: of the same mean and "
        "std. Markers: share of the surfaces in bins of a quarter of the std, over their width.",
        panels,
    )


def _load_panel(samples: Samples, key: str, contacts: float) -> Panel:
    h, m = 2.5, 100_000
    n = round(contacts / float(samples.base.scene.heights.above(np.array(h))))
    scene = replace(
        samples.base.scene, keep="sums", separations=(h,), quantities=("load",), n_asperities=n, n_surfaces=m
    )
    exact = scene.theory.cumulants("load", h)
    mean, std = float(exact.mean), float(np.sqrt(exact.variance))
    x = simulate(scene).load[:, 0] / mean
    width = std / mean / 4
    top = 1 + 5 * std / mean
    edges = np.arange(max(width * round((1 - 4 * std / mean) / width), width), top, width)
    step = width * mean / quantity_of("load").scale(scene.surface) / _FINE
    law = law_of_load(n, h, step, 2**18)
    cumulative = np.concatenate([[0.0], np.cumsum(law)])  # up to (k - 1/2) steps
    at = np.interp(edges / width * _FINE + 0.5, np.arange(len(cumulative)), cumulative)
    share, p = np.histogram(x, edges)[0] / m, np.diff(at)
    often = p * m >= 25  # a bin with fewer has no symmetric interval
    share, p, centre = share[often], p[often], ((edges[1:] + edges[:-1]) / 2)[often]
    points = Points(centre, share / width, np.sqrt(p * (1 - p) / m) / width, p / width)
    fine = np.linspace(max(0.0, 2 - top), top, 201)
    bell = np.exp(-(((fine - 1) * mean / std) ** 2) / 2) / np.sqrt(2 * np.pi) * mean / std
    none = (
        f"; no contact: {float(np.exp(n * np.log1p(-scene.heights.above(np.array(h))))):.1%}"
        if contacts < 10
        else ""
    )
    return Panel(
        f"{key}  {contacts:g} contacts{none}",
        r"load over its mean, $P/\langle P\rangle$",
        "probability density",
        (Series("exact", centre, p / width, points), Series("Gaussian", fine, bell)),
    )
