"""Means over elastic surfaces by levels: ``mcgw.elastic``."""

from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass
from itertools import accumulate, pairwise
from pathlib import Path
from typing import Any

import numpy as np

from mcgw.elasticity.levels import LEVELS, QUANTITIES
from mcgw.elasticity.multilevel import FEWEST, Design, Mean, design, difference, mean_of, terms_of
from mcgw.elasticity.solves import Solves
from mcgw.elasticity.sources import maps_of
from mcgw.errors import RunError
from mcgw.formats.files import parts_of
from mcgw.formats.table import Column, Shown, Table
from mcgw.machine.process import Progress, told
from mcgw.maps.synthetic import Spectrum
from mcgw.maps.topography import Topography
from mcgw.scene.kinds import argument
from mcgw.scene.scene import Scene
from mcgw.store.ownership import locked

_UNITS = {"area": "m^2", "stiffness": "N/m", "conductance": "m", "mean_gap": "m", "pressure": "Pa"}


@dataclass(frozen=True, repr=False)
class Elastic(Shown):
    """Means over elastic surfaces.

    Parameters
    ----------
    quantities : tuple of str
        Real area (m^2), stiffness (N/m), conductance C rho (m), and under a pressure the mean gap between
        the deformed surface and the plane (m), at a separation the pressure (Pa).
    found : Mean
        Means and standard errors, in the order of `quantities`.
    levels : Table
        A row for each term: number of maps, CPU seconds for one map, mean and standard deviation of the first
        quantity.
    planned : Design
        Levels, maps and their cost as planned after the pilot, in solves of boundary elements.
    seconds : float
        CPU seconds of all solves, including the pilot's.
    words : str
        Description of the maps, in words.
    """

    quantities: tuple[str, ...]
    found: Mean
    levels: Table
    planned: Design
    seconds: float
    words: str

    def mean(self, quantity: str) -> float:
        """Mean over surfaces, SI units."""
        return float(self.found.mean[self.quantities.index(quantity)])

    def interval(self, quantity: str, level: float = 0.95) -> tuple[float, float]:
        """Confidence interval of the mean (Student's), SI units."""
        low, high = self.found.interval(level)
        k = self.quantities.index(quantity)
        return float(low[k]), float(high[k])

    @property
    def saved(self) -> float:
        """Factor of cost saved over the most expensive level alone, for the same error, as planned."""
        return self.planned.plain / self.planned.cost

    def table(self) -> Table:
        """Return a row for each quantity: mean and interval."""
        low, high = self.found.interval()
        return Table((
            Column("quantity", list(self.quantities)),
            Column("unit", [_UNITS[name] for name in self.quantities]),
            Column("mean", self.found.mean, form=".5g"),
            Column("low", low, "95 % from", form=".5g"),
            Column("high", high, "to", form=".5g"),
        ))  # fmt: skip

    def verdict(self) -> str:
        """How much the cheaper levels helped, in one sentence."""
        plain = f"boundary elements alone: {self.planned.plain:.3g} for the same error"
        if len(self.planned.chain) == 1:
            return f"no cheaper level helps; {plain}"
        return f"{self.planned.cost:.3g} solves by levels, {self.saved:.1f} times less than {plain}"

    def sheet(self) -> Table:
        """Means, intervals and what was saved."""
        return self.table().under(f"Elastic mean over {self.words}", [("cost", self.verdict())])


def elastic(
    source: "Scene | Spectrum | Topography | str | Path | Sequence[Topography | str | Path]",
    *,
    pressure: float | str | None = None,
    separation: float | str | None = None,
    E_star: float | str | None = None,
    quantities: Sequence[str] | None = None,
    rel_err: float = 0.02,
    solves: int | None = None,
    pilot: int = 8,
    seed: int = 1,
    path: str | Path | None = None,
    progress: Progress = None,
) -> Elastic:
    """Find mean area, stiffness and conductance of elastic surfaces under a pressure, or at a separation.

    Sums over the summits of a map take a millisecond and predict most of the result of boundary elements.
    So few solves suffice: the mean of the cheap level comes from many maps, and the differences to a more
    expensive level from a few.

    Parameters
    ----------
    source : Scene, Spectrum, Topography, str, Path or list of them
        A scene that knows its spectrum (m0, m2, m4, or from a fit), or a spectrum: maps are drawn from it.
        One map: Gaussian maps of its spectrum are drawn. A list of periodic maps: the mean is over these.
    pressure : float or str, optional
        Load per nominal area, Pa, or text such as "1 MPa".
    separation : float or str, optional
        Instead: mean gap between the deformed surface and the plane, m, or text such as "2 um". Maps that
        do not touch there count as zero; a solve takes about three times as long.
    E_star : float or str, optional
        Composite modulus, Pa; that of the scene if there is one.
    quantities : sequence of str, optional
        Of ``area``, ``stiffness``, ``conductance`` (C rho) and ``mean_gap``, or of ``pressure`` at a
        separation; all if left out.
    rel_err : float, optional
        Half the width of the 95 % interval over the mean, of the worst quantity, as the pilot plans it.
    solves : int, optional
        Instead: how many solves of boundary elements there may be after the pilot.
    pilot : int, optional
        Maps on which all levels are tried first; they show which levels help and how many maps each needs.
    seed : int, optional
        Of the maps.
    path : str or Path, optional
        File for the solves, one line with a checksum for each; the same call again resumes from it. Damaged
        lines are named in a warning and solved again.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) in solves of boundary elements, as planned.

    Returns
    -------
    Elastic

    Raises
    ------
    ValueError
        If an argument is wrong, or the source has no maps: see `mcgw.elasticity.sources.maps_of`.
    RunError
        If Tamaas is not installed (``pip install -e '.[bem]'`` in a clone), a solve does not converge, or no
        map of the pilot touches.
    StoreError
        If `path` holds solves of another question, or another process adds to it.

    Notes
    -----
    The plan follows from the pilot and fixed costs of the levels, not from measured seconds: the same call
    gives the same numbers.
    The exact theory of summits is never taken as a level's mean: maps of pixels have their own.

    Examples
    --------
    >>> import mcgw
    >>> scene = mcgw.load_scene("spectral.toml")  # doctest: +SKIP
    >>> mcgw.elastic(scene, pressure="1 MPa", rel_err=0.05, path="solves.jsonl")  # doctest: +SKIP
    """
    maps = maps_of(source)
    if E_star is None and not isinstance(source, Scene):
        raise ValueError("E_star: give the composite modulus, which does not follow from a map")
    modulus = source.surface.E_star if E_star is None else argument("E_star", E_star, "Pa")  # type: ignore[union-attr]
    asked = {"pressure": (pressure, "Pa"), "separation": (separation, "m")}
    held = {name: argument(name, value, unit) for name, (value, unit) in asked.items() if value is not None}
    if len(held) != 1:
        raise ValueError("pressure, separation: give one of the two")
    names = QUANTITIES[next(iter(held))]
    wanted = names if quantities is None else tuple(quantities)
    known = [name for name in wanted if name in names]
    if not known or len(known) < len(wanted):
        raise ValueError(f"quantities = {wanted}: give one or more of {', '.join(names)}")
    if not 0 < rel_err < 1 or pilot < FEWEST or (solves is not None and solves < FEWEST):
        raise ValueError(
            f"rel_err = {rel_err}, pilot = {pilot}, solves = {solves}: give 0 < rel_err < 1, and {FEWEST} or "
            "more maps"
        )
    if seed < 0:
        raise ValueError(f"seed = {seed}: give a whole number >= 0")
    file = None if path is None else Path(path)
    with nullcontext() if file is None else locked(parts_of(file)), told(progress, "solves") as tell:
        return _by_levels(Solves(maps, held, modulus, seed, known, file), rel_err, solves, pilot, tell)


def _by_levels(solved: Solves, rel_err: float, solves: int | None, pilot: int, tell: Any) -> Elastic:
    """Pilot, plan, terms."""
    population = solved.maps.number
    tried = _chosen(population, solved.seed, 0, [pilot])[0]
    rows = [solved.at(LEVELS, number) for number in tried]
    values, seconds = (np.array(part) for part in zip(*rows, strict=True))
    costs = [level.cost for level in LEVELS]
    if not values[:, -1].any(axis=0).all():
        raise RunError(f"none of {len(tried)} maps touches; give a smaller separation")
    planned = design(values, costs, rel_err, solves)
    terms, done, samples = terms_of(planned.chain), 0.0, []
    for term, numbers in zip(terms, _chosen(population, solved.seed, pilot, planned.maps), strict=True):
        found = []
        for number in numbers:
            found.append(solved.at([LEVELS[level] for level in term], number)[0])
            done += sum(costs[level] for level in term)
            tell(min(done, planned.cost), planned.cost)
        samples.append(difference(np.array(found)))
    first = [x[:, 0] for x in samples]
    levels = Table((
        Column("term", [" - ".join(LEVELS[level].words for level in term) for term in terms]),
        Column("maps", [len(x) for x in samples], form="d"),
        Column("seconds", [seconds[:, term].mean(axis=0).sum() for term in terms], "s a map", form=".2g"),
        Column("mean", [x.mean() for x in first], f"mean {solved.quantities[0]}", form=".4g"),
        Column("std", [x.std(ddof=1) if len(x) > 1 else 0.0 for x in first], form=".2g"),
    ))  # fmt: skip
    mean, words = mean_of(samples, population), solved.maps.words
    return Elastic(tuple(solved.quantities), mean, levels, planned, solved.seconds, words)


def _chosen(population: int | None, seed: int, first: int, maps: Sequence[int]) -> list[Sequence[int]]:
    """Numbers of the maps of each term: new ones, or of a list that many, in an order of their own."""
    if population is None:
        return [range(*ends) for ends in pairwise(accumulate(maps, initial=first))]
    draws = (np.random.default_rng([seed, first, k]).permutation(population) for k in range(len(maps)))
    return [order[:many].tolist() for order, many in zip(draws, maps, strict=True)]
