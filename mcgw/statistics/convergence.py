"""The statistical convergence test, for this simulator and for a user's sampler or contact law."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.stats import binom, poisson

from analytic import quantity_of
from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.results import Results, joined
from mcgw.ensemble.simulation import simulate
from mcgw.formats.table import Column, Drawn, Table, evenly
from mcgw.machine.process import Progress, steps
from mcgw.machine.terminal import brief
from mcgw.scene.kinds import check_object
from mcgw.scene.scene import Scene
from mcgw.statistics.checks import PrincipalComponents, Slope, along_axes, slope, worst
from mcgw.statistics.verdict import Check, together, verdict

Sums = Mapping[str, NDArray[Any]]
Draw = Callable[[Scene], Sums]
Rows = Iterator[tuple[float, Array, float]]  # for a slope

SEEDS = 24


@dataclass(frozen=True, repr=False)
class Convergence(Drawn):
    """Result of the convergence test.

    Parameters
    ----------
    scene : Scene
        As tested: some of the separations, surfaces of one seed.
    checks : tuple of Check
        All of them.
    slopes : tuple of Slope
        Of the error, in M and in N.
    scores : ndarray
        Means of all seeds along all axes, in standard errors.
    """

    scene: Scene
    checks: tuple[Check, ...]
    slopes: tuple[Slope, ...]
    scores: Array

    @property
    def p(self) -> float:
        """Probability that the worst check is this bad by chance alone (Bonferroni)."""
        return together(self.checks).p

    @property
    def passed(self) -> bool:
        """Whether it passed; a correct sampler fails with a probability of 1/1000 at most."""
        return together(self.checks).agrees

    @property
    def word(self) -> str:
        """Whether it passed."""
        return "passed" if self.passed else "FAILED"

    def sheet(self) -> Table:
        """Return the verdict and its worst checks."""
        first = np.argsort([check.p for check in self.checks], kind="stable")[:8]  # checks displayed
        facts = [("p", f"{self.p:.3g} over all {len(self.checks)} checks")]
        return self.table().at(first.tolist()).under(f"Statistical convergence {self.word}", facts)

    def table(self) -> Table:
        """Every check."""
        names, p, seen = zip(*((each.name, each.p, brief(each.seen)) for each in self.checks), strict=True)
        return Table((Column("check", names), Column("p", p, form=".3g"), Column("seen", seen)))


def converge(
    scene: Scene, draw: Draw | None = None, *, seeds: int = SEEDS, progress: Progress = None, **changes: Any
) -> Convergence:
    """Test a sampler against the exact theory of a scene.

    Parameters
    ----------
    scene : Scene
        What to simulate; 64 to 1000 surfaces a seed and at most 12 of its separations are taken.
    draw : callable, optional
        Takes a scene (whose seed, number of surfaces and of asperities vary) and returns each quantity in
        SI units, shape (surfaces, separations); default: this simulator.
    seeds : int, optional
        How many ensembles.
    progress : bool or callable, optional
        True: a bar; a function: called with (done, total) ensembles.
    **changes
        Fields of the scene to change: see `mcgw.Scene.replace`.

    Returns
    -------
    Convergence
        Checks, slopes and the verdict.

    Raises
    ------
    ValueError
        If nothing touches, or means are known better than values.
    SceneError, TypeError
        As from `mcgw.Scene.replace`.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> scene = mcgw.Scene(surface, separations=[0, 1], seed=1)
    >>> mcgw.converge(scene, n_surfaces=64, seeds=8).passed
    True
    """
    check_object("converge", scene, Scene)
    scene = scene.replace(**changes)
    if not scene.touching:
        raise ValueError(
            f"contact.separations: no height reaches d/sigma = {scene.lowest:g}, so there is nothing to "
            "test; give smaller ones"
        )
    draw, h = draw or _own, np.unique(scene.separations)
    scene = scene.replace(  # few separations, in order, and a feasible number of surfaces
        separations=h[evenly(len(h), 12)], n_surfaces=min(max(scene.n_surfaces, 64), 1000),
        interaction=None, rel_err=None, max_seconds=None, keep="sums",
    )  # fmt: skip
    numbers = steps(range(seeds), "ensembles", progress)
    parts = [draw(scene.replace(seed=(scene.seed + k) % 2**64)) for k in numbers]
    sums = joined([{name: part[name] for name in scene.quantities} for part in parts])
    exact = PrincipalComponents.of(scene)
    y = exact.turn(sums)
    whole = scene.replace(n_surfaces=len(y))
    means = verdict(Ensemble(whole, "drawn", Results(sums)))
    checks = [means, *_contacts(whole, sums), *_repeats(scene, sums)]
    slopes: list[Slope] = []
    z = np.empty(0)
    if y.shape[1]:
        found, z = along_axes(exact, y.reshape(seeds, scene.n_surfaces, -1))
        checks += found
        slopes += slope("M", _of_surfaces(exact, y, scene.n_surfaces))
        slopes += slope("N", _of_asperities(scene, draw))
        checks += [each.check for each in slopes]
    return Convergence(scene, tuple(checks), tuple(slopes), z)


def _own(scene: Scene) -> Sums:
    drawn = simulate(scene)
    return {name: drawn.values(name) for name in scene.quantities}


def _contacts(scene: Scene, sums: Sums) -> list[Check]:
    """Test the number of contacts of all surfaces: binomial or Poisson, exact however few they are."""
    if "contacts" not in scene.quantities:
        return []
    total = np.rint(np.asarray(sums["contacts"], dtype=np.float64).sum(axis=0))
    share = scene.heights.sf(np.array(scene.separations))
    tried = float(scene.n_surfaces) * scene.n_asperities
    exact = binom(tried, share) if scene.count == "fixed" else poisson(tried * share)
    p = np.minimum(2 * np.minimum(exact.cdf(total), exact.sf(total - 1)), 1.0)

    def seen(k: int) -> str:
        return f"{total[k]:.0f} at d/sigma = {scene.separations[k]:g}, {tried * share[k]:.1f} expected"

    return [worst("number of contacts", p, seen)]


def _repeats(scene: Scene, sums: Sums) -> list[Check]:
    """Surfaces that give the same number to the last bit, which independent ones never do."""
    name = next((name for name in scene.quantities if not quantity_of(name).counts), None)
    if name is None or scene.touching < 100:
        return []
    values = sums[name][:, int(np.argmin(scene.separations))]
    again = len(values) - len(np.unique(values))
    # Two Gaussian numbers share their last bit with probability spacing/(2 sqrt(pi) std); their last ten
    # times as often, which leaves room for rounding.
    spacing = float(np.spacing(np.abs(values).max()))
    expected = 10 * spacing / max(float(values.std()), spacing) * len(values) ** 2 / 2
    return [Check("repeated surfaces", f"{again} of {len(values)}", float(poisson.sf(again - 1, expected)))]


def _of_surfaces(exact: PrincipalComponents, y: Array, most: int) -> Rows:
    """Error of means of 1, 4, 16, ... surfaces, each size from surfaces of its own."""
    sizes = [m for m in 4 ** np.arange(8) if m <= most // 4]
    kurtosis = float(exact.kurtosis.mean())
    for m, part in zip(sizes, np.array_split(y, len(sizes)), strict=True):
        means = part[: len(part) // m * m].reshape(-1, m, y.shape[1]).mean(axis=1)
        if means.size >= 24:  # squares for a root mean square, at least
            yield float(m), np.asarray(means**2), kurtosis / m


def _of_asperities(scene: Scene, draw: Draw) -> Rows:
    """Relative error of one surface of N/64, N/16, N/4, N asperities, at the lowest separation."""
    name = scene.quantities[0]
    for divisor in (k for k in (64, 16, 4, 1) if scene.n_asperities >= k):
        small = scene.replace(
            n_asperities=scene.n_asperities // divisor, separations=(scene.lowest,), quantities=(name,),
            seed=(scene.seed + 10**6 + divisor) % 2**64,
        )  # fmt: skip
        exact = PrincipalComponents.of(small, (name,))
        if exact.axes.size:
            y = exact.turn(draw(small))[:, 0] * exact.std[0] / exact.mean[0]
            yield float(small.n_asperities), np.asarray(y**2), float(exact.kurtosis[0])
