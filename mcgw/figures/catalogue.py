"""The figures of `mcgw figures`: one row each, of the paper's preset swept over gamma or of any scene."""

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, replace
from importlib.resources import files

import numpy as np

from mcgw.figures import populations, ratios
from mcgw.figures.compared import Compared
from mcgw.figures.data import FigureData
from mcgw.machine.progress import steps
from mcgw.scene.scene_file import scene_from

_SURFACES = 2000  # of the paper's figures


@dataclass(frozen=True)
class Row:
    """A figure.

    Parameters
    ----------
    name : str
        Name of its files.
    draw : callable
        Computes its numbers from the scenes.
    needs : tuple of callables, optional
        Requirements: each returns what is missing, or nothing.
    """

    name: str
    draw: Callable[[Compared], FigureData]
    needs: tuple[Callable[[Compared], str], ...] = ()

    def lacking(self, f: Compared) -> str:
        """Say why the figure has no meaning for a scene, or nothing."""
        return next(filter(None, (need(f) for need in self.needs)), "")


def _grading(f: Compared) -> str:
    return "" if f.graded else "the scene has no grading: E*(s) = E* at every height"


def _reference(f: Compared) -> str:
    """Require another scene for ratios."""
    alone = "the scene is its own reference (homogeneous, Hertz's law): every ratio is 1"
    return "" if f.others else alone


def _pressing(f: Compared) -> str:
    """Require positive loads, for ratios and logarithms."""
    pulls = any(np.any(f.theory(label, "load", f.line) <= 0) for label in f.all)
    return "the mean load is not positive at every separation" if pulls else ""


def _same_load(f: Compared) -> str:
    try:
        for label in f.others:
            f.at_load_of_reference(label, f.line)
    except ValueError:
        return "the scene does not reach the load of its reference at every separation"
    return ""


def _several(f: Compared) -> str:
    return "" if f.scene.n_surfaces > 1 else "there is only one surface"


CATALOGUE = (
    Row("figure-1", ratios.gradings, (_grading,)),
    Row("figure-2", ratios.load),
    Row("figure-3", ratios.area_per_load, (_reference, _pressing)),
    Row("figure-4", populations.mean_moduli, (_grading,)),
    Row("figure-5", ratios.stiffness),
    Row("figure-6", ratios.stiffness_ratios, (_reference,)),
    Row("equal-load", ratios.equal_load, (_reference, _pressing, _same_load)),
    Row("fluctuations", populations.fluctuations, (_several,)),
    Row("area-and-load", ratios.area_and_load, (_pressing,)),
)


def of_paper() -> Compared:
    """Take the surfaces of the preset ``demo``, in the paper's reduced quantities."""
    text = (files("mcgw.scene") / "presets" / "demo.toml").read_text(encoding="utf-8")
    return Compared(scene_from(text).replace(n_surfaces=_SURFACES), swept=True)


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
        yield row.name, row.lacking(f) or replace(row.draw(f), name=row.name)
