"""The model of a surface: its own number, count and height law in everything it says."""

import math
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import analytic
from analytic import Body, Exponential, Gaussian, Model, Surface, Weibull, composite_modulus

SURFACE = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
H = np.array([-0.5, 0.0, 1.5])


def test_the_number_is_that_of_the_surface_unless_given():
    left_out = Model(SURFACE)
    assert left_out.number == 1000
    assert replace(left_out, surface=replace(SURFACE, nominal_area=3e-6)).number == 3000
    assert (left_out.heights, left_out.count) == (Gaussian(), "fixed")
    np.testing.assert_array_equal(left_out.mean("load", H), analytic.load(SURFACE, H))


ON_A_SURFACE = ("load", "area", "contacts", "stiffness", "conductance", "barber_conductance", "area_per_load")
CALLS = dict.fromkeys(ON_A_SURFACE, (SURFACE, 1.0)) | dict.fromkeys(("fn", "fn_scaled"), (1.5, 1.0))
CALLS |= dict.fromkeys(("area_per_load_ratio", "stiffness_ratio", "mean_modulus"), (1.0, Exponential(2.0)))


def test_every_function_takes_the_height_law():
    law = Weibull(1.7)
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
    surface = Surface(sigma=5.0, radius=3.0, eta=1.0, nominal_area=7.0, E_star=2.0)
    for name, (title, scale) in TOLD.items():
        q = analytic.quantity_of(name)
        assert (q.name, q.title, q.scale(surface)) == (name, title, pytest.approx(scale, rel=1e-14))
