"""The separation at a given load or real area: by theory, and on every surface for itself."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import t as student

import analytic
from analytic import QUANTITIES, Quantity
from mcgw.sampling.asperities import heights
from mcgw.scene import Scene

__all__ = ["Solution", "separation_on", "solve"]

Array = NDArray[np.float64]

_MARGIN = 6.0  # standard deviations of a surface's separation that are drawn at once
_MOST_HEIGHTS = 3e9
_STEP = 0.5  # by which the search for a start goes down, where the margin was not enough
_ENOUGH = 1e-14  # relative excess of load where Newton's steps are rounding errors
_NEGATIVE = (
    "the modulus is negative at a height that touches at h = {:.4g}, where a load has no single "
    'separation; say negative = "clip" under [grading], or give less load'
)


@dataclass(frozen=True)
class Solution:
    """What holds at one given load or area.

    Parameters
    ----------
    given : str
        Which quantity was given: "load" or "area".
    value : float
        Its value, N or m^2.
    theory : dict of str to float
        "separation" (d/sigma) and every quantity (SI) of the mean surface.
    surfaces : dict of str to ndarray
        The same on every surface at its own separation, shape (surfaces,).
    """

    given: str
    value: float
    theory: dict[str, float]
    surfaces: dict[str, Array]

    def interval(self, name: str, level: float = 0.95) -> tuple[float, float]:
        """Confidence interval of the mean over surfaces, by Student's t."""
        x = self.surfaces[name]
        half = student.ppf((1 + level) / 2, len(x) - 1) * x.std(ddof=1) / np.sqrt(len(x))
        return float(x.mean() - half), float(x.mean() + half)


def solve(scene: Scene, given: str, values: Sequence[float]) -> list[Solution]:
    """Find the separation at which each surface has a given load or real area.

    The asperities of a surface are drawn one by one (sampler ``tail``), once for all values; so this
    serves any separation, and the mean differs from theory by what the finite number of asperities
    does to it, of order 1/N.

    Parameters
    ----------
    scene : Scene
        Its surface, grading, number of surfaces and asperities, and seed are used.
    given : {"load", "area"}
        What is known of every surface.
    values : sequence of float
        Its values, N or m^2.

    Returns
    -------
    list of Solution
        One for each value.

    Raises
    ------
    ValueError
        If a value is not reached, if the modulus of a contacting asperity is negative, if there are
        too many asperities to draw, or if a surface has none.
    """
    if scene.n_surfaces < 2:
        raise ValueError(f"n_surfaces = {scene.n_surfaces}: an interval takes at least 2 surfaces")
    q = QUANTITIES[given]
    theory = [_theory(scene, q, value) for value in values]
    lowest = min(at["separation"] - _MARGIN * _spread(scene, q, at["separation"]) for at in theory)
    drawn = replace(scene, sampler="tail", keep="sums", separations=(lowest,), quantities=tuple(QUANTITIES))
    touching = drawn.n_asperities * float(drawn.heights.above(np.array(lowest)))
    if touching * drawn.n_surfaces > _MOST_HEIGHTS:
        raise ValueError(
            f"{drawn.n_surfaces} surfaces with {touching:.3g} contacts each are too many to solve singly; "
            f"give fewer than {_MOST_HEIGHTS / touching:.0f} surfaces"
        )
    rows = [_surface(drawn, number, q, values) for number in range(drawn.n_surfaces)]
    return [
        Solution(given, float(value), at, {name: np.array([row[k][name] for row in rows]) for name in at})
        for k, (value, at) in enumerate(zip(values, theory, strict=True))
    ]


def _theory(scene: Scene, q: Quantity, value: float) -> dict[str, float]:
    """Separation and all quantities of the mean surface, scaled to the scene's number of asperities."""
    share = scene.n_asperities / scene.surface.n_asperities
    h = float(analytic.separation_at(scene.surface, q.name, value / share, scene.modulus, law=scene.heights))
    means = {
        name: float(analytic.mean(scene.surface, name, h, scene.modulus, law=scene.heights)) * share
        for name in QUANTITIES
    }
    return {"separation": h, **means}


def _spread(scene: Scene, q: Quantity, h: float) -> float:
    """Standard deviation of the separation of a surface, to first order: that of the sum over its slope."""
    grading = scene.modulus if q.modulus else None
    sums = analytic.cumulants(
        scene.surface,
        q.name,
        h,
        grading,
        n_asperities=scene.n_asperities,
        count=scene.count,
        law=scene.heights,
    )
    slope = (
        scene.n_asperities
        * q.scale(scene.surface)
        * q.exponent
        * analytic.fn(q.exponent - 1, h, grading, law=scene.heights)
    )
    return float(np.sqrt(sums.variance) / slope)


def _surface(scene: Scene, number: int, q: Quantity, values: Sequence[float]) -> list[dict[str, float]]:
    """All quantities of one surface at each value."""
    touching = _sorted(heights(scene, number))
    whole: Array | None = None
    rows = []
    for value in values:
        target = value / q.scale(scene.surface)
        s, start = touching, scene.lowest
        if _power_sum(scene, q, s, start) < target:  # rare: it lies below what was drawn
            whole = _sorted(heights(scene, number, untouched=True)) if whole is None else whole
            s = whole
        if not s.size:
            raise ValueError(f"surface {number} has not one asperity; give more n_asperities")
        while _power_sum(scene, q, s, start) < target:
            start -= _STEP
        modulus = scene.modulus(s) if q.modulus else np.ones_like(s)
        h = separation_on(s, modulus, q.exponent, target, start)
        rows.append({"separation": h, **dict(_sums(scene, s, h))})
    return rows


def _sorted(s: Array) -> Array:
    return np.sort(s)[::-1]


def _power_sum(scene: Scene, q: Quantity, s: Array, h: float) -> float:
    s = s[s > h]
    weights = scene.modulus(s) if q.modulus else np.ones_like(s)
    if weights.min(initial=0.0) < 0:
        raise ValueError(_NEGATIVE.format(h))
    return float(np.sum(weights * (s - h) ** q.exponent))


def _sums(scene: Scene, s: Array, h: float) -> Iterator[tuple[str, float]]:
    """All quantities of asperities of heights `s` at one separation, SI."""
    s = s[s > h]
    modulus = scene.modulus(s)
    for name, q in QUANTITIES.items():
        weights = modulus if q.modulus else 1.0
        yield name, q.scale(scene.surface) * float(np.sum(weights * (s - h) ** q.exponent))


def separation_on(heights: Array, modulus: Array, exponent: float, target: float, start: float) -> float:
    """Separation h at which ``sum modulus (s - h)_+^exponent`` over given heights is `target`.

    The root of order `exponent` of that sum is a norm of the approaches, so convex and decreasing
    in h: Newton's steps on it run up to the solution from below and never pass it.

    Parameters
    ----------
    heights, modulus : ndarray
        Reduced heights in falling order, and E*(s)/E* >= 0 of each; shape (n,).
    exponent : float
        At least 1.
    target : float
        Positive.
    start : float
        A separation where the sum is at least `target`.

    Returns
    -------
    float
        Reduced separation.
    """
    rising, h = -heights, start  # as searchsorted wants it
    while True:
        n = int(np.searchsorted(rising, -h))
        d = heights[:n] - h
        forces = modulus[:n] * d ** (exponent - 1)
        total = float(forces @ d)
        step = total / float(forces.sum()) * (1 - (target / total) ** (1 / exponent))
        if total <= target * (1 + _ENOUGH) or h + step <= h:
            return h
        h += step
