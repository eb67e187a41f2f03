"""The model of a surface: its own number, count and height law in everything it says."""

import math
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

import analytic
from analytic import (
    Body,
    Exponential,
    ExponentialHeights,
    Gaussian,
    Model,
    Surface,
    Weibull,
    composite_modulus,
)

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
H = np.array([-0.5, 0.0, 1.5])


@pytest.fixture
def model():
    return Model(
        SURFACE, grading=Exponential(0.5), heights=ExponentialHeights(), n_asperities=70.0, count="poisson"
    )


def test_means_and_variances_are_sums_of_independent_terms(model):
    """By literal quadrature over the density exp(-1 - s); a Poisson number has E f^2 for a variance."""
    for name, q in analytic.QUANTITIES.items():
        scale = q.scale(SURFACE)
        for k, h in enumerate(H):

            def moment(power, q=q, h=h):
                def term(v):  # s = h + v^2
                    s = h + v * v
                    e = 0.5 + 0.5 * math.exp(-s)
                    return 2 * v * (v ** (2 * q.exponent) * e**q.modulus) ** power * math.exp(-1 - s)

                return quad(term, 0, 7, epsrel=1e-12)[0]

            assert model.mean(name, H)[k] == pytest.approx(70 * scale * moment(1), rel=1e-10)
            assert model.std(name, H)[k] ** 2 == pytest.approx(70 * scale**2 * moment(2), rel=1e-10)
            fixed = replace(model, count="fixed").std(name, H)[k] ** 2
            assert fixed == pytest.approx(70 * scale**2 * (moment(2) - moment(1) ** 2), rel=1e-9)


def test_separations_belong_to_the_number_of_asperities(model):
    for name in ("load", "area"):
        np.testing.assert_allclose(model.separation_at(name, model.mean(name, H)), H, atol=1e-12)
        slope = (model.mean(name, H - 1e-5) - model.mean(name, H + 1e-5)) / 2e-5
        np.testing.assert_allclose(model.slope(name, H[1:]), slope[1:], rtol=1e-8)


def test_the_number_is_that_of_the_surface_unless_given():
    left_out = Model(SURFACE)
    assert left_out.number == 1000
    assert replace(left_out, surface=replace(SURFACE, nominal_area=3e-6)).number == 3000
    assert (left_out.heights, left_out.count) == (Gaussian(), "fixed")
    np.testing.assert_array_equal(left_out.mean("load", H), analytic.load(SURFACE, H))


@pytest.mark.parametrize(
    ("given", "told"),
    [({"n_asperities": 0.0}, "n_asperities = 0.0"), ({"count": "random"}, "count = 'random'")],
)
def test_mistakes_are_named(given, told):
    with pytest.raises(ValueError, match=told):
        Model(SURFACE, **given)


CALLS = {
    "mean": (SURFACE, "load", 1.0), "load": (SURFACE, 1.0), "area": (SURFACE, 1.0),
    "contacts": (SURFACE, 1.0), "stiffness": (SURFACE, 1.0), "conductance": (SURFACE, 1.0),
    "barber_conductance": (SURFACE, 1.0), "area_per_load": (SURFACE, 1.0),
    "area_per_load_ratio": (1.0, Exponential(2.0)), "stiffness_ratio": (1.0, Exponential(2.0)),
    "fn": (1.5, 1.0), "fn_scaled": (1.5, 1.0),
    "mean_modulus": (1.0, Exponential(2.0)),
}  # fmt: skip


def test_every_function_takes_the_height_law():
    law = Weibull(1.7)
    for name, given in CALLS.items():
        function = getattr(analytic, name)
        assert not np.array_equal(function(*given, heights=law), function(*given)), name
        with pytest.raises(TypeError, match="law"):
            function(*given, law=law)


def test_no_source_imports_the_simulator():
    paths = sorted(Path(analytic.__file__).parent.rglob("*.py"))
    assert paths
    for path in paths:
        imported = re.findall(r"^\s*(?:from|import)\s+(\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        assert set(imported) <= {"analytic", "numpy", "scipy", *sys.stdlib_module_names}, path


GOOD = {"sigma": 1.37e-6, "radius": 13e-6, "eta": 3e8, "nominal_area": 1e-4, "E_star": 78.6e9}


def test_composite_modulus():
    steel, glass = Body(210e9, 0.3), Body(70e9, 0.22)
    expected = 1 / ((1 - 0.09) / 210e9 + (1 - 0.0484) / 70e9)
    assert composite_modulus([steel, glass]) == pytest.approx(expected, rel=1e-15)
    assert composite_modulus([glass, steel]) == pytest.approx(expected, rel=1e-15)
    assert composite_modulus([steel, Body(math.inf)]) == pytest.approx(210e9 / 0.91, rel=1e-15)


def test_two_bodies_one_of_them_elastic():
    with pytest.raises(ValueError, match="give two of them, not 1"):
        composite_modulus([Body(1e9)])
    with pytest.raises(ValueError, match="both are rigid"):
        composite_modulus([Body(math.inf), Body(math.inf)])


@pytest.mark.parametrize("name", list(GOOD))
def test_every_parameter_is_positive_and_finite(name):
    for value in (0, -1.0, math.inf, math.nan):
        with pytest.raises(ValueError, match=rf"{name} = .*finite number > 0"):
            Surface(**{**GOOD, name: value})


# Words, symbol and unit of each quantity, and the power of lengths in its scale: R = 3, sigma = 5, E* = 2.
HERTZ, AREA, STIFF, SPOT = 4 / 3 * 2 * 3**0.5 * 5**1.5, math.pi * 15, 2 * 2 * 15**0.5, 4 * 15**0.5
GAP, JOINT, OHM = "Gap conductance h_g (W/(m² K))", "Joint conductance h_j (W/(m² K))", "(ohm m² or K m²/W)"
TOLD = {
    "load": ("Load P (N)", HERTZ),
    "area": ("Real area A (m²)", AREA),
    "stiffness": ("Stiffness K (N/m)", STIFF),
    "contacts": ("Contacts", 1.0),
    "conductance": ("Conductance Cρ (m)", SPOT),
    "load_slope": ("Slope of the loads (N/m)", STIFF),
    "conductance_si": ("Conductance C (S or W/K)", SPOT),
    "yielded": ("Yielded contacts", 1.0),
    "spot_conductance": ("Spot conductance (m)", SPOT),
    "load_unloading": ("Load P (N), unloading", HERTZ),
    "spot_conductance_unloading": ("Spot conductance (m), unloading", SPOT),
    "nominal_separation": ("Nominal separation", 1.0),
    "nominal_separation_unloading": ("Nominal separation, unloading", 1.0),
    "gap_conductance": (GAP, SPOT / 7),
    "gap_conductance_unloading": (f"{GAP}, unloading", SPOT / 7),
    "joint_conductance": (JOINT, SPOT / 7),
    "joint_conductance_unloading": (f"{JOINT}, unloading", SPOT / 7),
    "pressure": ("Pressure (Pa)", HERTZ / 7),
    "area_fraction": ("Area fraction", AREA / 7),
    "contact_conductance": ("Contact conductance (S/m² or W/(m² K))", SPOT / 7),
    "thermal_resistance": ("Thermal resistance (K/W)", 1 / SPOT),
    "contact_resistance": ("Contact resistance (ohm)", 1 / SPOT),
    "specific_contact_resistance": (f"Specific contact resistance {OHM}", 1 / SPOT),
}


@pytest.mark.parametrize("name", TOLD)
def test_each_quantity_has_its_unit_and_scale(name):
    surface = Surface(sigma=5.0, radius=3.0, eta=1.0, nominal_area=7.0, E_star=2.0)
    q, (title, scale) = analytic.quantity_of(name), TOLD[name]
    assert (q.name, q.title, q.scale(surface)) == (name, title, pytest.approx(scale, rel=1e-14))
    assert q.counts == (name in ("contacts", "yielded"))
