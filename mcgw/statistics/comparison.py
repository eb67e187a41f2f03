"""``mcgw.compare``: an ensemble, or all points of a sweep, against theory."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, overload

import numpy as np

from analytic.arrays import Array, Marks
from mcgw.ensemble.ensemble import Ensemble, how_many, shown
from mcgw.ensemble.intervals import interval_columns
from mcgw.ensemble.results import heading
from mcgw.formats.table import SEPARATION, Column, Drawn, Table, joined, stacked
from mcgw.machine.process import Progress, steps
from mcgw.scene.kinds import check_object
from mcgw.statistics.verdict import Check, Tested, laws_of_values, tested, together, verdict
from mcgw.sweeps.axes import label

if TYPE_CHECKING:
    from mcgw.sweeps.sweep import Sweep

_SEPARATIONS = 12  # separations of a point, at most: the cost of theory grows as their square


@dataclass(frozen=True)
class Points:
    """Monte-Carlo means beside theory, all arrays of one shape."""

    x: Array  # separations, or whatever a figure is drawn over
    mean: Array  # by Monte Carlo
    stderr: Array  # standard errors of these
    theory: Array  # exact means
    low: Array | None = None  # ends of 95 % intervals, nan with too few contacts; default: of a normal law
    high: Array | None = None

    @property
    def varies(self) -> Marks:
        """Where the means have an error."""
        return np.asarray(self.stderr > 0)

    @property
    def residual(self) -> Array:
        """(mean - theory)/stderr; 0 where neither fluctuates."""
        difference = self.mean - self.theory
        return np.divide(difference, self.stderr, out=np.zeros_like(difference), where=self.varies)

    @property
    def interval(self) -> tuple[Array, Array]:
        """Ends of the 95 % intervals."""
        half = 1.96 * self.stderr
        if self.low is None or self.high is None:
            return self.mean - half, self.mean + half
        return self.low, self.high


@dataclass(frozen=True, repr=False)
class Comparison(Drawn):
    """A comparison of an ensemble with theory.

    Parameters
    ----------
    ensemble : Ensemble
        What was compared, at the separations that are shown: 100 of them where there are more.
    curves : dict of str to Points
        By quantity, over the separations in SI units; the standard errors are exact.
    verdict : Check
        Of all means, and on the distributions of single surfaces if these were tested.
    of_many : str, optional
        At how many of its separations it is shown; nothing if at all.
    """

    ensemble: Ensemble
    curves: dict[str, Points]
    verdict: Check
    of_many: str = ""

    def sheet(self) -> Table:
        """Return the verdict, and each quantity at the separation where it is farthest from theory."""
        farthest, v = {}, self.verdict
        for name, table in self.tables().items():  # of those that read alike the first, despite rounding
            farthest[name] = table.at([int(np.abs(self.curves[name].residual).round(2).argmax())])
        within = self.ensemble.scene.validity().brief
        facts = [("all means", f"{v.seen}, p = {v.p:.3g}"), ("elasticity", within)]
        facts += [("shown", self.of_many)] if self.of_many else []
        table = stacked(farthest, "quantity", "farthest off")
        return table.under(f"Monte Carlo and theory {v.word}", facts)

    def tables(self) -> dict[str, Table]:
        """By quantity: mean, 95 % interval, standard deviation, theory, residual at each separation shown."""
        found = {}
        for name, c in self.curves.items():
            q = self.ensemble.scene.quantity(name)
            columns = (
                Column("separation", self.ensemble.separations, SEPARATION, form="g"),
                Column("mean", c.mean, unit=q.unit, error=c.stderr),
                *interval_columns(*c.interval, q.unit),
                Column("std", self.ensemble.std(name), unit=q.unit, form=".3g"),
                Column("theory", c.theory, unit=q.unit, error=c.stderr),
                Column("residual", c.residual, form="+z.2f"),
            )
            found[name] = Table(columns, heading(q))
        return found

    def table(self) -> Table:
        """Return a row for each quantity and separation shown."""
        return stacked(self.tables(), "quantity")


@dataclass(frozen=True, repr=False)
class SweepComparison(Drawn):
    """A comparison of a sweep with theory."""

    sweep: "Sweep"
    points: tuple[Tested, ...]  # that can be tested: those whose surfaces fluctuate as real ones do

    @property
    def verdict(self) -> Check:
        """On all points together."""
        found = together([one.verdict for one in self.points])
        return replace(found, seen=f"{found.seen} at the least likely of {len(self.points)} points")

    @cached_property
    def worst(self) -> list[Tested]:
        """All points, the least likely by chance first; of equally likely ones that with the worst mean."""
        return sorted(self.points, key=lambda one: (one.verdict.p, -abs(one.residual.flat[one.row])))

    @property
    def residuals(self) -> Array:
        """Residuals of all points, quantities and separations that count: standard normal, but dependent."""
        return np.concatenate([one.residual[one.counts] for one in self.points])

    def sheet(self, most: int = 7) -> Table:
        """Return the verdict, and the points that are farthest from theory."""
        v, n, z, shown = self.verdict, len(self.points), np.abs(self.residuals), self.worst[:most]
        every = f"p = {v.p:.3g}: {n} times the smallest p of a point, {shown[0].verdict.p:.3g}"
        beyond = f"{(z > 3).sum()} of {len(z)} beyond 3 standard errors"
        facts = [("all points", every), ("residuals", beyond)]
        at = [self.sweep.axes.values_text(one.number) for one in shown]
        rows = joined([one.table(self.sweep.scenes[0]).at([one.row]) for one in shown])
        columns = Column("point", at, ", ".join(self.sweep.axes.keys)), *rows.columns
        return Table(columns, f"Monte Carlo and theory of {n} scenes {v.word}", facts)

    def table(self) -> Table:
        """Return a row for each point, quantity and separation."""
        axes = self.sweep.axes
        tables = [one.table(self.sweep.scenes[0]) for one in self.points]
        at = [axes.at(one.number) for one, x in zip(self.points, tables, strict=True) for _ in range(len(x))]
        keys = (Column(key, [label(values[key]) for values in at]) for key in axes.keys)
        return Table((*keys, *joined(tables).columns))


@overload
def compare(result: Ensemble, *, laws: bool = False, progress: Progress = None) -> Comparison: ...
@overload
def compare(result: "Sweep", *, laws: bool = False, progress: Progress = None) -> "SweepComparison": ...
def compare(
    result: "Ensemble | Sweep", *, laws: bool = False, progress: Progress = None
) -> "Comparison | SweepComparison":
    """Compare the means of an ensemble, or those of every point of a sweep, with theory.

    Parameters
    ----------
    result : Ensemble or Sweep
        Its surfaces must be independent.
    laws : bool, optional
        Also test the values of single surfaces against their exact distributions (Kolmogorov and Smirnov),
        which takes half a second more; the verdict then covers both. Not for a sweep.
    progress : bool or callable, optional
        For a sweep. True: a bar; a function: called with (done, total) points.

    Returns
    -------
    Comparison or SweepComparison
        Curves and verdict; for a sweep its points, with one verdict on all of them.

    Raises
    ------
    ValueError
        If `laws` is set but single values are not kept, or their distribution is not known (see
        `mcgw.statistics.verdict`).

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1], n_surfaces=100, seed=1)
    >>> mcgw.compare(mcgw.simulate(scene)).verdict.agrees
    True
    >>> mcgw.compare(mcgw.sweep(scene, {"grading.gamma": [0.5, 2.0]})).verdict.agrees
    True
    """
    if not isinstance(result, Ensemble):
        from mcgw.sweeps.sweep import Sweep  # imports the samplers

        if isinstance(result, Sweep):
            if laws:
                raise ValueError("laws = True: a sweep keeps no single values; compare one of its scenes")
            numbered = steps([*enumerate(np.ndindex(result.shape))], "points", progress)
            points = (replace(tested(result.ensemble(at), _SEPARATIONS), number=k) for k, at in numbered)
            return SweepComparison(result, tuple(points))
    check_object("compare", result, Ensemble)
    some, found, curves = shown(result), verdict(result), {}
    if laws:
        found = together([found, laws_of_values(result)])
    theory, h = some.scene.theory, some.scene.separations
    for name in some.scene.answers:
        stderr = np.sqrt(theory.cumulants(name, h).variance / some.n_surfaces)
        exact = theory.mean(name, h)
        curves[name] = Points(some.separations, some.mean(name), stderr, exact, *some.interval(name))
    return Comparison(some, curves, found, how_many(result))
