"""The figures of `mcgw figures`: one row each, of the paper's preset swept over gamma or of any scene."""

from collections.abc import Collection, Iterator
from dataclasses import replace
from importlib.resources import files

from mcgw.figures import populations, ratios
from mcgw.figures.compared import Compared
from mcgw.figures.data import FigureData
from mcgw.machine.progress import steps
from mcgw.scene.scene_file import scene_from

_SURFACES = 2000  # of the paper's figures


# Figures of the paper by number, then all others by name.
CATALOGUE = tuple(
    sorted(
        (*ratios.FIGURES, *populations.FIGURES),
        key=lambda row: (not row.name.startswith("figure-"), row.name),
    )
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
