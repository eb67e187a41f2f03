"""Another grading, contact law, quantity or separation on the same surfaces."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from analytic import Grading, quantity_of
from analytic.arrays import Array
from analytic.laws import ContactLaw
from mcgw.ensemble.drawing import answered, blocks, kept
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.half_space import scene_alone
from mcgw.ensemble.results import MemoryResults, joined
from mcgw.sampling.asperities import listing_sampler, summits_drawn
from mcgw.sampling.block import Block
from mcgw.sampling.counted import Counted
from mcgw.sampling.direct import asperity_sums
from mcgw.sampling.samplers import regraded, sampler_of
from mcgw.scene.arguments import as_toml, check_object
from mcgw.scene.laws import read_law
from mcgw.scene.promises import promise_of
from mcgw.scene.scene import Scene, drawn_by, storable

Drawn = tuple[Array, Array, Array]  # moments, counts and single asperities of some surfaces
Tables = dict[str, NDArray[Any]]

_ROWS = 1024  # surfaces at a time
_CONTACT = ("unload_from", "film", "interaction", "joint")
_HEIGHTS = 2**18  # at a time, or one surface
_SAME = 1e-9  # relative difference of sums that are only rounded differently


def regrade(
    ensemble: Ensemble,
    grading: Grading | Callable[[Any], Any] | None = None,
    *,
    law: ContactLaw | dict[str, Any] | None = None,
    quantities: Sequence[str] | None = None,
    separations: ArrayLike | None = None,
    **contact: Any,
) -> Ensemble:
    """Give the surfaces of an ensemble another grading, or another contact law.

    Nothing is drawn again if the ensemble keeps its moments (``keep = "moments"``) and its cells have
    edges wherever a piece of the contact law begins, as always under Hertz's. Otherwise the same surfaces
    are drawn once more from their seed, and checked against the ensemble. Under Hertz's law that takes as
    long as simulating them. With another law, before or after, it takes much longer: each contact is
    summed by its formula at each separation, some 1e-7 s for one contact, separation and quantity.

    Parameters
    ----------
    ensemble : Ensemble
        Of any sampler that draws real surfaces; for another contact law of one that draws asperities one by
        one.
    grading : Grading or callable, optional
        The new E*(s)/E*, as `mcgw.Scene` takes it; from kept moments it must be smooth inside the cells of
        the ensemble. A function is resolved. Default: that of the ensemble.
    law : ContactLaw or dict, optional
        The new one, as `mcgw.KogutEtsion(critical=0.05)`, or `mcgw.Hertz()`; as `mcgw.Scene` takes it.
        Default: that of the ensemble.
    quantities : sequence of str, optional
        Any; default: those of the ensemble that still exist.
    separations : array_like, optional
        From kept moments: edges of the cells, such as the ensemble's own separations. Otherwise: any that are
        not lower than the ensemble's. Default: those of the ensemble.
    **contact
        ``unload_from``, ``film``, ``interaction`` or ``joint``, where they are to change;
        None leaves them out. By default they stay, where the law has them.

    Returns
    -------
    Ensemble
        Of the same surfaces, in memory. A new simulation with the same seed draws these surfaces only if it
        has the same cells: neither a break of the grading nor another contact law may move their edges.

    Raises
    ------
    ValueError
        If each surface finds its own equilibrium (``interaction.at = "nominal"``), the ensemble has no
        cells, a separation or break is not an edge of them, the moments kept do not resolve what is
        asked, or the surfaces that are drawn again are not those of the ensemble (of another version, or
        of a run that is not finished), or only statistics are kept.
    SceneError, TypeError
        As from `mcgw.Scene.replace`.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> e = mcgw.simulate(mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=100, seed=1))
    >>> stiffer = mcgw.regrade(e, mcgw.Exponential(2.0))
    >>> bool((stiffer.contacts == e.contacts).all()), bool((stiffer.load > e.load)[:, 1:].all())
    (True, True)
    >>> metal = mcgw.regrade(e, law=mcgw.KogutEtsion(critical=0.05))
    >>> mcgw.paired_ratio(metal, e, "load").ratio.round(1)
    array([0.7, 0.7, 0.8])
    """
    check_object("regrade", ensemble, Ensemble)
    scene_alone(ensemble.scene, "regrade")
    if ensemble.scene.keep == "statistics":
        raise ValueError(
            'keep = "statistics": single surfaces are not kept; simulate the scene with the other '
            "grading or law and the same seed, which gives the same surfaces"
        )
    scene = storable(regraded_scene(ensemble, grading, law, quantities, separations, contact))
    scene_alone(scene, "regrade")
    cells = _fitting(ensemble, scene)
    parts = list(_of_moments(ensemble, scene, cells) if cells else _of_heights(ensemble, scene))
    return Ensemble(scene, ensemble.sampler, MemoryResults(joined(parts)), ensemble.surfaces_of)


def regraded_scene(
    ensemble: Ensemble,
    grading: Grading | Callable[[Any], Any] | None,
    law: ContactLaw | dict[str, Any] | None,
    quantities: Sequence[str] | None = None,
    separations: ArrayLike | None = None,
    contact: dict[str, Any] | None = None,
) -> Scene:
    """What is asked of the surfaces of an ensemble; arguments as of `regrade`."""
    contact = contact or {}
    if unknown := set(contact) - set(_CONTACT):
        raise TypeError(f"regrade: {sorted(unknown)[0]!r} cannot be changed; {', '.join(_CONTACT)} can")
    old = ensemble.scene
    law = old.law if law is None else read_law(as_toml(law))
    contact = {**_unknown_under(law), **contact}
    if quantities is None:
        left = {**vars(old), **contact}
        quantities = [
            q.name
            for q in map(quantity_of, old.quantities)
            if not (q.unloading and left["unload_from"] is None)
            and not (q.base == "conductance_si" and left["film"] is None)
            and not (q.base == "yielded" and law.elastic)
        ]
    return old.replace(
        grading=old.grading if grading is None else grading,
        law=law,
        quantities=quantities,
        separations=old.separations if separations is None else separations,
        n_surfaces=ensemble.n_surfaces,
        **contact,
    )


def _unknown_under(law: ContactLaw) -> dict[str, None]:
    """What there cannot be under a law."""
    unknown: dict[str, None] = {}
    try:
        law.unloading()
    except ValueError:
        unknown["unload_from"] = None
    return unknown


def _fitting(ensemble: Ensemble, scene: Scene) -> Counted | None:
    """Cells whose moments serve the scene; None if the heights must, where a law is not Hertz's."""
    hertzian = all(x.hertzian for x in (scene, ensemble.scene, ensemble.surfaces_of))
    if not (hertzian or ensemble.scene.keep == "moments") or not promise_of(ensemble.sampler).keeps_moments:
        return None
    try:
        return regraded(scene, _with_moments(ensemble))
    except ValueError:
        if hertzian:
            raise
        return None


def _of_moments(ensemble: Ensemble, scene: Scene, cells: Counted) -> Iterator[Tables]:
    """What is kept of each block of surfaces, from its moments."""
    first = 0
    for drawn in _read(ensemble, cells) if ensemble.scene.keep == "moments" else _again(ensemble):
        yield kept(scene, Block(_sums(cells, first, drawn), *drawn))
        first += len(drawn[0])


def _of_heights(ensemble: Ensemble, scene: Scene) -> Iterator[Tables]:
    """The same from the heights; moments that are there stay."""
    first = 0
    for sums in sums_of_heights(ensemble, scene):
        stop = first + len(next(iter(sums.values())))
        drawn = _held(ensemble, first, stop) if scene.keep == "moments" else (None, None, None)
        yield kept(scene, Block(sums, *drawn))
        first = stop


def _with_moments(ensemble: Ensemble) -> Scene:
    """The scene that gives the surfaces of an ensemble, and their moments."""
    scene = drawn_by(ensemble.surfaces_of, ensemble.sampler)
    return replace(scene, keep="moments", n_surfaces=ensemble.n_surfaces)


def _sums(cells: Counted, first: int, drawn: Drawn) -> dict[str, Array]:
    moments, counts, own = drawn
    return cells.sums(first, np.ascontiguousarray(moments.T), np.ascontiguousarray(counts.T), own)


def _read(ensemble: Ensemble, drawn: Counted) -> Iterator[Drawn]:
    """Moments, counts and single asperities of some surfaces at a time, as the ensemble keeps them."""
    found = tuple(ensemble.sums.read(name, 0, 1).shape[1] for name in ("cells", "moments"))
    if found != (drawn.cells, drawn.moments):
        raise ValueError(
            "the kept moments belong to other cells, from another version of mcgw; regrade with that "
            "version, or simulate the scene again"
        )
    for first in range(0, ensemble.n_surfaces, _ROWS):
        yield _held(ensemble, first, min(first + _ROWS, ensemble.n_surfaces))


def _held(ensemble: Ensemble, first: int, stop: int) -> Drawn:
    outside = ensemble.sums.read("extras", 0, None)
    own = outside[(outside[:, 0] >= first) & (outside[:, 0] < stop)]
    return ensemble.sums.read("moments", first, stop), ensemble.sums.read("cells", first, stop), own


def _again(ensemble: Ensemble) -> Iterator[Drawn]:
    """The same, drawn once more; refused if they are not the surfaces of the ensemble."""
    origin = _with_moments(ensemble)
    other = None if ensemble.drawn_for is None else regraded(ensemble.scene, origin)
    first = 0
    for block in blocks(origin, sampler_of(origin)):
        if block.moments is None or block.counts is None or block.extras is None:
            raise AssertionError("a sampler that keeps moments gives them")
        drawn = block.moments, block.counts, block.extras
        sums = _sums(other, first, drawn) if other else block.sums
        check_same(ensemble, first, answered(ensemble.scene, sums))
        yield drawn
        first += len(block.moments)


def sums_of_heights(ensemble: Ensemble, scene: Scene) -> Iterator[dict[str, Array]]:
    """Sums that a scene asks for over the asperities of an ensemble, some surfaces at a time.

    At the lowest separation, sums under the ensemble's own law are compared with those that it holds.

    Raises
    ------
    ValueError
        If the sampler keeps no heights, a separation is lower than all for which they were drawn, or they
        are not those of the ensemble.
    """
    origin = replace(drawn_by(ensemble.surfaces_of, ensemble.sampler), n_surfaces=ensemble.n_surfaces)
    sampler, old = listing_sampler(origin), ensemble.scene
    if scene.lowest < origin.lowest:
        raise ValueError(
            f"separation {scene.lowest:g} is smaller than {origin.lowest:g}, down to which the asperities of "
            "these surfaces were drawn; give larger ones, or simulate the scene again"
        )
    lowest = replace(old, separations=(old.lowest,))
    where = old.separations.index(old.lowest)
    step = max(int(_HEIGHTS / max(origin.touching, 1.0)), 1)
    for first in range(0, ensemble.n_surfaces, step):
        surfaces = range(first, min(first + step, ensemble.n_surfaces))
        listed = [summits_drawn(origin, sampler, number) for number in surfaces]
        numbers = np.array([s.size for s, _ in listed])
        heights, own = np.concatenate([s for s, _ in listed]), [c for _, c in listed if c is not None]
        drawn = numbers, heights, np.ones(heights.size), np.concatenate(own) if own else None
        again = asperity_sums(lowest, *drawn)
        check_same(ensemble, first, answered(lowest, again), slice(where, where + 1))
        yield asperity_sums(scene, *drawn)


def check_same(ensemble: Ensemble, first: int, sums: dict[str, Array], columns: slice = slice(None)) -> None:
    """Compare sums of surfaces from `first` on, at some columns, with those that the ensemble holds.

    Raises
    ------
    ValueError
        If they differ.
    """
    for name, values in sums.items():
        held = ensemble.sums.read(name, first, first + len(values))[:, columns]
        same = max(_SAME, 2 * ensemble.scene.accuracy)
        if not np.allclose(values, held, rtol=same, atol=same * float(np.abs(held).mean())):
            raise ValueError(
                f"the surfaces cannot be drawn again: their {name} differs (another version of "
                'mcgw, or a run that is not finished); simulate them with keep = "moments"'
            )
