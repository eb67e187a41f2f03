"""Surface parameters, the composite modulus, and the units of the quantities."""

import math
from dataclasses import asdict, replace

import pytest

import analytic
from analytic import Body, Surface, composite_modulus

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


@pytest.mark.parametrize("modulus", [0, -1.0, math.nan])
def test_youngs_modulus_is_positive(modulus):
    with pytest.raises(ValueError, match=r"E = .*> 0 Pa"):
        Body(modulus)


@pytest.mark.parametrize("nu", [-1.01, 0.51, math.nan])
def test_poissons_ratio_has_its_range(nu):
    with pytest.raises(ValueError, match=r"nu = .*between -1 and 0\.5"):
        Body(1e9, nu)


@pytest.mark.parametrize("nu", [-1, 0, 0.5])
def test_poissons_ratio_may_be_extreme(nu):
    assert Body(1e9, nu).nu == nu


@pytest.mark.parametrize("value", [0, -1.0, math.inf, math.nan])
@pytest.mark.parametrize("name", list(GOOD))
def test_every_parameter_is_positive_and_finite(name, value):
    with pytest.raises(ValueError, match=rf"{name} = .*finite number > 0"):
        Surface(**{**GOOD, name: value})


def test_number_of_asperities():
    surface = Surface(**GOOD)
    assert surface.n_asperities == pytest.approx(30000, rel=1e-15)
    assert asdict(surface) == GOOD


# Exponents of m, N in the unit, from which a change of units is worked out.
UNITS = {"load": ("N", 0, 1), "area": ("m^2", 2, 0), "stiffness": ("N/m", -1, 1), "contacts": ("1", 0, 0),
         "conductance": ("m", 1, 0)}  # fmt: skip


@pytest.mark.parametrize("name", list(UNITS))
def test_quantities_have_the_dimension_of_their_unit(name):
    """The same surface in millimetres and newtons: the number changes as the unit says."""
    surface = Surface(**GOOD)
    in_mm = Surface(1e3 * surface.sigma, 1e3 * surface.radius, 1e-6 * surface.eta, 1e6 * surface.nominal_area,
                    1e-6 * surface.E_star)  # fmt: skip
    unit, metres, newtons = UNITS[name]
    assert analytic.QUANTITIES[name].unit == unit
    assert analytic.QUANTITIES[name].name == name
    ratio = float(analytic.mean(in_mm, name, 1.0) / analytic.mean(surface, name, 1.0))
    assert ratio == pytest.approx(1e3**metres, rel=1e-14)
    stiff = float(analytic.mean(replace(surface, E_star=2 * surface.E_star), name, 1.0))
    assert stiff / float(analytic.mean(surface, name, 1.0)) == pytest.approx(2**newtons, rel=1e-14)
