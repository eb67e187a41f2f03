"""Summits with radii of their own: drawn sums against literal ones, the law of the radii, every crossing."""

import math

import numpy as np
import pytest
from oracles.accurately import worst_error
from oracles.law_means import own_terms
from oracles.scenes import scene_by
from scipy import stats

import analytic
import mcgw
from mcgw.sampling.asperities import summits, summits_drawn
from mcgw.sampling.own_radii import radius_table
from mcgw.sampling.samplers import sampler_of

ALPHAS = (1.55, 2.0, 5.0, 50.0)
QUANTITIES = ("load", "area", "stiffness", "conductance", "contacts")


def spectral(alpha=5.0, **changes):
    """A scene of a surface with this bandwidth."""
    moments = analytic.SpectralMoments(1e-12, 1e-3, alpha * 1e-6 / 1e-12)
    surface = mcgw.SpectralSurface(moments.m0, moments.m2, moments.m4, 1e-6, 78.6e9)
    values = {
        "separations": np.linspace(0, 4, 9), "n_asperities": 20_000, "n_surfaces": 20, "seed": 1,
        "quantities": QUANTITIES,
    }  # fmt: skip
    return scene_by(surface, **(values | changes))


@pytest.mark.parametrize(
    ("sampler", "alpha"), [*(("cells", alpha) for alpha in ALPHAS), ("tail", 1.55), ("tail", 5.0)]
)
def test_sums_are_those_of_the_very_summits(sampler, alpha):
    scene = spectral(alpha, sampler=sampler, separations=[-1.0, 0.0, 0.3, 1.0, 2.5])
    assert worst_error(scene, 3) < 1e-12


@pytest.mark.parametrize("changes", [
    {"grading": analytic.Exponential(2.0)},
    {"grading": analytic.Table([-1.0, 0.3, 1.0, 2.2], [0.3, 0.5, 1.4, 1.5])},
    {"grading": lambda s: 1 + 0.3 * np.tanh(s)},
    {"n_asperities": 2},
    {"n_asperities": 400_000, "separations": (1.0,)},
    {"count": "poisson"},
    {"seed": 2**64 - 1},
    {"separations": np.linspace(0, 4, 41)},
    {"separations": (1.0, 1.0 + 1e-9, 1.5)},
    {"summits": analytic.RandomCurvature(5.0, 2.0)},
    {"quantities": ("contacts",)},
    {"quantities": ("contacts", "area", "load")},
], ids=lambda changes: ", ".join(changes))  # fmt: skip
def test_crossings(changes):
    assert worst_error(spectral(sampler="cells", **changes), 2) < 1e-12


@pytest.mark.parametrize("alpha", ALPHAS)
def test_table_is_the_inverse_of_the_law(alpha):
    """Shares of what the table gives, by the law's own distribution function, down to 2^-40 at both ends."""
    curvature = analytic.RandomCurvature(alpha)
    table, rng = radius_table(curvature, -3.0), np.random.default_rng(1)
    s = rng.uniform(-3, 7, 400)
    p = np.concatenate([rng.uniform(0, 0.5, 200), 2.0 ** rng.uniform(-40, -1, 200)])
    for side, of in ((-1, curvature.cdf), (1, curvature.sf)):
        x = 1 - 2 * p
        coarse = side * ((np.floor(np.abs(x) * 2**31) + 0.5) * 2.0**-31)  # as 32 bits give it
        fine = ((1 - np.abs(coarse)) / 2 - p) * -(2.0**33)
        g = (8 / math.sqrt(3 * math.pi)) / table.root_ratios(s, coarse, fine) ** 2
        np.testing.assert_allclose(of(g, s), p, rtol=2e-5, atol=0)
        np.testing.assert_allclose(of(g, s), p, rtol=0, atol=1e-6 if alpha < 2 else 3e-8)


def test_radii_and_heights_have_the_joint_law():
    """Kolmogorov and Smirnov, against summits made of four Gaussians; of nine tests, alarm at 1e-4 each."""
    alpha, n = 2.0, 60_000
    scene = spectral(alpha, sampler="cells", separations=(-0.5,), n_asperities=n, n_surfaces=2)
    sampler = sampler_of(scene)
    s, c = (
        np.concatenate(part) for part in zip(*(summits_drawn(scene, sampler, i) for i in (0, 1)), strict=True)
    )
    rng = np.random.default_rng(5)
    rho = math.sqrt(1.5 / alpha)
    zeta, xi = rng.normal(size=(2, 2, 1_500_000))  # of curvatures; of what is left of the height
    mean = rng.normal(size=1_500_000) * math.sqrt(2)  # T/q, of variance 2
    deviator = np.hypot(*zeta)
    det = mean**2 - deviator**2
    keep = (mean > 0) & (det > 0) & (rng.random(1_500_000) * 25 < det)
    heights = rho * mean / math.sqrt(2) + math.sqrt(1 - rho**2) * xi[0]
    law = analytic.Nayak(alpha)
    theirs = (heights[keep] - law.mean) / law.std, 8 / math.sqrt(3 * math.pi) / np.sqrt(det[keep])
    touching = theirs[0] > -0.5
    theirs = [part[touching] for part in theirs]
    for low, high in ((-0.5, 10), (-0.5, 0.3), (1.2, 10)):
        mine, other = ((a > low) & (a < high) for a in (s, theirs[0]))
        for ours, theirs_too in ((s, theirs[0]), (c, theirs[1]), (c * s, theirs[1] * theirs[0])):
            assert stats.ks_2samp(ours[mine], theirs_too[other]).pvalue > 1e-4
    assert (
        stats.ks_2samp(rng.permutation(c) * s, theirs[1] * theirs[0]).pvalue < 1e-6
    )  # were they independent


@pytest.mark.parametrize("sampler", ["cells", "tail", "direct"])
def test_means_are_those_of_theory(sampler):
    """|z| < 5 by the exact variance, which exists though the kurtosis of the area does not."""
    scene = spectral(2.0, n_asperities=2000, separations=(0.0, 1.5), sampler=sampler, n_surfaces=400)
    ensemble, theory = mcgw.simulate(scene), scene.theory
    for name in scene.quantities:
        mean, std = (get(name, scene.separations) for get in (theory.mean, theory.std))
        assert (np.abs(ensemble.mean(name) - mean) < 5 * std / 20).all(), name


LAWS = [
    mcgw.KogutEtsion(hardness=1.2e9), mcgw.JacksonGreen(yield_strength=4e8),
    mcgw.JohnsonKendallRoberts(work=0.05), mcgw.PowerLawGraded(k=0.3, c0=1e-6),
]  # fmt: skip


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_each_summit_has_the_law_of_its_own_radius(law):
    scene = spectral(
        law=law, n_asperities=150, separations=(-0.5, 1.0), grading=analytic.Exponential(0.5),
        quantities=("load", "area", "stiffness", "contacts"),
    )  # fmt: skip
    sampler = sampler_of(scene)
    assert sampler.name == "tail"
    drawn = sampler.block(0, 1).sums
    s, ratios = summits_drawn(scene, sampler, 0)
    for name in scene.quantities:
        sums = own_terms(scene, name, s, scene.surface.radius * ratios).sum(axis=1)
        np.testing.assert_allclose(drawn[name][0], sums, rtol=1e-12)


def test_all_summits_of_a_surface():
    scene = spectral(sampler="cells", n_asperities=5000)
    s, ratios = summits(scene, 0)
    touching = mcgw.radii(scene, 0)
    assert s.size == ratios.size == 5000
    np.testing.assert_allclose(scene.surface.radius * ratios[: touching.size], touching, rtol=1e-15)
    assert stats.kstest(s, lambda x: analytic.Nayak(5.0).cdf(x)).pvalue > 1e-4
    assert np.mean(1 / ratios) == pytest.approx(2.34902690068464 / 2.60588006348224, abs=0.02)


HEAD = '[surface]\nnominal_area = "1 mm^2"\nE_star = "78.6 GPa"\n'
SPECTRUM, PLAIN = "m0 = 1e-12\nm2 = 1e-3\nm4 = 5e6\n", "sigma = 1e-6\nradius = 1e-5\neta = 1e9\n"
METAL = "law.name = 'kogut-etsion'\nlaw.hardness = 1e9\n[ensemble]\nsampler = 'cells'\n"


@pytest.mark.parametrize(
    ("surface", "more", "says"),
    [
        ("m0 = 1e-12\nm2 = 1e-3\nm4 = 1e6\n", "", "alpha"),
        ("m0 = 1e-12\nm2 = 1e-3\n", "", "m4: missing"),
        (SPECTRUM + "radius = 1\n", "", "m0 = 1e-12: give it or radius"),
        (SPECTRUM, "[ensemble]\nsampler = 'aggregate'\n", "aggregate"),
        (SPECTRUM, "[heights]\nlaw = 'gaussian'\n", "nayak"),
        (PLAIN, "datum = 'surface'\n", "datum"),
        (PLAIN, "[summits]\ncurvature = 'random'\n", "nayak"),
        (PLAIN, "[summits]\nlargest_radius = 1\n", "largest_radius"),
        (SPECTRUM, METAL, "tail"),
    ],
)
def test_what_does_not_go_together_gets_one_line(surface, more, says):
    with pytest.raises(mcgw.SceneError) as caught:
        mcgw.scene_from(f"{HEAD}{surface}[contact]\nseparations = 1\n{more}")
    assert len(caught.value.problems) == 1, caught.value.problems
    assert says in caught.value.problems[0]


def test_a_wrong_area_is_seen_though_its_kurtosis_is_infinite(monkeypatch):
    """The verdict holds areas to theory: were each summit 5 % too large, it would say so."""
    from mcgw.statistics.verdict import verdict

    scene = spectral(n_surfaces=400, n_asperities=5000, sampler="cells", separations=(0.0, 1.0, 2.0))
    ensemble = mcgw.simulate(scene)
    assert np.isinf(scene.theory.cumulants("area", 1.0).excess_kurtosis)
    found = verdict(ensemble)
    assert found.agrees
    assert found.degrees > len(scene.separations) * 2
    plain = type(ensemble).mean

    def wrong(self, quantity):
        return plain(self, quantity) * (1.05 if quantity == "area" else 1.0)

    monkeypatch.setattr(type(ensemble), "mean", wrong)
    assert not verdict(ensemble).agrees
