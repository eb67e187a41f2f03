"""Summits from a file in a scene: literal sums over them, resampled in pairs, and mistakes in files."""

import math

import numpy as np
import pytest
from oracles.law_means import own_terms
from oracles.scenes import scene_by
from oracles.summits_by_hand import summit_contact
from scipy.optimize import brentq
from test_random_radii import LAWS as OTHERS

import analytic
import mcgw
from mcgw.maps.summit_sums import SUMMITS, Summits

K = 200
MODULUS = 78.6e9
QUANTITIES = ("load", "area", "stiffness", "contacts", "conductance")
SEPARATIONS = (-1.0, 0.0, 0.7, 1.5)


def measured(seed=1):
    """Heights and radii in m; high summits are sharper, as on a map, and two have the same height."""
    rng = np.random.default_rng(seed)
    z = rng.normal(size=K) * 1e-6
    radii = 1e-5 * np.exp(0.4 * rng.normal(size=K) - 0.5 * z / 1e-6)
    z[7] = z[8]
    return z - z.mean(), radii


Z, RADII = measured()


def scene(*, resampled=False, radii=RADII, **changes):
    """A scene of these summits, from Python."""
    surface = mcgw.Surface(Z.std(), 1 / np.mean(1 / radii), K / 1e-6, 1e-6, MODULUS)
    heights = mcgw.MeasuredHeights(Z, resampled=resampled)
    values = {"separations": SEPARATIONS, "quantities": QUANTITIES, "seed": 1, "n_surfaces": 1}
    return scene_by(
        surface, summits=mcgw.MeasuredRadii(heights, radii / surface.radius), **(values | changes)
    )


HEAD = '[surface]\nnominal_area = "1 mm^2"\nE_star = "78.6 GPa"\n'
ASKED = "[contact]\nseparations = [-1.0, 0.0, 0.7, 1.5]\n[ensemble]\nseed = 1\n"


@pytest.fixture
def table(tmp_path):
    """The summits in a file as `mcgw fit --summits` writes it."""
    curvatures = np.array([1.25 / RADII, 0.8 / RADII])
    place = np.linspace(0, 1e-3, K)
    tile = np.zeros(K, dtype=np.int64)
    summits = Summits(place[None], place, place, Z, place, curvatures, tile, (1.0, 1.0))
    summits.table().write(tmp_path / "summits.csv", comment=SUMMITS)
    return tmp_path / "summits.csv"


def from_file(table, more=""):
    return mcgw.scene_from(HEAD + f'[summits]\nfile = "{table.name}"\n{more}' + ASKED, folder=table.parent)


def test_file_as_it_is_gives_the_sums_over_its_summits(table):
    x = from_file(table)
    assert (x.n_asperities, x.n_surfaces) == (K, 1)
    assert x.surface.sigma == Z.std()
    assert x.surface.radius == pytest.approx(1 / np.mean(1 / RADII), rel=1e-14)
    assert x.surface.eta == K / 1e-6
    ensemble = mcgw.simulate(x)
    exact = summit_contact(Z, RADII, MODULUS, np.array(SEPARATIONS) * Z.std())
    for name in ("load", "area", "stiffness", "contacts"):
        np.testing.assert_allclose(ensemble[name], getattr(exact, name), rtol=1e-12)
        np.testing.assert_allclose(x.theory.mean(name, SEPARATIONS), getattr(exact, name)[0], rtol=1e-12)
    assert mcgw.compare(ensemble).verdict.agrees


LAWS = [None, *OTHERS]
GRADINGS = [None, mcgw.Exponential(1.5), mcgw.Table([-1.0, 0.3, 1.0, 2.2], [0.3, 0.5, 1.4, 1.5])]


@pytest.mark.parametrize(("law", "grading"), [
    (0, 2), (1, 0), (2, 2), (3, 1), (4, 0),
])  # fmt: skip
def test_each_summit_has_the_law_of_its_own_radius(law, grading):
    """Means over surfaces drawn from the list, and their variance, as well: n times those of one summit."""
    x = scene(law=LAWS[law], grading=GRADINGS[grading])
    drawn, theory = mcgw.simulate(x), x.theory
    for name in QUANTITIES:
        terms = own_terms(x, name, Z / Z.std(), RADII)
        sums = [math.fsum(row) for row in terms.tolist()]
        np.testing.assert_allclose(drawn[name][0], sums, rtol=1e-12)
        np.testing.assert_allclose(theory.mean(name, SEPARATIONS), sums, rtol=1e-12)
        covariance = K * np.cov(terms, bias=True)
        found = theory.covariance([name], SEPARATIONS)[0, :, 0]
        np.testing.assert_allclose(found, covariance, rtol=1e-10, atol=1e-12 * np.diag(covariance).max())


@pytest.mark.parametrize(("law", "surfaces"), [
    (None, 2000), pytest.param(mcgw.KogutEtsion(hardness=1.2e9), 200, marks=pytest.mark.slow),
], ids=("hertz", "kogut-etsion"))  # fmt: skip
def test_resampled_means_and_variances_are_exact(law, surfaces):
    """|z| < 5 of 16 means and 16 variances each: a false alarm in 50 000."""
    x = scene(resampled=True, law=law, n_surfaces=surfaces, count="fixed", quantities=QUANTITIES[:4])
    ensemble, m = mcgw.simulate(x), x.n_surfaces
    assert ensemble.sampler == "direct"
    for name in x.quantities:
        for k, terms in enumerate(own_terms(x, name, Z / Z.std(), RADII)):
            mean, variance = K * terms.mean(), K * terms.var()
            fourth = K * (np.mean((terms - terms.mean()) ** 4) - 3 * terms.var() ** 2) + 3 * variance**2
            assert abs(ensemble[name][:, k].mean() - mean) < 5 * math.sqrt(variance / m), (name, k)
            spread = math.sqrt((fourth - variance**2) / m)
            assert abs(ensemble[name][:, k].var() - variance) < 5 * spread, (name, k)
    assert mcgw.compare(ensemble).verdict.agrees


def test_slopes_inverses_and_shares():
    layered = mcgw.Joint((150.0, 16.0), layer={"thickness": "1 um", "conductivity": 1.3})
    theory, h = scene(law=mcgw.KogutEtsion(hardness=1.2e9), joint=layered).theory, 0.7123
    for name in ("load", "area", "conductance", "conductance_si"):
        step = 1e-6
        rise = (theory.mean(name, h - step) - theory.mean(name, h + step)) / (2 * step)
        assert theory.slope(name, h) == pytest.approx(rise, rel=1e-6)
        assert theory.separation_at(name, theory.mean(name, h)) == pytest.approx(h, abs=1e-12)
    yielded = theory.mean("yielded", h) / theory.mean("contacts", h)
    assert theory.share(0, h) == pytest.approx(1 - yielded, rel=1e-12)


def test_a_scene_reads_the_same_again(table):
    x = from_file(table, "resample = true\n")
    assert mcgw.scene_from(mcgw.scene_text(x)) == x
    beside = mcgw.scene_text(x, heights_file=table.name)
    assert mcgw.scene_from(beside, folder=table.parent) == x
    assert len(beside) < 2000
    with_lists = HEAD + f"[summits]\nheights = {(Z - Z.mean()).tolist()}\nradii = {RADII.tolist()}\n" + ASKED
    found = mcgw.scene_from(with_lists)
    assert found.heights == from_file(table).heights
    assert found.summits.ratios == pytest.approx(RADII * np.mean(1 / RADII), rel=1e-14)


def test_what_the_surface_gives_is_used(table):
    x = mcgw.scene_from(
        HEAD + f'sigma = "2 um"\nradius = "20 um"\n[summits]\nfile = "{table.name}"\n' + ASKED,
        folder=table.parent,
    )
    assert (x.surface.sigma, x.surface.radius) == (2e-6, 2e-5)
    exact = summit_contact(Z * (2e-6 / Z.std()), RADII, MODULUS, np.array(SEPARATIONS) * 2e-6)
    np.testing.assert_allclose(mcgw.simulate(x).load, exact.load, rtol=1e-12)


PAIR = "[summits]\nheights = [1e-6, 2e-6, 4e-6]\nradii = [1e-5, 2e-5, 1e-5]\n"
SPECTRUM, PLAIN = "m0 = 1e-12\nm2 = 1e-3\nm4 = 5e6\n", "sigma = 1e-6\nradius = 1e-5\neta = 1e9\n"
METAL = "law.name = 'kogut-etsion'\nlaw.hardness = 1e9\n[ensemble]\nsampler = 'cells'\n"


@pytest.mark.parametrize(("surface", "more", "says"), [
    ("", "[summits]\nheights = [1e-6, 2e-6]", "give radii or ratios too"),
    ("", "[summits]\nresample = true", "give heights or file too"),
    ("", PAIR + "ratios = [1, 2, 1]", "give it or ratios, not both"),
    ("", PAIR + "file = 'a.csv'", "not both"),
    ("", PAIR + "curvature = 'random'", "give it or curvature, not both"),
    ("", PAIR + "largest_radius = 1", "give it or largest_radius, not both"),
    ("", PAIR + "[heights]\nlaw = 'nayak'\nalpha = 5.0", "leave [heights] out"),
    (SPECTRUM, PAIR, "surface.m0"),
    ("", PAIR + "[ensemble]\nsampler = 'cells'", 'use "direct"'),
    ("", PAIR + "[ensemble]\nn_surfaces = 5", "set summits.resample = true"),
    ("", PAIR + "[ensemble]\nn_asperities = 5", "summits.resample = true"),
    ("", PAIR + "resample = true\n[ensemble]\nsampler = 'aggregate'", 'use "direct"'),
    (SPECTRUM + "radius = 1\n", "", "m0 = 1e-12: give it or radius"),
    (SPECTRUM, "[ensemble]\nsampler = 'aggregate'\n", "aggregate"),
    (SPECTRUM, "[heights]\nlaw = 'gaussian'\n", "nayak"),
    (SPECTRUM, METAL, "tail"),
    (PLAIN, "datum = 'surface'\n", "datum"),
    (PLAIN, "[summits]\ncurvature = 'random'\n", "nayak"),
    (PLAIN, "[summits]\nlargest_radius = 1\n", "largest_radius"),
])  # fmt: skip
def test_summits_that_do_not_go_together_get_one_line(surface, more, says):
    with pytest.raises(mcgw.SceneError) as caught:
        mcgw.scene_from(f"{HEAD}{surface}[contact]\nseparations = 1\n{more}")
    assert len(caught.value.problems) == 1, caught.value.problems
    assert says in caught.value.problems[0]


@pytest.mark.parametrize(("content", "says"), [
    ("height\n1e-6\n2e-6\n", "must name height and radius"),
    ("height,radius\n1e-6,1e-5\n2e-6,flat\n", "row 2 below the header has no number"),
    ("height,radius\n1e-6,1e-5\nnan,1e-5\n", "row 2 below the header has no number"),
    ("height,radius\n", "two or more"),
])  # fmt: skip
def test_bad_files_get_one_line(content, says, tmp_path):
    (tmp_path / "s.csv").write_text(content)
    with pytest.raises(mcgw.SceneError) as caught:
        from_file(tmp_path / "s.csv")
    assert len(caught.value.problems) == 1, caught.value.problems
    assert says in caught.value.problems[0]


def test_of_a_list_there_is_nothing_to_trade_off():
    with pytest.raises(ValueError, match="no other method"):
        mcgw.tradeoff(scene(resampled=True))


@pytest.mark.parametrize("own", [True, False])
def test_a_load_on_the_very_summits(own):
    """Against a root of plain sums over the list; specimens are lists resampled from it, and scatter so."""
    x = scene() if own else scene().replace(summits="mean")
    s, r = np.array(x.heights.heights), np.array(x.summits.ratios if own else np.ones(len(Z)))
    unit = 4 / 3 * x.surface.E_star * x.surface.radius**0.5 * x.surface.sigma**1.5

    def load(h, s=s, r=r):
        return unit * np.sum(np.sqrt(r) * np.maximum(s - h, 0) ** 1.5)

    def separation(which):
        return brentq(lambda h: load(h, s[which], r[which]) - wished, -9, s.max())

    wished = load(0.5)
    found = mcgw.solve(x, load=wished)
    assert found.theory["separation"] == pytest.approx(0.5, rel=1e-12)
    assert found.theory["area"] == pytest.approx(
        float(mcgw.simulate(x.replace(separations=[0.5])).area[0, 0])
    )
    for k in (0, 7):
        h = found.surfaces["separation"][k]
        own_radii = found.radii(k) / x.surface.radius
        assert {*zip(found.heights(k), own_radii.round(9), strict=True)} <= {*zip(s, r.round(9), strict=True)}
        assert load(h, found.heights(k), own_radii) == pytest.approx(wished, rel=1e-10)
    rng = np.random.default_rng(1)
    by_hand = [separation(rng.integers(0, s.size, s.size)) for _ in range(200)]
    # Two samples of 200: means within 4.5 standard errors but in 7 of 1e6, deviations in 30 % but in 1e-4.
    apart = found.surfaces["separation"].mean() - np.mean(by_hand)
    assert abs(apart) < 4.5 * np.std(by_hand) * np.sqrt(2 / 200)
    assert np.log(found.surfaces["separation"].std() / np.std(by_hand)) == pytest.approx(0, abs=0.3)


def test_radii_of_other_heights_are_refused():
    radii = mcgw.MeasuredRadii(mcgw.MeasuredHeights(Z), RADII)
    with pytest.raises(mcgw.SceneError, match="differ from those of the measured summits"):
        scene().replace(heights=mcgw.MeasuredHeights(-Z))
    with pytest.raises(ValueError, match="their own heights"):
        analytic.Model(scene().surface, curvature=radii)
    with pytest.raises(mcgw.SceneError, match="HeightTable"):
        scene().replace(heights=mcgw.MeasuredHeights(Z, resampled=True), summits=None)
    for ratios, says in (([1.0], "1 for 200"), (np.where(Z > 0, 1.0, np.nan), "is nan")):
        with pytest.raises(ValueError, match=says):
            mcgw.MeasuredRadii(mcgw.MeasuredHeights(Z), ratios)
