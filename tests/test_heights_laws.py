"""ContactLaws of heights beside the Gaussian: closed forms, literal quadrature, and every exact sampler.

Statistical gates are |z| < 5 for means and variances with fixed seeds: a false alarm in 2e6. The laws
differ from the Gaussian by tens of percent, thousands of standard errors; the last tests prove that.
"""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

import analytic
import mcgw
from analytic import (
    Exponential,
    ExponentialHeights,
    Gaussian,
    HeightTable,
    MeasuredHeights,
    Nayak,
    ScipyHeights,
    Weibull,
)
from mcgw.sampling.asperities import heights
from mcgw.sampling.hertz import hertz_sums

SAMPLE = np.random.default_rng(1).weibull(1.6, size=3000)
LAWS = {
    "exponential": ExponentialHeights(),
    "weibull +1": Weibull(1.56391),
    "weibull 0": Weibull(3.60235),
    "weibull -1": Weibull(40.743),
    "nayak": Nayak(1.8),
    "gamma": ScipyHeights(scipy.stats.gamma(2.5)),
    "beta": ScipyHeights(scipy.stats.beta(2.5, 3.5)),
    "laplace": ScipyHeights(scipy.stats.laplace()),
    "t": ScipyHeights(scipy.stats.t(8)),
    "uniform": ScipyHeights(scipy.stats.uniform()),
    "table": HeightTable.of(SAMPLE),
}
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS.keys())


def greenwood_williamson(n, h, gamma):
    """F*_n of exponential heights of mean 0, by hand, for h >= -1 (GW 1966 with the paper's grading)."""
    n, h, gamma = mp.mpf(n), mp.mpf(h), mp.mpf(gamma)
    return mp.gamma(n + 1) * mp.exp(-h - 1) * (gamma - (gamma - 1) * mp.mpf(2) ** (-n - 1) * mp.exp(-h))


@pytest.mark.parametrize("n", [0, 0.5, 1, 1.5, 2, 3])
@pytest.mark.parametrize("gamma", [0.2, 1.0, 2.0])
def test_exponential_heights_have_a_closed_form(n, gamma):
    h = np.array([-1.0, -0.5, 0.0, 1.0, 5.0, 20.0, 200.0])
    found = analytic.fn(n, h, Exponential(gamma), heights=ExponentialHeights())
    truth = [float(greenwood_williamson(n, x, gamma)) for x in h]
    # 64 nodes a piece, and exp(-201) known to 201 roundings of 1e-16; gamma = 2 loses a digit below 0.
    assert found == pytest.approx(truth, rel=1e-13)


@pytest.mark.parametrize("shape", [1.56391, 3.60235, 12.0])
@pytest.mark.parametrize("h", [-5.0, -0.7, 0.0, 1.3])
def test_weibull_integrals_against_quadrature_in_x(shape, h):
    """The definition in the unreduced variable x, at 30 digits, where nothing is singular but x = 0."""
    with mp.workdps(30):
        k = mp.mpf(shape)
        mean = mp.gamma(1 + 1 / k)
        std = mp.sqrt(mp.gamma(1 + 2 / k) - mean**2)
        low = max(mp.mpf(0), mean + std * h)

        def integrand(x):
            return abs((x - mean) / std - h) ** mp.mpf("1.5") * k * x ** (k - 1) * mp.exp(-(x**k))

        cuts = [low, *(low + mp.mpf(c) for c in ("0.01", "0.1", "0.4", "1", "2", "4", "9", "20", "50"))]
        truth = float(mp.quad(integrand, cuts))
    assert float(analytic.fn(1.5, h, heights=Weibull(shape))) == pytest.approx(truth, rel=1e-12)


@every_law
def test_laws_are_reduced(law):
    rule = analytic.HeightRule.over([-60.0], analytic.Homogeneous(), law)
    one, mean, square = (float(rule.probabilities @ rule.heights**k) for k in range(3))
    # Student's t lies below -60 with a probability of 1e-12; scipy's pdf is good to some 1e-13.
    assert (one, square) == (pytest.approx(1, abs=1e-9), pytest.approx(1, abs=1e-6))
    assert mean == pytest.approx(0, abs=1e-8)


@every_law
@pytest.mark.parametrize("s", [-1.1, 0.3, 1.1])
def test_shares_and_their_inverses_fit(law, s):
    p, s = np.array([1e-6, 0.1, 0.5, 0.9]), max(s, law.support[0] + 0.1)
    low, high = law.from_below(p, s), law.from_above(p, s)
    # scipy's ppf stops within 1e-9 of some shares
    assert law.below(low) == pytest.approx(p * law.below(np.array(s)), rel=1e-8, abs=1e-13)
    assert law.above(high) == pytest.approx(p * law.above(np.array(s)), rel=1e-8, abs=1e-13)
    assert np.all(low <= s)
    assert np.all(high >= s)


@every_law
def test_density_is_the_slope_of_the_shares(law):
    a, b = 0.31, 0.62
    breaks = [x for x in law.breaks if a < x < b]
    area = quad(
        lambda s: float(law.density(np.array(s))), a, b, points=breaks or None, limit=300, epsrel=1e-11
    )[0]
    assert area == pytest.approx(float(law.below(np.array(b)) - law.below(np.array(a))), rel=1e-9)


@every_law
def test_log_ratio_is_that_of_the_density(law):
    s = 0.31
    t = np.array([1e-9, 1e-3]) * min(law.span(s), 1e-3)
    expected = np.log(law.density(s + t) / law.density(np.array(s)))
    # absolute: the quotient of densities is known to a few last digits
    assert law.log_ratio(np.array(s), t) == pytest.approx(expected, abs=1e-13)


@every_law
def test_sums_over_the_listed_heights_equal_the_row(law, make_scene):
    """Each cell's own moments against plain sums over the very heights, to the 1e-12 of the mesh."""
    for separations in ((0.0, 0.4, 1.0), (-30.0, -0.9, 0.5)):
        scene = make_scene(
            heights=law, separations=separations, sampler="cells", n_surfaces=3, grading=Exponential(0.7)
        )
        ensemble = mcgw.simulate(scene)
        listed = heights(scene, 2)
        sums = hertz_sums(scene, np.array([listed.size]), listed, np.ones(listed.size))
        for name in scene.quantities:
            assert ensemble.values(name)[2] == pytest.approx(sums[name][0], rel=1e-12)


def gates(scene, law):
    """Largest |z| of means and of variances against the exact ones of a law."""
    ensemble = mcgw.simulate(scene)
    m, worst = scene.n_surfaces, []
    for name in scene.quantities:
        exact = analytic.cumulants(
            scene.surface, name, scene.separations, scene.modulus,
            n_asperities=scene.n_asperities, count=scene.count, heights=law,
        )  # fmt: skip
        z = (ensemble.mean(name) - exact.mean) / np.sqrt(exact.variance / m)
        spread = exact.variance * np.sqrt(2 / (m - 1) + exact.excess_kurtosis / m)
        worst.append((np.abs(z).max(), np.abs((ensemble.std(name) ** 2 - exact.variance) / spread).max()))
    return np.max(worst, axis=0)


@every_law
@pytest.mark.parametrize("sampler", ["direct", "tail", "cells"])
def test_samplers_have_the_exact_mean_and_variance(law, sampler, make_scene):
    scene = make_scene(
        heights=law, sampler=sampler, n_surfaces=400, n_asperities=500, seed=7,
        separations=(-0.4, 0.0, 0.8), grading=Exponential(0.5),
    )  # fmt: skip
    assert np.all(gates(scene, law) < 5)


@pytest.mark.parametrize("wrong", [Gaussian(), Weibull(1.5)])
def test_another_law_fails_the_same_gates(wrong, make_scene):
    """Companion: the gates see a shape of 1.56 taken for 1.5, and the Gaussian at once."""
    scene = make_scene(
        heights=Weibull(1.56391), sampler="cells", n_surfaces=12000, separations=(0.0, 0.8), seed=7
    )
    assert gates(scene, Weibull(1.56391)).max() < 5
    assert gates(scene, wrong).max() > 8


@pytest.mark.parametrize("law", [ExponentialHeights(), Weibull(1.56391)], ids=["exponential", "weibull"])
def test_the_error_of_the_mean_falls_as_it_should(law, make_scene):
    """Root mean square z over four ensembles of 16, 64, ... 4096 surfaces stays 1.

    Each is a mean of 16 values; over 1.9 would be a false alarm of 1e-4 for chi-square of 16.
    """
    h = (0.0, 0.7, 1.4, 2.1)
    for surfaces in (16, 64, 256, 1024, 4096):
        squares = []
        for seed in range(4):
            scene = make_scene(
                heights=law, separations=h, n_surfaces=surfaces, seed=seed, quantities=("load",)
            )
            exact = analytic.cumulants(
                scene.surface, "load", h, scene.modulus, n_asperities=scene.n_asperities, heights=law
            )
            z = (mcgw.simulate(scene).mean("load") - exact.mean) / np.sqrt(exact.variance / surfaces)
            squares.append(z**2)
        assert 0.2 < math.sqrt(np.mean(squares)) < 1.9


def test_load_of_exponential_heights_is_proportional_to_area():
    """What Greenwood and Williamson built on: A/P, the mean pressure, is the same at every separation."""
    ratio = analytic.fn(1, [0.0, 1.0, 4.0], heights=ExponentialHeights()) / analytic.fn(
        1.5, [0.0, 1.0, 4.0], heights=ExponentialHeights()
    )
    assert ratio == pytest.approx(1 / math.gamma(2.5), rel=1e-13)


def test_the_separation_is_found_again_under_another_law():
    surface = analytic.Surface(1e-6, 1e-5, 1e9, 1e-6, 1e9)
    h = np.array([0.2, 1.7])
    load = analytic.load(surface, h, heights=Weibull(2.0))
    assert analytic.separation_at(surface, "load", load, heights=Weibull(2.0)) == pytest.approx(h, abs=1e-12)


def test_measured_heights_are_added_up_as_they_are(make_scene):
    law = MeasuredHeights(SAMPLE)
    scene = make_scene(
        heights=law, sampler="direct", n_surfaces=1, n_asperities=SAMPLE.size, separations=(0.1, 1.0)
    )
    s = (SAMPLE - SAMPLE.mean()) / SAMPLE.std()
    for k, h in enumerate(scene.separations):
        literal = sum((x - h) ** 1.5 * (2 - math.exp(-x)) for x in s if x > h)
        unit = analytic.QUANTITIES["load"].scale(scene.surface)
        assert mcgw.simulate(scene).load[0, k] == pytest.approx(unit * literal, rel=1e-12)
        assert analytic.fn(1.5, h, Exponential(2.0), heights=law) * SAMPLE.size == pytest.approx(
            literal, rel=1e-12
        )


def test_a_table_comes_close_to_its_sample():
    """The means over the smoothed law and over the sample differ by less than the sample's own error."""
    table, sample = HeightTable.of(SAMPLE), MeasuredHeights(SAMPLE)
    for h in (-1.0, 0.0, 1.0, 2.0):
        f = np.maximum(np.array(sample.heights) - h, 0) ** 1.5
        error = f.std() / math.sqrt(f.size)
        assert abs(float(analytic.fn(1.5, h, heights=table)) - f.mean()) < 0.5 * error


def test_ties_do_not_break_a_table():
    law = HeightTable.of(np.repeat([1.0, 1.0, 2.0, 5.0], 50))
    assert np.all(np.diff(law.s) > 0)
    assert float(analytic.fn(0, -9.0, heights=law)) == pytest.approx(1, rel=1e-14)


@settings(deadline=None)
@given(st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=60))
def test_a_table_of_any_heights_is_a_law(values):
    if np.std(values) < 1e-6:
        return
    law = HeightTable.of(values)
    rule = analytic.HeightRule.over([law.s[0] - 1], analytic.Homogeneous(), law)
    # A gap between two heights is only known to their last digits.
    known = 1e-13 + 1e-15 * max(np.abs(law.s)) / min(np.diff(law.s))
    assert float(rule.probabilities.sum()) == pytest.approx(1, rel=known)
    assert float(rule.probabilities @ rule.heights**2) == pytest.approx(1, rel=100 * known)


HEAD = """
[surface]
sigma = 1e-6
radius = 1e-5
eta = 1e9
nominal_area = 1e-6
E_star = 1e9
[contact]
separations = [0.0]
"""


@pytest.mark.parametrize(
    "section",
    [
        'law = "exponential"',
        'law = "weibull"\nshape = 1.56',
        'law = "table"\nheights = [1.0, 2.0, 3.5, 7.0]',
        'law = "table"\ns = [0.0, 1.0, 3.0]\nshare = [0.0, 0.4, 1.0]',
        'law = "scipy"\nname = "gamma"\nshapes = {a = 2.5}',
        'law = "scipy"\nname = "norm"',
        'law = "table"\nheights = [1.0, 2.0, 3.5, 7.0]\nresample = false\n'
        '[ensemble]\nn_surfaces = 1\nn_asperities = 4\nsampler = "direct"',
    ],
)
def test_a_scene_with_heights_reads_the_same_again(section):
    scene = mcgw.scene_from(HEAD + "[heights]\n" + section)
    assert not isinstance(scene.heights, Gaussian)
    again = mcgw.scene_from(mcgw.scene_text(scene))
    assert again == scene


@pytest.mark.parametrize(
    ("section", "told"),
    [
        ('law = "weibul"', "did you mean weibull"),
        ('law = "weibull"', r"heights\.shape: missing"),
        ('law = "weibull"\nshape = 0.2', r"heights\.shape = 0\.2: give a number from 1 to 100"),
        ('law = "table"\nheights = [1.0, 1.0]', "all alike"),
        ('law = "table"\nheights = ["a"]', "give heights"),
        ('law = "table"\nfile = "nowhere.csv"', "No such file"),
        ('law = "table"\ns = [0.0, 1.0]\nshare = [0.0, 0.4]', "share from 0 to 1"),
        ('law = "scipy"\nname = "poisson"', "continuous distribution"),
        ('law = "scipy"\nname = "gamma"', "give its shapes"),
        ('law = "scipy"\nname = "cauchy"', "must be finite"),
        ('law = "table"\nheights = [1.0, 2.0]\nresample = false', "measured heights"),
        ('law = "exponential"\nshape = 2', "unknown key"),
    ],
)
def test_mistakes_in_heights_are_named(section, told):
    with pytest.raises(mcgw.SceneError, match=told):
        mcgw.scene_from(HEAD + "[heights]\n" + section)


def test_heights_from_files(tmp_path):
    np.save(tmp_path / "z.npy", SAMPLE)
    np.savetxt(tmp_path / "z.csv", SAMPLE, header="m")
    for name in ("z.npy", "z.csv"):
        scene = mcgw.scene_from(HEAD + f'[heights]\nlaw = "table"\nfile = "{name}"', folder=tmp_path)
        assert scene.heights == HeightTable.of(SAMPLE)


def test_a_negative_modulus_is_found_far_up_a_heavy_tail(make_scene):
    """Exponential heights reach s = 36, where a grading may turn negative that Gaussian ones never see."""
    falling = analytic.Custom(lambda s: np.where(s > 20, -1.0, 1.0), breaks=(20.0,))
    make_scene(grading=falling)
    with pytest.raises(mcgw.SceneError, match="negative from s = 20"):
        make_scene(grading=falling, heights=ExponentialHeights())
