"""Ways to one number, each with a size that buys accuracy: what `mcgw.tradeoff` measures.

Every one gives the relative error of the first quantity of a scene, at some of its separations.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.polynomial.legendre import leggauss
from numpy.typing import NDArray
from scipy.integrate import quad

import analytic
from mcgw.sampling.asperities import heights
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.hertz import hertz_sums
from mcgw.sampling.response import response_of
from mcgw.sampling.samplers import Cells, Sampler, aggregate_of, sampler_of
from mcgw.scene import Scene
from mcgw.simulation import blocks

__all__ = ["Method", "methods_for", "reference"]

Array = NDArray[np.float64]

_MOST_DRAWS = 1e7  # asperities of one surface, beyond which a sampler is not even tried
_REACH = 13.0  # above max(h, 0): the density falls by e-37


@dataclass(frozen=True)
class Method:
    """One way to a number.

    Parameters
    ----------
    name : str
        For the table.
    unit : str
        What the size counts.
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
    """All ways to the first quantity of a scene at the separations number `chosen`."""
    exact = reference(scene, chosen)
    surfaces = tuple(4.0**k for k in range(12))
    n = float(scene.n_asperities)
    touching = scene.touching
    found = [
        Method(name, "surfaces", surfaces, -0.5, partial(_by_sampler, scene, chosen, exact, name), name)
        for name, draws in (("direct", n), ("tail", touching), ("cells", touching / 100))
        if draws < _MOST_DRAWS
    ]
    for crowd in (1, 16, 256, 4096):
        errors = partial(_by_aggregate, scene, chosen, exact, crowd)
        found.append(Method(f"aggregate, crowds from {crowd}", "surfaces", surfaces, -0.5, errors))
    strata = tuple(float(10**3 * 4**k) for k in range(10))
    found.append(Method("stratified", "strata", strata, -1.5, partial(_by_strata, scene, chosen, exact)))
    orders = tuple(10.0**k for k in range(1, 14, 2))
    by_moments = _ByMoments.of(scene, chosen)
    found.append(Method("order of moments (same asperities)", "1/accuracy", orders, None, by_moments))
    return (*found, *_quadratures(scene, chosen, exact))


def _mean(scene: Scene, chosen: tuple[int, ...], sampler: Sampler) -> Array:
    name = scene.quantities[0]
    total = np.zeros(len(chosen))
    for _, block in blocks(scene, sampler):
        total += block.sums[name][:, list(chosen)].sum(axis=0)
    return total / scene.n_surfaces


def _by_sampler(
    scene: Scene, chosen: tuple[int, ...], exact: Array, name: str, size: float, seed: int
) -> Array:
    asked = replace(scene, sampler=name, n_surfaces=int(size), seed=seed, keep="sums")
    return _mean(asked, chosen, sampler_of(asked)) / exact - 1


def _by_aggregate(
    scene: Scene, chosen: tuple[int, ...], exact: Array, crowd: int, size: float, seed: int
) -> Array:
    asked = replace(scene, sampler="aggregate", n_surfaces=int(size), seed=seed, keep="sums")
    return _mean(asked, chosen, aggregate_of(asked, crowd)) / exact - 1


def _by_strata(scene: Scene, chosen: tuple[int, ...], exact: Array, size: float, seed: int) -> Array:
    asked = replace(scene, sampler="stratified", n_surfaces=1, n_asperities=int(size), seed=seed, keep="sums")
    return _mean(asked, chosen, sampler_of(asked)) / (exact / scene.n_asperities * int(size)) - 1


@dataclass(frozen=True)
class _ByMoments:
    """Moments cut at an accuracy, against a plain sum over the same asperities of one surface."""

    scene: Scene
    chosen: tuple[int, ...]
    plain: Array

    @classmethod
    def of(cls, scene: Scene, chosen: tuple[int, ...]) -> "_ByMoments":
        n = min(scene.n_asperities, 10**5)
        name = scene.quantities[0]
        scene = replace(scene, sampler="cells", n_asperities=n, quantities=(name,), n_surfaces=1, keep="sums")
        s = heights(scene, 0)
        return cls(scene, chosen, hertz_sums(scene, np.array([s.size]), s, np.ones(s.size))[name][0])

    def __call__(self, size: float, _seed: int) -> Array:
        scene, name = self.scene, self.scene.quantities[0]
        mesh = mesh_of(scene)
        summed = (name,) if analytic.QUANTITIES[name].exponent > 0 else ()
        sampler = Cells(scene, mesh, response_of(scene, mesh, summed, accuracy=1 / size), "cells")
        value, plain = sampler.block(0, 1).sums[name][0], self.plain
        pick = list(self.chosen)
        with np.errstate(divide="ignore", invalid="ignore"):  # no contact there: no relative error
            return np.asarray(value[pick] / plain[pick] - 1)


def reference(scene: Scene, chosen: tuple[int, ...]) -> Array:
    """Exact mean, by a composite rule of its own: 64 panels of 40 points in the root of the approach."""
    q = analytic.QUANTITIES[scene.quantities[0]]
    x, w = leggauss(40)
    values = []
    for k in chosen:
        h = scene.separations[k]
        cuts = [c for c in analytic.resolved_breaks(scene.modulus, h, h + _REACH) if c > h]
        marks = np.sqrt(np.array([0.0, *[c - h for c in cuts], max(-h, 0.0) + _REACH]))
        edges = np.unique(np.concatenate([np.linspace(a, b, 65) for a, b in pairwise(marks)]))
        half = np.diff(edges)[:, None] / 2
        v = edges[:-1, None] + half * (1 + x)
        values.append(float(np.sum(half * w * _integrand(scene, q, h, v))))
    return scene.n_asperities * q.scale(scene.surface) * np.array(values)


def _integrand(scene: Scene, q: analytic.Quantity, h: float, v: Array | float) -> Array:
    """Of F*_n in v, with s = h + v^2."""
    v = np.asarray(v)
    s = h + v * v
    e = scene.modulus(s) if q.modulus else np.ones_like(s)
    return np.asarray(2 * v ** (2 * q.exponent + 1) * e * scene.heights.density(s))


def _quadratures(scene: Scene, chosen: tuple[int, ...], exact: Array) -> list[Method]:
    q = analytic.QUANTITIES[scene.quantities[0]]
    h = np.array(scene.separations)[list(chosen)]
    factor = scene.n_asperities * q.scale(scene.surface)
    grading = scene.modulus if q.modulus else None

    def ours(_size: float, _seed: int) -> Array:
        return scene.theory.mean(q.name, h) / exact - 1

    def scipys(size: float, _seed: int) -> Array:
        rows = []
        for x in h.tolist():
            top = np.sqrt(max(-x, 0.0) + _REACH)
            row = quad(lambda v, x=x: float(_integrand(scene, q, x, v)), 0, top, epsabs=0, epsrel=1 / size)
            rows.append(row[0])
        return np.asarray(factor * np.array(rows) / exact - 1)

    def papers(size: float, _seed: int) -> Array:
        gamma = grading.gamma if isinstance(grading, analytic.Exponential) else 1.0
        return factor * analytic.fn_paper(q.exponent, h, gamma, int(size)) / exact - 1

    found = [
        Method("theory: analytic.fn", "64 points", (64.0,), None, ours),
        Method("scipy.integrate.quad", "1/epsrel", (1e2, 1e6, 1e10), None, scipys),
    ]
    gaussian = isinstance(scene.heights, analytic.Gaussian)
    if gaussian and (grading is None or isinstance(grading, analytic.Exponential | analytic.Homogeneous)):
        sizes = tuple(2.0**k for k in range(2, 9))
        found.append(Method("paper's Gauss rule, Eq. (9)", "points", sizes, None, papers))
    return found
