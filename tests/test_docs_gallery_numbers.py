"""Numbers that the texts of the gallery name, by theory; each stands in its script word for word."""

import math
from pathlib import Path

import numpy as np
import pytest

import analytic

GALLERY = Path(__file__).parent.parent / "runs" / "gallery"
SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3e8, nominal_area=1e-6, E_star=78.6e9)


def says(script, words):
    return words in " ".join((GALLERY / f"{script}.py").read_text().split())


def test_size_of_a_specimen():
    """Scatter goes as one over the root of the area; the specimen of the model is 1 mm^2."""
    model = analytic.Model(SURFACE)
    h = model.separation_at("pressure", 1e6)
    area = (model.std("load", h) / model.mean("load", h) / 0.1) ** 2
    assert area == pytest.approx(50, rel=0.05)
    assert says("specimen_size", "at 1 MPa this surface needs about 50 mm² for a scatter of 10 %")


@pytest.mark.parametrize(("gamma", "factor"), [(2.0, 1.5), (0.5, 2.5)])
def test_area_over_load(gamma, factor):
    model = analytic.Model(SURFACE, grading=analytic.Exponential(gamma))
    light, heavy = (model.mean("area", model.separation_at("pressure", p)) / p for p in (1e3, 1e8))
    assert light / heavy == pytest.approx(factor, abs=0.05)
    assert says("area_and_load", "a factor of 1.5 (stiff tips) to 2.5 (soft ones)")


def test_number_of_spots():
    model = analytic.Model(SURFACE)
    few, many = (model.mean("contacts", model.separation_at("pressure", p)) for p in (1e5, 1e7))
    assert many / few == pytest.approx(50, rel=0.05)
    assert says("spot_sizes", "A hundred times the pressure makes fifty times as many spots")


def test_ra_for_sigma():
    """Loads go as sigma^(3/2) F_3/2(d/sigma)."""
    errors = []
    for alpha in np.geomspace(1.6, 100, 30):
        wrong = math.sqrt(2 / math.pi) / analytic.SpectralMoments(1.0, 1.0, alpha).sigma
        errors.append(wrong**1.5 * analytic.fn(1.5, 2 / wrong) / analytic.fn(1.5, 2.0))
    assert 1 / min(errors) == pytest.approx(6, abs=0.3)
    assert 3 < max(errors) < 6
    assert says("ra_for_sigma", "six times at most of those here")


def test_sliding():
    """Nine tenths of the friction are reached within some tenths of a micrometre, by summing over heights."""
    model = analytic.Model(SURFACE)
    push = np.linspace(0, 1.2e-6, 121)
    tangential = analytic.Tangential(0.3, 0.3, push)
    share = np.array([model.tangential_load(h, tangential) for h in (0.0, 1.0)]).reshape(2, -1)
    share /= 0.3 * model.mean("load", np.array([0.0, 1.0]))[:, None]
    reached = push[(share < 0.9).sum(axis=1)]
    assert np.all((reached > 0.2e-6) & (reached < 0.7e-6))
    assert says("before_it_slips", "within some tenths of a micrometre")
