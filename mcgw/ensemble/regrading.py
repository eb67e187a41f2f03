"""Another grading, quantity or separation on the same surfaces: one product, nothing drawn again."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analytic import Grading
from mcgw.ensemble.ensemble import Arrays, Ensemble
from mcgw.ensemble.simulation import kept
from mcgw.sampling.block import Block
from mcgw.sampling.counted import Counted
from mcgw.sampling.samplers import regraded

__all__ = ["Paired", "paired_ratio", "regrade"]

Array = NDArray[np.float64]

_ROWS = 1024  # surfaces at a time
_PAIRED = ("surface", "separations", "heights", "n_asperities", "count", "seed")


def regrade(
    ensemble: Ensemble,
    grading: Grading,
    *,
    quantities: Sequence[str] | None = None,
    separations: Sequence[float] | None = None,
) -> Ensemble:
    """Give the surfaces of an ensemble another grading.

    Parameters
    ----------
    ensemble : Ensemble
        Simulated with ``keep = "moments"``.
    grading : Grading
        The new E*(s)/E*, smooth inside the cells of the ensemble.
    quantities : sequence of str, optional
        Any; left out: those of the ensemble.
    separations : sequence of float, optional
        Edges of its cells, such as its own separations; left out: these.

    Returns
    -------
    Ensemble
        Of the same surfaces, in memory; with no breaks in the grading, what a new simulation with the
        same seed would give.

    Raises
    ------
    ValueError
        If the moments were not kept, or are those of other cells, or if a separation or break is no edge
        of the cells.
    """
    old = ensemble.scene
    if old.keep != "moments":
        raise ValueError('the file keeps no moments: simulate it with keep = "moments" under [ensemble]')
    scene = replace(
        old,
        grading=grading,
        quantities=tuple(quantities or old.quantities),
        separations=tuple(separations or old.separations),
        n_surfaces=ensemble.n_surfaces,
    )
    cells = regraded(scene, old)
    _check_cells(cells, ensemble)
    _check_edges("separation", scene.separations, cells.mesh.edges)
    _check_edges("break of the grading", scene.modulus.breaks, cells.mesh.edges)
    extras = ensemble.sums.read("extras", 0, None)
    parts = []
    for first in range(0, ensemble.n_surfaces, _ROWS):
        stop = min(first + _ROWS, ensemble.n_surfaces)
        moments = ensemble.sums.read("moments", first, stop)
        counts = ensemble.sums.read("cells", first, stop)
        own = extras[(extras[:, 0] >= first) & (extras[:, 0] < stop)]
        sums = cells.sums(first, np.ascontiguousarray(moments.T), np.ascontiguousarray(counts.T), own)
        parts.append(kept(scene, Block(sums, moments, counts, own)))
    arrays = {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
    return Ensemble(scene, ensemble.sampler, Arrays(arrays))


def _check_cells(drawn: Counted, ensemble: Ensemble) -> None:
    """The moments must be of the cells that this version makes."""
    found = tuple(ensemble.sums.read(name, 0, 1).shape[1] for name in ("cells", "moments"))
    if found != (drawn.cells, drawn.moments):
        raise ValueError(
            "the moments kept are of other cells, as another version of mcgw makes them; "
            "regrade with that version, or simulate the scene anew"
        )


def _check_edges(what: str, wanted: Sequence[float], edges: Array) -> None:
    """Every separation, and every break among the cells, must be an edge."""
    for s in wanted:
        if (what == "separation" or edges[0] < s < edges[-1]) and s not in edges:
            near = edges[np.argmin(np.abs(edges - s))]
            raise ValueError(f"{what} {s:.6g} is no edge of the cells (the nearest is {near:.6g})")


@dataclass(frozen=True)
class Paired:
    """Two ensembles of the same surfaces, compared surface by surface; arrays over the separations.

    Parameters
    ----------
    ratio, stderr : ndarray
        Ratio of the means and its standard error.
    gain : ndarray
        Variance of the ratio of two independent ensembles of this size over that of the pair.
    """

    ratio: Array
    stderr: Array
    gain: Array


def paired_ratio(numerator: Ensemble, denominator: Ensemble, quantity: str) -> Paired:
    """Ratio of two means over the same surfaces: Eqs. (12) and (15) of the paper by Monte Carlo.

    Parameters
    ----------
    numerator, denominator : Ensemble
        Of the same surfaces, such as from `regrade`.
    quantity : str
        One they share.

    Returns
    -------
    Paired
        The error is that of ``b - r a`` over the surfaces (delta method), in which what both share
        cancels.

    Raises
    ------
    ValueError
        If the two differ in anything but grading and quantities; the line says in what.
    """
    differ = [name for name in _PAIRED if getattr(numerator.scene, name) != getattr(denominator.scene, name)]
    differ += [
        name for name in ("n_surfaces", "sampler") if getattr(numerator, name) != getattr(denominator, name)
    ]
    if differ:
        raise ValueError(
            f"a paired ratio takes two ensembles of the same surfaces; these differ in {', '.join(differ)}"
        )
    b, a = (e.values(quantity).astype(np.float64) for e in (numerator, denominator))
    ratio = b.mean(axis=0) / a.mean(axis=0)
    residual = (b - ratio * a).var(axis=0, ddof=1)
    apart = b.var(axis=0, ddof=1) + ratio**2 * a.var(axis=0, ddof=1)
    return Paired(ratio, np.sqrt(residual / len(a)) / a.mean(axis=0), apart / residual)
