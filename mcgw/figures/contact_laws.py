"""Effects of contact laws: yielding, unloading, sliding, films."""

from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from analytic import Exponential, Model, laws
from analytic.arrays import Array
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import Compared, of_gamma
from mcgw.figures.data import (
    PRESSURE,
    SEPARATION,
    FigureData,
    Panel,
    Points,
    Series,
    mean_points,
    ratio_of_sums,
)
from mcgw.figures.style import prefixed

_CRITICAL = 0.02
_STRAIN = 0.004
_AT, _LINE = np.linspace(0, 3, 7), np.linspace(0, 3.5, 36)
_FALLING = _LINE[::-1]  # pressures rise
_LOWER = np.linspace(-2, 3.5, 56)  # where Hertz's loads are reached
_STATES = (("elastic", (0,)), ("elastoplastic", (1, 2)), ("fully plastic", (3,)))
_LAWS: dict[str, laws.ContactLaw] = {
    "Chang": laws.ChangEtsionBogy(critical=_CRITICAL),
    "Zhao": laws.ZhaoMaiettaChang(critical=_CRITICAL),
    "Kogut": laws.KogutEtsion(critical=_CRITICAL),
    "Jackson": laws.JacksonGreen(yield_strain=_STRAIN, critical=_CRITICAL),
}
_ENOUGH = 100  # contacts on either side of a share
_TURN, _STRETCH = 0.5, 0.5
_FRICTION, _POISSON = 0.3, 0.3
_RESISTIVITY = 1e-7
_STICKS = "sticking (Johnson, Kendall, Roberts)"
_WAYS: dict[str, laws.ContactLaw] = {
    "yielding (Kogut, Etsion)": laws.KogutEtsion(critical=_CRITICAL),
    _STICKS: laws.JohnsonKendallRoberts(pull_off=_STRETCH),
}
_PUSHED = r"displacement $u/(\mu\sigma)$"
_SLIPS = r"$T/(\mu P)$"


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
        "Contacts that yield, elastic, elastic-plastic and plastic",
        f"Kogut and Etsion's law; an asperity of modulus E* yields at a penetration of {_CRITICAL:g} σ, "
        f"stiffer ones sooner. {f.listed_caption}",
        tuple(panels),
    )


def laws_compared(f: Compared) -> FigureData:
    """Show load and area of laws that yield over Hertz's on the same surfaces, and at its load."""
    hertz, model = f.sums(laws.Hertz(), _AT), f.model()
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
        "Contact laws compared, with the same onset of yield",
        f"All yield at a penetration of {_CRITICAL:g} σ (Jackson's with S_y/E* = {_STRAIN:g}). Ratios are "
        f"for the same surfaces. {f.listed_caption}",
        tuple(panels),
    )


def _pressure(model: Model, h: Array) -> Array:
    return model.mean("pressure", h) / 1e6


def _share(model: Model, pieces: tuple[int, ...], h: Array) -> Array:
    return np.asarray(np.sum([model.share(piece, h) for piece in pieces], axis=0))


def _share_points(
    listed: tuple[Array, ...], law: laws.ContactLaw, gamma: float, model: Model, pieces: tuple[int, ...]
) -> Points:
    """Shares on the listed surfaces, where they have enough contacts of this kind and of others."""
    grading = Exponential(gamma)
    counts = np.zeros((2, len(listed), len(_AT)))
    for i, s in enumerate(listed):
        for k, h in enumerate(_AT):
            touching = s[s > h]
            piece = laws.piece_of(law, touching - h, grading(touching))
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


def way_back(f: Compared) -> FigureData:
    """Show load and contacts on the way in and back: of a sweep for asperities that yield and that stick."""
    area, labels = f.scene.surface.nominal_area, {"load": "pressure (MPa)", "contacts": "contacts per mm²"}
    if f.swept:
        h, line, panels = np.linspace(_TURN, 2, 7), np.linspace(_TURN, 2.5, 41), []
        for key, (name, law) in zip("ab", _WAYS.items(), strict=True):
            sums = f.sums(law, h, quantities=("load", "contacts"), unload_from=_TURN)
            ways = _Ways(f.model(law=law, unload_from=_TURN), sums, h, line, fewest=1)
            for quantity, label in labels.items():
                title = f"{key}  {name}: {quantity}" if quantity == "load" else f"{key}  contacts"
                panels.append(ways.panel(title, label, quantity, 1e6 * area))
        return FigureData(
            "Unloading: hysteresis of contacts that yield or adhere",
            f"Pressed to d/σ = {_TURN:g} and unloaded, with the same asperities. Penetration at yield "
            f"{_CRITICAL:g} σ; stretch at break-off {_STRETCH:g} σ. {f.listed_caption}",
            tuple(panels),
        )
    both = f.scene.replace(unload_from=f.asked.unload_from, quantities=("load", "contacts"))
    ensemble = simulate(both)
    sums = {name: ensemble.values(name) for name in (*labels, *(f"{x}_unloading" for x in labels))}
    most = max(np.abs(both.theory.mean(name, f.line)).max() for name in ("load", "load_unloading"))
    unit, prefix = prefixed(float(most) / area)
    ways = _Ways(both.theory, sums, f.h, f.line, fewest=20)
    panels = [
        ways.panel("a  load", f"pressure ({prefix}Pa)", "load", area * unit),
        ways.panel("b  contacts", labels["contacts"], "contacts", 1e6 * area),
    ]
    return FigureData(f"Pressed to d/σ = {both.theory.unload_from:g}, and unloaded", f.caption, tuple(panels))


@dataclass(frozen=True)
class _Ways:
    """Data of loading and unloading: theory, sums of surfaces, and surfaces per point."""

    theory: Any
    sums: dict[str, Array]
    h: Array
    line: Array
    fewest: int

    def panel(self, title: str, ylabel: str, quantity: str, unit: float) -> Panel:
        series = []
        for way, name in (("in", quantity), ("back", f"{quantity}_unloading")):
            exact, line = (self.theory.mean(name, x) / unit for x in (self.h, self.line))
            values = self.sums[name] / unit
            known = np.count_nonzero(values, axis=0) >= self.fewest  # a mean of no surfaces has no error
            points = mean_points(self.h[known], values[:, known], exact[known]) if known.any() else None
            series.append(Series(way, self.line, line, points))
        return Panel(title, SEPARATION, ylabel, tuple(series), level=0.0)


def sliding(f: Compared) -> FigureData:
    """Show pre-sliding curves, and cycles by Masing's rule."""
    u, line = np.linspace(0, 1.2, 7)[1:], np.linspace(0, 1.2, 61)
    model, curves, cycles = f.model(), [], []
    for h in (0.0, 1.0, 2.0):
        pushed = laws.Tangential(_FRICTION, _POISSON, u * _FRICTION * f.scene.surface.sigma)
        sums = f.sums(laws.Hertz(), np.array([h]), quantities=("load",), tangential=pushed)
        ratio, stderr = ratio_of_sums(sums["tangential_load"][:, 0], _FRICTION * sums["load"])
        points = Points(u, ratio, stderr, _slipping(model, h, u))
        curves.append(Series(f"d/σ = {h:g}", line, _slipping(model, h, line), points))
    for reach in (0.6, 0.3, 0.1):
        x = np.linspace(0, reach, 61)
        virgin = _slipping(model, 1.0, x)
        back, down = laws.masing(virgin), reach - 2 * x
        around = np.concatenate([x, down, -down]), np.concatenate([virgin, back, -back])
        cycles.append(Series(f"up to {reach:g}", *around))
    return FigureData(
        "Tangential load: from partial slip to gross sliding",
        f"Theorem of Ciavarella and Jaeger for each surface; friction {_FRICTION:g}, Poisson's ratio "
        f"{_POISSON:g}. Cycles at d/σ = 1 by Masing's rule. {f.listed_caption}",
        (
            Panel("a  first push", _PUSHED, _SLIPS, tuple(curves), level=1.0),
            Panel("b  cycles", _PUSHED, _SLIPS, tuple(cycles), level=0.0),
        ),
    )


def _slipping(model: Model, h: float, u: Array) -> Array:
    """Mean tangential load over that of gross sliding, at displacements in units of mu sigma."""
    pushed = laws.Tangential(_FRICTION, _POISSON, u * _FRICTION * model.surface.sigma)
    load = model.mean("load", h)
    return np.asarray((load - model.mean("load", h + pushed.shifts(model.surface))) / load)


def films(f: Compared) -> FigureData:
    """Show the resistance against load, with a film on the spots."""
    h, line = np.linspace(0, 3, 7), np.linspace(3.5, 0, 36)  # pressures rise
    root, unit = np.sqrt(f.scene.surface.radius * f.scene.surface.sigma), 1e9 * f.scene.surface.nominal_area
    bare, series = f.model(), []
    pressure, shown = (bare.mean("pressure", x) / 1e6 for x in (h, line))
    for b in (0.0, 0.1, 1.0, 10.0):
        film = laws.Film(_RESISTIVITY, b * np.pi * _RESISTIVITY * root / 4)
        model = f.model(film=film)
        exact, resistance = (unit / model.mean("conductance_si", x) for x in (h, line))
        values = f.sums(laws.Hertz(), h, quantities=("load",), film=film)["conductance_si"]
        mean = values.mean(axis=0)
        error = values.std(axis=0, ddof=1) / np.sqrt(len(values)) / mean
        points = Points(pressure, unit / mean, unit / mean * error, exact)
        series.append(Series("no film" if b == 0 else f"b = {b:g}", shown, resistance, points))
    return FigureData(
        "A film on the spots",
        f"b is the radius, over √(Rσ), of a spot whose film and constriction have equal resistance; "
        f"ρ = {_RESISTIVITY:g} Ω m. {f.listed_caption}",
        (Panel("", PRESSURE, "resistance of 1 mm² (mΩ)", tuple(series), ("log", "log")),),
    )
