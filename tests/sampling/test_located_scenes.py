"""Scenes whose summits have places: drawn surfaces against plain loops over pairs, limits, and refusals."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from oracles.located_by_hand import residual
from scipy.stats import t as student

import mcgw
from mcgw.cli import main
from mcgw.elasticity.levels import Pressed
from mcgw.maps.synthetic import Spectrum, gaussian_map
from mcgw.reports.plan import plan_of, plan_text
from mcgw.sampling.counts import generator
from mcgw.sampling.located.equilibrium import Located
from mcgw.sampling.located.spots import Grid, HertzSpots, LawSpots

LOCATED = {"reference": "located"}


def scene_of(area="0.09 mm^2", eta="1000/mm^2", **given):
    """90 summits a surface."""
    surface = mcgw.Surface("1 um", "10 um", eta, area, "1 GPa")
    asked = {
        "separations": [0.3, 1.5],
        "interaction": LOCATED,
        "n_surfaces": 2,
        "seed": 5,
        "sampler": "direct",
    }
    return mcgw.Scene(surface, **{**asked, **given})


def test_each_surface_is_a_balance_of_plain_loops():
    """Load, area and contacts follow by hand from penetrations that leave 1e-10 over."""
    scene = scene_of(quantities=["load", "area", "stiffness", "contacts", "conductance"])
    e = mcgw.simulate(scene)
    grid = Grid((80, 80), (3e-4, 3e-4), True)  # eight points for the mean distance of 90 summits
    for number in (0, 1):
        z = 1e-6 * mcgw.heights(scene, number)
        cells = generator(5, 2, number).choice(6400, 90, replace=False)
        one = Located(HertzSpots(z, np.full(90, 1e-5), 1e9), np.array([cells // 80, cells % 80]), grid)
        for k, h in enumerate(scene.separations):
            balance = one.at_separation(h * 1e-6)
            assert residual(one, balance) < 1e-10
            delta = balance.penetrations[balance.penetrations > 0]
            load = 4 / 3 * 1e9 * math.sqrt(1e-5) * (delta**1.5).sum()
            assert_allclose(e.load[number, k], load, rtol=1e-8)
            assert_allclose(e.area[number, k], math.pi * 1e-5 * delta.sum(), rtol=1e-8)
            assert e.contacts[number, k] == delta.size
    assert_allclose(e.conductance, 2 * e.stiffness / 1e9, rtol=1e-14)
    assert e.contacts.min() > 3
    assert not np.array_equal(e.load[0], e.load[1])


def test_far_apart_they_are_independent_and_nearer_they_are_as_a_mean_field_has_them():
    far = {"area": "9 m^2", "eta": "10/m^2"}
    located, alone = (mcgw.simulate(scene_of(**far, interaction=x)).load for x in (LOCATED, None))
    assert_allclose(located, alone, rtol=1e-4)
    some = {"n_surfaces": 30, "eta": "3000/mm^2"}
    pressed, alone = (
        mcgw.simulate(scene_of(**some, separations=[0.5], interaction=x)).mean("load")[0]
        for x in (LOCATED, None)
    )
    field = scene_of(**some, separations=np.linspace(0, 0.5, 11), interaction="mean-plane").theory
    felt = np.linspace(0, 0.5, 201)
    nominal = field.mean("nominal_separation", felt)
    found = float(field.mean("load", np.interp(0.5, nominal, felt)))
    assert abs(found / pressed - 1) < abs(alone / pressed - 1)
    assert pressed > alone * 1.02  # pressed from the mean plane, more of them touch


def test_stiffness_is_the_derivative_and_nothing_touches_above_all():
    z = mcgw.heights(scene_of(), 0)
    e = mcgw.simulate(scene_of(separations=[0.3 - 1e-6, 0.3, 0.3 + 1e-6, float(z.max()) + 0.1], n_surfaces=1))
    assert_allclose(e.stiffness[0, 1], (e.load[0, 0] - e.load[0, 2]) / 2e-12, rtol=1e-5)
    assert (e.load[0, 3], e.area[0, 3], e.stiffness[0, 3], e.contacts[0, 3]) == (0, 0, 0, 0)


def test_laws_gradings_and_own_radii_go_with_it():
    plain = mcgw.simulate(scene_of()).load
    law = mcgw.simulate(scene_of(law=mcgw.KogutEtsion(critical=0.05))).load
    assert (law < 0.95 * plain)[:, 0].all()
    stiff = mcgw.simulate(scene_of(grading=mcgw.Custom(lambda s: 1.5 + 0 * s))).load
    assert (stiff > plain).all()
    poisson = mcgw.simulate(scene_of(count="poisson", n_surfaces=5))
    assert np.isfinite(poisson.load).all()
    interval = poisson.interval("load")
    assert (interval[0] < poisson.mean("load")).all()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"sampler": "cells"}, 'sampler = "cells".*use "direct"'),
        ({"interaction": {**LOCATED, "bulk_modulus": 1e9}}, "leave it out"),
        ({"keep": "statistics"}, 'use "sums"'),
        ({"quantities": ["load", "yielded"], "law": mcgw.KogutEtsion(critical=0.1)}, "leave out yielded"),
        ({"rel_err": 0.05, "n_surfaces": None}, "give n_surfaces"),
        ({"n_asperities": 20_001}, "20001 asperities a surface; give 20000 or fewer"),
        ({"unload_from": 0.1}, "unload_from"),
        ({"negative": "allow"}, 'needs loads that decrease with the separation; use "clip"'),
        ({"film": mcgw.Film(1e-7)}, "resistivity"),
        ({"law": mcgw.JohnsonKendallRoberts(work=0.01)}, "fall with the separation"),
    ],
)
def test_refuses_what_does_not_fit(changes, words):
    assert scene_of(n_asperities=20_000).located
    with pytest.raises(ValueError, match=words):
        scene_of(**changes)


def test_where_theory_is_needed_none_is_told(tmp_path, capsys):
    scene = scene_of()
    assert "1e-11 of every value" in plan_text(scene, plan_of(scene))
    (tmp_path / "scene.toml").write_text(mcgw.scene_text(scene))
    for command in (("figures", "--scene"), ("converge",), ("tradeoff",)):
        assert main([*command, str(tmp_path / "scene.toml"), "-o", str(tmp_path / "new")]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    assert len(list(tmp_path.iterdir())) == 1
    for command in (("run",), ("sweep", "--over", "ensemble.n_surfaces=1,2")):
        path = tmp_path / f"{command[0]}.h5"
        assert main([*command, str(tmp_path / "scene.toml"), "-o", str(path)]) == 0
        assert f"next: mcgw show {path}\n" in capsys.readouterr().out
    assert "for summits at places" in scene.validity().unknown
    assert scene.series("stiffness") == 0  # that of all together has it
    e = mcgw.simulate(scene)
    for ask in (
        lambda: mcgw.compare(e),
        lambda: mcgw.solve(scene, pressure="1 kPa"),
        lambda: mcgw.converge(scene),
        lambda: mcgw.tradeoff(scene),
        lambda: scene.theory,
        lambda: scene.compliance,
    ):
        with pytest.raises(ValueError, match="no theory is known of summits at their places"):
            ask()


WIDTH, HEIGHT, POINTS = 1.6e-4, 0.9e-4, (72, 128)  # 36 summits, sixteen points for their mean distance


def placed(shuffle=None, places=True, resampled=False, **given):
    """36 summits by hand: heights and radii of their own, the higher the nearer to a point of the cell."""
    rng = np.random.default_rng(3)
    z = np.sort(rng.normal(size=36))[::-1] * 1e-6
    cells = rng.choice(POINTS[0] * POINTS[1], 36, replace=False)
    rows, columns = np.divmod(cells, POINTS[1])
    order = np.argsort(np.hypot(rows - 30, columns - 70))
    if shuffle is not None:
        order = np.random.default_rng(shuffle).permutation(order)
    rows, columns = rows[order], columns[order]
    x, y = columns * WIDTH / POINTS[1] - 3e-5, rows * HEIGHT / POINTS[0] + 5e-5  # wherever its corner is
    heights = mcgw.MeasuredHeights(z, resampled=resampled)
    ratios = rng.uniform(0.5, 2.0, 36)
    curvature = mcgw.MeasuredRadii(heights, ratios, (x, y) if places else None, aspect=WIDTH / HEIGHT)
    surface = mcgw.Surface(z.std(), 1e-5, 36 / (WIDTH * HEIGHT), WIDTH * HEIGHT, 1e9)
    asked = {"separations": [-0.5, 0.8], "interaction": LOCATED, "seed": 5, "n_surfaces": 1}
    scene = mcgw.Scene(surface, curvature=curvature, **{**asked, **given})
    columns, rows = np.rint([(x + 3e-5) / WIDTH * POINTS[1], (y - 5e-5) / HEIGHT * POINTS[0]]).astype(int)
    return scene, np.array([rows, columns]), ratios


@pytest.mark.parametrize("law", [None, mcgw.KogutEtsion(critical=0.05)], ids=["hertz", "kogut-etsion"])
def test_a_maps_summits_are_in_balance_at_their_own_places(law):
    """By plain loops over pairs, on a rectangle whose corner lies anywhere."""
    scene, places, ratios = placed(law=law)
    e = mcgw.simulate(scene)
    z = np.array(scene.heights.heights)
    one = HertzSpots(z * scene.surface.sigma, ratios * 1e-5, 1e9)
    one = Located(one if law is None else LawSpots(scene, z * scene.surface.sigma, ratios), places,
                  Grid(POINTS, (WIDTH, HEIGHT), True))  # fmt: skip
    for k, h in enumerate(scene.separations):
        balance = one.at_separation(h * scene.surface.sigma)
        assert residual(one, balance) < 1e-10
        assert balance.contacts > 4
        assert_allclose([e.load[0, k], e.area[0, k]], [balance.load, balance.area], rtol=1e-9)
    random = mcgw.simulate(placed(law=law, places=False)[0])
    assert (np.abs(random.load / e.load - 1) > 0.01).all()


def test_places_of_few_summits_on_a_strip_and_near_ones():
    surface = mcgw.Surface(1e-6, 1e-5, 3e8, 1e-8, 1e9)
    heights = mcgw.MeasuredHeights([0.0, 1.0, 3.0])
    for second, words in (
        (3e-4, None),
        (1e-4 + 1e-6, None),
        (1e-4 + 1e-10, "two of them lie within .* leave"),
    ):
        at = [1e-4, second, 8e-4], [0.0, 0.0, 1e-5]
        scene = mcgw.Scene(surface, curvature=mcgw.MeasuredRadii(heights, [1.0] * 3, at, 100.0),
                           separations=0.0, interaction=LOCATED, seed=1)  # fmt: skip
        if words is None:
            assert mcgw.simulate(scene).load[0, 0] > 0
            continue
        with pytest.raises(mcgw.RunError, match=words):
            mcgw.simulate(scene)


def test_high_summits_side_by_side_bear_less_than_the_same_ones_far_apart():
    """Less than in each of 20 random orders, which one of those would in a case of 21."""
    load = mcgw.simulate(placed()[0]).load[0]
    shuffled = [mcgw.simulate(placed(shuffle=k)[0]).load[0] for k in range(20)]
    assert load[0] < 0.95 * np.min(shuffled, axis=0)[0]
    assert load[1] < np.mean(shuffled, axis=0)[1]


def test_places_are_kept_in_text_and_read_from_a_table(tmp_path):
    """Of located summits alone, whatever else such columns hold; what is drawn lies at random."""
    scene, *_ = placed()
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene
    assert "summits at their own places" in str(scene)
    drawn = placed(resampled=True)[0], placed(places=False, resampled=True)[0]
    assert_allclose(*(mcgw.simulate(x, n_surfaces=2).load for x in drawn), rtol=0)
    assert "summits at random places" in str(drawn[0])
    c, sigma = scene.curvature, scene.surface.sigma
    rows = zip(*c.places, np.array(c.heights.heights) * sigma, np.array(c.ratios) * 1e-5, strict=True)
    table = "# m\nx,y,height,radius\n" + "".join(",".join(map(repr, map(float, row))) + "\n" for row in rows)
    surface = "".join(
        f"{k} = {getattr(scene.surface, k)!r}\n" for k in ("radius", "sigma", "nominal_area", "E_star")
    )
    text = (
        f"[surface]\n{surface}[summits]\nfile = 's.csv'\naspect = {c.aspect!r}\n[contact]\n"
        "separations = [-0.5, 0.8]\n[interaction]\nreference = "
    )
    (tmp_path / "s.csv").write_text(table)
    read = mcgw.scene_from(f"{text}'located'", folder=tmp_path)
    assert read.curvature.places == c.places
    assert_allclose(mcgw.simulate(read).load, mcgw.simulate(scene).load, rtol=1e-9)
    with pytest.raises(ValueError, match=r"summits.aspect = 1: places extend over .* along x"):
        mcgw.scene_from(f"{text.replace(f'aspect = {c.aspect!r}', '')}'located'", folder=tmp_path)
    (tmp_path / "s.csv").write_text(table.replace("-", "", 1).replace("\n", "\n?", 2).replace("?x", "x", 1))
    assert mcgw.scene_from(f"{text}'mean-plane'", folder=tmp_path).curvature.places is None
    with pytest.raises(ValueError, match="summit 1 has no number as height or radius or x or y"):
        mcgw.scene_from(f"{text}'located'", folder=tmp_path)


def test_a_fitted_map_brings_its_places():
    """They give what the map's own summits at its own points do, which lie up to half a point beside them."""
    used = gaussian_map(Spectrum(1e-6, 64e-6, 8e-6), (96, 128), (1e-6, 1e-6), np.random.default_rng(4))
    fit = mcgw.fit(used, cutoff=None, form="none")
    scene = mcgw.fitted_scene(fit, heights="summits", E_star="1 GPa", separations=[0.5], interaction=LOCATED)
    assert scene.own_places
    assert scene.curvature.sides(scene.surface.nominal_area) == pytest.approx((128e-6, 96e-6))
    own = Pressed(used.heights, used.size, 1e9).summits.at_separation(
        fit.mean_summit + 0.5 * fit.summits.std()
    )
    assert_allclose(mcgw.simulate(scene).load[0, 0], own.load, rtol=0.02)
    assert not mcgw.fitted_scene(fit, heights="measured", E_star="1 GPa").own_places


@pytest.mark.parametrize(("places", "words"), [
    (([0, 1], [0, 1, 2]), "give x and y of each"),
    (([0, 1, math.nan], [0, 1, 2]), "number 2 is not finite"),
    (([0, 1, 0], [0, 1, 0]), "numbers 0 and 2 lie at one"),
])  # fmt: skip
def test_places_that_are_none(places, words):
    with pytest.raises(ValueError, match=words):
        mcgw.MeasuredRadii(mcgw.MeasuredHeights([0.0, 1.0, 3.0]), [1.0, 1.0, 1.0], places)


@pytest.mark.parametrize("level", [0.5, 0.95])
def test_intervals_of_surfaces_without_a_theory_are_students(level):
    e = mcgw.simulate(scene_of(n_surfaces=5))
    for name in ("load", "contacts"):
        low, high = e.interval(name, level)
        for k in range(2):
            ends = student.interval(level, 4, e[name][:, k].mean(), e[name][:, k].std(ddof=1) / 5**0.5)
            assert_allclose((low[k], high[k]), ends, rtol=1e-12)
    assert np.isnan(mcgw.simulate(scene_of(n_surfaces=1)).interval("load", level)).all()
