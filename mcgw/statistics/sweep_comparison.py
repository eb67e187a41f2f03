"""The points of a sweep against theory: each against its own, with one verdict on all of them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import quantity_of
from mcgw.ensemble.asperities_alone import scene_alone
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import SEPARATION, Column, Table
from mcgw.machine.notebook import plotted
from mcgw.machine.progress import Progress, told
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene
from mcgw.statistics.comparison import FALSE_ALARM, Tested, tested
from mcgw.sweeps.axes import label
from mcgw.sweeps.sweep import Sweep

__all__ = ["PointTested", "SweepComparison", "SweepVerdict", "compare_sweep"]

Array = NDArray[np.float64]

_SEPARATIONS = 12  # of a point, at most: what theory takes grows as their square
_LISTED = 7


@dataclass(frozen=True)
class SweepVerdict:
    """A test of all points at once.

    Parameters
    ----------
    smallest : float
        The smallest probability of a point: of a chi-square as large as its own, by chance.
    points : int
        How many are tested.
    """

    smallest: float
    points: int

    @property
    def p(self) -> float:
        """Probability that any of so many points has one as small, at most (Bonferroni).

        It holds whatever points have in common, their surfaces too.
        """
        return min(1.0, self.points * self.smallest)

    @property
    def agrees(self) -> bool:
        """False in at most one of `1/FALSE_ALARM` sweeps that follow the theory."""
        return self.p > FALSE_ALARM

    @property
    def line(self) -> str:
        """Do they agree, and how sure is that."""
        word = "agree" if self.agrees else "DISAGREE"
        return (
            f"Monte Carlo and theory of this model {word}: p = {self.p:.3g} for {self.points} points "
            f"together (false alarms: at most 1 in {1 / FALSE_ALARM:.0f})"
        )


@dataclass(frozen=True)
class PointTested:
    """One point against its theory.

    Parameters
    ----------
    number : int
        Of the point, the last axis fastest.
    tested : Tested
        Its means, and the verdict on them.
    """

    number: int
    tested: Tested

    @property
    def worst(self) -> tuple[int, int]:
        """Quantity and separation, by number, of the mean that is farthest off, of those that count."""
        off = np.where(self.tested.counts, np.abs(self.tested.residual), -1.0)
        quantity, separation = divmod(int(np.argmax(off)), len(self.tested.separations))
        return quantity, separation

    @property
    def unlikely(self) -> tuple[float, float]:
        """What orders points: the probability by chance, and for equal ones how far off the worst mean is."""
        return self.tested.verdict.p, -abs(float(self.tested.residual[self.worst]))


@dataclass(frozen=True, repr=False)
class SweepComparison(Shown):
    """A comparison of a sweep with theory.

    Parameters
    ----------
    sweep : Sweep
        What was compared.
    points : tuple of PointTested
        Those that can be: whose surfaces fluctuate as real ones do.
    """

    sweep: Sweep
    points: tuple[PointTested, ...]

    @property
    def verdict(self) -> SweepVerdict:
        """On all points together."""
        return SweepVerdict(min(one.tested.verdict.p for one in self.points), len(self.points))

    @cached_property
    def worst(self) -> list[PointTested]:
        """The points, those first whose means are the least likely by chance."""
        return sorted(self.points, key=lambda one: one.unlikely)

    @property
    def residuals(self) -> Array:
        """Of all points, quantities and separations that count: standard normal each, and not independent."""
        return np.concatenate([one.tested.residual[one.tested.counts] for one in self.points])

    def plot(self, ax: Any = None) -> Any:
        """Draw how the residuals of all points are distributed; returns the axes."""
        return plotted(self, ax)

    def sheet(self) -> Sheet:
        """The verdict, and the points that are farthest from theory."""
        return self.sheet_of(_LISTED)

    def sheet_of(self, most: int) -> Sheet:
        """As `sheet`, with so many points."""
        v = self.verdict
        word = "agree" if v.agrees else "DISAGREE"
        left = self.sweep.axes.size - v.points
        beyond = int((np.abs(self.residuals) > 3).sum())
        facts = [
            ("all points", f"p = {v.p:.3g}: {v.points} times the smallest p of a point, {v.smallest:.3g}"),
            ("residuals", f"{beyond} of {len(self.residuals)} beyond 3 standard errors"),
            *([("left out", f"{left} stratified points, whose surfaces are no real ones")] if left else []),
        ]
        where = list(self.sweep.axes.points())
        shown = [(one, *one.worst) for one in self.worst[:most]]
        at = [self.sweep.axes.values_text(where[one.number]) for one, *_ in shown]
        columns = (Column("point", at, ", ".join(self.sweep.axes.keys)), *_columns(shown))
        title = f"Monte Carlo and theory of {v.points} scenes {word}"
        return Sheet(title, facts, Table(columns))

    def table(self) -> Table:
        """A row for each point, quantity and separation."""
        where, axes = list(self.sweep.axes.points()), self.sweep.axes
        rows = [
            (one, q, k)
            for one in self.points
            for q, k in np.ndindex(len(one.tested.quantities), len(one.tested.separations))
        ]
        at = [axes.at(where[one.number]) for one, *_ in rows]
        keys = (Column(key, [label(values[key]) for values in at]) for key in axes.keys)
        return Table((*keys, *_columns(rows)))


def _columns(rows: Sequence[tuple[PointTested, int, int]]) -> tuple[Column, ...]:
    """Of points, each at a quantity and a separation, by number."""
    found = [(one.tested, q, k) for one, q, k in rows]
    names = [t.quantities[q] for t, q, _ in found]
    return (
        Column("quantity", names),
        Column("unit", [quantity_of(name).unit for name in names]),
        Column("separation", [t.separations[k] for t, _, k in found], SEPARATION, form="g"),
        Column("mean", [t.mean[q, k] for t, q, k in found]),
        Column("theory", [t.theory[q, k] for t, q, k in found]),
        Column("residual", [t.residual[q, k] for t, q, k in found], form="+.2f"),
        Column("p_of_point", [t.verdict.p for t, *_ in found], form=".2g"),
    )


def compare_sweep(sweep: Sweep, *, progress: Progress = None) -> SweepComparison:
    """As `mcgw.compare`, of a sweep.

    Each point is tested as an ensemble is, at twelve separations at most; of asperities that press each other
    down, stiffnesses are left out, for of the surfaces only their means in series with the half-space are
    kept.
    """
    means = {name: sweep.mean(name).reshape(sweep.axes.size, -1) for name in sweep.scenes[0].quantities}
    found = []
    with told(progress, "points") as tell:
        for i in range(sweep.axes.size):
            tell(i, sweep.axes.size)
            scene = sweep.scenes[i]
            if promise_of(scene.sampler).real_surfaces:
                surfaces = sweep.groups[sweep.places[i].group].n
                found.append(
                    PointTested(i, _tested(scene, surfaces, {q: x[i] for q, x in means.items()}.get))
                )
        tell(sweep.axes.size, sweep.axes.size)
    if not found:
        raise ValueError("stratified points hold means, not ensembles; compare takes another sampler")
    return SweepComparison(sweep, tuple(found))


def _tested(scene: Scene, surfaces: int, mean: Callable[[str], Any]) -> Tested:
    """A point as its asperities are by themselves, where these press each other down."""
    if scene.interaction is not None and not scene.interaction.nominal:
        from analytic.interacting import is_stiffness  # who asks for no interaction needs none of it

        names = tuple(name for name in scene.quantities if not is_stiffness(name))
        scene = scene_alone(scene, "this").replace(quantities=names)
    return tested(scene, surfaces, mean, _SEPARATIONS)
