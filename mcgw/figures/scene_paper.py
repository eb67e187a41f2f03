"""Figures 1 to 6 of the paper, of anybody's scene beside its homogeneous reference."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from analytic import MeasuredHeights, mean_modulus
from mcgw.figures.beside import SCENE, Beside, needs_grading, needs_pressing, needs_reference
from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figures.style import prefixed
from mcgw.sampling.asperities import heights

__all__ = ["figure_1", "figure_2", "figure_3", "figure_4", "figure_5", "figure_6"]

Array = NDArray[np.float64]

_LISTED = 100  # surfaces whose heights are looked at one by one
_MOST_HEIGHTS = 10_000_000
_BESIDE = 1.5  # sigma above the highest separation that a grading is shown


def figure_1(b: Beside) -> FigureData:
    """The modulus over the height."""
    needs_grading(b, "E*(s) = E* at every height")
    s = np.linspace(b.h.min(), b.h.max() + _BESIDE, 161)
    series = (Series(SCENE, s, b.scene.modulus(s)), Series("homogeneous", s, np.ones_like(s)))
    panel = Panel("", "summit height s = z/σ", "E*(s)/E*", series)
    return FigureData("figure-1", "The grading", b.words, (panel,), columns=1)


def _against_separation(
    b: Beside, name: str, title: str, quantity: str, symbol: str, unit: str
) -> FigureData:
    area = b.scene.surface.nominal_area
    top = max(float(np.abs(b.theory(label, quantity, b.line)).max()) for label in b.all) / area
    size, prefix = prefixed(top)
    series, positive = [], True
    for label in b.all:
        line = b.theory(label, quantity, b.line) / area / size
        positive &= bool(np.all(line >= 0) and np.any(line > 0))
        series.append(Series(label, b.line, line, b.means(label, quantity, area * size)))
    scales = ("linear", "log" if positive else "linear")
    level = None if positive else 0.0
    panel = Panel("", SEPARATION, f"{symbol} ({prefix}{unit})", tuple(series), scales, level)
    return FigureData(name, title, b.caption, (panel,), columns=1)


def figure_2(b: Beside) -> FigureData:
    """Load over the separation."""
    title = "Load at a given separation (Eq. 7)"
    return _against_separation(b, "figure-2", title, "load", "pressure $P/A_n$", "Pa")


def figure_5(b: Beside) -> FigureData:
    """Stiffness over the separation."""
    title = "Stiffness at a given separation; the paper's “conductance”"
    return _against_separation(b, "figure-5", title, "stiffness", "stiffness $K/A_n$", "Pa/m")


def figure_3(b: Beside) -> FigureData:
    """Area per load over the reference's."""
    needs_reference(b)
    needs_pressing(b)

    def exact(label: str, h: Array) -> Array:
        return b.theory(label, "area", h) / b.theory(label, "load", h)

    series = []
    for label in list(b.all)[:-1]:
        above, below = ((b.drawn[x].values("area"), b.drawn[x].values("load")) for x in (label, b.reference))
        line, at = (exact(label, h) / exact(b.reference, h) for h in (b.line, b.h))
        series.append(Series(label, b.line, line, b.quotient(above, below, at)))
    title = "Area per load at a given separation (Eq. 12)"
    return _ratios(b, "figure-3", title, r"$(A/P)\,/\,(A/P)_\mathrm{ref}$", series)


def figure_6(b: Beside) -> FigureData:
    """Stiffness over the reference's."""
    needs_reference(b)
    series = []
    for label in list(b.all)[:-1]:
        ours, theirs = (b.drawn[x].values("stiffness") for x in (label, b.reference))
        line, at = (
            b.theory(label, "stiffness", h) / b.theory(b.reference, "stiffness", h) for h in (b.line, b.h)
        )
        series.append(Series(label, b.line, line, b.ratio(ours, theirs, at)))
    title = "Stiffness at a given separation (Eq. 15: “conductance”)"
    return _ratios(b, "figure-6", title, r"$K/K_\mathrm{ref}$", series)


def _ratios(b: Beside, name: str, title: str, ylabel: str, series: list[Series]) -> FigureData:
    panel = Panel("", SEPARATION, ylabel, tuple(series), level=1.0)
    caption = f"Reference: {b.reference}, the same surface. {b.caption}"
    return FigureData(name, title, caption, (panel,), columns=1)


def figure_4(b: Beside) -> FigureData:
    """Mean modulus of the contacts, which the plasticity index goes as."""
    needs_grading(b, "the plasticity index is the same at every height")
    plain = b.hertz and b.scene.curvature is None  # else area and load of a contact are no powers
    powers = {"number": 0.0, "area": 1.0, "load": 1.5} if plain else {"number": 0.0}
    listed = _listed(b)
    series = []
    for weight, power in powers.items():
        asked = {"weight": weight, "heights": b.scene.heights}
        line, at = (mean_modulus(h, b.scene.modulus, **asked) for h in (b.line, b.h))  # type: ignore[arg-type]
        label = "contacts" if weight == "number" else weight
        series.append(Series(label, b.line, line, _mean_moduli(b, listed, power, weight == "load", at)))
    panel = Panel("", SEPARATION, r"$\psi/\psi_\mathrm{hom}$", tuple(series), level=1.0)
    caption = (
        f"Mean over the contacts, each weighted alike (contacts){', by its area, or by its load' * plain}. "
    )
    count = f"{b.scene.n_surfaces} surf"
    caption += b.caption.replace(count, f"{len(listed)} surf") if listed else b.words
    title = "Plasticity index over that of the homogeneous surface"
    return FigureData("figure-4", title, caption, (panel,), columns=1)


def _listed(b: Beside) -> tuple[Array, ...]:
    """Heights of some surfaces, in sigma."""
    if isinstance(b.scene.heights, MeasuredHeights):  # the same on every surface, or nearly
        return ()
    some = min(_LISTED, b.scene.n_surfaces, max(int(_MOST_HEIGHTS / max(b.scene.touching, 1.0)), 2))
    scene = b.scene.replace(sampler="tail") if b.scene.curvature is None else b.scene
    return tuple(heights(scene, number) for number in range(some))


def _mean_moduli(
    b: Beside, listed: tuple[Array, ...], power: float, by_load: bool, exact: Array
) -> Points | None:
    if len(listed) < 2:
        return None
    known = b.enough(replace(b.scene, n_surfaces=len(listed)))
    if not known.any():
        return None
    above, below = np.zeros((2, len(listed), len(b.h)))
    for i, s in enumerate(listed):
        for k in np.flatnonzero(known):
            touching = s[s > b.h[k]]
            modulus = b.scene.modulus(touching)
            weights = (touching - b.h[k]) ** power * (modulus if by_load else 1.0)
            above[i, k], below[i, k] = np.sum(weights * modulus), np.sum(weights)
    return Points(b.h[known], *ratio_of_sums(above[:, known], below[:, known]), exact[known])
