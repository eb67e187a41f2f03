"""Scenes on the same surfaces side by side: one and what it is measured by, or a preset swept over gamma.

Their means over separation and load, ratios at equal separation and load, and mean moduli, each with points
by Monte Carlo.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property, wraps
from typing import Any, TypeVar

import numpy as np

from analytic import QUANTITIES, Exponential, Hertz, Homogeneous, MeasuredHeights, mean_modulus
from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.figures.panels import GAMMA, SEPARATION, Panel, Series
from mcgw.figures.studies import ENOUGH
from mcgw.figures.style import contact_label, short
from mcgw.formats.law_text import law_text
from mcgw.formats.table import evenly
from mcgw.sampling.asperities import heights
from mcgw.scene.scene import Scene
from mcgw.scene.section import SceneError
from mcgw.statistics.comparison import Points

Key = str | float  # label of a scene or, in a sweep, a gamma
Estimate = tuple[Array, Array]  # means and their standard errors
Gammas = tuple[Array, Array]  # of lines and of points
_Result = TypeVar("_Result")

SCENE = "this scene"
POWERS = {"number": 0.0, "area": 1.0, "load": 1.5}
_GAMMAS = (2.0, 1.5, 1.2, 1.0, 0.8, 0.5, 0.2)
_MOST_SURFACES, _MOST_ASPERITIES = 1000, 1_000_000_000
_MOST_SEPARATIONS, _FINE, _COARSE = 17, 49, 25  # separations of lines: own radii are slow
_MOST_HEIGHTS = 10_000_000
_ROUNDING = 1e-14  # of a ratio of sums that are the same: no residual is given in units of it


def _once(method: Callable[..., _Result]) -> Callable[..., _Result]:
    """Keep what a method returns for the same labels, names and separations."""

    @wraps(method)
    def call(self: "Compared", *given: Any) -> Any:
        place = (method.__name__, *(x.tobytes() if isinstance(x, np.ndarray) else x for x in given))
        if place not in self._kept:
            self._kept[place] = method(self, *given)
        return self._kept[place]

    return call


class Compared:
    """Scenes on the same surfaces, each with its theory and its ensemble when first asked for.

    Those of a scene that is swept get the gradings of the paper. Any other is pressed once, with the sums
    that the figures show, at some of its separations. It stands as it is beside what it is measured by:
    itself without interaction, without its grading, and with Hertz's law.
    """

    def __init__(self, asked: Scene, swept: bool = False, most_listed: int = 100) -> None:
        self.swept, self.most_listed = swept, most_listed  # surfaces whose heights are listed one by one
        self.scene, self.all, self.line = _swept(asked) if swept else _beside(asked)
        self.h = np.array(self.scene.separations)  # of the points; more of the lines
        labels = tuple(self.all)
        self.reference = "γ = 1" if swept else labels[-1]  # of ratios: the simplest
        self.others = tuple(label for label in labels if label != self.reference)
        self.graded = swept or "homogeneous" in labels  # whether a modulus depends on the height
        one = labels.index(self.reference)  # titles of panels, and labels of what they show together:
        halves = (("a  stiffer tips", labels[: one + 1]), ("b  softer tips", labels[one:]))
        self.groups = halves if swept else (("", labels),)
        self._kept: dict[Any, Any] = {}

    def of(self, key: Key) -> Scene:
        """Return the scene of a label or gamma."""
        return self.all[key] if isinstance(key, str) else self.scene.replace(grading=Exponential(key))

    @_once
    def theory(self, key: Key, quantity: str, h: Array) -> Array:
        """Exact means, each computed once."""
        return np.asarray(self.of(key).theory.mean(quantity, h))

    @_once
    def at_load_of_reference(self, key: Key, h: Array) -> Array:
        """Separations with the load that the reference has at these."""
        found = self.of(key).theory.separation_at("load", self.theory(self.reference, "load", h))
        # Where both have the same load, the last digit would draw them in other cells.
        return np.where(np.abs(found - h) < 1e-12, h, found)  # of searches for the same load

    @_once
    def drawn(self, key: Key, h: Array) -> Ensemble:
        """Ensemble on the same surfaces at some separations."""
        return simulate(self.of(key), separations=h)

    def values(self, key: Key, quantity: str, h: Array) -> Array:
        """Return the sums of each surface at some of the separations of the scene, or at others."""
        if np.isin(h, self.h).all():
            return np.asarray(self.drawn(key, self.h).values(quantity)[:, np.searchsorted(self.h, h)])
        return np.asarray(self.drawn(key, h).values(quantity))

    @cached_property
    def listed(self) -> tuple[Array, ...]:
        """Heights of some surfaces, in sigma, of all that touch."""
        if isinstance(self.scene.heights, MeasuredHeights):  # the same on every surface, or nearly
            return ()
        room = max(int(_MOST_HEIGHTS / max(self.scene.touching, 1.0)), 2)
        scene = self.scene.replace(sampler="tail") if self.scene.summits is None else self.scene
        return tuple(heights(scene, k) for k in range(min(self.most_listed, scene.n_surfaces, room)))

    def caption(self, surfaces: int | None = None) -> str:
        """Describe the scene, and what is drawn of so many surfaces (default: all); of none, it alone."""
        surfaces, said = self.scene.n_surfaces if surfaces is None else surfaces, []
        if not self.swept:
            pressed = ", interacting (d/σ is effective)" if self.scene.interaction is not None else ""
            law = short(law_text(self.scene.heights))
            said.append(f"This scene: {contact_label(self.scene)}{pressed}; heights {law}.")
        if surfaces > 1:
            drawn = f"{surfaces} surfaces of {self.scene.n_asperities:g} asperities, seed {self.scene.seed}"
            alike = f"the same for all {'γ' if self.swept else 'lines'}"
            said.append(f"Markers: Monte-Carlo means with 95 % intervals, {drawn}, {alike}.")
        return " ".join([*said, "Lines: theory."] if surfaces else said)


def _swept(scene: Scene) -> tuple[Scene, dict[str, Scene], Array]:
    """Return what is drawn, the same with the gradings of the paper by label, and separations of lines."""
    h = np.linspace(0, 4, 17)
    scene = scene.replace(grading=Homogeneous(), separations=h, quantities=tuple(QUANTITIES))
    graded = {g: scene if g == 1 else scene.replace(grading=Exponential(g)) for g in _GAMMAS}
    return scene, {f"γ = {g:g}": one for g, one in graded.items()}, np.linspace(0, 4, 161)


def _beside(scene: Scene) -> tuple[Scene, dict[str, Scene], Array]:
    """Return what is drawn, the same and simpler ones by label, and separations of lines."""
    h = np.unique(scene.separations)
    h = h[evenly(len(h), _MOST_SEPARATIONS)]
    cheap = _MOST_ASPERITIES // scene.n_asperities
    scene = scene.replace(
        separations=h, quantities=tuple(QUANTITIES), unload_from=None, joint=None, keep="sums", rel_err=None,
        n_surfaces=max(min(scene.n_surfaces, _MOST_SURFACES, cheap), 1), max_seconds=None,
    )  # fmt: skip
    found = {SCENE: scene}
    if scene.interaction is not None:
        found["independent"] = scene.replace(interaction=None)
    if not isinstance(scene.grading, Homogeneous):
        found["homogeneous"] = scene.replace(grading=Homogeneous())
    if type(scene.law) is not Hertz:
        found["homogeneous, Hertz"] = scene.replace(grading=Homogeneous(), law=Hertz())
    fine = _FINE if scene.summits is None else _COARSE
    return scene, found, np.linspace(h.min(), h.max(), fine if len(h) > 1 else 1)


def _ratio(above: Sequence[Array], below: Sequence[Array]) -> Estimate:
    """Take a product of means over the same surfaces over another, with its error by the delta method.

    Sums are of shape (surfaces, ...). An error of the last digits alone is 0; it is nan where nothing is.
    """
    signed = [*((1, x) for x in above), *((-1, x) for x in below)]
    with np.errstate(invalid="ignore", divide="ignore"):
        value = np.prod([x.mean(axis=0) ** float(sign) for sign, x in signed], axis=0)
        influence = np.sum([sign * x / x.mean(axis=0) for sign, x in signed], axis=0)
        relative = influence.std(axis=0, ddof=1) / np.sqrt(len(influence))
    return value, np.abs(value) * np.where(relative <= _ROUNDING, 0.0, relative)


@dataclass(frozen=True)
class Mean:
    """A product of means over others, such as area per load."""

    above: tuple[str, ...]  # names of the quantities
    below: tuple[str, ...] = ()
    relative: bool = False  # whether it is divided by that of the reference
    at_load: bool = False  # whether separations are those of the reference, and the load is the same
    factor: float = 1.0  # what it is multiplied by

    def exact(self, f: Compared, key: Key, h: Array) -> Array:
        """By theory."""
        above, below = self._factors(f, key, h, f.theory)
        return np.asarray(self.factor * np.prod(above, axis=0) / np.prod(below, axis=0))

    def drawn(self, f: Compared, key: Key, h: Array) -> Estimate:
        """By Monte Carlo."""
        mean, stderr = _ratio(*self._factors(f, key, h, f.values))
        return self.factor * mean, self.factor * stderr

    def _factors(self, f: Compared, key: Key, h: Array, of: Any) -> tuple[list[Array], list[Array]]:
        """Numerator and denominator; `of` takes a label, a quantity and separations."""
        there = f.at_load_of_reference(key, h) if self.at_load else h
        above, below = ([of(key, name, there) for name in names] for names in (self.above, self.below))
        if self.relative:
            above += [of(f.reference, name, h) for name in self.below]
            below += [of(f.reference, name, h) for name in self.above]
        return above, below


@dataclass(frozen=True)
class Modulus:
    """Mean of E*(s)/E* over the contacts, weighted by one of `POWERS`."""

    weight: Any

    def exact(self, f: Compared, key: Key, h: Array) -> Array:
        """By theory."""
        return mean_modulus(h, f.of(key).modulus, heights=f.scene.heights, weight=self.weight)

    def drawn(self, f: Compared, key: Key, h: Array) -> Estimate:
        """Over the contacts of the listed surfaces."""
        above, below = np.zeros((2, len(f.listed), len(h)))
        for i, s in enumerate(f.listed):
            e, overlap = f.of(key).modulus(s), s - h[:, None]
            weights = np.where(overlap > 0, np.abs(overlap) ** POWERS[self.weight], 0.0)
            weights *= e if self.weight == "load" else 1.0
            above[i], below[i] = weights @ e, weights.sum(axis=1)
        return _ratio([above], [below])


Measure = Mean | Modulus


def over_separation(f: Compared, label: str, what: Measure, key: str = "", n_surfaces: int = 0) -> Series:
    """Return what is measured on a scene, by default that of the label, over the separation.

    Points are where so many surfaces (default: all) have enough contacts for an error; there are none if a
    modulus is not positive at all separations of what is measured.
    """
    key, n, points = key or label, n_surfaces or f.scene.n_surfaces, None
    known = (f.theory(key, "contacts", f.h) * n >= ENOUGH) & (n > 1)
    with suppress(SceneError):
        if known.any():
            (mean, stderr), exact = what.drawn(f, key, f.h), what.exact(f, key, f.h)
            points = Points(f.h[known], mean[known], stderr[known], exact[known])
    return Series(label, f.line, what.exact(f, key, f.line), points)


def ratio(f: Compared, title: str, symbol: str, what: Measure, gammas: Gammas, at: Array) -> Panel:
    """Draw a ratio to the reference: of a sweep over gamma, else over the separation for each other scene."""
    ylabel = rf"${symbol}_\mathrm{{{'hom' if f.swept else 'ref'}}}$"
    if not f.swept:
        series = tuple(over_separation(f, label, what) for label in f.others)
        return Panel(title, SEPARATION, ylabel, series, level=1.0)
    line, known = gammas
    mean, stderr = np.array([what.drawn(f, float(g), at) for g in known]).transpose(1, 2, 0)
    curves, truth = (np.array([what.exact(f, float(g), at) for g in each]).T for each in gammas)
    series = tuple(
        Series(f"d/σ = {h:g}", line, curve, Points(known, *each))
        for h, curve, *each in zip(at, curves, mean, stderr, truth, strict=True)
    )
    return Panel(title, GAMMA, ylabel, series, level=1.0)
