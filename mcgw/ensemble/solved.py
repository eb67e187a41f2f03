"""The result of `mcgw.solve`: the state of surfaces at one given load or real area."""

from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.special import stdtrit

from analytic import SEPARATIONS, yielding_share
from analytic.arrays import Array
from analytic.at_load import Moments
from mcgw.ensemble.at_load import GAPS, Answers, answers_at, controlled, exact_moments
from mcgw.ensemble.budget import Budget, budget_of, corrected
from mcgw.ensemble.intervals import FEWEST, laws_are_quick
from mcgw.ensemble.solved_table import elastic_verdict, sheet_of, table_of
from mcgw.formats.table import Drawn
from mcgw.scene.scene import Scene
from mcgw.validity.lookup import validity_of
from mcgw.validity.model_error import Validity

if TYPE_CHECKING:
    from analytic.distribution import Law


@dataclass(frozen=True, repr=False)
class Solution(Drawn):
    """The state of surfaces at one given load or real area.

    Parameters
    ----------
    scene : Scene
        The scene that describes the surfaces.
    given : str
        Which quantity was given: "load", "area" or "nominal_separation".
    amount : float
        Its value, N, m^2 or d/sigma.
    theory : dict of str to float
        "separation" (d/sigma) and every quantity (SI) of an infinite surface at that pressure, on loading;
        the mean of finite ones is `value`.
        With asperity interaction the separation is the effective one, and "nominal_separation" is given as
        well. "mean_gap" is the distance of the mean planes of the surfaces, m; where they are not known there
        is "gap_to_summits" instead: see `answers_at`.
    loaded : LoadedSurfaces
        Surfaces at this value, and at others given with it.
    number : int
        Of this value among them.
    """

    scene: Scene
    given: str
    amount: float
    theory: dict[str, float]
    loaded: Any
    number: int

    @cached_property
    def surfaces(self) -> dict[str, Array]:
        """The same as `theory` for every surface at its own separation, shape (surfaces,); drawn if need be.

        Raises
        ------
        ValueError
            If surfaces cannot reach the value, or if there are too many asperities to draw.
        """
        return answers_at(self.scene, self.loaded.sums[self.number])

    @property
    def drawn(self) -> Scene:
        """The scene with which the surfaces are drawn."""
        scene: Scene = self.loaded.drawn
        return scene

    @property
    def title(self) -> str:
        """The given load or real area, in words."""
        share = self.amount / self.scene.surface.nominal_area
        if self.given == "load":
            return f"At the load {self.amount:.6g} N = pressure {share / 1e6:.6g} MPa"
        if self.given == "nominal_separation":
            return f"At the nominal separation {self.amount:.6g} sigma"
        return f"At the real area {self.amount:.6g} m^2 = {share:.4%} of the nominal area"

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
        s: Array = self.loaded.contacts(self.number, surface)[0]
        return s

    def radii(self, surface: int) -> Array:
        """Radii of the asperities in contact, m, in the order of `heights`."""
        s, ratios = self.loaded.contacts(self.number, surface)
        return np.asarray(self.scene.surface.radius * (np.ones_like(s) if ratios is None else ratios))

    @cached_property
    def value(self) -> Answers:
        """Mean over specimens, each at its own separation under the given load: the answer of the model.

        Sums of asperities of one radius are averaged exactly where their law is known (see
        `analytic.at_load`), without a draw; what is not a sum, as a resistance, is then the mean of the
        surfaces drawn, corrected by what their sums and separations lack (a control variate). Otherwise it is
        the mean of the surfaces drawn.
        """
        return Answers({name: lambda name=name: self._estimate(name)[0] for name in self.theory})

    @cached_property
    def std(self) -> Answers:
        """Standard deviation over specimens: exact to 2e-4 where `value` is, else of the surfaces drawn."""
        exact = {name: lambda x=x: x for name, x in self._exact.std.items()}
        return Answers({x: exact.get(x, lambda x=x: self.surfaces[x].std(ddof=1)) for x in self.theory})

    def interval(self, name: str, level: float = 0.95) -> tuple[float, float]:
        """Confidence interval of `value` (Student's t); of no width where that is exact.

        nan if the surfaces drawn have too few contacts.
        """
        value, half = self.value[name], self.half_width(name, level)
        if half and self.surfaces.get("contacts", np.array(np.inf)).sum() < FEWEST:
            return float("nan"), float("nan")
        return value - half, value + half

    def half_width(self, name: str, level: float = 0.95) -> float:
        """Return half of the width of `interval`, however few contacts there are; 0 if `value` is exact."""
        _, error, freedom = self._estimate(name)
        return float(stdtrit(freedom, (1 + level) / 2)) * error if error else 0.0

    @property
    def exact(self) -> bool:
        """Whether the means and the scatter of the answers need no draw."""
        return all(name in self._exact.mean for name in self.theory if name != "load_slope")

    def _estimate(self, name: str) -> tuple[float, float, int]:
        """Mean over specimens of an answer, its standard error, and the degrees of freedom of that."""
        exact = self._exact.mean
        return (exact[name], 0.0, 0) if name in exact else self._drawn_estimates[name]

    @cached_property
    def _drawn_estimates(self) -> dict[str, tuple[float, float, int]]:
        """The same of what is not known exactly."""
        exact, drawn = self._exact.mean, self.surfaces
        sums = ("separation", "conductance_si", "stiffness", "area")  # what is given is no control
        known = [(drawn[x], exact[x]) for x in sums if x in exact and x != self.given]
        return {name: controlled(x, known) for name, x in drawn.items() if name not in exact}

    @cached_property
    def _exact(self) -> Moments:
        """Means and standard deviations that need no draw, in the units of `surfaces`."""
        return exact_moments(self.scene, self.given, self.amount)

    @cached_property
    def separation_law(self) -> "Law | None":
        """Exact distribution over surfaces of the effective separation, d/sigma; None if it is not known.

        It is not known where sums may rise with the separation, as with adhesive asperities, nor at a nominal
        separation.
        """
        with suppress(ValueError):
            if self.given != "nominal_separation":
                return self.scene.alone.separation_law(self.amount, self.given)
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
            low, high = self.theory[name] + unit * (law.ppf(ends) - self.theory["separation"])
        else:
            low, high = np.quantile(self.surfaces[name], ends)
        return float(low), float(high)

    def asperities_for(self, scatter: float) -> dict[str, float]:
        """Find how many asperities make specimens at this pressure, or area fraction, scatter so little.

        Parameters
        ----------
        scatter : float
            Standard deviation over specimens, divided by the answer: 0.01 for one percent.

        Returns
        -------
        dict of str to float
            For area, load, stiffness and conductance, to leading order in 1/N.
        """
        names, model = ["load", "area", "stiffness", "conductance"], self.scene.alone
        if self.given == "nominal_separation":
            model = self.scene.theory
        elif self.scene.interaction is not None:
            names = names[:2]  # the medium counts in series for the others
        h = self.theory["separation"]
        return {
            name: float(model.asperities_for(name, h, scatter, given=self.given))
            for name in names
            if name in self.theory and name != self.given
        }

    @cached_property
    def yielding(self) -> float:
        """Share of the contacts that pass first yield at this separation, under an elastic law.

        nan if the scene has no hardness beside such a law: see `analytic.yielding_share`.
        """
        softer = self.scene.softer
        if softer is None or not self.scene.law.elastic:
            return float("nan")
        return float(yielding_share(self.scene.alone, self.theory["separation"], *softer))

    @property
    def verdict(self) -> str:
        """Measured error of the model, and whether contacts yield that it takes as elastic, in one line."""
        return elastic_verdict([self])

    def budget(self) -> Budget:
        """Error budget: how much a real specimen may differ from `value`, cause by cause.

        It is made once. The causes are the number of surfaces drawn (none where `value` is exact), the
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
        >>> scene = mcgw.Scene(surface, separations=0, n_surfaces=20, seed=1)
        >>> scene = scene.replace(uncertainty={"sigma": "20 %"})
        >>> budget = mcgw.solve(scene, pressure="1 MPa").budget()
        >>> round(float(budget.shares["parameters"][0]), 2)  # of the area
        0.17
        """
        return self._budget

    _budget = cached_property(budget_of)

    @cached_property
    def against_elasticity(self) -> Validity:
        """Measured error of the model at this separation."""
        return validity_of(self.scene, [self.theory["separation"]])

    corrected, sheet, table = corrected, sheet_of, table_of
