"""Who yields, and what the choice of the law is worth on the same surfaces."""

import numpy as np
from numpy.typing import NDArray

from analytic import Exponential, Model
from analytic.laws import (
    ChangEtsionBogy,
    ContactLaw,
    Hertz,
    JacksonGreen,
    KogutEtsion,
    ZhaoMaiettaChang,
    piece_of,
)
from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figures.listed import PRESSURE, model_of, sums_of
from mcgw.figures.samples import Samples

__all__ = ["laws_compared", "who_yields"]

Array = NDArray[np.float64]

_CRITICAL, _STRAIN = 0.02, 0.004
_AT, _LINE = np.linspace(0, 3, 7), np.linspace(0, 3.5, 36)
_FALLING = _LINE[::-1]  # pressures rise
_LOWER = np.linspace(-2, 3.5, 56)  # where the loads of Hertz are reached
_STATES = (("elastic", (0,)), ("elastoplastic", (1, 2)), ("fully plastic", (3,)))
_LAWS: dict[str, ContactLaw] = {
    "Chang": ChangEtsionBogy(critical=_CRITICAL),
    "Zhao": ZhaoMaiettaChang(critical=_CRITICAL),
    "Kogut": KogutEtsion(critical=_CRITICAL),
    "Jackson": JacksonGreen(yield_strain=_STRAIN, critical=_CRITICAL),
}
_ENOUGH = 100  # contacts on either side of a share


def who_yields(samples: Samples) -> FigureData:
    """Shares of the contacts that are elastic, yield, and are fully plastic, by the grading."""
    law, panels = _LAWS["Kogut"], []
    models = {gamma: model_of(samples, law, gamma) for gamma in (2.0, 1.0, 0.5)}
    for key, (name, pieces) in zip("abc", _STATES, strict=True):
        series = []
        for gamma, model in models.items():
            line = _share(model, pieces, _FALLING)
            points = _share_points(samples, law, gamma, model, pieces)
            series.append(Series(f"γ = {gamma:g}", _pressure(model, _FALLING), line, points))
        title, label = f"{key}  {name}", "share of the contacts"
        panels.append(Panel(title, PRESSURE, label, tuple(series), ("log", "linear")))
    return FigureData(
        "who-yields",
        "Who yields: the plasticity index as a count of contacts",
        f"Kogut and Etsion's law; an asperity of modulus E* yields at a penetration of {_CRITICAL:g} σ, a "
        f"stiffer one sooner. {samples.listed_caption}",
        tuple(panels),
    )


def laws_compared(samples: Samples) -> FigureData:
    """Load and area of all laws that yield, relative to Hertz's on the same surfaces, and at its load."""
    hertz, model = sums_of(samples, Hertz(), _AT), model_of(samples, Hertz())
    models = {label: model_of(samples, law) for label, law in _LAWS.items()}
    sums = {label: sums_of(samples, law, _AT) for label, law in _LAWS.items()}
    panels = []
    for key, name in (("a", "load"), ("b", "area")):
        series = []
        for label, yielding in models.items():
            exact, line = (yielding.mean(name, h) / model.mean(name, h) for h in (_AT, _LINE))
            points = Points(_AT, *ratio_of_sums(sums[label][name], hertz[name]), exact)
            series.append(Series(label, _LINE, line, points))
        panels.append(Panel(f"{key}  {name}", SEPARATION, f"{name} over Hertz's", tuple(series), level=1.0))
    at_load = tuple(Series(label, *_at_load(model, yielding)) for label, yielding in models.items())
    label = "area over Hertz's at this load"
    panels.append(Panel("c  equal load", PRESSURE, label, at_load, ("log", "linear"), level=1.0))
    return FigureData(
        "laws-compared",
        "The choice of the law: the same surfaces, the same onset of yield",
        f"All yield at a penetration of {_CRITICAL:g} σ (Jackson's with S_y/E* = {_STRAIN:g}). Ratios on the "
        f"same surfaces have next to no noise. {samples.listed_caption}",
        tuple(panels),
    )


def _pressure(model: Model, h: Array) -> Array:
    return model.mean("pressure", h) / 1e6


def _share(model: Model, pieces: tuple[int, ...], h: Array) -> Array:
    return np.asarray(np.sum([model.share(piece, h) for piece in pieces], axis=0))


def _share_points(
    samples: Samples, law: ContactLaw, gamma: float, model: Model, pieces: tuple[int, ...]
) -> Points:
    """Shares on the listed surfaces, where they have enough contacts of this kind and of others."""
    grading = Exponential(gamma)
    counts = np.zeros((2, len(samples.heights), len(_AT)))
    for i, s in enumerate(samples.heights):
        for k, h in enumerate(_AT):
            touching = s[s > h]
            piece = piece_of(law, touching - h, grading(touching))
            counts[:, i, k] = len(touching), np.isin(piece, pieces).sum()
    among, others = counts[1].sum(axis=0), (counts[0] - counts[1]).sum(axis=0)
    known = (among >= _ENOUGH) & (others >= _ENOUGH)
    share, stderr = ratio_of_sums(counts[1], counts[0])
    h = _AT[known]
    return Points(_pressure(model, h), share[known], stderr[known], _share(model, pieces, h))


def _at_load(hertz: Model, yielding: Model) -> tuple[Array, Array]:
    """Pressures in MPa, and the area over Hertz's under the same load: both curves log by log."""
    loads, areas = (hertz.mean(name, _FALLING) for name in ("load", "area"))
    load, ours = (np.log(yielding.mean(name, _LOWER))[::-1] for name in ("load", "area"))
    area = np.exp(np.interp(np.log(loads), load, ours))
    return loads / hertz.surface.nominal_area / 1e6, area / areas
