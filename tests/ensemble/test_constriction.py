"""Constriction of both bodies: conductance goes with stiffness as Barber's theorem says, in every mode.

J. R. Barber, Proc. R. Soc. Lond. A 459 (2003) 53: C rho = 2 K/E* of homogeneous rough bodies.
"""

import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest
from conftest import SURFACE
from oracles.inside import cautions
from oracles.scenes import scene_by

import analytic
import mcgw
from analytic.interaction import LATTICE, Interaction, in_series

MODES = [Interaction(reference) for reference in ("body", "mean-plane")]
NAMES = ("load", "stiffness", "conductance", "spot_conductance")
H = (0.8, 1.7, 2.6)


def scene_of(interaction, **changes):
    surface = replace(SURFACE, eta=changes.pop("eta", SURFACE.eta))
    asked = {"quantities": NAMES, "n_asperities": 800, "n_surfaces": 3, "seed": 4}
    return scene_by(surface, interaction=interaction, **{"separations": H} | asked | changes)


@pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.reference)
class TestBarber:
    def test_drawn(self, mode):
        for sampler in ("cells", "tail"):
            e = mcgw.simulate(scene_of(mode, sampler=sampler))
            np.testing.assert_allclose(
                e.conductance, 2 * e.stiffness / SURFACE.E_star, rtol=1e-12, err_msg=sampler
            )
            apart = np.abs(e["spot_conductance"] / e.conductance - 1)
            assert apart[:, 0].min() > 3e-3, "what spots alone conduct must not pass for it"

    def test_exact(self, mode):
        theory = scene_of(mode).theory
        for get in (theory.mean, theory.std):
            found = get("conductance", H)
            np.testing.assert_allclose(found, 2 * get("stiffness", H) / SURFACE.E_star, rtol=1e-12)
        apart = np.abs(theory.mean("spot_conductance", H) / theory.mean("conductance", H) - 1)
        assert apart[0] > 4e-3

    def test_of_spots_that_resist_besides(self, mode):
        """A film adds to the spots, rho E_b compliance/2 to all of them; without E_b/2 it would not fit."""
        film = mcgw.Joint(resistivity=2e-8, film_resistance=1e-14)
        scene = scene_of(mode, joint=film, quantities=("load", "conductance_si"), sampler="tail")
        e = mcgw.simulate(scene)
        between = scene.film.rho * SURFACE.E_star * scene.compliance / 2
        for i in range(3):
            s = np.maximum(mcgw.heights(scene, i)[:, None] - H, 0)
            a = np.sqrt(SURFACE.radius * SURFACE.sigma * s)
            spots = np.sum(
                1 / (2e-8 / (4 * np.maximum(a, 1e-99)) + 1e-14 / (np.pi * np.maximum(a, 1e-99) ** 2)), 0
            )
            np.testing.assert_allclose(1 / e["conductance_si"][i], 1 / spots + between, rtol=1e-11)
            wrong = 1 / spots + scene.compliance
            assert (np.abs(wrong * e["conductance_si"][i] - 1) > 1e-3).any()


def test_spots_alone_are_all_without_interaction():
    e = mcgw.simulate(scene_of(None))
    np.testing.assert_array_equal(e.conductance, e["spot_conductance"])


@pytest.mark.parametrize("law", [analytic.KogutEtsion(critical=0.05), analytic.Hertz()], ids=lambda x: x.name)
@pytest.mark.parametrize(
    "grading", [analytic.Homogeneous(), analytic.Exponential(2.0)], ids=["same", "graded"]
)
def test_it_is_geometry_under_every_law_and_grading(law, grading):
    asked = {"law": law, "grading": grading, "separations": (0.8, 1.7)}  # each surface has contacts there
    e = mcgw.simulate(scene_of(Interaction("body"), **asked))
    extra = 1 / e.conductance - 1 / e["spot_conductance"]
    assert extra == pytest.approx(0.4732010044093386 / math.sqrt(SURFACE.nominal_area), rel=1e-9)
    softer = mcgw.simulate(scene_of(Interaction("body", bulk_modulus=SURFACE.E_star / 7), **asked))
    np.testing.assert_allclose(softer.conductance, e.conductance, rtol=1e-12)


def test_way_back():
    law = analytic.KogutEtsion(critical=0.05)
    scene = scene_of(Interaction("body"), law=law, unload_from=0.5, separations=(0.6, 0.9))
    e = mcgw.simulate(scene)
    extra = 1 / e["conductance_unloading"] - 1 / e["spot_conductance_unloading"]
    assert extra == pytest.approx(0.4732010044093386 / math.sqrt(SURFACE.nominal_area), rel=1e-9)


def test_infinite_load_leaves_the_constriction_of_a_square():
    """Mean temperature of a square under uniform flux into a half-space: mean of 1/(2 pi r) by mpmath."""

    def along(angle):
        tan = mpmath.tan(angle)
        return (1 - (1 + tan) / 2 + tan / 3) / mpmath.cos(angle)

    mean = 8 / (2 * mpmath.pi) * mpmath.quad(along, [0, mpmath.pi / 4])
    assert float(mean) == pytest.approx(0.473201004409, abs=5e-13)
    area = SURFACE.nominal_area
    found = in_series(1e30, Interaction("body").series("conductance", SURFACE, 1.0))
    assert 1 / found == pytest.approx(float(mean) / math.sqrt(area), rel=1e-13)


def test_equal_spots_on_a_square_lattice():
    """All of them touching: factor 1 - 1.40087 eps of one spot's resistance, eps = sqrt(A/A_n)."""
    n, a = 1e4, 1e-7  # radius of a spot, m
    eps = a * math.sqrt(math.pi * n / SURFACE.nominal_area)
    spots = 4 * a * n
    found = in_series(spots, Interaction("mean-plane").series("conductance", SURFACE, n))
    lattice = 2 * LATTICE / math.pi**1.5
    assert lattice == pytest.approx(1.40087, abs=5e-6)
    assert spots / found == pytest.approx(1 - lattice * eps, rel=1e-13)
    assert abs(lattice - 1.5) > 0.09  # Cooper, Mikic and Yovanovich's first order
    assert abs(lattice - 1.40833) > 7e-3  # a hexagonal lattice


def test_no_answer_where_less_than_nothing_would_resist():
    mode = Interaction("mean-plane")
    other = mode.series("conductance", SURFACE, 800)
    np.testing.assert_array_equal(in_series(np.array([0.0, -2 / other]), other), [0.0, np.nan])


def test_surfaces_without_an_answer_are_cautioned_of():
    """A stiff half-space has a balance all the same, and its surfaces say nan."""

    def lines(*separations):
        scene = scene_of(stiff, n_asperities=None, eta=eta, separations=separations)
        return scene, [line for line in cautions(scene) if "conductance" in line and "law" not in line]

    stiff = Interaction("mean-plane", bulk_modulus=20 * SURFACE.E_star)
    eta = 0.2 / (SURFACE.radius * SURFACE.sigma)
    scene, (line,) = lines(-2.0, 3.0)
    assert line.startswith("up to d/sigma = -2 conductance is nan: the correction for the mean plane")
    e = mcgw.simulate(scene)
    np.testing.assert_array_equal(np.isnan(e.conductance), [[True, False]] * 3)
    assert not np.isnan(e.load).any()
    assert not lines(3.0)[1]
