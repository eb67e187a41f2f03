"""Another grading on the same surfaces: equal to a new simulation, and ratios with far smaller errors."""

import dataclasses
from contextlib import nullcontext

import numpy as np
import pytest

import analytic
import mcgw
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.paired import paired_ratio
from mcgw.ensemble.regrading import check_same, regrade
from mcgw.ensemble.results import MemoryResults
from mcgw.jobs.running import run
from mcgw.sampling import cells, spacing
from mcgw.sampling.block import Layout
from mcgw.sampling.response.response import LAST_DIGITS, parts_of, response_of
from mcgw.sampling.samplers import regraded, sampler_of
from mcgw.store.saving import save

H = tuple(np.linspace(0, 4, 21))


@pytest.fixture(scope="module")
def base(make_scene):
    scene = make_scene(separations=H, n_surfaces=4000, n_asperities=30_000, seed=4, keep="moments")
    return mcgw.simulate(scene, grading=analytic.Homogeneous())


def assert_same(a, b):
    """To 1e-12, or 1e-14 of the mean: a contact that just touches cannot be known better from moments."""
    for name in b.scene.quantities:
        x, y = a.values(name)[: b.n_surfaces], b.values(name)
        np.testing.assert_allclose(x, y, rtol=1e-12, atol=1e-14 * y.mean())


def test_moments_that_just_suffice_do_and_one_less_does_not():
    """As many as the series take answer as more do; one less, of each kind, names where the cell starts."""
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    scene = mcgw.Scene(surface, separations=[0.0, 1.0], n_surfaces=2, seed=1)
    mesh, names = cells.mesh_of(scene), ("load", "stiffness")
    needed = parts_of(scene, mesh, names, LAST_DIGITS, lasting=True).layout
    more = Layout(needed.plain + 1, needed.rooted + 1)
    just, with_more = (response_of(scene, mesh, names, kept=kept).matrix() for kept in (needed, more))
    np.testing.assert_array_equal(with_more[..., more.rows_of(needed)], just)
    for kind in ("plain", "rooted"):
        for k in np.flatnonzero(getattr(needed, kind))[[0, -1]]:
            less = {name: getattr(needed, name).copy() for name in ("plain", "rooted")}
            less[kind][k] -= 1
            with pytest.raises(ValueError, match=f"do not resolve it near s = {mesh.edges[k]:.4g}; simulate"):
                response_of(scene, mesh, names, kept=Layout(**less))


@pytest.mark.parametrize("gamma", [0.0, 0.2, 2.0, 3.0])
def test_equals_a_new_simulation(base, gamma):
    grading = analytic.Exponential(gamma)
    fresh = mcgw.simulate(dataclasses.replace(base.scene, grading=grading, keep="sums", n_surfaces=500))
    some = dataclasses.replace(base, scene=dataclasses.replace(base.scene, n_surfaces=500))
    regraded = regrade(some, grading)
    assert_same(regraded, fresh)


def test_other_quantities_and_separations(base):
    regraded = regrade(
        base, analytic.Exponential(0.5), quantities=("conductance",), separations=(H[5], H[10])
    )
    scene = dataclasses.replace(base.scene, quantities=("conductance",), keep="sums")
    fresh = mcgw.simulate(dataclasses.replace(scene, grading=analytic.Exponential(0.5)))
    np.testing.assert_allclose(regraded.conductance, fresh.conductance[:, [5, 10]], rtol=1e-12, atol=1e-20)


def test_paired_ratios_are_the_papers(base):
    """Eqs. (12) and (15) by Monte Carlo: |z| < 5, and errors that are those of theory."""
    grading = analytic.Exponential(2.0)
    regraded = regrade(base, grading)
    load, stiffness = (paired_ratio(regraded, base, name) for name in ("load", "stiffness"))
    exact = 1 / analytic.area_per_load_ratio(H, grading)
    assert np.abs((load.ratio - exact) / load.stderr).max() < 5
    assert np.abs((stiffness.ratio - analytic.stiffness_ratio(H, grading)) / stiffness.stderr).max() < 5
    wrong = analytic.Exponential(2.002)  # the companion: an error of one in a thousand shows
    assert np.abs((load.ratio - 1 / analytic.area_per_load_ratio(H, wrong)) / load.stderr).max() > 5


def test_gain_in_variance_is_what_theory_says(base):
    """gamma = 2 against 1: 194 at h = 0 and 9394 at h = 2, from the exact moments of theory.md's section 3.

    The variance ratio of 4000 surfaces is known to sqrt(2 * 2/4000) = 3 % for Gaussian sums, five times
    that and the excess kurtosis of the residual at h = 2 give 25 %.
    """
    pair = paired_ratio(regrade(base, analytic.Exponential(2.0)), base, "load")
    for k, h in ((0, 0.0), (10, 2.0)):
        n, e = 1.5, np.exp
        mean_a, mean_b = float(analytic.fn(n, h)), float(analytic.fn(n, h, analytic.Exponential(2.0)))
        aa = float(analytic.fn(3, h)) - mean_a**2
        ab = 2 * float(analytic.fn(3, h)) - e(0.5) * float(analytic.fn(3, h + 1)) - mean_a * mean_b
        bb = moment_of_the_square(3, h) - mean_b**2
        r = mean_b / mean_a
        exact = (bb + r * r * aa) / (bb - 2 * r * ab + r * r * aa)
        assert pair.gain[k] == pytest.approx(exact, rel=0.25)
        assert exact == pytest.approx({0.0: 194, 2.0: 9394}[h], rel=5e-3)


def moment_of_the_square(n, h):
    """Integral of (s-h)^n (2 - exp(-s))^2 phi, in closed form."""
    terms = zip((4, -4 * np.exp(0.5), np.exp(2)), (0, 1, 2), strict=True)
    return sum(c * float(analytic.fn(n, h + j)) for c, j in terms)


def test_what_cannot_be_regraded(base, make_scene):
    with pytest.raises(ValueError, match=r"separation 0\.123 is not an edge"):
        regrade(base, analytic.Homogeneous(), separations=(0.123,))
    last = float(sampler_of(base.scene).mesh.edges[-2:].mean())
    for kink in (0.123, last):
        with pytest.raises(ValueError, match=f"break of the grading {kink:.6g}"):
            regrade(base, analytic.Table([-1.0, kink, kink + 1.0], [1.0, 2.0, 3.0]))
    with pytest.raises(ValueError, match="not resolve"):
        regrade(base, analytic.Custom(lambda s: 2 + np.sin(20 * s)))
    with pytest.raises(ValueError, match='sampler = "stratified" keeps no heights; use "cells", "tail"'):
        regrade(mcgw.simulate(make_scene(sampler="stratified", n_surfaces=5)), analytic.Homogeneous())
    with pytest.raises(ValueError, match='sampler = "direct" has no cells'):
        regraded(base.scene, make_scene(sampler="direct"))


@pytest.mark.parametrize("sampler", ["tail", "direct"])
def test_samplers_without_moments_are_regraded_by_their_heights(make_scene, sampler):
    old = mcgw.simulate(make_scene(sampler=sampler, n_surfaces=5))
    s, d = mcgw.heights(old.scene, 3), old.separations[1]
    np.testing.assert_allclose(old.area[3, 1], quantity_sum(old.scene, "area", s, d), rtol=1e-12)
    new = regrade(old, analytic.Exponential(2.0))
    np.testing.assert_allclose(new.load, mcgw.simulate(new.scene).load, rtol=1e-12)
    np.testing.assert_array_equal(new.contacts, old.contacts)


def test_of_one_surface_there_is_a_ratio_without_an_error(make_scene):
    one = mcgw.simulate(make_scene(separations=(0.0, 1.0), n_surfaces=1))
    pair = paired_ratio(regrade(one, analytic.Exponential(2.0)), one, "load")
    new = mcgw.simulate(one.scene.replace(grading=analytic.Exponential(2.0)))
    np.testing.assert_allclose(pair.ratio, new.load[0] / one.load[0], rtol=1e-12)
    assert np.isnan([pair.stderr, pair.gain]).all()


def quantity_sum(scene, name, s, h):
    """Over a list of heights, by hand; of a quantity without a modulus."""
    q = analytic.quantity_of(name)
    return q.scale(scene.surface) * sum((x - h) ** q.exponent for x in s.tolist() if x > h)


OTHERS = {
    "seed": {"seed": 5}, "count": {"count": "poisson"}, "n_asperities": {"n_asperities": 3001},
    "n_surfaces": {"n_surfaces": 8}, "heights": {"heights": analytic.Weibull(2.0)},
    "separations": {"separations": (0.0, 1.5)}, "separations, seed": {"separations": (0.5, 1.0), "seed": 5},
    "sampler": {"sampler": "tail"}, "surface": {"surface": analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9)},
}  # fmt: skip


@pytest.mark.parametrize("told", OTHERS)
def test_a_pair_is_of_the_same_surfaces(make_scene, told):
    """Anything but the grading that differs is named; by hand below a pair of two gradings passes."""
    one = mcgw.simulate(make_scene(separations=(0.0, 1.0), sampler="cells", n_surfaces=9))
    with pytest.raises(ValueError, match=rf"the same surfaces; these differ in {told}$"):
        paired_ratio(mcgw.simulate(one.scene, **OTHERS[told]), one, "load")


def test_a_ratio_of_the_same_surfaces_by_hand(make_scene):
    scene = make_scene(separations=(0.0, 1.0), n_surfaces=80)
    new = mcgw.simulate(dataclasses.replace(scene, grading=analytic.Exponential(0.5)))
    old = mcgw.simulate(scene)
    pair = paired_ratio(new, old, "load")
    b, a = new.load, old.load
    ratio = b.sum(axis=0) / a.sum(axis=0)
    np.testing.assert_allclose(pair.ratio, ratio, rtol=1e-13)
    stderr = np.sqrt(((b - ratio * a) ** 2).sum(axis=0) / (79 * 80)) / a.mean(axis=0)
    np.testing.assert_allclose(pair.stderr, stderr, rtol=1e-9)
    leave_one_out = [
        np.delete(b, k, axis=0).sum(axis=0) / np.delete(a, k, axis=0).sum(axis=0) for k in range(80)
    ]
    jackknife = np.sqrt(79 / 80 * ((leave_one_out - np.mean(leave_one_out, axis=0)) ** 2).sum(axis=0))
    np.testing.assert_allclose(pair.stderr, jackknife, rtol=0.05)


def test_moments_of_another_version(base, monkeypatch):
    """Cells priced otherwise are other cells: their moments must not be taken for these."""
    monkeypatch.setattr(spacing, "_CELL", 4000.0)
    cells._edges.cache_clear()
    with pytest.raises(ValueError, match="another version of mcgw"):
        regrade(base, analytic.Exponential(0.5))
    cells._edges.cache_clear()


def test_from_file_to_file(make_scene, tmp_path):
    scene = make_scene(keep="moments", n_surfaces=150)
    stored = run(scene, tmp_path / "base.h5")
    grading = analytic.Exponential(0.5)
    assert_same(regrade(stored, grading), regrade(mcgw.simulate(scene), grading))
    again = save(regrade(stored, grading), tmp_path / "other.h5")
    assert again.scene.grading == grading
    assert_same(regrade(again, scene.grading), stored)  # there and back


@pytest.mark.parametrize(("accuracy", "same"), [(1e-13, 1e-9), (1e-3, 2e-3)])
@pytest.mark.parametrize("quantity", ["load", "area"])
def test_surfaces_drawn_again_may_differ_by_rounding_or_what_was_asked(accuracy, same, quantity, make_scene):
    """However small they are: by so much of the value and as much of the mean, which are one here."""
    scene = make_scene(separations=(0.0, 1.0), n_surfaces=6, accuracy=accuracy)
    held = np.full((6, 2), 3e-10)
    ensemble = Ensemble(scene, "cells", MemoryResults({quantity: held}))
    for factor, differs in ((1.9, False), (-1.9, False), (2.1, True), (-2.1, True)):
        again = held[2:5].copy()
        again[1, 1] *= 1 + factor * same
        for columns, seen in ((slice(None), True), (slice(1, 2), True), (slice(0, 1), False)):
            told = rf"cannot be drawn again: their {quantity} differs"
            with pytest.raises(ValueError, match=told) if differs and seen else nullcontext():
                check_same(ensemble, 2, {quantity: again[:, columns]}, columns)
