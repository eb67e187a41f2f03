"""The model of a surface: its number and law of heights in what it says, and back to the separation."""

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from oracles.reference import F, F_star

import analytic
from analytic import Body, Custom, Exponential, Gaussian, Model, composite_modulus

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-4, E_star=78.6e9)
H = np.array([-30.0, -8.0, -1.0, 0.0, 0.1, 2.0, 9.9, 10.2, 25.0, 36.0])


def test_the_number_is_that_of_the_surface_unless_given():
    left_out = Model(SURFACE)
    assert left_out.number == 30_000
    assert replace(left_out, surface=replace(SURFACE, nominal_area=1e-6)).number == 300
    assert (left_out.heights, left_out.count) == (Gaussian(), "fixed")
    np.testing.assert_array_equal(left_out.mean("load", H), analytic.load(SURFACE, H))


ON_A_SURFACE = ("load", "area", "contacts", "stiffness", "conductance", "barber_conductance", "area_per_load")
CALLS = dict.fromkeys(ON_A_SURFACE, (SURFACE, 1.0)) | {"fn": (1.5, 1.0)}
CALLS |= dict.fromkeys(("area_per_load_ratio", "stiffness_ratio", "mean_modulus"), (1.0, Exponential(2.0)))


def test_every_function_takes_the_height_law():
    law = analytic.Weibull(1.7)
    for name, given in CALLS.items():
        function = getattr(analytic, name)
        assert not np.array_equal(function(*given, heights=law), function(*given)), name


def test_composite_modulus():
    steel, glass = Body(210e9, 0.3), Body(70e9, 0.22)
    expected = 1 / ((1 - 0.09) / 210e9 + (1 - 0.0484) / 70e9)
    assert composite_modulus([steel, glass]) == pytest.approx(expected, rel=1e-15)
    assert composite_modulus([glass, steel]) == pytest.approx(expected, rel=1e-15)
    assert composite_modulus([steel, Body(math.inf)]) == pytest.approx(210e9 / 0.91, rel=1e-15)


# Words, symbol and unit of each quantity, and the power of lengths in its scale: R = 3, sigma = 5, E* = 2.
HERTZ, AREA, SPOT = 4 / 3 * 2 * 3**0.5 * 5**1.5, math.pi * 15, 4 * 15**0.5
TOLD = {
    "spot_conductance_unloading": ("Spot conductance (m), unloading", SPOT),
    "nominal_separation_unloading": ("Nominal separation, unloading", 1.0),
    "pressure": ("Pressure (Pa)", HERTZ / 7),
    "area_fraction": ("Area fraction", AREA / 7),
    "contact_conductance": ("Contact conductance (S/m² or W/(m² K))", SPOT / 7),
    "thermal_resistance": ("Thermal resistance (K/W)", 1 / SPOT),
    "contact_resistance": ("Contact resistance (ohm)", 1 / SPOT),
    "specific_contact_resistance": ("Specific contact resistance (ohm m² or K m²/W)", 1 / SPOT),
}


def test_each_quantity_has_its_unit_and_scale():
    surface = analytic.Surface(sigma=5.0, radius=3.0, eta=1.0, nominal_area=7.0, E_star=2.0)
    for name, (title, scale) in TOLD.items():
        q = analytic.quantity_of(name)
        assert (q.name, q.title, q.scale(surface)) == (name, title, pytest.approx(scale, rel=1e-14))


# From a load, an area, ... back to the separation; and comparisons at equal load


def test_equal_load_under_another_height_law():
    law, grading = analytic.Weibull(1.7), Exponential(2.0)
    homogeneous, graded = Model(SURFACE, heights=law), Model(SURFACE, heights=law, grading=grading)
    other = graded.separation_at("load", homogeneous.mean("load", 1.0))
    truth = float(graded.mean("area", other) / homogeneous.mean("area", 1.0))
    found = analytic.ratio_at_equal_load("area", 1.0, grading, heights=law)
    assert float(found) == pytest.approx(truth, rel=1e-10)


RISES, NORMAL = Custom(lambda s: 2 + np.tanh(s)), np.random.default_rng(1).normal(size=300)


@pytest.mark.parametrize(
    ("quantity", "more", "h"),  # below, a quantity need not fall with h, or everything touches
    [
        ("load", {"grading": Exponential(0.2)}, H[H > -3]),
        ("pressure", {}, H),
        ("stiffness", {"grading": RISES}, H[H > -1.6]),
        ("contacts", {"grading": Exponential(0.2)}, H[H > -5]),
        ("load", {"heights": analytic.ExponentialHeights(), "grading": Exponential(1.8)}, [-0.7, 0.31, 12.0]),
        ("load", {"heights": analytic.HeightTable.of(NORMAL), "grading": Exponential(1.8)}, [-0.7, 1.2]),
        ("load", {"heights": analytic.MeasuredHeights(NORMAL)}, [-0.7, 0.31, 1.2]),
        (
            "load",
            {"heights": analytic.ScipyHeights(scipy.stats.lognorm(0.3)), "grading": RISES},
            [-0.7, 12.0],
        ),
    ],
)
def test_separation_at_inverts_the_mean(quantity, more, h):
    model = Model(SURFACE, n_asperities=70.0, **more)
    found = model.separation_at(quantity, model.mean(quantity, h).reshape(1, -1))[0]
    # The mean has 1e-14 of error; h^2/2 turns it into less where h is large, d ln F/dh ~ 1e-2 into more.
    np.testing.assert_allclose(found, h, rtol=1e-12, atol=2e-13)


@pytest.mark.parametrize(
    ("heights", "gamma", "h", "low", "high"),
    [
        (Gaussian(), 5.0, -4.0, -2.637, 37),  # theory.md: where the stiffness changes sign
        (Gaussian(), -0.2, 0.0, 0.8108, 0.81087),
        (analytic.ExponentialHeights(), 5.0, -4.5, -3.0, 37),
    ],
)
def test_the_largest_of_several_separations(heights, gamma, h, low, high):
    """The load rises, falls and turns negative, as the surfaces approach (gamma = 5) or part (-0.2)."""
    model = Model(SURFACE, grading=Exponential(gamma), heights=heights)
    value = float(model.mean("load", h)) * (1e-6 if gamma < 0 else 1)
    found = float(model.separation_at("load", value))
    assert low < found < high
    assert float(model.mean("load", found)) == pytest.approx(value, rel=1e-8)  # 1e-14/1e-6


@pytest.mark.parametrize(("h", "gamma"), [(2.0, 2.0), (60.0, 0.2)])
def test_equal_load_by_a_root_at_forty_digits(h, gamma):
    """Also at h = 60, where the loads themselves underflow."""
    target = mp.log(F(1.5, h))
    other = mp.findroot(lambda x: mp.log(F_star(1.5, x, gamma)) - target, h)
    for quantity, n in (("area", 1), ("contacts", 0), ("conductance", 0.5)):
        truth = F(n, other) / F(n, h)
        found = float(analytic.ratio_at_equal_load(quantity, h, Exponential(gamma)))
        # ln F = -1800 at h = 60 is known to its last digit, 2e-13, four times over.
        assert found == pytest.approx(float(truth), rel=1e-12)
    stiffness = float(analytic.ratio_at_equal_load("stiffness", h, Exponential(gamma)))
    assert stiffness == pytest.approx(float(F_star(0.5, other, gamma) / F(0.5, h)), rel=1e-12)
