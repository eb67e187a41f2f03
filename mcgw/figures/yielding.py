"""Who yields, and what the choice of the law is worth on the same surfaces."""

from dataclasses import replace
from functools import partial

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
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import Compared, of_gamma
from mcgw.figures.data import PRESSURE, SEPARATION, FigureData, Panel, Points, Series, ratio_of_sums

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


def who_yields(f: Compared) -> FigureData:
    """Show the share of the contacts that yielded: of a sweep those of each state, by the grading."""
    return _states(f) if f.swept else _yielded(f)


def _yielded(f: Compared) -> FigureData:
    area, series = f.scene.surface.nominal_area, []
    for label, scene in f.all.items():
        if scene.law.elastic:
            continue
        ensemble = simulate(scene.replace(quantities=("load", "contacts", "yielded")))
        load = f.theory(label, "load", f.line)
        share, exact = (f.theory(label, "yielded", h) / f.theory(label, "contacts", h) for h in (f.line, f.h))
        yielded, contacts = ensemble.values("yielded"), ensemble.values("contacts")
        points = f.points(partial(ratio_of_sums, yielded, contacts), exact)
        if points:
            points = replace(points, x=ensemble.mean("load")[f.enough(f.scene)] / area / 1e6)
        series.append(Series(label, load / area / 1e6, share, points))
    panel = Panel("", PRESSURE, "share of the contacts that yielded", tuple(series), ("log", "linear"))
    return FigureData("Who yields", f.caption, (panel,))


def _states(f: Compared) -> FigureData:
    law, panels = _LAWS["Kogut"], []
    models = {gamma: f.model(gamma, law=law) for gamma in (2.0, 1.0, 0.5)}
    for key, (name, pieces) in zip("abc", _STATES, strict=True):
        series = []
        for gamma, model in models.items():
            line = _share(model, pieces, _FALLING)
            points = _share_points(f.listed, law, gamma, model, pieces)
            series.append(Series(of_gamma(gamma), _pressure(model, _FALLING), line, points))
        title, label = f"{key}  {name}", "share of the contacts"
        panels.append(Panel(title, PRESSURE, label, tuple(series), ("log", "linear")))
    return FigureData(
        "Who yields: the plasticity index as a count of contacts",
        f"Kogut and Etsion's law; an asperity of modulus E* yields at a penetration of {_CRITICAL:g} σ, a "
        f"stiffer one sooner. {f.listed_caption}",
        tuple(panels),
    )


def laws_compared(f: Compared) -> FigureData:
    """Show load and area of laws that yield over Hertz's on the same surfaces, and at its load."""
    hertz, model = f.sums(Hertz(), _AT), f.model()
    models = {label: f.model(law=law) for label, law in _LAWS.items()}
    sums = {label: f.sums(law, _AT) for label, law in _LAWS.items()}
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
        "The choice of the law: the same surfaces, the same onset of yield",
        f"All yield at a penetration of {_CRITICAL:g} σ (Jackson's with S_y/E* = {_STRAIN:g}). Ratios on the "
        f"same surfaces have next to no noise. {f.listed_caption}",
        tuple(panels),
    )


def _pressure(model: Model, h: Array) -> Array:
    return model.mean("pressure", h) / 1e6


def _share(model: Model, pieces: tuple[int, ...], h: Array) -> Array:
    return np.asarray(np.sum([model.share(piece, h) for piece in pieces], axis=0))


def _share_points(
    listed: tuple[Array, ...], law: ContactLaw, gamma: float, model: Model, pieces: tuple[int, ...]
) -> Points:
    """Shares on the listed surfaces, where they have enough contacts of this kind and of others."""
    grading = Exponential(gamma)
    counts = np.zeros((2, len(listed), len(_AT)))
    for i, s in enumerate(listed):
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
