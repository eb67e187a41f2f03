"""Constriction of both bodies: conductance goes with stiffness as Barber's theorem says, in every mode.

J. R. Barber, Proc. R. Soc. Lond. A 459 (2003) 53: C rho = 2 K/E* of homogeneous rough bodies.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from conftest import SURFACE
from oracles.inside import cautions
from oracles.scenes import scene_by

import analytic
import mcgw
from analytic.interaction import Interaction

MODES = [Interaction(reference) for reference in ("body", "mean-plane")]
NAMES = ("load", "stiffness", "conductance", "spot_conductance")
H = (0.8, 1.7, 2.6)


def scene_of(interaction, **changes):
    surface = replace(SURFACE, eta=changes.pop("eta", SURFACE.eta))
    asked = {"quantities": NAMES, "n_asperities": 800, "n_surfaces": 3, "seed": 4}
    return scene_by(surface, interaction=interaction, **{"separations": H} | asked | changes)


by_mode = pytest.mark.parametrize("mode", MODES, ids=lambda mode: mode.reference)


@by_mode
def test_conductance_is_stiffness_drawn_and_exact(mode):
    """What spots alone conduct must not pass for it."""
    for sampler in ("cells", "tail"):
        e = mcgw.simulate(scene_of(mode, sampler=sampler))
        np.testing.assert_allclose(e.conductance, 2 * e.stiffness / SURFACE.E_star, rtol=1e-12)
        assert np.abs(e["spot_conductance"] / e.conductance - 1)[:, 0].min() > 3e-3
    theory = scene_of(mode).theory
    for get in (theory.mean, theory.std):
        found = get("conductance", H)
        np.testing.assert_allclose(found, 2 * get("stiffness", H) / SURFACE.E_star, rtol=1e-12)


@by_mode
def test_of_spots_that_resist_besides(mode):
    """A film adds to the spots, rho E_b compliance/2 to all of them; without E_b/2 it would not fit."""
    film = mcgw.Joint(resistivity=2e-8, film_resistance=1e-14)
    scene = scene_of(mode, joint=film, quantities=("load", "conductance_si"), sampler="tail")
    e = mcgw.simulate(scene)
    between = scene.film.rho * SURFACE.E_star * scene.theory.compliance * SURFACE.sigma / 2
    for i in range(3):
        s = np.maximum(mcgw.heights(scene, i)[:, None] - H, 0)
        a = np.maximum(np.sqrt(SURFACE.radius * SURFACE.sigma * s), 1e-99)
        spots = np.sum(1 / (2e-8 / (4 * a) + 1e-14 / (np.pi * a**2)), axis=0)
        np.testing.assert_allclose(1 / e["conductance_si"][i], 1 / spots + between, rtol=1e-11)
        wrong = 1 / spots + scene.theory.compliance * SURFACE.sigma
        assert (np.abs(wrong * e["conductance_si"][i] - 1) > 1e-3).any()


@pytest.mark.parametrize("asked", [
    {"grading": analytic.Exponential(2.0), "separations": (0.8, 1.7)},
    {"law": analytic.KogutEtsion(critical=0.05), "unload_from": 0.5, "separations": (0.6, 0.9)},
])  # fmt: skip
def test_it_is_geometry_under_every_law_and_grading_and_on_the_way_back(asked):
    """Each surface has contacts there."""
    e = mcgw.simulate(scene_of(Interaction("body"), **asked))
    for way in ("", "_unloading") if "law" in asked else ("",):
        extra = 1 / e[f"conductance{way}"] - 1 / e[f"spot_conductance{way}"]
        assert extra == pytest.approx(0.4732010044093386 / math.sqrt(SURFACE.nominal_area), rel=1e-9)
    softer = mcgw.simulate(scene_of(Interaction("body", bulk_modulus=SURFACE.E_star / 7), **asked))
    np.testing.assert_allclose(softer.conductance, e.conductance, rtol=1e-12)


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
