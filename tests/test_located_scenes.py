"""Scenes whose summits have places: drawn surfaces against plain loops over pairs, limits, and refusals."""

import math

import numpy as np
import pytest
from located_by_hand import residual
from numpy.testing import assert_allclose

import mcgw
from mcgw.cli import main
from mcgw.reports.plan import plan_of, plan_text
from mcgw.sampling.counts import generator
from mcgw.sampling.located.balance import Located
from mcgw.sampling.located.spots import Grid, HertzSpots

LOCATED = {"reference": "located", "at": "nominal"}


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
    some = {"n_surfaces": 30, "separations": [0.5], "eta": "3000/mm^2"}
    field = {"reference": "mean-plane", "at": "nominal"}
    found = [mcgw.simulate(scene_of(**some, interaction=x)).mean("load")[0] for x in (LOCATED, field, None)]
    assert abs(found[1] / found[0] - 1) < abs(found[2] / found[0] - 1)
    assert found[0] > found[2] * 1.02  # pressed from the mean plane, more of them touch


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
        ({"interaction": {"reference": "located"}}, 'at = "nominal"'),
        ({"interaction": {**LOCATED, "bulk_modulus": 1e9}}, "leave it out"),
        ({"keep": "statistics"}, 'use "sums"'),
        ({"quantities": ["load", "yielded"], "law": mcgw.KogutEtsion(critical=0.1)}, "leave out yielded"),
        ({"rel_err": 0.05, "n_surfaces": None}, "give n_surfaces"),
        ({"n_asperities": 30000}, "20000 or fewer"),
        ({"unload_from": 0.1}, "unload_from"),
        ({"film": mcgw.Film(1e-7)}, "resistivity"),
        ({"law": mcgw.JohnsonKendallRoberts(work=0.01)}, "fall with the separation"),
    ],
)
def test_refuses_what_does_not_fit(changes, words):
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
    assert "for summits at random places" in scene.validity().unknown
    e = mcgw.simulate(scene)
    for ask in (
        lambda: mcgw.compare(e),
        lambda: mcgw.solve(scene, pressure="1 kPa"),
        lambda: mcgw.converge(scene),
        lambda: mcgw.tradeoff(scene),
        lambda: mcgw.regrade(e, mcgw.Exponential(1.2)),
        lambda: scene.theory,
    ):
        with pytest.raises(ValueError, match="no theory is known of summits at their places"):
            ask()
