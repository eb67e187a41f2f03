"""The very asperities of the surfaces that `solve` solved: their sums, by hand, are what was given."""

import numpy as np
import pytest

import mcgw
from mcgw.ensemble import loaded_surfaces

PLAIN = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "0.5 mm^2", "78.6 GPa")
SPECTRAL = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "0.2 mm^2", "78.6 GPa")
GRADED = mcgw.Exponential(0.5)


def load_of(found, i):
    """Hertz's loads, added up literally."""
    surface, h = found.scene.surface, found.surfaces["separation"][i]
    total = 0.0
    for s, radius in zip(found.heights(i), found.radii(i), strict=True):
        modulus = surface.E_star * found.scene.grading(np.array(s))
        total += 4 / 3 * modulus * np.sqrt(radius) * ((s - h) * surface.sigma) ** 1.5
    return total


@pytest.mark.parametrize("surface", [PLAIN, SPECTRAL], ids=["plain", "spectral"])
@pytest.mark.parametrize("count", ["fixed", "poisson"])
@pytest.mark.parametrize("grading", [mcgw.Homogeneous(), GRADED], ids=["same", "graded"])
def test_their_loads_add_up_to_what_was_given(surface, count, grading):
    scene = mcgw.Scene(
        surface, separations=0.0, grading=grading, ensemble=mcgw.Sampling(count=count), n_surfaces=3, seed=2
    )
    for found in mcgw.solve(scene, pressure=["0.1 MPa", "2 MPa"]):
        for i in (0, 2):
            assert load_of(found, i) == pytest.approx(found.amount, rel=1e-9)
            assert found.heights(i).size == found.radii(i).size == found.surfaces["contacts"][i]
            assert np.all(np.diff(found.heights(i)) <= 0)
            assert found.heights(i)[-1] > found.surfaces["separation"][i]
        assert not np.array_equal(found.heights(0), found.heights(2))


def test_of_areas_too_and_below_what_was_drawn_at_first(monkeypatch):
    monkeypatch.setattr(loaded_surfaces, "_MARGIN", 0.1)  # so that surfaces lie lower than was expected
    scene = mcgw.Scene(PLAIN, separations=0.0, ensemble=mcgw.Sampling(n_asperities=10), n_surfaces=40, seed=1)
    below = 0
    for share in (0.02, 0.4):
        found = mcgw.solve(scene, area_fraction=share * 1e-2)
        h = found.surfaces["separation"]
        below += np.count_nonzero(h < found.drawn.lowest)
        for i in range(40):
            area = np.pi * PLAIN.radius * PLAIN.sigma * np.sum(found.heights(i) - h[i])
            assert area == pytest.approx(found.amount, rel=1e-9)
    assert below


def test_asperities_that_press_each_other_down_have_theirs():
    scene = mcgw.Scene(PLAIN, separations=0.0, n_surfaces=3, seed=2, interaction="body")
    found = mcgw.solve(scene, pressure="1 MPa")
    alone = mcgw.solve(scene.replace(interaction=None), pressure="1 MPa")
    assert np.array_equal(found.heights(2), alone.heights(2))
    assert found.heights(2).size == found.surfaces["contacts"][2] > 0


@pytest.mark.parametrize("number", [-1, 3])
def test_a_surface_that_there_is_not_is_refused(number):
    found = mcgw.solve(mcgw.Scene(PLAIN, separations=0.0, n_surfaces=3, seed=2), load=1.0)
    with pytest.raises(ValueError, match=rf"^surface = {number}: give a number from 0 to 2$"):
        found.heights(number)
