"""Numbers of Figures 1 to 6 of the paper, with Monte-Carlo points."""

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import NDArray

import analytic
from analytic import Exponential, quantity_of
from mcgw.ensemble.paired import paired_ratio
from mcgw.figures.data import GAMMA, SEPARATION, FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figures.samples import Samples

__all__ = ["NEGATIVE", "PAPER", "POSITIVE", "paper_figures"]

PAPER = tuple(f"figure-{i}" for i in range(1, 7))  # names of their files

Array = NDArray[np.float64]
Weight = Literal["number", "area", "load"]

POSITIVE, NEGATIVE = (1.0, 1.2, 1.5, 2.0), (1.0, 0.8, 0.5, 0.2)
_GAMMAS = {"a": np.array([1.2, 1.4, 1.6, 1.8, 2.0]), "b": np.array([0.2, 0.4, 0.6, 0.8])}
_RANGES = {"a": (1.0, 2.0), "b": (0.2, 1.0)}
_H = np.arange(5.0)


def paper_figures(samples: Samples) -> list[FigureData]:
    """Figures 1 to 6.

    Parameters
    ----------
    samples : Samples
        The surfaces.

    Returns
    -------
    list of FigureData
        In order.
    """
    return [
        _figure_1(),
        _curves(
            samples, "figure-2", "Load at a given separation (Eq. 7)", "load", r"load integral $F^*_{3/2}$"
        ),
        _ratios(samples, "figure-3", "Area per load at a given separation (Eq. 12)", "load"),
        _figure_4(samples),
        _curves(
            samples,
            "figure-5",
            "Stiffness at a given separation; the paper's “conductance”",
            "stiffness",
            r"stiffness integral $F^*_{1/2}$",
        ),
        _ratios(samples, "figure-6", "Stiffness at a given separation (Eq. 15: “conductance”)", "stiffness"),
    ]


def _figure_1() -> FigureData:
    s = np.linspace(0, 4, 161)
    panels = tuple(
        Panel(
            title,
            "summit height s = z/σ",
            "E*(s)/E*",
            tuple(Series(f"γ = {g:g}", s, Exponential(g)(s)) for g in gammas),
        )
        for title, gammas in (("a  stiffer tips", POSITIVE[::-1]), ("b  softer tips", NEGATIVE))
    )
    return FigureData(
        "figure-1", "Exponential grading (Eq. 4)", "E*(s)/E* = γ − (γ − 1) exp(−s). Theory alone.", panels
    )


def _curves(samples: Samples, name: str, title: str, quantity: str, ylabel: str) -> FigureData:
    q = quantity_of(quantity)
    unit = samples.n_asperities * q.scale(samples.surface)
    line, h = np.linspace(0, 4, 161), samples.base.separations
    panels = []
    for panel, gammas in (("a  stiffer tips", POSITIVE[::-1]), ("b  softer tips", NEGATIVE)):
        series = []
        for gamma in gammas:
            e, ensemble = Exponential(gamma), samples.graded(gamma)
            points = Points(
                h,
                ensemble.mean(quantity) / unit,
                ensemble.stderr(quantity) / unit,
                analytic.fn(q.exponent, h, e),
            )
            series.append(Series(f"γ = {gamma:g}", line, analytic.fn(q.exponent, line, e), points))
        panels.append(Panel(panel, SEPARATION, ylabel, tuple(series), ("linear", "log")))
    return FigureData(name, title, samples.caption, tuple(panels))


def _ratios(samples: Samples, name: str, title: str, quantity: str) -> FigureData:
    """Figs. 3 and 6: ratios to the homogeneous surface against gamma."""
    inverse = quantity == "load"
    ylabel = r"$(A/P)\,/\,(A/P)_\mathrm{hom}$" if inverse else r"$K/K_\mathrm{hom}$"
    panels = tuple(
        Panel(
            f"{key}  {word}",
            GAMMA,
            ylabel,
            _ratio_series(samples, quantity, key),
            level=1.0,
        )
        for key, word in (("a", "stiffer tips"), ("b", "softer tips"))
    )
    return FigureData(name, title, samples.caption, panels)


def _ratio_series(samples: Samples, quantity: str, key: str) -> tuple[Series, ...]:
    """One for each separation."""
    line, gammas = np.linspace(*_RANGES[key], 81), _GAMMAS[key]
    columns = [samples.base.scene.separations.index(h) for h in _H]
    pairs = []
    for gamma in gammas:
        new, old = samples.graded(float(gamma)), samples.base
        pair = paired_ratio(old, new, quantity) if quantity == "load" else paired_ratio(new, old, quantity)
        pairs.append((pair.ratio[columns], pair.stderr[columns]))
    mean, stderr = np.transpose(pairs, (1, 2, 0))
    exact, curves = _exact_ratios(quantity, gammas), _exact_ratios(quantity, line)
    return tuple(
        Series(f"d/σ = {h:g}", line, curves[k], Points(gammas, mean[k], stderr[k], exact[k]))
        for k, h in enumerate(_H)
    )


def _exact_ratios(quantity: str, gammas: Array) -> Array:
    """Shape (separations, gammas)."""
    law = analytic.area_per_load_ratio if quantity == "load" else analytic.stiffness_ratio
    return np.transpose([law(_H, Exponential(float(g))) for g in gammas])


def _figure_4(samples: Samples) -> FigureData:
    line, gammas = np.linspace(0.2, 2, 73), np.concatenate([_GAMMAS["b"], _GAMMAS["a"]])
    just = tuple(Series(f"d/σ = {h:g}", line, line - (line - 1) * np.exp(-h)) for h in _H)
    panels = [
        Panel("a  the paper's: just touching, s = d/σ", GAMMA, r"$\psi/\psi_\mathrm{hom}$", just, level=1.0)
    ]
    weights: Sequence[tuple[str, Weight]] = (
        ("b  mean over the contacts", "number"),
        ("c  weighted by area", "area"),
        ("d  weighted by load", "load"),
    )
    for title, weight in weights:
        series = []
        exact, curves = _exact_moduli(gammas, weight), _exact_moduli(line, weight)
        for k, h in enumerate(_H):
            mean, stderr = _mean_moduli(samples.heights, float(h), gammas, weight)
            points = Points(gammas, mean, stderr, exact[k])
            series.append(Series(f"d/σ = {h:g}", line, curves[k], points))
        panels.append(Panel(title, GAMMA, r"$\psi/\psi_\mathrm{hom}$", tuple(series), level=1.0))
    return FigureData(
        "figure-4",
        "Plasticity index over that of the homogeneous surface",
        samples.listed_caption,
        tuple(panels),
    )


def _exact_moduli(gammas: Array, weight: Weight) -> Array:
    """Shape (separations, gammas)."""
    return np.transpose([analytic.mean_modulus(_H, Exponential(float(g)), weight=weight) for g in gammas])


def _mean_moduli(listed: tuple[Array, ...], h: float, gammas: Array, weight: Weight) -> tuple[Array, Array]:
    """Mean of E*(s)/E* over the contacts and its standard error, for each gamma."""
    above, below = np.empty((2, len(listed), len(gammas)))
    exponent = {"number": 0.0, "area": 1.0, "load": 1.5}[weight]
    for i, s in enumerate(listed):
        touching = s[s > h]
        modulus = gammas[:, None] - (gammas[:, None] - 1) * np.exp(-touching)
        weights = (touching - h) ** exponent * (modulus if weight == "load" else np.ones_like(modulus))
        above[i], below[i] = (weights * modulus).sum(axis=1), weights.sum(axis=1)
    return ratio_of_sums(above, below)
