"""Values of single surfaces against exact sums over their heights: no error above what the scene asks.

At all separations, from hardly a contact to many, for gradings, laws of heights and of contact, films, ways
back and individual summit radii. Nothing here is statistical: bounds hold.
"""

from dataclasses import replace

import numpy as np
import pytest
import scipy.stats
from oracles.accurately import worst_error
from test_random_radii import spectral

import analytic
import mcgw
from analytic import laws

H = tuple(np.linspace(0, 4, 21))
CLOSE = (1.0, 1.0 + 1e-9, 1.0 + 1e-6, 1.5)
BASIC = ("load", "area", "stiffness", "contacts", "conductance")
KOGUT = laws.KogutEtsion(critical=0.05)
FILM = mcgw.Joint(resistivity=1e-7, film_resistance=1e-12)
BENT = 1e-11  # where the modulus, the law or the radii bend
SURFACES, FEW = 50, 10


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
    "high": {"separations": np.linspace(2, 5, 16), "n_asperities": 20_000},
    "geometric": {"separations": np.geomspace(1e-3, 4, 15)},
    "close": {"separations": CLOSE},
    "from -40": {"separations": (-40.0, -9.0, 0.0, 4.0)},
}
OTHERS = {
    "exponential": heights(analytic.ExponentialHeights()),
    "weibull": heights(analytic.Weibull(1.5)),
    "nayak": heights(analytic.Nayak(2.0)),
    "table of heights": heights(analytic.HeightTable.of(np.random.default_rng(1).weibull(1.6, size=300))),
    "uniform": heights(analytic.ScipyHeights(scipy.stats.uniform())),
    "t": heights(analytic.ScipyHeights(scipy.stats.t(5))),
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
    "film": {"joint": FILM, "quantities": ("conductance_si", "load"), "law": KOGUT},
}
SCENES = HERTZ | OTHERS


@pytest.fixture
def asked(make_scene):
    """A scene by its name."""

    def make(name):
        values = {"separations": H, "n_asperities": 600, "sampler": "cells", "quantities": BASIC}
        values |= {"seed": 3, "negative": "clip"} | SCENES[name]
        return make_scene(**values)

    return make


@pytest.mark.parametrize("name", SCENES)
def test_values_are_right_to_the_last_digits(name, asked):
    """A lone contact may be off twice, as it is itself and as part of a larger node."""
    assert worst_error(asked(name), FEW) <= (2e-13 if name in HERTZ else BENT)


@pytest.mark.slow
def test_values_of_a_million_asperities(make_scene):
    """Where many touch, series are held against the sum of a surface, which is sure to be large."""
    scene = make_scene(separations=H, n_asperities=10**6, sampler="cells", quantities=BASIC)
    assert worst_error(scene, 3) <= 2e-13


@pytest.mark.parametrize("alpha", [1.55, 50.0])
def test_values_of_summits_with_radii_of_their_own(alpha):
    scene = spectral(alpha, sampler="cells", n_asperities=600, grading=analytic.Exponential(2.0))
    assert worst_error(scene, SURFACES) <= BENT


WISH = {"accuracy": 1e-2, "n_asperities": 10**6}


def test_compare_agrees_and_sees_another_gamma(make_scene):
    """By 1 %, which is far more than anybody allowed for."""
    scene = make_scene(n_surfaces=1000, **WISH)
    ensemble = mcgw.simulate(scene)
    assert mcgw.compare(ensemble).verdict.agrees
    wrong = scene.replace(grading=analytic.Exponential(2.02))
    assert not mcgw.compare(replace(ensemble, scene=wrong)).verdict.agrees


@pytest.mark.slow
def test_converge_passes(make_scene):
    assert mcgw.converge(make_scene(**WISH), n_surfaces=64, seeds=8).passed
