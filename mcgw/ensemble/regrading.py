"""Another grading, quantity or separation on the same surfaces: one product, nothing drawn again."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic import Grading
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import MemoryResults, joined
from mcgw.ensemble.simulation import blocks, kept
from mcgw.sampling.block import Block
from mcgw.sampling.counted import Counted
from mcgw.sampling.samplers import regraded, sampler_of
from mcgw.scene.scene import Scene
from mcgw.scene.storable import storable

__all__ = ["regrade"]

Array = NDArray[np.float64]

_ROWS = 1024  # surfaces at a time
_SAME = 1e-9  # relative difference of sums that are only rounded differently


def regrade(
    ensemble: Ensemble,
    grading: Grading | Callable[[Any], Any],
    *,
    quantities: Sequence[str] | None = None,
    separations: ArrayLike | None = None,
) -> Ensemble:
    """Give the surfaces of an ensemble another grading.

    Nothing is drawn again if the ensemble keeps its moments (``keep = "moments"``). Otherwise the very same
    surfaces are drawn once more from their seed, which takes as long as simulating them, and checked
    against what the ensemble holds.

    Parameters
    ----------
    ensemble : Ensemble
        Of the sampler ``cells`` or ``aggregate``.
    grading : Grading or callable
        The new E*(s)/E*, as `mcgw.Scene` takes it, smooth inside the cells of the ensemble. A function is
        resolved.
    quantities : sequence of str, optional
        Any; default: those of the ensemble.
    separations : array_like, optional
        Edges of its cells, such as its own separations; default: these.

    Returns
    -------
    Ensemble
        Of the same surfaces, in memory; with no breaks in the grading, what a new simulation with the
        same seed would give.

    Raises
    ------
    ValueError
        If the sampler has no moments, if the moments are those of other cells, or if a separation or break
        is not an edge of the cells.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> e = mcgw.simulate(mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=100, seed=1))
    >>> stiffer = mcgw.regrade(e, mcgw.Exponential(2.0))
    >>> bool((stiffer.contacts == e.contacts).all()), bool((stiffer.load > e.load)[:, 1:].all())
    (True, True)
    """
    old = ensemble.scene
    asked = old.replace(
        grading=grading,
        quantities=quantities or old.quantities,
        separations=old.separations if separations is None else separations,
        n_surfaces=ensemble.n_surfaces,
    )
    again = replace(old, sampler=ensemble.sampler, keep="moments", n_surfaces=ensemble.n_surfaces)
    scene = storable(asked)
    cells = regraded(scene, again)
    parts, first = [], 0
    for moments, counts, own in _read(ensemble, cells) if old.keep == "moments" else _again(ensemble, again):
        sums = cells.sums(first, np.ascontiguousarray(moments.T), np.ascontiguousarray(counts.T), own)
        parts.append(kept(scene, Block(sums, moments, counts, own)))
        first += len(moments)
    return Ensemble(scene, ensemble.sampler, MemoryResults(joined(parts)))


def _read(ensemble: Ensemble, drawn: Counted) -> Iterator[tuple[Array, Array, Array]]:
    """Moments, counts and single asperities of some surfaces at a time, as the ensemble keeps them."""
    _check_cells(drawn, ensemble)
    outside = ensemble.sums.read("extras", 0, None)
    for first in range(0, ensemble.n_surfaces, _ROWS):
        stop = min(first + _ROWS, ensemble.n_surfaces)
        own = outside[(outside[:, 0] >= first) & (outside[:, 0] < stop)]
        yield ensemble.sums.read("moments", first, stop), ensemble.sums.read("cells", first, stop), own


def _again(ensemble: Ensemble, scene: Scene) -> Iterator[tuple[Array, Array, Array]]:
    """The same, drawn once more; refused if they are not the surfaces of the ensemble."""
    first = 0
    for block in blocks(scene, sampler_of(scene)):
        if block.moments is None or block.counts is None or block.extras is None:
            raise AssertionError("a sampler that keeps moments gives them")
        for name, values in block.sums.items():
            held = ensemble.sums.read(name, first, first + len(values))
            if not np.allclose(values, held, rtol=_SAME, atol=_SAME * float(np.abs(held).mean())):
                raise ValueError(
                    f"the surfaces cannot be drawn again: their {name} differs (another version of "
                    'mcgw, or a run that is not finished); simulate them with keep = "moments"'
                )
        yield block.moments, block.counts, block.extras
        first += len(block.moments)


def _check_cells(drawn: Counted, ensemble: Ensemble) -> None:
    """The moments must be of the cells that this version makes."""
    found = tuple(ensemble.sums.read(name, 0, 1).shape[1] for name in ("cells", "moments"))
    if found != (drawn.cells, drawn.moments):
        raise ValueError(
            "the moments kept are of other cells, as another version of mcgw makes them; "
            "regrade with that version, or simulate the scene anew"
        )
