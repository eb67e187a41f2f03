"""Ways to one number, each with a size that buys accuracy: what `mcgw.statistics.tradeoff` measures.

Every one gives the relative error of the first quantity of a scene, at some of its separations, against
exact means by a rule that shares nothing with `analytic`: over the share of higher heights.

With ``p = exp(-t)`` the share of the touching heights that lie above s, the mean of f over these is
``int exp(-t) f(s(t)) dt``: no density is asked for, any tail falls at least like a power of p, and a
bounded distribution ends where p does. Panels shrink towards t = 0, where f has a root or the density a
broken power. Under other contact laws than Hertz's every asperity adds what its own formula says, and
panels shrink towards both sides of every height at which another formula begins.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss
from scipy.integrate import quad

import analytic
from analytic import LAW_QUANTITIES, MeasuredHeights, Quantity, RandomCurvature, quantity_of, resolved_breaks
from analytic.arrays import Array
from analytic.laws import Hertz, term_of
from mcgw.ensemble.drawing import blocks
from mcgw.errors import RunError
from mcgw.sampling.samplers import sampler_of
from mcgw.scene.scene import Scene

_POINTS = 24
_SMALLEST = -50  # power of two of the panel next to t = 0, which is left out
_WIDEST = 0.5
_STAGES = (50.0, 100.0, 200.0, 400.0)  # after each of these the rest may be negligible
_LAST = 600.0  # p = 1e-260
_NOTHING = 1e-18
_BREAKS = 46.0  # t up to which kinks are looked for: p = 1e-20


def reference(scene: Scene, chosen: tuple[int, ...]) -> Array:
    """Exact mean of the first quantity of a scene, SI, at the chosen separations; shape (chosen,)."""
    q = quantity_of(scene.quantities[0])
    of_one = [_one_asperity(scene, q, scene.separations[k]) for k in chosen]
    return scene.n_asperities * q.scale(scene.surface) * np.array(of_one)


def quantiles(scene: Scene, h: float, t: Array) -> Array:
    """Heights above which the share ``exp(-t)`` of the heights above `h` lies, rising with t."""
    with np.errstate(under="ignore"):  # a share of 0 is the end of the support
        return np.maximum(scene.heights.isf(np.exp(-t), h), h)


def _one_asperity(scene: Scene, q: Quantity, h: float) -> float:
    """Mean contribution of one asperity, in units of the scale."""
    heights, low = scene.heights, lowest(scene, q, h)
    if isinstance(heights, MeasuredHeights):
        s = np.array(heights.heights)
        return float(np.sum(added(scene, q, h, s[s > low]))) / s.size
    touching = float(heights.sf(np.array(low)))
    x, w = leggauss(_POINTS)
    edges = _edges(scene, q, h, touching)
    total = 0.0
    for few in np.split(edges, np.searchsorted(edges, _STAGES)):
        ends = np.append(few, edges[edges > few[-1]][:1])
        half = np.diff(ends)[:, None] / 2
        t = ends[:-1, None] + half * (1 + x)
        s = quantiles(scene, low, t)
        there = np.isfinite(s)
        values = np.exp(-t) * added(scene, q, h, np.where(there, s, low))
        more = float(np.sum(np.where(there, half * w * values, 0.0)))
        total += more
        if abs(more) < _NOTHING * abs(total):
            break
    return touching * total


def added(scene: Scene, q: Quantity, h: float, s: Array) -> Array:
    """What asperities at `s` above `h` add, in units of the scale: ``(s - h)^n e(s)`` under Hertz's law."""
    if by_powers(scene, q):
        weight = scene.modulus(s) if q.modulus else np.ones_like(s)
        if isinstance(scene.curvature, RandomCurvature):  # of listed summits there is one method alone
            weight = weight * scene.curvature.mean(q.radius, s)
        return np.asarray((s - h) ** q.exponent * weight)
    if scene.curvature:
        raise ValueError(
            f'contact.law = "{scene.law.name}" with summits.curvature = "random": means are integrals over '
            'heights and radii, which no other rule can check; use curvature = "mean"'
        )
    return term_of(q.base, scene.branch_of(q.name), h, s, scene.modulus(s))


def by_powers(scene: Scene, q: Quantity) -> bool:
    """Whether asperities add powers of their approach."""
    return type(scene.law) is Hertz and q.base not in LAW_QUANTITIES


def lowest(scene: Scene, q: Quantity, h: float) -> float:
    """Height below which no asperity adds anything."""
    return h if by_powers(scene, q) else scene.branch_of(q.name).lowest(h)


def formula_ends(scene: Scene, q: Quantity, h: float, low: float, high: float) -> Array:
    """Heights between two others where the formula changes, increasing."""
    if by_powers(scene, q):
        return np.empty(0)
    found = scene.branch_of(q.name).regimes(scene.modulus, [h], low, high)
    ends = np.unique([found.low, found.high])
    return np.asarray(ends[(low < ends) & (ends < high)])


def _edges(scene: Scene, q: Quantity, h: float, touching: float) -> Array:
    """Ends of the panels in t: small ones first, and one at every kink of density, modulus and formula."""
    above, range_ends = scene.heights.sf, quantiles(scene, lowest(scene, q, h), np.array([0.0, _BREAKS]))
    low, high = range_ends.tolist()
    kinks = [*scene.heights.breaks, *resolved_breaks(scene.modulus, low, high)]
    share = above(np.array([b for b in kinks if low < b < high])) / touching
    ends = above(formula_ends(scene, q, h, low, high)) / touching
    t = -np.log(ends[ends > 0])[:, None]
    small = 2.0 ** np.arange(_SMALLEST, 0)
    around = [*t.ravel(), *(t - small).ravel(), *(t + small).ravel()]
    inside = [x for x in around if x > small[0]]
    return np.unique([*small, *np.arange(_WIDEST, _LAST, _WIDEST), *-np.log(share[share > 0]), *inside])


_MOST_DRAWS = 1e7  # asperities per surface above which a sampler is not tried
_PIECES = (0.0, 1.0, 3.0, 7.0, 14.0, 24.0, 40.0, 80.0)  # -log of shares of higher heights where quad's end
_AGREE = 1e-10  # of theory and its reference


@dataclass(frozen=True)
class Method:
    """A method for one number.

    Parameters
    ----------
    name : str
        Its name in the table.
    unit : str
        Unit of the size.
    sizes : tuple of float
        In increasing order of cost.
    slope : float or None
        Expected exponent of the error in the size; None: exponential, or none.
    errors : callable
        Size and seed to relative errors, shape (separations,).
    sampler : str
        Which sampler makes an exact ensemble this way; "" for none.
    """

    name: str
    unit: str
    sizes: tuple[float, ...]
    slope: float | None
    errors: Callable[[float, int], Array]
    sampler: str = ""


def methods_for(scene: Scene, chosen: tuple[int, ...]) -> tuple[Method, ...]:
    """All methods for the first quantity of a scene, at separations with indices `chosen`.

    Raises
    ------
    ValueError
        If the heights are measured ones, of which there is no ensemble, or if the mean is 0.
    RunError
        If theory and its reference, an integral by another rule, differ by more than 1e-10.
    """
    if isinstance(scene.curvature, analytic.MeasuredRadii):
        raise ValueError("summits: listed summits are summed or drawn, and have no other method")
    if isinstance(scene.heights, analytic.MeasuredHeights):
        raise ValueError(
            "heights: measured heights are summed exactly; set resample = true to compare samplers"
        )
    exact = _checked(scene, chosen)
    surfaces = tuple(4.0**k for k in range(12))
    n = float(scene.n_asperities)
    touching = scene.touching
    found = [
        Method(name, "surfaces", surfaces, -0.5, partial(_by_sampler, scene, chosen, exact, name), name)
        for name, draws in (("direct", n), ("tail", touching), ("cells", touching / 100))
        if draws < _MOST_DRAWS
    ]
    if scene.curvature is None:  # radii of their own are drawn one by one
        drawn = partial(_by_sampler, scene, chosen, exact, "aggregate")
        found.append(Method("aggregate", "surfaces", surfaces, -0.5, drawn))
    return (*found, *_quadratures(scene, chosen, exact))


def _checked(scene: Scene, chosen: tuple[int, ...]) -> Array:
    """The reference, after a check that theory agrees."""
    exact, name = reference(scene, chosen), scene.quantities[0]
    theory = scene.theory.mean(name, [scene.separations[k] for k in chosen])
    for k, ours, other in zip(chosen, theory, exact, strict=True):
        where = f"mean {name} at d/sigma = {scene.separations[k]:g}"
        if not other:
            raise ValueError(f"{where} is 0: a relative error needs a mean that is not; change separations")
        if not abs(ours / other - 1) <= _AGREE:
            raise RunError(
                f"{where}: theory gives {ours:.15g} and its reference {other:.15g}, which differ by more "
                f"than {_AGREE:g}; no error can be measured"
            )
    return exact


def _by_sampler(
    scene: Scene, chosen: tuple[int, ...], exact: Array, name: str, size: float, seed: int
) -> Array:
    """By so many surfaces."""
    surfaces = int(size)
    asked = replace(scene, sampler=name, n_surfaces=surfaces, seed=seed, keep="sums")
    total = np.zeros(len(chosen))
    for block in blocks(asked, sampler_of(asked)):
        total += block.sums[scene.quantities[0]][:, list(chosen)].sum(axis=0)
    return np.asarray(total / surfaces / exact - 1)


def _by_quad(scene: Scene, q: analytic.Quantity, h: float, accuracy: float) -> float:
    """Mean of one asperity by SciPy's adaptive rule, from break to break and to the tail of the heights."""
    low = lowest(scene, q, h)
    ends = quantiles(scene, low, np.array(_PIECES))
    changes = formula_ends(scene, q, h, float(ends[0]), float(ends[-1]))
    breaks = [b for b in (*scene.heights.breaks, *scene.modulus.breaks, *changes) if ends[0] < b < ends[-1]]
    ends = np.sqrt(np.unique([*ends, *breaks]) - low)

    def integrand(v: float) -> float:
        """In v, the root of how far the asperity rises above the lowest that can touch."""
        s = np.asarray(low + v * v)
        return float(2 * v * added(scene, q, h, s) * scene.heights.pdf(s))

    # full output suppresses warnings: its error stands in the table
    rules = (quad(integrand, *e, epsabs=0, epsrel=accuracy, full_output=1) for e in pairwise(ends.tolist()))
    return float(sum(found[0] for found in rules))


def _quadratures(scene: Scene, chosen: tuple[int, ...], exact: Array) -> list[Method]:
    q = analytic.quantity_of(scene.quantities[0])
    h = np.array(scene.separations)[list(chosen)]
    factor = scene.n_asperities * q.scale(scene.surface)
    grading = scene.modulus if q.modulus else None

    def ours(_size: float, _seed: int) -> Array:
        return scene.theory.mean(q.name, h) / exact - 1

    def scipys(size: float, _seed: int) -> Array:
        rows = [_by_quad(scene, q, x, 1 / size) for x in h.tolist()]
        return np.asarray(factor * np.array(rows) / exact - 1)

    def papers(size: float, _seed: int) -> Array:
        gamma = grading.gamma if isinstance(grading, analytic.Exponential) else 1.0
        return factor * analytic.fn_paper(q.exponent, h, gamma, int(size)) / exact - 1

    powers = by_powers(scene, q)
    found = [
        Method(
            "theory: analytic.fn" if powers else "theory: analytic.Model", "64 points", (64.0,), None, ours
        ),
        Method("scipy.integrate.quad", "1/epsrel", (1e2, 1e6, 1e10), None, scipys),
    ]
    gaussian = isinstance(scene.heights, analytic.Gaussian)
    if (
        powers
        and gaussian
        and (grading is None or isinstance(grading, analytic.Exponential | analytic.Homogeneous))
    ):
        sizes = tuple(2.0**k for k in range(2, 9))
        found.append(Method("paper's Gauss rule, Eq. (9)", "points", sizes, None, papers))
    return found
