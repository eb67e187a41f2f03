"""Where a surface has been: the way back, sideways, and through films."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Model
from analytic.laws import ContactLaw, Film, Hertz, JohnsonKendallRoberts, KogutEtsion, Tangential, masing
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import Compared
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
            "The way back: contacts lift off early where they yielded, late where they stick",
            f"Pressed to d/σ = {_TURN:g} and released: the same asperities both ways. Penetration at yield "
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
    return FigureData(f"Pressed to d/σ = {both.theory.unload_from:g}, and let go", f.caption, tuple(panels))


@dataclass(frozen=True)
class _Ways:
    """What is known of both ways: theory, sums of surfaces at separations, and how many make a point."""

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
            known = np.count_nonzero(values, axis=0) >= self.fewest  # a mean of nothing has no error
            points = mean_points(self.h[known], values[:, known], exact[known]) if known.any() else None
            series.append(Series(way, self.line, line, points))
        return Panel(title, SEPARATION, ylabel, tuple(series), level=0.0)


def sliding(f: Compared) -> FigureData:
    """Show pre-sliding curves, and cycles by Masing's rule."""
    u, line = np.linspace(0, 1.2, 7)[1:], np.linspace(0, 1.2, 61)
    model, curves, cycles = f.model(), [], []
    for h in (0.0, 1.0, 2.0):
        pushed = Tangential(_FRICTION, _POISSON, u * _FRICTION * f.scene.surface.sigma)
        sums = f.sums(Hertz(), np.array([h]), quantities=("load",), tangential=pushed)
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
        "Pushed sideways: from the first slip to gross sliding",
        f"Ciavarella's and Jaeger's theorem, surface by surface; friction {_FRICTION:g}, Poisson's ratio "
        f"{_POISSON:g}. Cycles at d/σ = 1 by Masing's rule. {f.listed_caption}",
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


def films(f: Compared) -> FigureData:
    """Show the resistance against load, with a film on the spots."""
    h, line = np.linspace(0, 3, 7), np.linspace(3.5, 0, 36)  # pressures rise
    root, unit = np.sqrt(f.scene.surface.radius * f.scene.surface.sigma), 1e9 * f.scene.surface.nominal_area
    bare, series = f.model(), []
    pressure, shown = (bare.mean("pressure", x) / 1e6 for x in (h, line))
    for b in (0.0, 0.1, 1.0, 10.0):
        film = Film(_RESISTIVITY, b * np.pi * _RESISTIVITY * root / 4)
        model = f.model(film=film)
        exact, resistance = (unit / model.mean("conductance_si", x) for x in (h, line))
        values = f.sums(Hertz(), h, quantities=("load",), film=film)["conductance_si"]
        mean = values.mean(axis=0)
        error = values.std(axis=0, ddof=1) / np.sqrt(len(values)) / mean
        points = Points(pressure, unit / mean, unit / mean * error, exact)
        series.append(Series("no film" if b == 0 else f"b = {b:g}", shown, resistance, points))
    return FigureData(
        "A film on the spots",
        f"b is the radius of a spot over √(Rσ) whose film and constriction resist alike; "
        f"ρ = {_RESISTIVITY:g} Ω m. {f.listed_caption}",
        (Panel("", PRESSURE, "resistance of 1 mm² (mΩ)", tuple(series), ("log", "log")),),
    )
