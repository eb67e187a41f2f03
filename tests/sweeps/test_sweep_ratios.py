"""Ratios over the same surfaces: of two points of a sweep, and of two ensembles."""

import numpy as np
import pytest
from oracles.drawn_together import drawn_together

import analytic
import mcgw

H = (0.0, 1.0, 2.0)
KE = mcgw.KogutEtsion(critical=0.05)


@pytest.fixture(scope="module")
def scene(make_scene):
    return make_scene(separations=H, n_surfaces=4000, n_asperities=30_000, seed=4, grading=None)


@pytest.fixture(scope="module")
def two(scene):
    return mcgw.sweep(scene, {"grading.gamma": [1.0, 2.0]})


def test_ratios_are_the_papers(two):
    """Eqs. (12) and (15) by Monte Carlo: |z| < 5, and an error of one in a thousand shows."""
    load, stiffness = (two.ratio(name, 1, 0) for name in ("load", "stiffness"))
    for gamma, fits in ((2.0, True), (2.002, False)):
        grading = analytic.Exponential(gamma)
        exact = 1 / analytic.area_per_load_ratio(H, grading)
        assert (np.abs((load.ratio - exact) / load.stderr).max() < 5) == fits
        far = np.abs((stiffness.ratio - analytic.stiffness_ratio(H, grading)) / stiffness.stderr)
        assert (far.max() < 5) == fits


def test_gain_in_variance_is_what_theory_says(two):
    """gamma = 2 against 1: 194 at h = 0 and 9394 at h = 2, from exact moments.

    The variance ratio of 4000 surfaces is known to sqrt(2 * 2/4000) = 3 % for Gaussian sums, five times
    that and the excess kurtosis of the residual at h = 2 give 25 %.
    """
    pair = two.ratio("load", 1, 0)
    for k, h in ((0, 0.0), (2, 2.0)):
        mean_a, mean_b = (float(analytic.fn(1.5, h, e)) for e in (None, analytic.Exponential(2.0)))
        aa = float(analytic.fn(3, h)) - mean_a**2
        ab = 2 * float(analytic.fn(3, h)) - np.exp(0.5) * float(analytic.fn(3, h + 1)) - mean_a * mean_b
        bb = moment_of_the_square(3, h) - mean_b**2
        r = mean_b / mean_a
        exact = (bb + r * r * aa) / (bb - 2 * r * ab + r * r * aa)
        assert pair.gain[k] == pytest.approx(exact, rel=0.25)
        assert exact == pytest.approx({0.0: 194, 2.0: 9394}[h], rel=5e-3)


def moment_of_the_square(n, h):
    """Integral of (s-h)^n (2 - exp(-s))^2 phi, in closed form."""
    terms = zip((4, -4 * np.exp(0.5), np.exp(2)), (0, 1, 2), strict=True)
    return sum(c * float(analytic.fn(n, h + j)) for c, j in terms)


def stiffening(s):
    return 1 + 0.5 * np.tanh(s)


GRADINGS = [
    mcgw.Homogeneous(),
    mcgw.Exponential(2.0),
    mcgw.Table([-1.0, 0.3, 5.0], [1.0, 1.5, 2.0]),
    stiffening,
]


def assert_by_hand(pair, b, a):
    """Delta method and jackknife, from the values of every surface."""
    ratio, n = b.sum(axis=0) / a.sum(axis=0), len(a)
    stderr = np.sqrt(((b - ratio * a) ** 2).sum(axis=0) / ((n - 1) * n)) / a.mean(axis=0)
    out = [np.delete(b, k, axis=0).sum(axis=0) / np.delete(a, k, axis=0).sum(axis=0) for k in range(n)]
    jackknife = np.sqrt((n - 1) / n * ((out - np.mean(out, axis=0)) ** 2).sum(axis=0))
    np.testing.assert_allclose(pair.ratio, ratio, rtol=1e-12)
    np.testing.assert_allclose(pair.stderr, stderr, rtol=1e-6)
    np.testing.assert_allclose(pair.stderr, jackknife, rtol=0.05)
    low, high = pair.interval()
    np.testing.assert_allclose([ratio - low, high - ratio], [1.959964 * stderr] * 2, rtol=1e-6)


@pytest.mark.parametrize("path", [None, "s.h5"])
def test_tables_and_functions_share_their_surfaces(make_scene, tmp_path, path):
    """The values of each point on the same surfaces give the ratios; from a file as well."""
    scene = make_scene(separations=H, n_surfaces=80, grading=None)
    swept = mcgw.sweep(scene, {"grading": GRADINGS}, path=path and tmp_path / path)
    assert len(swept.groups) == 1
    edges, values = drawn_together(swept)
    assert edges  # a table and a function want cells of their own
    ratios = swept.ratios()
    for k in (1, 2, 3):
        assert_by_hand(swept.ratio("load", k, 0), values[k]["load"], values[0]["load"])
        np.testing.assert_array_equal(ratios["load"][k].ratio, swept.ratio("load", k, 0).ratio)
    assert swept.scene(3).grading.name == "stiffening"
    assert "contacts" not in ratios
    with pytest.raises(ValueError, match="a point that has a function is named by its indices"):
        swept.ratio("load", {"grading": stiffening}, 1)


def test_points_that_are_weighted_means_have_the_same_ratios(make_scene):
    """Of nine gradings two are computed; two others have the ratio of their own surfaces, as of two runs."""
    scene = make_scene(separations=H, n_surfaces=60, grading=None)
    swept = mcgw.sweep(scene, {"grading.gamma": np.linspace(0.4, 2.0, 9).tolist()})
    b, a = (mcgw.simulate(swept.scene(k)) for k in (6, 2))
    for pair in (swept.ratio("load", 6, 2), mcgw.paired_ratio(b, a, "load")):
        assert_by_hand(pair, b.load, a.load)


def test_one_surface_has_a_ratio_without_an_error(make_scene):
    swept = mcgw.sweep(make_scene(separations=H, n_surfaces=1), {"grading.gamma": [1.0, 2.0]})
    pair = swept.ratio("load", 1, 0)
    two = [mcgw.simulate(swept.scene(k)).load[0] for k in (1, 0)]
    np.testing.assert_allclose(pair.ratio, two[0] / two[1], rtol=1e-12)
    assert np.isnan([pair.stderr, pair.gain, *pair.interval()]).all()
    with pytest.raises(ValueError, match=r"level = 95: give a number between 0 and 1"):
        pair.interval(95)


def test_points_of_other_surfaces_have_no_ratio(make_scene):
    swept = mcgw.sweep(make_scene(n_surfaces=9), {"ensemble.n_asperities": [300, 600]})
    assert swept.ratios() == {}
    assert "load_ratio" not in {column.name for column in swept.table().columns}
    with pytest.raises(ValueError, match="have different surfaces, so there are no pairs"):
        swept.ratio("load", 1, 0)


OTHERS = {
    "seed": {"seed": 5}, "count": {"count": "poisson"}, "n_asperities": {"n_asperities": 3001},
    "n_surfaces": {"n_surfaces": 8}, "heights": {"heights": analytic.Weibull(2.0)},
    "separations, seed": {"separations": (0.5, 1.0), "seed": 5}, "sampler": {"sampler": "tail"},
    "surface": {"surface": analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9)},
    r"law, .*mcgw\.sweep.*": {"law": KE},
}  # fmt: skip


@pytest.mark.parametrize("told", OTHERS)
def test_a_pair_is_of_the_same_surfaces(make_scene, told):
    """Anything but the grading that differs is named; two laws have other cells and so other heights."""
    one = mcgw.simulate(make_scene(separations=(0.0, 1.0), sampler="cells", n_surfaces=9))
    with pytest.raises(ValueError, match=rf"the same surfaces; these differ in {told}$"):
        mcgw.paired_ratio(mcgw.simulate(one.scene, **OTHERS[told]), one, "load")


def test_two_laws_drawn_by_tail_are_a_pair(make_scene):
    base = make_scene(separations=H, n_surfaces=40, n_asperities=2000, sampler="tail")
    one, other = (mcgw.simulate(base, law=law) for law in (None, KE))
    np.testing.assert_array_equal(one.contacts, other.contacts)
    assert np.all(mcgw.paired_ratio(one, other, "load").gain > 1)
