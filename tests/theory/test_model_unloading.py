"""The exact theory of the way back, and of films."""

import math
from dataclasses import replace

import numpy as np
import pytest
from oracles.laws_by_hand import GRADINGS, SURFACE, differences, kogut_etsion, reduced
from oracles.unloading_by_hand import TOP, carried, ends, integral

import analytic
from analytic import (
    ChangEtsionBogy,
    Coated,
    Exponential,
    ExponentialHeights,
    KogutEtsion,
    MeasuredHeights,
    Model,
    PowerLawGraded,
    quantity_of,
)
from analytic.laws import DerjaguinMullerToporov, Film, JohnsonKendallRoberts, Unloading, term_of

LAW = KogutEtsion(critical=0.05)
BACK = Model(SURFACE, law=LAW, unload_from=0.5)
MEASURED = MeasuredHeights(np.random.default_rng(3).standard_normal(200))


def film_of(b):
    """A film of this parameter, with a resistivity of 1."""
    return Film(1.0, b * math.pi * math.sqrt(SURFACE.radius * SURFACE.sigma) / 4)


# Means of the way back


@pytest.mark.parametrize(
    ("h", "value"),  # physics.md, A: scipy.quad
    [(0.5, 0.133048585347), (0.6, 0.0951909343557), (0.7, 0.0639624164483), (0.9, 0.0229255442328)],
)
def test_check_values(h, value):
    assert float(reduced(BACK, "load_unloading", h)) == pytest.approx(value, rel=1e-11)


@pytest.mark.parametrize(
    ("name", "quantity", "h"),
    [("uniform", "area", 0.52), ("uniform", "conductance", 0.8), ("no tips", "load", 0.55),
     ("no tips", "contacts", 0.8), ("soft tips", "load", 0.52), ("soft tips", "area", 0.8),
     ("stiff tips", "contacts", 0.55), ("stiff tips", "load", 0.8)],
)  # fmt: skip
def test_means_are_literal_integrals(name, quantity, h):
    model = replace(BACK, grading=GRADINGS[name])

    modulus = GRADINGS[name]
    truth = integral(lambda s: carried(quantity, s, h, 0.5, modulus(s)), ends(h, 0.5, modulus))
    assert float(reduced(model, f"{quantity}_unloading", h)) == pytest.approx(truth, rel=1e-11)


@pytest.mark.parametrize("grading", GRADINGS.values(), ids=GRADINGS)
def test_unloading_begins_where_loading_ends(grading):
    model = replace(BACK, grading=grading, film=film_of(0.1))
    for name in ("load", "area", "stiffness", "contacts", "conductance", "conductance_si"):
        turn, there = model.mean(f"{name}_unloading", 0.5), model.mean(name, 0.5)
        assert float(turn) == pytest.approx(float(there), rel=1e-12)


def test_separations_that_share_a_rule_do_not_matter_to_each_other():
    h = np.array([0.5, 0.5 + 1e-9, 0.53, 0.9, 0.9 + 1e-9, 4.0])
    for grading, name in (("no tips", "load_unloading"), ("stiff tips", "contacts_unloading")):
        model = replace(BACK, grading=GRADINGS[grading])
        alone = [float(model.mean(name, x)) for x in h]
        np.testing.assert_allclose(model.mean(name, h), alone, rtol=1e-11)


def test_other_heights():
    exponential = replace(BACK, heights=ExponentialHeights())
    marks = [*ends(0.8, 0.5), 20.0, 40.0]
    truth = integral(lambda s: carried("load", s, 0.8, 0.5), marks, lambda s: np.exp(-1 - s))
    assert float(reduced(exponential, "load_unloading", 0.8)) == pytest.approx(truth, rel=1e-10)
    measured = replace(BACK, heights=MEASURED)
    exact = carried("load", MEASURED.heights, 0.8, 0.5).mean()
    assert float(reduced(measured, "load_unloading", 0.8)) == pytest.approx(exact, rel=1e-13)


def sum_of_pieces(law, formula, penetration, e):
    """The formula of each piece where it holds."""
    reached = (law.limits(e) <= penetration).sum(axis=0)
    return sum(np.where(reached == piece, formula(piece, np.sqrt(penetration), e), 0.0) for piece in range(4))


# Fluctuations of the way back


def test_covariance_of_there_and_back_is_literal():
    names, h = ["load", "load_unloading", "contacts_unloading"], np.array([0.6, 0.9])
    model = replace(BACK, n_asperities=1.0, count="poisson")
    matrix = model.covariance(names, h)
    law, scale = kogut_etsion(0.05), quantity_of("load").scale(SURFACE)

    def loaded(s):
        return sum_of_pieces(law, law.load, np.maximum(s - 0.6, 0.0), np.ones_like(s))

    kinks = [0.6 + 0.05 * x for x in (1, 6, 110)]
    truth = integral(lambda s: loaded(s) * carried("load", s, 0.9, 0.5), [*ends(0.9, 0.5), 0.9, *kinks[2:]])
    assert matrix[0, 0, 1, 1] / scale**2 == pytest.approx(truth, rel=1e-10)
    marks = [*ends(0.6, 0.5), *ends(0.9, 0.5)]
    truth = integral(
        lambda s: carried("load", s, 0.6, 0.5) * carried("contacts", s, 0.9, 0.5), np.unique(marks)
    )
    assert matrix[1, 0, 2, 1] / scale == pytest.approx(truth, rel=1e-10)
    for k, name in enumerate(names):
        np.testing.assert_allclose(np.diag(matrix[k, :, k, :]), model.std(name, h) ** 2, rtol=1e-11)


# Slopes and separations of the way back


@pytest.mark.parametrize(("name", "h"), [("uniform", 0.8), ("soft tips", 1.5)])
def test_slope_of_the_load(name, h):
    """Away from where asperities first come off."""
    model = replace(BACK, grading=GRADINGS[name])
    slope = float(model.slope("load_unloading", h))
    assert slope == pytest.approx(differences(model, "load_unloading", h), rel=1e-9)
    assert slope != pytest.approx(float(model.slope("load", h)), rel=0.05)


def test_separations_belong_to_means():
    h = np.array([0.501, 0.7, 3.0])
    found = BACK.separation_at("load_unloading", BACK.mean("load_unloading", h))
    np.testing.assert_allclose(found, h, rtol=1e-12)
    with pytest.raises(ValueError, match=r"load_unloading: not reached for h from 0\.5 to"):
        BACK.separation_at("load_unloading", 2 * float(BACK.mean("load", 0.5)))


# Who has no way back


def test_questions_without_an_answer_are_refused():
    with pytest.raises(
        ValueError, match=r"quantity = 'load_unloading': asperities yield .* give unload_from"
    ):
        Model(SURFACE, law=LAW).mean("load_unloading", 0.5)
    with pytest.raises(ValueError, match=r"h = 0\.4 is smaller than unload_from = 0\.5"):
        BACK.mean("load_unloading", [0.6, 0.4])
    with pytest.raises(ValueError, match="unload_from = nan: give a finite separation"):
        replace(BACK, unload_from=math.nan)
    with pytest.raises(ValueError, match="law = 'chang-etsion-bogy': no unloading is known"):
        Model(SURFACE, law=ChangEtsionBogy(critical=0.05), unload_from=0.5)
    with pytest.raises(KeyError, match="yielded_unloading"):
        BACK.mean("yielded_unloading", 0.6)
    with pytest.raises(ValueError, match="quantity = 'area_unloading': its slope is not known; give"):
        BACK.slope("area_unloading", 0.6)
    with pytest.raises(ValueError, match="load_slope_unloading"):
        BACK.slope("load_slope_unloading", 0.6)
    with pytest.raises(ValueError, match="quantity = 'conductance_si': give a film"):
        BACK.mean("conductance_si", 1.0)


@pytest.mark.parametrize(
    "law", [None, PowerLawGraded(0.5, reduced_c0=1.0), Coated(ratio=3.0, reduced_thickness=0.5)]
)
def test_elastic_asperities_go_back_as_they_came(law):
    model, h = Model(SURFACE, law=law, unload_from=0.5), np.array([0.5, 1.0])
    for name in ("load", "contacts", "stiffness"):
        np.testing.assert_array_equal(model.mean(f"{name}_unloading", h), model.mean(name, h))
    matrix = model.covariance(["load", "load_unloading"], h)
    np.testing.assert_array_equal(matrix[0, :, 0], matrix[1, :, 1])


def test_a_law_of_one_piece_that_comes_off_late():
    """Contact is lost at a tenth of the deepest penetration: (s - h) > (s - h_min)/10, by hand."""

    class Late(Unloading):
        def residual(self, deepest, e):
            return 0.1 * deepest + 0 * e

    class Law(analytic.ContactLaw):
        name, elastic = "late", False

        def unloading(self):
            return Late(self)

    model = Model(SURFACE, law=Law(), unload_from=0.5)
    lost = (0.8 - 0.05) / 0.9
    truth = math.erfc(lost / math.sqrt(2)) / 2
    assert float(reduced(model, "contacts_unloading", 0.8)) == pytest.approx(truth, rel=1e-12)
    truth = integral(lambda s: (0.9 * (s - lost)) ** 0.5, [lost, lost + 1, TOP])
    assert float(reduced(model, "conductance_unloading", 0.8)) == pytest.approx(truth, rel=1e-11)


# Films


@pytest.mark.parametrize(("b", "value"), [(0.1, 0.09089518816122444), (1.0, 0.04466451344935666)])
def test_films_at_their_check_values(b, value):
    """physics.md A.8."""
    assert float(reduced(Model(SURFACE, film=film_of(b)), "conductance_si", 1.0)) == pytest.approx(
        value, rel=1e-12
    )


def test_without_a_film_resistance_it_is_the_spots():
    model, h = Model(SURFACE, film=Film(2e-8), law=LAW), np.array([0.0, 2.0])
    np.testing.assert_allclose(
        model.mean("conductance_si", h), model.mean("conductance", h) / 2e-8, rtol=1e-13
    )
    np.testing.assert_allclose(
        model.slope("conductance_si", h), model.slope("conductance", h) / 2e-8, rtol=1e-9
    )


@pytest.mark.parametrize(
    ("name", "back"), [("uniform", False), ("soft tips", True), ("stiff tips", False), ("no tips", True)]
)
def test_films_on_spots_that_yield(name, back):
    grading = GRADINGS[name]
    model, h, b = replace(BACK, grading=grading, film=film_of(0.03)), 0.8, 0.03
    law = kogut_etsion(0.05)

    def radius(s):
        if back:
            return carried("conductance", s, h, 0.5, grading(s))
        return sum_of_pieces(law, law.radius, s - h, grading(s))

    def conducted(s):
        a = radius(s)
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
    (0.05, "load", 0.07347199399110158), (0.05, "load_unloading", 0.07324746648337926),
    (0.05, "area", 0.1089474218832419), (0.05, "area_unloading", 0.1097973547290834),
    (0.5, "load", -0.001395827560214945), (0.5, "load_unloading", -0.08691870486353161),
    (0.5, "area", 0.2710312896208413), (0.5, "area_unloading", 0.370556433499445),
    (0.05, "contacts_unloading", 0.1710561263084818), (0.5, "contacts_unloading", 0.3085375387259869),
]  # fmt: skip


@pytest.mark.parametrize(("stretch", "quantity", "value"), STUCK)
def test_contacts_that_stick_at_their_check_values(stretch, quantity, value):
    """On the way back asperities that have touched hold below the separation."""
    assert float(reduced(stuck(stretch, unload_from=-6.0), quantity, 1.0)) == pytest.approx(
        value, rel=1e-12, abs=1e-14
    )


@pytest.mark.parametrize("h", [0.5, 0.9, 1.2])
def test_only_what_has_touched_sticks(h):
    """From a turn at 0.5 contacts are those above h - D, and above 0.5; and both ways have a covariance."""
    model = stuck(0.5, unload_from=0.5, n_asperities=1.0, count="poisson")
    way, below_and_above = model.ways.of("contacts_unloading"), np.array([0.499, 0.501])
    np.testing.assert_array_equal(term_of("contacts", way, 0.8, below_and_above, np.ones(2)), [0, 1])
    low, back = max(h - 0.5, 0.5), JohnsonKendallRoberts(pull_off=0.5).unloading()
    most = np.array(9.0)

    def load(s):
        return back.load(0, np.sqrt(np.maximum(s - h + 0.5, 0.0)), most, np.array(1.0))

    marks = [low, *(low + x for x in (0.5, 2.0, 5.0)), TOP]
    assert float(reduced(model, "load_unloading", h)) == pytest.approx(integral(load, marks), rel=1e-11)
    scale = quantity_of("load").scale(SURFACE)
    m2 = integral(lambda s: load(s) ** 2, marks)
    assert float(model.std("load_unloading", h)) / scale == pytest.approx(math.sqrt(m2), rel=1e-11)
    both = model.covariance(["contacts", "contacts_unloading"], [h])[0, 0, 1, 0]
    assert both == pytest.approx(math.erfc(h / math.sqrt(2)) / 2, rel=1e-12)


@pytest.mark.parametrize(("stretch", "load"), [(0.05, 0.07157171634920946), (0.5, -0.05387329499027977)])
def test_contacts_after_derjaguin_at_their_check_values(stretch, load):
    model = Model(SURFACE, law=DerjaguinMullerToporov(pull_off=stretch))
    assert float(reduced(model, "load", 1.0)) == pytest.approx(load, rel=1e-12)


def test_the_slope_counts_that_contacts_snap_in():
    model = Model(SURFACE, law=JohnsonKendallRoberts(pull_off=0.3), grading=Exponential(0.2))
    assert float(model.slope("load", 0.8)) == pytest.approx(differences(model, "load", 0.8), rel=1e-9)
    with pytest.raises(ValueError, match="the stiffness of contacts that break off has no variance"):
        stuck(0.3, unload_from=0.5).slope("load_unloading", 0.8)
