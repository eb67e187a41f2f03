"""Where a surface has been: the way back, sideways, and through films."""

import numpy as np
from numpy.typing import NDArray

from analytic import Model
from analytic.laws import ContactLaw, Film, Hertz, JohnsonKendallRoberts, KogutEtsion, Tangential, masing
from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figures.listed import PRESSURE, area_of, mean_points, model_of, sums_of
from mcgw.figures.samples import Samples

__all__ = ["films", "sliding", "way_back"]

Array = NDArray[np.float64]

_TURN, _CRITICAL, _STRETCH = 0.5, 0.02, 0.5
_FRICTION, _POISSON = 0.3, 0.3
_RESISTIVITY = 1e-7
_STICKS = "sticking (Johnson, Kendall, Roberts)"
_WAYS: dict[str, ContactLaw] = {
    "yielding (Kogut, Etsion)": KogutEtsion(critical=_CRITICAL),
    _STICKS: JohnsonKendallRoberts(pull_off=_STRETCH),
}
_PUSHED = r"displacement $u/(\mu\sigma)$"
_SLIPS = r"$T/(\mu P)$"


def way_back(samples: Samples) -> FigureData:
    """Load and contacts on the way in and back, of asperities that yield and of those that stick."""
    h, line = np.linspace(_TURN, 2, 7), np.linspace(_TURN, 2.5, 41)
    scales = {"load": 1e-6 / area_of(samples), "contacts": 1e-6 / area_of(samples)}
    labels = {"load": "pressure (MPa)", "contacts": "contacts per mm²"}
    panels = []
    for key, (name, law) in zip("ab", _WAYS.items(), strict=True):
        model = model_of(samples, law, unload_from=_TURN)
        sums = sums_of(samples, law, h, quantities=("load", "contacts"), unload_from=_TURN)
        for quantity, scale in scales.items():
            series = []
            for way, ending in (("in", ""), ("back", "_unloading")):
                asked = quantity + ending
                exact, shown = (model.mean(asked, x) * scale for x in (h, line))
                touching = sums[asked].any(axis=0)  # a mean of nothing has no error
                points = mean_points(h[touching], sums[asked][:, touching] * scale, exact[touching])
                series.append(Series(way, line, shown, points))
            title = f"{key}  {name}: {quantity}" if quantity == "load" else f"{key}  contacts"
            panels.append(Panel(title, SEPARATION, labels[quantity], tuple(series), level=0.0))
    return FigureData(
        "way-back",
        "The way back: contacts lift off early where they yielded, late where they stick",
        f"Pressed to d/σ = {_TURN:g} and released: the same asperities both ways. Penetration at yield "
        f"{_CRITICAL:g} σ; stretch at break-off {_STRETCH:g} σ. {samples.listed_caption}",
        tuple(panels),
    )


def sliding(samples: Samples) -> FigureData:
    """Pre-sliding curves, and cycles by Masing's rule."""
    u, line = np.linspace(0, 1.2, 7)[1:], np.linspace(0, 1.2, 61)
    model, curves, cycles = model_of(samples, Hertz()), [], []
    for h in (0.0, 1.0, 2.0):
        pushed = Tangential(_FRICTION, _POISSON, u * _FRICTION * samples.surface.sigma)
        sums = sums_of(samples, Hertz(), np.array([h]), quantities=("load",), tangential=pushed)
        ratio, stderr = ratio_of_sums(sums["tangential_load"][:, 0], _FRICTION * sums["load"])
        points = Points(u, ratio, stderr, _slipping(model, h, u))
        curves.append(Series(f"d/σ = {h:g}", line, _slipping(model, h, line), points))
    for reach in (0.6, 0.3, 0.1):
        x = np.linspace(0, reach, 61)
        virgin = _slipping(model, 1.0, x)
        back, down = masing(virgin), reach - 2 * x
        around = np.concatenate([x, down, -down]), np.concatenate([virgin, back, -back])
        cycles.append(Series(f"up to {reach:g}", *around))
    return FigureData(
        "sliding",
        "Pushed sideways: from the first slip to gross sliding",
        f"Ciavarella's and Jaeger's theorem, surface by surface; friction {_FRICTION:g}, Poisson's ratio "
        f"{_POISSON:g}. Cycles at d/σ = 1 by Masing's rule. {samples.listed_caption}",
        (
            Panel("a  first push", _PUSHED, _SLIPS, tuple(curves), level=1.0),
            Panel("b  cycles", _PUSHED, _SLIPS, tuple(cycles), level=0.0),
        ),
    )


def _slipping(model: Model, h: float, u: Array) -> Array:
    """Mean tangential load over that of gross sliding, at displacements in units of mu sigma."""
    pushed = Tangential(_FRICTION, _POISSON, u * _FRICTION * model.surface.sigma)
    load = model.mean("load", h)
    return np.asarray((load - model.mean("load", h + pushed.shifts(model.surface))) / load)


def films(samples: Samples) -> FigureData:
    """Resistance against load, with a film on the spots."""
    h, line = np.linspace(0, 3, 7), np.linspace(3.5, 0, 36)  # pressures rise
    root, unit = np.sqrt(samples.surface.radius * samples.surface.sigma), 1e9 * area_of(samples)
    bare, series = model_of(samples, Hertz()), []
    pressure, shown = (bare.mean("pressure", x) / 1e6 for x in (h, line))
    for b in (0.0, 0.1, 1.0, 10.0):
        film = Film(_RESISTIVITY, b * np.pi * _RESISTIVITY * root / 4)
        model = model_of(samples, Hertz(), film=film)
        exact, resistance = (unit / model.mean("conductance_si", x) for x in (h, line))
        values = sums_of(samples, Hertz(), h, quantities=("load",), film=film)["conductance_si"]
        mean = values.mean(axis=0)
        error = values.std(axis=0, ddof=1) / np.sqrt(len(values)) / mean
        points = Points(pressure, unit / mean, unit / mean * error, exact)
        series.append(Series("no film" if b == 0 else f"b = {b:g}", shown, resistance, points))
    return FigureData(
        "films",
        "A film on the spots",
        f"b is the radius of a spot over √(Rσ) whose film and constriction resist alike; "
        f"ρ = {_RESISTIVITY:g} Ω m. {samples.listed_caption}",
        (Panel("", PRESSURE, "resistance of 1 mm² (mΩ)", tuple(series), ("log", "log")),),
        columns=1,
    )
