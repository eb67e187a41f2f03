"""The model of a surface: its number and law of heights in what it says, and back to the separation."""

import math
import re
import sys
from dataclasses import replace
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from oracles.reference import F, F_star

import analytic
from analytic import Body, Custom, Exponential, Gaussian, Model, composite_modulus, inversion

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-4, E_star=78.6e9)
H = np.array([-30.0, -8.0, -1.0, 0.0, 0.1, 2.0, 9.9, 10.2, 25.0, 36.0])


def test_the_number_is_that_of_the_surface_unless_given():
    left_out = Model(SURFACE)
    assert left_out.number == 30_000
    assert replace(left_out, surface=replace(SURFACE, nominal_area=1e-6)).number == 300
    assert (left_out.heights, left_out.count) == (Gaussian(), "fixed")
    np.testing.assert_array_equal(left_out.mean("load", H), analytic.load(SURFACE, H))


ON_A_SURFACE = ("load", "area", "contacts", "stiffness", "conductance", "barber_conductance", "area_per_load")
CALLS = dict.fromkeys(ON_A_SURFACE, (SURFACE, 1.0)) | dict.fromkeys(("fn", "fn_scaled"), (1.5, 1.0))
CALLS |= dict.fromkeys(("area_per_load_ratio", "stiffness_ratio", "mean_modulus"), (1.0, Exponential(2.0)))


def test_every_function_takes_the_height_law():
    law = analytic.Weibull(1.7)
    for name, given in CALLS.items():
        function = getattr(analytic, name)
        assert not np.array_equal(function(*given, heights=law), function(*given)), name


def test_no_source_imports_the_simulator():
    paths = sorted(Path(analytic.__file__).parent.rglob("*.py"))
    assert paths
    for path in paths:
        imported = re.findall(r"^\s*(?:from|import)\s+(\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        assert set(imported) <= {"analytic", "numpy", "scipy", *sys.stdlib_module_names}, path


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


@pytest.mark.parametrize(
    ("quantity", "grading", "above"),  # below, a quantity need not fall with h, or everything touches
    [
        ("load", Exponential(0.2), -3),
        ("pressure", None, -40),
        ("stiffness", Custom(lambda s: 2 + np.tanh(s)), -1.6),
        ("contacts", Exponential(0.2), -5),
    ],
)
def test_separation_at_inverts_the_mean(quantity, grading, above):
    h = H[above < H]
    model = Model(SURFACE, grading=grading or analytic.Homogeneous(), n_asperities=70.0)
    found = model.separation_at(quantity, model.mean(quantity, h).reshape(1, -1))[0]
    # The mean has 1e-14 of error; h^2/2 turns it into less where h is large, d ln F/dh ~ 1e-2 into more.
    np.testing.assert_allclose(found, h, rtol=1e-12, atol=2e-13)


def test_a_target_beyond_the_end_of_its_bracket_by_a_last_digit_is_that_end():
    """A mean whose values one by one are a little more, or less, than all at once; what is known is wrong."""
    grid = np.array([0.0, 1.0, 2.0, 3.0])
    for more, target, h in ((-1e-9, -1.0, 1.0), (1e-9, -2.0 + 5e-10, 2.0)):

        def log_mean(x, more=more):
            return -np.asarray(x) + (0.0 if np.ndim(x) else more)

        found = inversion.last_separations(log_mean, np.array([[target]]), grid, np.full(4, -9.0), "load")
        np.testing.assert_array_equal(found, [[h]])


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


@pytest.mark.parametrize(
    ("law", "grading", "top"),
    [
        (analytic.ExponentialHeights(), Exponential(1.8), 12.0),
        (analytic.HeightTable.of(np.random.default_rng(1).normal(size=300)), Exponential(1.8), 1.2),
        (analytic.MeasuredHeights(np.random.default_rng(2).normal(size=300)), analytic.Homogeneous(), 1.2),
        (analytic.ScipyHeights(scipy.stats.lognorm(0.3)), Custom(lambda s: 2 + np.tanh(s)), 12.0),
    ],
)
def test_any_law_is_inverted(law, grading, top):
    model, h = Model(SURFACE, grading=grading, heights=law), np.array([-0.7, 0.31, top])
    values = model.mean("load", h)
    np.testing.assert_allclose(model.separation_at("load", values), h, rtol=1e-12, atol=2e-13)
