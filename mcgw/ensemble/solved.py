"""What holds on surfaces at one given load or area: what `mcgw.solve` finds."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.special import stdtrit

from analytic import SEPARATIONS, Nayak, quantity_of
from analytic.arrays import Array
from mcgw.ensemble.intervals import FEWEST, MANY, interval_column
from mcgw.formats.sheet import Sheet, Shown
from mcgw.formats.table import Column, Table
from mcgw.machine.terminal import plotted
from mcgw.sampling.asperities import summits, touching_summits
from mcgw.scene.scene import Scene
from mcgw.scene.validity import Validity, validity_of


@dataclass(frozen=True, repr=False)
class Solution(Shown):
    """What holds at one given load or area.

    Parameters
    ----------
    scene : Scene
        Of which surfaces.
    given : str
        Which quantity was given: "load" or "area".
    value : float
        Its value, N or m^2.
    theory : dict of str to float
        "separation" (d/sigma) and every quantity (SI) of the mean surface, on loading. Where asperities press
        each other down the separation is what they feel, and "nominal_separation" there besides. "mean_gap"
        is the distance of the mean planes, m: see `with_mean_gap`.
    surfaces : dict of str to ndarray
        The same on every surface at its own separation, shape (surfaces,).
    drawn : Scene
        What the surfaces were drawn by.
    """

    scene: Scene
    given: str
    value: float
    theory: dict[str, float]
    surfaces: dict[str, Array]
    drawn: Scene

    def heights(self, surface: int) -> Array:
        """Reduced heights of the asperities of a surface that touch at its own separation, in falling order.

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
        """Their radii, m, in the order of `heights`; all alike where summits have one radius."""
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
        """Confidence interval of the mean over surfaces, by Student's t; nan for too few contacts of all."""
        x = self.surfaces[name]
        if len(x) * self.theory["contacts"] < FEWEST:
            return float("nan"), float("nan")
        half = stdtrit(len(x) - 1, (1 + level) / 2) * x.std(ddof=1) / np.sqrt(len(x))
        return float(x.mean() - half), float(x.mean() + half)

    def plot(self, ax: Any = None) -> Any:
        """Draw how the separation differs from surface to surface; returns the axes."""
        return plotted(self, ax)

    def sheet(self) -> Sheet:
        """Theory and Monte Carlo side by side."""
        many = f"{len(self.surfaces['separation'])} surfaces of {self.scene.n_asperities} asperities"
        facts = [("over", many), ("elasticity", against_elasticity([self]).brief)]
        if (contacts := self.theory["contacts"]) < MANY:
            few = f"{contacts:.2g} contacts a surface: few for theory, which is of a large one"
            facts.append(("caution", f"{few}; give more area"))
        table = self.table()
        found = [k for k, name in enumerate(self.surfaces) if name != self.given]
        return Sheet(table.title, facts, table.at(found))

    def table(self) -> Table:
        """Theory beside the mean over the surfaces, a row for each quantity."""
        share = self.value / self.scene.surface.nominal_area
        if self.given == "load":
            title = f"At the load {self.value:.6g} N = pressure {share / 1e6:.6g} MPa"
        else:
            title = f"At the real area {self.value:.6g} m^2 = {share:.4%} of the nominal area"
        units = {"mean_gap": "m", "separation": "sigma", **dict.fromkeys(SEPARATIONS, "sigma")}
        names = list(self.surfaces)
        low, high = np.array([self.interval(name) for name in names]).T
        found = [self.surfaces[name] for name in names]
        error = (high - low) / 4
        return Table(
            (
                Column("quantity", names),
                Column("unit", [units.get(name) or quantity_of(name).unit for name in names]),
                Column("theory", [self.theory[name] for name in names], error=error),
                Column("mean", [x.mean() for x in found], error=error),
                interval_column(low, high),
                Column("std", [x.std(ddof=1) for x in found], form=".3g"),
            ),
            title,
        )


def against_elasticity(solutions: Sequence[Solution]) -> Validity:
    """How far the model is from elasticity at solutions of one scene, by what the asperities feel there."""
    return validity_of(solutions[0].scene, [each.theory["separation"] for each in solutions], felt=True)


def at_solutions(scene: Scene, solutions: Sequence[Solution]) -> Scene:
    """The scene at the separations of its mean surface there: what is said of them is said of the loads."""
    name = "nominal_separation" if scene.nominal else "separation"
    h = sorted({each.theory[name] for each in solutions})
    loading = [q for q in scene.quantities if not quantity_of(q).unloading] or ["load"]
    return scene.replace(separations=h, unload_from=None, quantities=loading)


def with_half_space(scene: Scene, alone: Solution) -> Solution:
    """What holds where the asperities press each other down: the sums of each are the same at its load."""
    from mcgw.ensemble.half_space import at_loads  # for those scenes alone

    theory, surfaces = (
        with_mean_gap(scene, at_loads(scene, {k: v for k, v in found.items() if k != "mean_gap"}))
        for found in (alone.theory, alone.surfaces)
    )
    return replace(alone, scene=scene, theory=theory, surfaces=surfaces)


def with_mean_gap(scene: Scene, found: dict[str, Any]) -> dict[str, Any]:
    """The same of what holds at given loads: with "mean_gap", m, after the separations.

    That is how far the rigid plane lies from the mean plane of the surface, or from that of its summits where
    the scene does not tell the other. Where asperities press each other down it is the separation that they
    feel, or the nominal one if that counts from the mean plane itself (`reference = "mean-plane"`).
    """
    nominal = scene.interaction is not None and scene.interaction.reference == "mean-plane"
    h = found["nominal_separation" if nominal else "separation"]
    gap = scene.surface.sigma * (h + (rise_of_summits(scene) or 0.0))
    ahead = {name: found[name] for name in found if name in ("separation", *SEPARATIONS)}
    return {**ahead, "mean_gap": gap, **found}


def rise_of_summits(scene: Scene) -> float | None:
    """Of the mean plane of the summits above that of the surface, over sigma; None if no one told."""
    heights = scene.heights
    return heights.mean / heights.std if isinstance(heights, Nayak) else None
