"""The figures of `mcgw figures`: one row each, of the paper's preset swept over gamma or of any scene."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from functools import partial
from importlib.resources import files
from typing import Any

import numpy as np

from analytic import mean_modulus
from analytic.arrays import Array
from mcgw.ensemble.simulation import simulate
from mcgw.figures.against_theory import spread
from mcgw.figures.compared import SCENE, Compared, Key
from mcgw.figures.data import GAMMA, SEPARATION, Estimate, FigureData, Panel, Series, ratio_of_sums
from mcgw.figures.ratios import (
    Ratio,
    against_separation,
    area_and_load,
    at_separation,
    equal_load,
    gradings,
    ratio,
)
from mcgw.figures.style import power_of_ten
from mcgw.machine.progress import steps
from mcgw.scene.scene_file import scene_from

_SURFACES = 2000  # of the paper's figures
_SPREADING = ("load", "area", "stiffness")
_PSI = r"$\psi/\psi_\mathrm{hom}$"
_POWERS = {"number": 0.0, "area": 1.0, "load": 1.5}
_LINE = np.linspace(0.2, 2, 73)
_GAMMAS = np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.4, 1.6, 1.8, 2.0])
_AT = np.arange(5.0)
_TITLES = {
    "number": "b  mean over the contacts",
    "area": "c  weighted by area",
    "load": "d  weighted by load",
}


def mean_moduli(f: Compared) -> FigureData:
    """Show the mean modulus of the contacts, which the plasticity index goes as."""
    title, caption = "Plasticity index over that of the homogeneous surface", f.caption_of(len(f.listed))
    if f.swept:
        return FigureData(title, caption, _over_gamma(f))
    plain = f.hertz and f.scene.summits is None  # else area and load of a contact are not powers
    series = []
    many = f.scene.replace(n_surfaces=max(len(f.listed), 1))  # points where their heights are enough
    for weight in _POWERS if plain else ("number",):
        how, label = _Modulus(weight), "contacts" if weight == "number" else weight
        points = f.points(partial(how.drawn, f, SCENE, f.h), how.exact(f, SCENE, f.h), many)
        series.append(Series(label, f.line, how.exact(f, SCENE, f.line), points))
    panel = Panel("", SEPARATION, _PSI, tuple(series), level=1.0)
    said = (
        f"Mean over the contacts, each weighted alike (contacts){', by its area, or by its load' * plain}. "
    )
    return FigureData(title, said + caption, (panel,))


def _over_gamma(f: Compared) -> tuple[Panel, ...]:
    just = tuple(Series(f"d/σ = {h:g}", _LINE, _LINE - (_LINE - 1) * np.exp(-h)) for h in _AT)
    panels = [Panel("a  as in the paper: just touching, s = d/σ", GAMMA, _PSI, just, level=1.0)]
    for weight, title in _TITLES.items():
        panels.append(ratio(f, title, r"$\psi/\psi", _Modulus(weight), _LINE, _GAMMAS, _AT))
    return tuple(panels)


@dataclass(frozen=True)
class _Modulus:
    """Mean of E*(s)/E* over the contacts, weighted."""

    weight: Any

    def exact(self, f: Compared, key: Key, h: Array) -> Array:
        return mean_modulus(h, f.of(key).modulus, heights=f.scene.heights, weight=self.weight)

    def drawn(self, f: Compared, key: Key, h: Array) -> Estimate:
        """Over the contacts of the listed surfaces."""
        above, below = np.zeros((2, len(f.listed), len(h)))
        for i, s in enumerate(f.listed):
            for k, separation in enumerate(h):
                touching = s[s > separation]
                e = f.of(key).modulus(touching)
                weights = (touching - separation) ** _POWERS[self.weight] * (
                    e if self.weight == "load" else 1.0
                )
                above[i, k], below[i, k] = np.sum(weights * e), np.sum(weights)
        return ratio_of_sums([above], [below])


def fluctuations(f: Compared) -> FigureData:
    """Show the standard deviation over the mean: of a sweep from a hundred asperities to a million."""
    if not f.swept:
        series = tuple(spread(name, f.scene, name, f.line, f.drawn(SCENE)) for name in _SPREADING)
        panel = Panel("", SEPARATION, "std / mean", series, ("linear", "log"), level=1.0)
        size = f"{f.scene.surface.nominal_area * 1e6:g} mm²"
        return FigureData(f"Scatter of surfaces of {size}", f.caption, (panel,))
    scene = f.scene.replace(keep="sums", separations=np.linspace(0, 4, 9), quantities=_SPREADING)
    sizes = {n: min(2000, 400_000_000 // n) for n in (100, 10_000, 1_000_000)}
    drawn = {n: simulate(scene.replace(n_asperities=n, n_surfaces=m)) for n, m in sizes.items()}
    line, panels = np.linspace(0, 4, 41), []
    for key, name in zip("abc", scene.quantities, strict=True):
        series = tuple(
            spread(f"N = {power_of_ten(n)}", scene.replace(n_asperities=n), name, line, drawn.get(n), 400)
            for n in (100, 1000, 10_000, 100_000, 1_000_000)
        )
        panels.append(Panel(f"{key}  {name}", SEPARATION, "std / mean", series, ("linear", "log"), 1.0))
    return FigureData(
        "Scatter of finite surfaces",
        f"N asperities per surface; 2000 surfaces (400 for N = 10⁶), seed {scene.seed}. Markers with 95 % "
        "intervals, for 400 contacts or more.",
        tuple(panels),
    )


@dataclass(frozen=True)
class Row:
    """A figure.

    Parameters
    ----------
    name : str
        Name of its files.
    draw : callable
        Computes its numbers from the scenes.
    needs : tuple of str, optional
        What it needs of them, for `_lacking`.
    """

    name: str
    draw: Callable[[Compared], FigureData]
    needs: tuple[str, ...] = ()


CATALOGUE = (
    Row("figure-1", gradings, ("grading",)),
    Row("figure-2", partial(against_separation, title="Load at a given separation (Eq. 7)",
                            quantity="load", words="pressure", unit="Pa")),
    Row("figure-3", partial(at_separation, title="Area per load at a given separation (Eq. 12)",
                            symbol=r"(A/P)\,/\,(A/P)", how=Ratio("area", "load")), ("reference", "pressing")),
    Row("figure-4", mean_moduli, ("grading",)),
    Row("figure-5", partial(against_separation, quantity="stiffness", words="stiffness", unit="Pa/m",
                            title="Stiffness at a given separation; the paper's “conductance”")),
    Row("figure-6", partial(at_separation, title="Stiffness at a given separation (Eq. 15: “conductance”)",
                            symbol="K/K", how=Ratio("stiffness")), ("reference",)),
    Row("area-and-load", area_and_load, ("pressing",)),
    Row("equal-load", equal_load, ("reference", "pressing", "same load")),
    Row("fluctuations", fluctuations, ("several",)),
)  # fmt: skip


def of_paper() -> Compared:
    """Take the surfaces of the preset ``demo``, in the paper's reduced quantities."""
    text = (files("mcgw.scene") / "presets" / "demo.toml").read_text(encoding="utf-8")
    return Compared(scene_from(text).replace(n_surfaces=_SURFACES), swept=True)


def _lacking(f: Compared, need: str) -> str:
    """Say what a scene lacks that a figure needs, or nothing."""
    match need:
        case "grading" if not f.graded:
            return "the scene has no grading: E*(s) = E* at every height"
        case "reference" if not f.others:
            return "the scene is its own reference (homogeneous, Hertz's law): every ratio is 1"
        case "pressing" if any(np.any(f.theory(label, "load", f.line) <= 0) for label in f.all):
            return "the mean load is not positive at every separation"
        case "several" if f.scene.n_surfaces == 1:
            return "there is only one surface"
        case "same load":
            try:
                for label in f.others:
                    f.at_load_of_reference(label, f.line)
            except ValueError:
                return "the scene does not reach the load of its reference at every separation"
    return ""


def figures_of(f: Compared, only: Collection[str] = ()) -> Iterator[tuple[str, FigureData | str]]:
    """Compute the figures of a scene or of a sweep.

    Parameters
    ----------
    f : Compared
        Of a scene its surface, separations, grading, contact law, height law and seed are used.
    only : collection of str, optional
        Names of figures; default: all.

    Yields
    ------
    (str, FigureData or str)
        Name of a figure, and its numbers, or why it has no meaning for this scene.
    """
    for row in steps([row for row in CATALOGUE if not only or row.name in only], "figures"):
        why = next((why for need in row.needs if (why := _lacking(f, need))), "")
        yield row.name, why or replace(row.draw(f), name=row.name)
