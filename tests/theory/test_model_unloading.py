"""The exact theory of the way back, and of films."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.laws_by_hand import GRADINGS, SURFACE, differences, reduced
from oracles.laws_of_one_depth import kogut_etsion
from oracles.unloading_by_hand import TOP, carried, ends, integral

from analytic import Coated, Exponential, ExponentialHeights, KogutEtsion, MeasuredHeights, Model, quantity_of
from analytic.laws import DerjaguinMullerToporov, Film, JohnsonKendallRoberts

LAW = KogutEtsion(critical=0.05)
BACK = Model(SURFACE, law=LAW, unload_from=0.5)


def film_of(b):
    """A film of this parameter, with a resistivity of 1."""
    return Film(1.0, b * math.pi * math.sqrt(SURFACE.radius * SURFACE.sigma) / 4)


@pytest.mark.parametrize(
    ("name", "quantity", "h"),
    [("uniform", "conductance", 0.8), ("no tips", "load", 0.55), ("soft tips", "area", 0.8),
     ("stiff tips", "contacts", 0.55)],
)  # fmt: skip
def test_means_are_literal_integrals(name, quantity, h):
    model, modulus = replace(BACK, grading=GRADINGS[name]), GRADINGS[name]
    truth = integral(lambda s: carried(quantity, s, h, 0.5, modulus(s)), ends(h, 0.5, modulus))
    assert float(reduced(model, f"{quantity}_unloading", h)) == pytest.approx(truth, rel=1e-11)


def test_unloading_begins_where_loading_ends():
    bridged = KogutEtsion(critical=0.05, bridge="hermite")
    model = replace(BACK, law=bridged, grading=GRADINGS["soft tips"], film=film_of(0.1))
    for name in ("load", "area", "stiffness", "contacts", "conductance", "conductance_si"):
        turn, there = model.mean(f"{name}_unloading", 0.5), model.mean(name, 0.5)
        assert float(turn) == pytest.approx(float(there), rel=1e-12)


def test_other_heights():
    exponential = replace(BACK, heights=ExponentialHeights())
    marks = [*ends(0.8, 0.5), 20.0, 40.0]
    truth = integral(lambda s: carried("load", s, 0.8, 0.5), marks, lambda s: np.exp(-1 - s))
    assert float(reduced(exponential, "load_unloading", 0.8)) == pytest.approx(truth, rel=1e-10)
    measured = MeasuredHeights(np.random.default_rng(3).standard_normal(200))
    exact = carried("load", measured.heights, 0.8, 0.5).mean()
    found = reduced(replace(BACK, heights=measured), "load_unloading", 0.8)
    assert float(found) == pytest.approx(exact, rel=1e-13)


def test_covariance_of_there_and_back_is_literal():
    names, h = ["load", "load_unloading", "contacts_unloading"], np.array([0.6, 0.9])
    model = replace(BACK, n_asperities=1.0, count="poisson")
    matrix = model.covariance(names, h)
    scale, marks = quantity_of("load").scale(SURFACE), [*ends(0.9, 0.5), 0.6 + 110 * 0.05]
    truth = integral(lambda s: kogut_etsion(s - 0.6)[0] * carried("load", s, 0.9, 0.5), marks)
    assert matrix[0, 0, 1, 1] / scale**2 == pytest.approx(truth, rel=1e-10)
    marks = [*ends(0.6, 0.5), *ends(0.9, 0.5)]
    truth = integral(
        lambda s: carried("load", s, 0.6, 0.5) * carried("contacts", s, 0.9, 0.5), np.unique(marks)
    )
    assert matrix[1, 0, 2, 1] / scale == pytest.approx(truth, rel=1e-10)
    for k, name in enumerate(names):
        np.testing.assert_allclose(np.diag(matrix[k, :, k, :]), model.std(name, h) ** 2, rtol=1e-11)


def test_slope_of_the_load():
    """Away from where asperities first come off."""
    model, h = replace(BACK, grading=GRADINGS["soft tips"]), 1.5
    slope = float(model.slope("load_unloading", h))
    assert slope == pytest.approx(differences(model, "load_unloading", h), rel=1e-9)
    assert slope != pytest.approx(float(model.slope("load", h)), rel=0.05)


def test_separations_belong_to_means():
    h = np.array([0.501, 0.7, 3.0])
    found = BACK.separation_at("load_unloading", BACK.mean("load_unloading", h))
    np.testing.assert_allclose(found, h, rtol=1e-12)


@pytest.mark.parametrize("law", [None, Coated(ratio=3.0, reduced_thickness=0.5)])
def test_elastic_asperities_go_back_as_they_came(law):
    model, h = Model(SURFACE, law=law, unload_from=0.5), np.array([0.5, 1.0])
    for name in ("load", "contacts", "stiffness"):
        np.testing.assert_array_equal(model.mean(f"{name}_unloading", h), model.mean(name, h))
    matrix = model.covariance(["load", "load_unloading"], h)
    np.testing.assert_array_equal(matrix[0, :, 0], matrix[1, :, 1])


# Films


def test_without_a_film_resistance_it_is_the_spots():
    model, h = Model(SURFACE, film=Film(2e-8), law=LAW), np.array([0.0, 2.0])
    for ask, within in ((model.mean, 1e-13), (model.slope, 1e-9)):
        np.testing.assert_allclose(ask("conductance_si", h), ask("conductance", h) / 2e-8, rtol=within)


@pytest.mark.parametrize(("name", "back"), [("soft tips", True), ("stiff tips", False)])
def test_films_on_spots_that_yield(name, back):
    grading = GRADINGS[name]
    model, h, b = replace(BACK, grading=grading, film=film_of(0.03)), 0.8, 0.03

    def conducted(s):
        loaded = np.sqrt(kogut_etsion(s - h, grading(s))[1])
        a = carried("conductance", s, h, 0.5, grading(s)) if back else loaded
        return a * a / (a + b)

    marks = ends(h, 0.5, grading) if back else ends(h, h, grading)
    name = "conductance_si_unloading" if back else "conductance_si"
    assert float(reduced(model, name, h)) == pytest.approx(integral(conducted, marks), rel=1e-11)
    m2 = integral(lambda s: conducted(s) ** 2, marks)
    spread = float(replace(model, count="poisson", n_asperities=1.0).std(name, h))
    assert spread / quantity_of(name).scale(SURFACE) == pytest.approx(math.sqrt(m2), rel=1e-10)


# Contacts that stick


def stuck(stretch, **changes):
    return Model(SURFACE, law=JohnsonKendallRoberts(pull_off=stretch), **changes)


STUCK = [  # physics.md A.7: mpmath, from a deepest separation far below
    (0.05, "load_unloading", 0.07324746648337926), (0.05, "area", 0.1089474218832419),
    (0.5, "load", -0.001395827560214945), (0.5, "area_unloading", 0.370556433499445),
    (0.5, "contacts_unloading", 0.3085375387259869),
]  # fmt: skip


@pytest.mark.parametrize(("stretch", "quantity", "value"), STUCK)
def test_contacts_that_stick_at_their_check_values(stretch, quantity, value):
    """On the way back asperities that have touched hold below the separation."""
    assert float(reduced(stuck(stretch, unload_from=-6.0), quantity, 1.0)) == pytest.approx(
        value, rel=1e-12, abs=1e-14
    )


@pytest.mark.parametrize("h", [0.5, 1.2])
def test_only_what_has_touched_sticks(h):
    """From a turn at 0.5 contacts are those above h - D, and above 0.5; and both ways have a covariance."""
    model = stuck(0.5, unload_from=0.5, n_asperities=1.0, count="poisson")
    low, back = max(h - 0.5, 0.5), JohnsonKendallRoberts(pull_off=0.5).unloading(9.0)

    def load(s):
        return back.load(0, np.sqrt(np.maximum(s - h + 0.5, 0.0)), np.array(1.0))

    marks = [low, *(low + x for x in (0.5, 2.0, 5.0)), TOP]
    assert float(reduced(model, "load_unloading", h)) == pytest.approx(integral(load, marks), rel=1e-11)
    scale = quantity_of("load").scale(SURFACE)
    m2 = integral(lambda s: load(s) ** 2, marks)
    assert float(model.std("load_unloading", h)) / scale == pytest.approx(math.sqrt(m2), rel=1e-11)
    both = model.covariance(["contacts", "contacts_unloading"], [h])[0, 0, 1, 0]
    assert both == pytest.approx(math.erfc(h / math.sqrt(2)) / 2, rel=1e-12)


def test_contacts_after_derjaguin_at_their_check_value():
    model = Model(SURFACE, law=DerjaguinMullerToporov(pull_off=0.5))
    assert float(reduced(model, "load", 1.0)) == pytest.approx(-0.05387329499027977, rel=1e-12)


def test_the_slope_counts_that_contacts_snap_in():
    model = Model(SURFACE, law=JohnsonKendallRoberts(pull_off=0.3), grading=Exponential(0.2))
    assert float(model.slope("load", 0.8)) == pytest.approx(differences(model, "load", 0.8), rel=1e-9)
