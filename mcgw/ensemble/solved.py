"""The result of `mcgw.solve`: the state of surfaces at one given load or real area."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import stdtrit

from analytic import SEPARATIONS, quantity_of
from analytic.arrays import Array
from mcgw.ensemble.at_load import GAPS, asperities_of, mean_surface
from mcgw.ensemble.intervals import FEWEST, MANY, interval_column, laws_are_quick
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import Column, Table
from mcgw.machine.terminal import plotted
from mcgw.sampling.asperities import summits, touching_summits
from mcgw.scene.scene import Scene
from mcgw.scene.validity import Validity
from mcgw.scene.validity_lookup import validity_of

if TYPE_CHECKING:
    from analytic.distribution import Law
    from mcgw.ensemble.budget import Budget, Corrected


@dataclass(frozen=True, repr=False)
class Solution(Shown):
    """The state of surfaces at one given load or real area.

    Parameters
    ----------
    scene : Scene
        The scene that describes the surfaces.
    given : str
        Which quantity was given: "load" or "area".
    value : float
        Its value, N or m^2.
    theory : dict of str to float
        "separation" (d/sigma) and every quantity (SI) of the mean surface, on loading.
        With asperity interaction the separation is the effective one, and "nominal_separation" is given as
        well. "mean_gap" is the distance of the mean planes of the surfaces, m; where they are not known there
        is "gap_to_summits" instead: see `answers_at`.
    surfaces : dict of str to ndarray
        The same for every surface at its own separation, shape (surfaces,).
    drawn : Scene
        The scene with which the surfaces were drawn.
    """

    scene: Scene
    given: str
    value: float
    theory: dict[str, float]
    surfaces: dict[str, Array]
    drawn: Scene

    @property
    def title(self) -> str:
        """The given load or real area, in words."""
        share = self.value / self.scene.surface.nominal_area
        if self.given == "load":
            return f"At the load {self.value:.6g} N = pressure {share / 1e6:.6g} MPa"
        return f"At the real area {self.value:.6g} m^2 = {share:.4%} of the nominal area"

    def heights(self, surface: int) -> Array:
        """Reduced heights of the asperities of a surface in contact at its separation, in descending order.

        Parameters
        ----------
        surface : int
            Its number, from 0.

        Returns
        -------
        ndarray
            Those whose sums are in `surfaces`, in units of sigma.

        Examples
        --------
        >>> import mcgw
        >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
        >>> found = mcgw.solve(mcgw.Scene(surface, separations=0, n_surfaces=20, seed=1), load="1 N")
        >>> found.heights(3).size == int(found.surfaces["contacts"][3])
        True
        """
        return self._contacts(surface)[0]

    def radii(self, surface: int) -> Array:
        """Radii of the asperities in contact, m, in the order of `heights`."""
        s, ratios = self._contacts(surface)
        return np.asarray(self.scene.surface.radius * (np.ones_like(s) if ratios is None else ratios))

    def _contacts(self, surface: int) -> tuple[Array, Array | None]:
        separations = self.surfaces["separation"]
        if not 0 <= surface < separations.size:
            raise ValueError(f"surface = {surface}: give a number from 0 to {separations.size - 1}")
        h = float(separations[surface])
        s, ratios = (summits if h < self.drawn.lowest else touching_summits)(self.drawn, surface)
        order = np.argsort(-s, kind="stable")[: np.count_nonzero(s > h)]
        return s[order], None if ratios is None else ratios[order]

    def interval(self, name: str, level: float = 0.95) -> tuple[float, float]:
        """Confidence interval of the mean over surfaces (Student's t); nan if they have too few contacts."""
        x = self.surfaces[name]
        if len(x) * self.theory["contacts"] < FEWEST:
            return float("nan"), float("nan")
        half = stdtrit(len(x) - 1, (1 + level) / 2) * x.std(ddof=1) / np.sqrt(len(x))
        return float(x.mean() - half), float(x.mean() + half)

    @cached_property
    def separation_law(self) -> "Law | None":
        """Exact distribution over surfaces of the effective separation, d/sigma; None if it is not known.

        It is not known where sums may rise with the separation, as with adhesive asperities.
        """
        try:
            return asperities_of(self.scene).theory.separation_law(self.value, self.given)
        except ValueError:
            return None

    @property
    def told_by(self) -> "Law | None":
        """Distribution that `specimens` uses for separations: the exact one, if that takes milliseconds."""
        return self.separation_law if laws_are_quick(self.scene) else None

    def specimens(self, name: str, share: float = 0.9) -> tuple[float, float]:
        """Range that holds this share of all surfaces, with equal shares below and above it.

        For separations it follows from the exact distribution (see `told_by`); otherwise its ends are
        quantiles of the surfaces drawn.
        """
        ends = np.array([(1 - share) / 2, (1 + share) / 2])
        nominal = name == "nominal_separation" or (name in GAPS and self.scene.interaction is not None)
        moved = self.given == "load" or not nominal  # from the separation, by the same on all surfaces
        exact = name in ("separation", *GAPS, *SEPARATIONS) and moved
        if exact and (law := self.told_by) is not None:
            unit = self.scene.surface.sigma if name in GAPS else 1.0
            if share not in self._ends:
                self._ends[share] = law.ppf(ends)
            low, high = self.theory[name] + unit * (self._ends[share] - self.theory["separation"])
        else:
            low, high = np.quantile(self.surfaces[name], ends)
        return float(low), float(high)

    @cached_property
    def _ends(self) -> dict[float, Array]:
        """Ends of the law of the separation, by share: each takes a search."""
        return {}

    def asperities_for(self, scatter: float) -> dict[str, float]:
        """Number of asperities for which specimens at this pressure, or area fraction, scatter so little.

        Parameters
        ----------
        scatter : float
            Standard deviation over specimens, divided by the answer: 0.01 for one percent.

        Returns
        -------
        dict of str to float
            For area, load, stiffness and conductance, to leading order in 1/N.
        """
        alone = asperities_of(self.scene).theory
        names = [x for x in ("load", "area", "stiffness", "conductance") if x in self.theory]
        if self.scene.interaction is not None:
            names = names[:2]  # the medium counts in series for the others
        h = self.theory["separation"]
        return {
            name: float(alone.asperities_for(name, h, scatter, given=self.given))
            for name in names
            if name != self.given
        }

    def budget(self) -> "Budget":
        """Error budget: how much a real specimen may differ from `theory`, cause by cause.

        The causes are the number of surfaces drawn (it affects the Monte Carlo mean, not the theory), the
        scatter of specimens (from one nominal area to another), the uncertainty of the parameters of the
        surface (``[surface] uncertainty``), and the error of the model against elasticity, where it was
        measured. The total is the root of the sum of their squares.

        Returns
        -------
        Budget
            Half-widths of 95 % intervals, divided by the answers: see `table`, and a sentence in `advice`.

        Examples
        --------
        >>> import mcgw
        >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
        >>> scene = mcgw.Scene(surface, separations=0, n_surfaces=20, seed=1, uncertainty={"sigma": "20 %"})
        >>> budget = mcgw.solve(scene, pressure="1 MPa").budget()
        >>> round(float(budget.shares["parameters"][0]), 2)  # of the area
        0.17
        """
        from mcgw.ensemble.budget import budget_of

        return budget_of(
            self.scene,
            self.title,
            self.theory,
            self.surfaces,
            {name: self.interval(name) for name in self.surfaces},
            against_elasticity([self]),
            lambda scene: mean_surface(scene, self.given, self.value),
            self.given == "load",
        )

    def corrected(self, quantity: str) -> "Corrected":
        """Answer of the theory, corrected by the measured error of the model against boundary elements.

        Parameters
        ----------
        quantity : str
            "area", "stiffness", "conductance", "mean_gap" or "gap_to_summits".

        Returns
        -------
        Corrected
            With the ends between which 95 % of such surfaces lie; nan where nothing was measured, with the
            reason in `why`.
        """
        from mcgw.ensemble.budget import Corrected, corrected

        if self.given != "load":
            return Corrected.unknown("errors of models are measured at a given load")
        std = float(self.surfaces[quantity].std(ddof=1))
        return corrected(against_elasticity([self]), self.scene, quantity, self.theory[quantity], std)

    def plot(self, ax: Any = None) -> Any:
        """Draw how the separation differs from surface to surface; returns the axes."""
        return plotted(self, ax)

    def sheet(self) -> Sheet:
        """Theory and Monte Carlo side by side."""
        many = f"{len(next(iter(self.surfaces.values())))} surfaces of {self.scene.n_asperities} asperities"
        many += ", drawn from the measured summits" if self.scene.as_measured else ""
        facts = [("over", many), ("elasticity", against_elasticity([self]).brief)]
        if (contacts := self.theory["contacts"]) < MANY:
            few = f"{contacts:.2g} contacts per surface: few for theory, which is of a large surface"
            facts.append(("caution", f"{few}; use a larger area"))
        table = self.table()
        table = replace(table, columns=tuple(x for x in table.columns if x.name != "std"))
        if np.isnan(table.flat[-1].values).all():
            table = replace(table, columns=table.columns[:-1])
        found = [k for k, name in enumerate(self.surfaces) if name != self.given]
        return Sheet(table.title, facts, table.at(found))

    def table(self) -> Table:
        """Theory beside the mean over the surfaces, a row for each quantity."""
        units = {**dict.fromkeys(GAPS, "m"), "separation": "sigma", **dict.fromkeys(SEPARATIONS, "sigma")}
        names = list(self.surfaces)
        low, high = np.array([self.interval(name) for name in names]).T
        found = [self.surfaces[name] for name in names]
        least, most = np.array([self.specimens(name) for name in names]).T
        error = (high - low) / 4
        right, below, above, _ = map(np.array, zip(*map(self.corrected, names), strict=True))
        off = Column("corrected_95", (above - below) / 2, form=".1g")
        return Table(
            (
                Column("quantity", names),
                Column("unit", [units.get(name) or self.scene.quantity(name).unit for name in names]),
                Column("theory", [self.theory[name] for name in names], error=error),
                Column("mean", [x.mean() for x in found], error=error),
                interval_column(low, high),
                Column("std", [x.std(ddof=1) for x in found], form=".3g"),
                Column(
                    "specimen_05",
                    least,
                    "90 % of specimens",
                    form=".4g",
                    between=" ... ",
                    beside=Column("specimen_95", most, form=".4g"),
                ),
                Column(
                    "corrected",
                    right,
                    "corrected (95 %)",
                    error=(above - below) / 2,
                    missing="",
                    beside=off,
                    between=" ± ",
                ),
            ),
            self.title,
        )


def against_elasticity(solutions: Sequence[Solution]) -> Validity:
    """Error of the model against elasticity at solutions of one scene, at their effective separations."""
    return validity_of(solutions[0].scene, [each.theory["separation"] for each in solutions])


def at_solutions(scene: Scene, solutions: Sequence[Solution]) -> Scene:
    """The scene at the separations of the mean surface in these solutions, which stand for their loads."""
    h = sorted({each.theory["separation"] for each in solutions})
    loading = [q for q in scene.quantities if not quantity_of(q).unloading] or ["load"]
    return scene.replace(separations=h, unload_from=None, quantities=loading)
