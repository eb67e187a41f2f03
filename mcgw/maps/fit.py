"""From a measured map to the parameters of a Greenwood-Williamson surface, with their uncertainty."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.formats.table import Column, Drawn, Table
from mcgw.maps.estimates import (
    METHODS,
    SUMMITS,
    Estimate,
    Roughness,
    Visible,
    by_caps,
    by_moments,
    by_summits,
    estimates_table,
    roughness_of,
    visible,
)
from mcgw.maps.form import ORDERS, form_left
from mcgw.maps.preparation import Prepared
from mcgw.maps.steps import Form
from mcgw.maps.summit_sums import EDGE, Summits, coarse_sums_of, summit_sums_of, variation
from mcgw.maps.topography import SMALLEST
from mcgw.maps.waves import Uncertain, Waves, uncertain, waves_of

# Random caps 12 and 20 pixels apart are lost as if a summit had to be 0.7 to 1.2 pixels from a valley, and
# 0.2 to 0.45 cutoffs.
_BLUR = 0.3
# Sub-areas crossed by long waves underestimate errors, and few sub-areas estimate them badly.
_FEWEST = 8  # summits on a map, at least, for counting
_A_LITTLE = 2  # summits in a sub-area on average, for errors of the moments


@dataclass(frozen=True, repr=False)
class Fit(Drawn):
    """Result of `mcgw.fit`: what a map says about its summits.

    Parameters
    ----------
    estimates : dict of str to Estimate
        By method, of `METHODS`. ``caps`` is missing if no field of independent caps looks like this map, and
        only ``moments`` is there if the map has fewer than eight summits.
    moments : SpectralMoments
        m0, m2 and m4, averaged over both axes.
    numbers : dict of str to Uncertain
        The moments m0, m2 and m4 with their errors, m^2, 1 and 1/m^2; and alpha, m0 m4/m2^2.
    skewness : (float, float)
        Skewness of the map's heights, and its standard error.
    listed : Summits
        Every summit: its place, height above the mean plane and curvature; and sums over the sub-areas.
    visible : Visible or None
        How much of a field of independent caps like this one is visible in a map.
    mean_squares : dict of str to float
        Mean squares of slopes and second derivatives, by the names of `mcgw.maps.summit_sums.SUMS`.
    form : str
        The form that was removed.
    waves : Waves
        Errors due to the small number of waves on the map.
    roughness : Roughness
        Roughness of all heights of the filtered map without its form; sigma belongs to the summits only.
    notes : tuple of str, optional
        What was done to the map, one line per step.
    cautions : tuple of str, optional
        Reasons for caution found by `mcgw.fit`, one line each.
    maps : tuple of str, optional
        Names of the maps, if there are several, each of which is a sub-area.
    """

    estimates: dict[str, Estimate]
    moments: SpectralMoments
    numbers: dict[str, Uncertain]
    skewness: tuple[float, float]
    listed: Summits
    visible: Visible | None
    mean_squares: dict[str, float]
    form: Form
    waves: Waves
    roughness: Roughness
    notes: tuple[str, ...] = ()
    cautions: tuple[str, ...] = ()
    maps: tuple[str, ...] = ()

    @property
    def area(self) -> float:
        """Area evaluated, m^2."""
        return self.listed.area

    @property
    def mean_summit(self) -> float:
        """Mean height of the summits above the mean plane, m."""
        return float(self.listed.heights.mean())

    @property
    def summits(self) -> Array:
        """Heights of the summits relative to their mean, m."""
        return np.asarray(self.listed.heights - self.listed.heights.mean())

    @property
    def curvatures(self) -> Array:
        """Mean curvatures of the summits, in the order of their heights, 1/m."""
        return np.asarray(self.listed.curvatures.mean(axis=0))

    @property
    def radii(self) -> Array:
        """Radii of the summits, in the order of their heights, m: ``1/sqrt(k1 k2)``."""
        return self.listed.radii

    @property
    def tiles(self) -> Table:
        """Estimates from each sub-area alone, or from each map: see `mcgw.maps.summit_sums.Summits.tiles`."""
        found = self.listed.tiles()
        return Table((Column("map", list(self.maps)), *found.columns[3:])) if self.maps else found

    @property
    def lay(self) -> float:
        """Mean square slope across the lay over that along it, in whatever direction: 1 if isotropic."""
        x, y, xy = (self.mean_squares[key] for key in ("slope_x", "slope_y", "slope_xy"))
        apart = math.hypot(x - y, 2 * xy)
        return (x + y + apart) / max(x + y - apart, 1e-12 * (x + y))

    @property
    def agreement(self) -> float | None:
        """Largest ratio between eta, R or sigma by moments and by counted summits; None for few summits.

        On 20 isotropic Gaussian maps of 1000 to 4000 summits it was 1.01 to 1.05, on as many of 70 to 500
        summits 1.01 to 1.12; with a lay of 2 : 1 it is 1.6, on honed, lognormal or Weibull maps 1.6 and more.
        """
        if "summits" not in self.estimates:
            return None
        told, seen = self.estimates["moments"], self.estimates["summits"]
        pairs = ((getattr(told, x).value, getattr(seen, x).value) for x in SUMMITS)
        return float(max(max(pair) / min(pair) for pair in pairs))

    @property
    def spread_of_curvatures(self) -> float:
        """Relative standard deviation of summit curvatures, from their quartiles as if they were Gaussian."""
        low, median, high = np.percentile(self.curvatures, (25, 50, 75))
        return float((high - low) / 1.349 / median)

    @property
    def best(self) -> str:
        """Which estimate to use: ``caps`` if all summits have about one radius, else ``summits``.

        Of fields of caps whose eta R sigma is 0.002 to 0.2, ``caps`` finds eta within 3 % and ``summits``
        loses 2 to 45 %; on Gaussian surfaces, whose curvatures spread by 0.35, ``caps`` finds 10 to 130 %
        too many and ``summits`` is right within 1 to 9 %. ``moments`` is used if there are too few summits.
        """
        if "summits" not in self.estimates:
            return "moments"
        one_radius = "caps" in self.estimates and self.spread_of_curvatures < 0.17  # half of a Gaussian one
        return "caps" if one_radius else "summits"

    def sheet(self) -> Table:
        """Estimates by all methods, with standard errors, and the first of the cautions."""
        told = {name: f"{x.value:.4g} +- {x.error:.1g}" for name, x in self.numbers.items()}
        (skewness, error), across = self.skewness, round(len(self.tiles) ** 0.5)
        parts = f"{len(self.maps)} maps" if self.maps else f"{across} x {across} sub-areas"
        varies = self.tiles.only("eta", "radius", "sigma").columns
        varied = ", ".join(f"{c.words or c.name} by {100 * variation(c.values):.2g} %" for c in varies)
        curved = f"curvatures spread by {self.spread_of_curvatures:.2g} (Gaussian surfaces: 0.35)"
        facts = [
            ("moments", f"m0 = {told['m0']} m^2, m2 = {told['m2']}, skewness {skewness:z.2f} +- {error:.1g}"),
            ("", f"m4 = {told['m4']} 1/m^2, alpha = {told['alpha']}"),
            ("all heights", self.roughness.text("S")),
            ("scatter", f"{varied} between {parts}"),
            ("best here", f"{METHODS[self.best]}; {curved}"),
        ]
        if self.visible is not None and self.best == "caps":
            eta, sigma = (f"{100 * (x - 1):+.2g} %" for x in (self.visible.share, self.visible.std))
            facts.append(("hidden", f"of such caps counts are off by {eta} in eta and {sigma} in sigma"))
        if self.cautions:
            facts.append(("cautions", f"{len(self.cautions)} in .cautions; {self.cautions[0]}"))
        where = f"on {self.area:.4g} m^2, {self.mean_summit:.3g} m above the mean plane"
        return estimates_table(self.estimates).under(f"{self.summits.size} summits {where}", facts)


def fit_prepared(ready: Prepared) -> Fit:
    """Estimate eta, R and sigma of a prepared map; ValueError if it has no summit, or too large a sigma.

    Standard errors are those of a jackknife over the sub-areas, or those that follow from the number of
    waves on the map, if larger: sub-areas share its long waves.
    """
    used, form, across = ready.used, ready.asked.form, ready.asked.parts

    def count(across: int, sums_of: Callable[..., Summits] = summit_sums_of) -> Summits:
        return _without_summit_form(sums_of(used, across=across, seen=ready.seen), form, used.size)

    def heights(part: Any = ...) -> Array:
        return np.asarray(used.heights[part] if ready.seen is None else used.heights[part][ready.seen[part]])

    counted = count(across)
    number = counted.heights.size
    if not number:
        form_too = ", or --form quadratic" if form_left(ready.levelled, form) else ""
        raise ValueError(f"the map has no summit; give a larger map or a shorter cutoff{form_too}")
    if number < _A_LITTLE * across**2:
        counted = count(min(across, max(math.isqrt(number // _A_LITTLE), 3)))
    moments = counted.moments
    if not (moments.m2 > SMALLEST and moments.sigma > 0):  # alpha contains its square
        raise ValueError(
            f"m0 = {moments.m0:.3g} m^2, m2 = {moments.m2:.3g}, m4 = {moments.m4:.3g} 1/m^2: no surface has "
            "these; give the right unit, or take bad points near the edge out by --spikes remove or --trim"
        )
    waves = waves_of(used, moments, ORDERS[form])
    told = by_moments(counted)
    estimates = {"moments": Estimate.of([told[name] for name in SUMMITS], waves)}
    blur = math.hypot(max(used.pixel), _BLUR * (ready.asked.cutoff or 0.0))
    peak_to_valley = float(np.ptp(heights()))
    if number >= _FEWEST:
        fewer = max(min(across, math.isqrt(number // 4)), 2)  # four summits in a sub-area on average
        fine = counted if counted.parts == fewer**2 else count(fewer)
        estimates["summits"] = Estimate.of(by_summits(fine, count(fewer, coarse_sums_of)), waves)
        caps = by_caps(fine, blur)
        if caps is not None and caps[2][0] <= peak_to_valley:  # else too many are hidden
            estimates["caps"] = Estimate.of(caps, waves)
    for name, estimate in estimates.items():
        if not estimate.sigma.value <= peak_to_valley:
            raise ValueError(
                f"sigma of {METHODS[name]} is {estimate.sigma.value:.4g} m, more than the peak to valley of "
                f"the map, {peak_to_valley:.4g} m; look at the map, and crop artefacts"
            )
    shown = None
    if found := estimates.get("caps"):
        shown = visible(found.overlap, blur / math.sqrt(2 * found.radius.value * found.sigma.value))
    inside = (slice(None) if used.periodic else slice(EDGE, -EDGE),) * 2
    squares = counted.mean_squares
    x, y = ((a - b) / 2 for a, b in zip(ready.levelled.size, used.size, strict=True))  # of equal margins
    return Fit(
        estimates=estimates,
        moments=moments,
        numbers={x: uncertain(*told[x], waves.spreads[x]) for x in ("m0", "m2", "m4", "alpha")},
        skewness=told["skewness"],
        listed=replace(counted, x=counted.x + x, y=counted.y + y, heights=counted.heights - squares["z"]),
        visible=shown,
        mean_squares=squares,
        form=form,
        waves=waves,
        roughness=roughness_of(heights(inside)),
        notes=ready.notes,
    )


def _without_summit_form(counted: Summits, form: Form, size: tuple[float, float]) -> Summits:
    """Summit heights about their own plane, since deep valleys tilt that of a map of this size."""
    order = min(ORDERS[form], 2)
    if order < 0 or not counted.heights.size:
        return counted
    x, y = (
        2 * (place // p + 0.5) * p / length - 1  # of the pixel that it is in
        for place, p, length in zip((counted.x, counted.y), counted.pixel, size, strict=True)
    )
    basis = np.array([np.ones_like(x), x, y, *((x * x, x * y, y * y) if order == 2 else ())]).T
    found = np.linalg.lstsq(basis, counted.heights, rcond=None)[0]
    return replace(counted, heights=counted.heights - basis[:, 1:] @ found[1:])
