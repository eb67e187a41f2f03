"""Another contact law on the same surfaces: literal sums over the very heights, and pairs of laws."""

import dataclasses

import numpy as np
import pytest

import mcgw
from mcgw.ensemble.regrading import sums_of_heights
from mcgw.sampling.asperities import same_heights

H = (0.0, 0.5, 1.0, 2.0)
KE = mcgw.KogutEtsion(critical=0.05)
LAWS = (
    KE,
    mcgw.ChangEtsionBogy(critical=0.05),
    mcgw.ZhaoMaiettaChang(critical=0.05),
    mcgw.JacksonGreen(yield_strength=0.8e9),
    mcgw.Coated(ratio=3.0, thickness=1e-6),
    mcgw.PowerLawGraded(0.5, c0=1e-6),
)


@pytest.fixture(scope="module")
def surface():
    return mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")


@pytest.fixture(scope="module")
def base(surface):
    return mcgw.simulate(mcgw.Scene(surface, separations=H, n_surfaces=40, n_asperities=2000, seed=4))


def literal(ensemble, law, modulus):
    """Sums of the first surface over the heights that `mcgw.heights` lists, asperity by asperity."""
    scene = ensemble.surfaces_of
    law = law.on(scene.surface)
    unit = 4 / 3 * scene.surface.E_star * (scene.surface.radius * scene.surface.sigma**3) ** 0.5
    area = np.pi * scene.surface.radius * scene.surface.sigma
    sums = {name: np.zeros(len(H)) for name in ("load", "area", "contacts")}
    heights = mcgw.heights(scene, 0)
    for k, h in enumerate(H):
        for x in heights[heights > h]:
            e = np.array(modulus(x))
            y, piece = np.sqrt(x - h), int(np.sum(law.limits(e) <= x - h))
            sums["load"][k] += unit * law.load(piece, y, e)
            sums["area"][k] += area * law.radius(piece, y, e) ** 2
            sums["contacts"][k] += 1
    return sums


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_from_hertz_to_another_law(base, law):
    new = mcgw.regrade(base, law=law)
    for name, expected in literal(new, law, lambda s: 1.0).items():
        np.testing.assert_allclose(new[name][0], expected, rtol=1e-12)
    assert np.abs(new.load[0, :2] / base.load[0, :2] - 1).min() > 1e-3


@pytest.fixture(scope="module")
def yielding(surface):
    contact = {"law": KE, "unload_from": "loop", "film": mcgw.Film(1e-7, 1e-14)}
    quantities = ["load", "area", "contacts", "yielded"]
    scene = mcgw.Scene(surface, separations=H, quantities=quantities, n_asperities=2000, seed=6, **contact)
    return mcgw.simulate(scene, n_surfaces=30, keep="moments")


def test_an_ensemble_with_a_law_has_another_grading(yielding):
    grading = mcgw.Exponential(1.5)
    new = mcgw.regrade(yielding, grading)
    assert new.scene.law == KE
    assert set(new.scene.quantities) == set(yielding.scene.quantities)
    np.testing.assert_allclose(new.load[0], literal(new, KE, grading)["load"], rtol=1e-12)
    assert np.all(new["load_unloading"][:, 0] == pytest.approx(new.load[:, 0]))
    assert new["yielded"].sum() > yielding["yielded"].sum()  # what is stiffer yields earlier


def test_and_another_law_and_back(yielding):
    """Quantities that are no more are left out; there and back the numbers are the same."""
    hertz = mcgw.regrade(yielding, law=mcgw.Hertz(), unload_from=None, film=None)
    assert hertz.scene.quantities == ("load", "area", "contacts")
    by_hand = literal(hertz, mcgw.Hertz(), lambda s: 1.0)["load"]
    np.testing.assert_allclose(hertz.load[0], by_hand, rtol=1e-12)
    back = mcgw.regrade(
        hertz, law=KE, unload_from="loop", film=yielding.scene.film, quantities=yielding.scene.quantities
    )
    assert back.scene == yielding.scene
    for name in back.scene.quantities:
        np.testing.assert_allclose(back[name], yielding[name], rtol=1e-11, atol=1e-13 * yielding[name].mean())


def test_kept_moments_and_heights_say_the_same(yielding):
    """Where the breaks are edges already, nothing is drawn again: other quantities of the same law."""
    some = mcgw.regrade(yielding, quantities=["conductance", "load_slope", "stiffness_unloading"])
    drawn = next(sums_of_heights(yielding, some.scene))
    for name in some.scene.quantities:
        np.testing.assert_allclose(some[name], drawn[name], rtol=1e-11, atol=1e-12 * some[name].mean())


def test_moments_are_used_where_they_serve(yielding, monkeypatch):
    def fail(*_):
        raise AssertionError("heights are listed")

    monkeypatch.setattr("mcgw.ensemble.regrading.sums_of_heights", fail)
    mcgw.regrade(yielding, quantities=["conductance"])
    with pytest.raises(AssertionError, match="heights are listed"):
        mcgw.regrade(yielding, law=mcgw.KogutEtsion(critical=0.06))


def test_pairs_of_laws(base):
    """Load of all laws on the same surfaces: |z| < 5, with errors far below those of independent ones."""
    theory = base.scene.theory
    for law in LAWS[:3]:
        new = mcgw.regrade(base, law=law)
        pair = mcgw.paired_ratio(new, base, "load")
        exact = dataclasses.replace(theory, law=law).mean("load", H) / theory.mean("load", H)
        assert np.abs((pair.ratio - exact) / pair.stderr)[:3].max() < 5
        assert pair.gain[:3].min() > 2
        assert np.abs((1.1 * pair.ratio - exact) / pair.stderr)[:3].max() > 5


def test_two_simulations_under_two_laws_are_no_pair(base):
    """Their cells differ, and with them their heights; under one law, or drawn by tail, they are a pair."""
    other = mcgw.simulate(base.scene, law=KE)
    assert not same_heights(base.scene, other.scene)
    with pytest.raises(ValueError, match=r"these differ in law, .*mcgw\.regrade"):
        mcgw.paired_ratio(other, base, "load")
    mcgw.paired_ratio(mcgw.regrade(base, law=KE), base, "load")
    mcgw.paired_ratio(mcgw.regrade(other, law=mcgw.Hertz()), other, "load")
    tails = [mcgw.simulate(base.scene, law=law, sampler="tail") for law in (None, KE)]
    np.testing.assert_array_equal(tails[0].contacts, tails[1].contacts)
    assert np.all(mcgw.paired_ratio(*tails, "load").gain > 1)


def test_a_file_says_what_its_surfaces_were_drawn_for(base, tmp_path):
    metal = mcgw.save(mcgw.regrade(base, law=KE), tmp_path / "metal.h5")
    assert metal.drawn_for == base.scene
    again = mcgw.regrade(mcgw.open_ensemble(tmp_path / "metal.h5"), law=mcgw.Hertz())
    np.testing.assert_allclose(again.load, base.load, rtol=1e-11)
    assert mcgw.save(base, tmp_path / "base.h5").drawn_for is None


def test_what_was_regraded_is_regraded_again(surface):
    """Also where the second grading needs moments that the first one did not."""
    scene = mcgw.Scene(
        surface, separations=H, n_surfaces=20, n_asperities=3000, seed=2, keep="moments", sampler="cells"
    )
    for keep in ("moments", "sums"):
        start = mcgw.simulate(scene, keep=keep)
        once = mcgw.regrade(start, mcgw.Exponential(6.0), separations=H[1:])
        twice = mcgw.regrade(once, mcgw.Exponential(2.0))
        direct = mcgw.regrade(start, mcgw.Exponential(2.0))
        np.testing.assert_allclose(twice.load, direct.load[:, 1:], rtol=1e-12)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"law": KE, "separations": [-0.1]}, r"^separation -0\.1 is smaller than 0, down to which"),
        ({"law": {"law": "kogut-etsion"}}, r"^contact\.hardness = None"),
        ({"law": LAWS[3], "unload_from": "loop"}, r"^contact\.unload_from = 0: law = 'jackson-green'"),
    ],
)
def test_what_cannot_be_had(base, change, told):
    with pytest.raises(ValueError, match=told):
        mcgw.regrade(base, **change)


def test_surfaces_that_cannot_be_had(base):
    with pytest.raises(TypeError, match=r"^regrade: 'seed' cannot be changed; unload_from, film"):
        mcgw.regrade(base, law=KE, seed=3)
    crowd = mcgw.simulate(base.scene, sampler="aggregate")
    with pytest.raises(
        ValueError, match=r'^sampler = "aggregate" keeps no heights; use "cells", "tail" or "direct"'
    ):
        mcgw.regrade(crowd, law=KE)
    wrong = dataclasses.replace(base, scene=base.scene.replace(seed=5))
    with pytest.raises(ValueError, match="cannot be drawn again: their load differs"):
        mcgw.regrade(wrong, law=KE)
