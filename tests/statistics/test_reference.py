"""A rule that shares nothing with theory follows every height law to its tail; theory is held to it."""

import numpy as np
import pytest
from conftest import SURFACE
from oracles.reference_means import reference
from oracles.scenes import scene_by
from oracles.thirteen_height_laws import LAWS, SAMPLE

import analytic
import mcgw
from analytic import ExponentialHeights, MeasuredHeights

QUANTITIES = ("load", "area", "stiffness", "contacts")
STIFFER = analytic.Table([-3, 0, 1, 3], [1, 1.2, 2, 2.5])


def scene_of(law, quantity="load", separations=(-2.0, -1.0, 0.0, 1.0, 2.0, 3.0)):
    own = {"n_asperities": 3000}
    if isinstance(law, MeasuredHeights):
        own = {"n_surfaces": 1, "sampler": "direct", "n_asperities": SAMPLE.size}
    return scene_by(
        surface=SURFACE, separations=separations, quantities=(quantity,), heights=law, grading=STIFFER,
        **own,
    )  # fmt: skip


def relative(found, exact):
    """Relative difference; of 0 and 0 it is 0."""
    return np.abs(found - exact) / np.where(exact == 0, 1.0, np.abs(exact))


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_reference_is_the_theory_for_every_height_law(law):
    """Two rules in different variables; separations below, in and above the support of bounded laws."""
    scene = scene_of(law)
    one = scene.theory.fluctuations(QUANTITIES, scene.separations).mean.reshape(len(QUANTITIES), -1)
    for name, row in zip(QUANTITIES, one, strict=True):
        exact = scene.n_asperities * analytic.QUANTITIES[name].scale(SURFACE) * row
        found = reference(scene.replace(quantities=(name,)), tuple(range(6)))
        assert relative(found, exact).max() < 1e-10


def test_reference_of_radii_of_their_own():
    spectral = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "78.6 GPa")
    for name in ("load", "area", "stiffness"):
        scene = mcgw.Scene(
            spectral,
            separations=[0.0, 2.0],
            contact=mcgw.Contact(quantities=[name]),
            ensemble=mcgw.Sampling(n_asperities=1000),
        )
        exact = scene.theory.mean(name, scene.separations)
        np.testing.assert_allclose(reference(scene, (0, 1)), exact, rtol=1e-9)


def test_reference_of_exponential_heights_by_hand():
    """``Gamma(n + 1) exp(-1 - h)`` for h >= -1, and its polynomial below: no other rule takes part."""
    h = (-2.0, -1.0, 0.0, 3.0)
    scene = scene_of(ExponentialHeights(), "area", h).replace(
        grading=analytic.Homogeneous(), quantities=("area",)
    )
    one = np.array([2.0, *np.exp([0.0, -1.0, -4.0])])  # E (s + 2) = 2
    np.testing.assert_allclose(
        reference(scene, (0, 1, 2, 3)), 3000 * np.pi * 13e-6 * 1.37e-6 * one, rtol=1e-13
    )
