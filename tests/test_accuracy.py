"""Values of single surfaces against exact sums over their heights: no error above what the scene asks.

A hundred surfaces at all separations, from hardly a contact to many, for gradings, laws of heights and of
contact, films, ways back and summits with radii of their own. Nothing here is statistical: bounds hold.
"""

import numpy as np
import pytest
import scipy.stats
from accurately import worst_share
from test_random_radii import spectral

import analytic
import mcgw
from analytic import laws
from mcgw.sampling import cells

H = tuple(np.linspace(0, 4, 21))
CLOSE = (1.0, 1.0 + 1e-9, 1.0 + 1e-6, 1.5)
BASIC = ("load", "area", "stiffness", "contacts", "conductance")
KOGUT = laws.KogutEtsion(critical=0.05)
FILM = mcgw.Film(resistivity=1e-7, film_resistance=1e-12)
ALL = (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-10)
SURFACES, FEW = 100, 25


def steep(slope, middle):
    return analytic.Custom(lambda s: 1.5 + np.tanh(slope * (s - middle)))


def heights(law):
    return {"heights": law, "grading": analytic.Exponential(0.5), "separations": np.linspace(-0.3, 1.5, 13)}


def under(law, *more, **changes):
    return {"law": law, "quantities": (*BASIC, "load_slope", *more), "separations": np.linspace(0, 3, 13)} | (
        changes
    )


HERTZ = {
    "few": {"n_asperities": 50},
    "many": {"n_asperities": 3000},
    "homogeneous": {"grading": None},
    "gamma 0": {"grading": analytic.Exponential(0.0)},
    "poisson": {"count": "poisson", "grading": analytic.Exponential(0.2)},
    "table": {"grading": analytic.Table([-1.0, 0.3, 1.0, 2.2], [0.3, 0.5, 1.4, 1.5])},
    "moments kept": {"keep": "moments"},
    "high": {"separations": np.linspace(2, 5, 16), "n_asperities": 20_000},
    "geometric": {"separations": np.geomspace(1e-3, 4, 15)},
    "close": {"separations": CLOSE},
    "from -40": {"separations": (-40.0, -9.0, 0.0, 4.0)},
}
OTHERS = {
    "step": {"grading": analytic.Custom(lambda s: np.where(s > 1.234, 2.0, 0.5), (1.234,))},
    "untold step": {"grading": analytic.Custom(lambda s: np.where(s > 0.777, 2.0, 0.5))},
    "steep": {"grading": steep(1e3, 0.5)},
    "steeper": {"grading": steep(1e6, 0.5)},
    "exp(-30 s)": {"grading": analytic.Custom(lambda s: np.exp(-30 * s))},
    "exp(60 s)": {"grading": analytic.Custom(lambda s: np.exp(60 * (s - 3)))},
    "exponential": heights(analytic.ExponentialHeights()),
    "weibull": heights(analytic.Weibull(1.5)),
    "nayak": heights(analytic.Nayak(2.0)),
    "table of heights": heights(analytic.HeightTable.of(np.random.default_rng(1).weibull(1.6, size=300))),
    "uniform": heights(analytic.ScipyHeights(scipy.stats.uniform())),
    "t": heights(analytic.ScipyHeights(scipy.stats.t(5))),
    "steep weibull": {
        "heights": analytic.Weibull(1.82),
        "grading": steep(47, 2.12),
        "separations": (-27.6, -21.7, -10.8),
    },
    "Kogut": under(KOGUT, "yielded"),
    "Kogut, few": under(KOGUT, n_asperities=50, count="poisson"),
    "Kogut, soft": under(laws.KogutEtsion(critical=0.001), "yielded"),
    "Kogut, bridged": under(laws.KogutEtsion(critical=0.05, bridge="hermite"), unload_from="loop"),
    "Kogut, and back": under(KOGUT, unload_from="loop", quantities=("load", "area", "contacts")),
    "Kogut, table": under(KOGUT, grading=analytic.Table((-4.0, 0.0, 1.0, 4.0), (0.5, 1.0, 2.0, 1.5))),
    "Kogut, steep": under(KOGUT, grading=steep(8, 1)),
    "Kogut, weibull": under(KOGUT) | heights(analytic.Weibull(1.5)),
    "Chang": under(laws.ChangEtsionBogy(critical=0.05)),
    "Zhao": under(laws.ZhaoMaiettaChang(critical=0.05)),
    "Jackson": under(laws.JacksonGreen(yield_strain=0.004, critical=0.1)),
    "half-space": under(laws.PowerLawGraded(0.5, reduced_c0=1.0)),
    "coated, and back": under(laws.Coated(reduced_thickness=0.5, ratio=3.0), unload_from="loop"),
    "Derjaguin": under(laws.DerjaguinMullerToporov(pull_off=0.05)),
    "Johnson": under(laws.JohnsonKendallRoberts(pull_off=0.05)),
    "Johnson, sticky": under(laws.JohnsonKendallRoberts(pull_off=0.5)),
    "Johnson, and back": under(
        laws.JohnsonKendallRoberts(pull_off=0.5),
        unload_from="loop",
        quantities=("load", "area", "contacts", "conductance"),
    ),
    "film": {"film": FILM, "quantities": ("conductance_si", "load"), "law": KOGUT},
}
SCENES = HERTZ | OTHERS


@pytest.fixture
def asked(make_scene):
    """A scene by its name."""

    def make(name, accuracy):
        values = {"separations": H, "n_asperities": 600, "sampler": "cells", "quantities": BASIC}
        values |= {"seed": 3, "negative": "clip", "accuracy": accuracy} | SCENES[name]
        return make_scene(**values)

    return make


@pytest.mark.parametrize("name", SCENES)
def test_no_error_is_above_what_is_asked(name, asked):
    assert worst_share(asked(name, 1e-6), FEW) <= 1


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", ALL)
@pytest.mark.parametrize("name", SCENES)
def test_at_any_accuracy(name, accuracy, asked):
    assert worst_share(asked(name, accuracy), SURFACES) <= 1


@pytest.mark.slow
@pytest.mark.parametrize("accuracy", [*ALL, 1e-12])
def test_of_a_million_asperities(make_scene, accuracy):
    """Where many touch, series are held against the sum of a surface, which is sure to be large."""
    scene = make_scene(
        separations=H, n_asperities=10**6, sampler="cells", quantities=BASIC, accuracy=accuracy
    )
    assert worst_share(scene, 5) <= 1


@pytest.mark.parametrize("alpha", [1.55, pytest.param(5.0, marks=pytest.mark.slow), 50.0])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, pytest.param(1e-10, marks=pytest.mark.slow)])
def test_of_summits_with_radii_of_their_own(alpha, accuracy):
    scene = spectral(
        alpha, sampler="cells", n_asperities=600, accuracy=accuracy, grading=analytic.Exponential(2.0)
    )
    assert worst_share(scene, SURFACES) <= 1


@pytest.mark.parametrize("name", ["few", "many"])
def test_series_that_are_twice_too_loose_fail(name, asked, monkeypatch):
    """The companion: as they would be if an asperity could be off in one way only, and by twice as much."""
    monkeypatch.setattr(cells, "_ALONE", 2.0)
    assert worst_share(asked(name, 1.001e-6), SURFACES) > 1


@pytest.mark.parametrize("name", HERTZ)
def test_near_the_last_digits(name, asked):
    """Elsewhere a lone contact in a cell where the modulus grows by decades keeps fewer digits."""
    assert worst_share(asked(name, 1e-12), FEW) <= 1


@pytest.mark.parametrize("name", HERTZ)
def test_the_last_digits(name, asked):
    """Where nothing is asked the bits are those of older versions.

    Their series are good to 1e-13, of a sum over many; a lone contact may be off by twice as much, in the
    two ways of `mcgw.sampling.cells.series_accuracy`.
    """
    assert worst_share(asked(name, 1e-13), SURFACES) <= 2
