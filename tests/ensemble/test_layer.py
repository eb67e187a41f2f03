"""Spots on a layer of any thickness: check values, limits, and sums over spots under every law of contact.

Statistical gates are |z| < 5 with fixed seeds: false alarms 6e-7 a number; thin films fail.
"""

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest
from conftest import SURFACE
from oracles.accurately import term
from oracles.literal import scores
from oracles.scenes import scene_by
from scipy.integrate import quad
from scipy.special import j1

import analytic
import mcgw
from analytic.laws.film import layered_resistivity

UNIT = math.sqrt(SURFACE.radius * SURFACE.sigma)
LAYER = analytic.Layer(0.3 * UNIT, 1.3)
FILM = mcgw.Joint(conductivities=(200.0, 16.0), layer=LAYER)
H = (0.5, 1.5)
LAWS = {
    "hertz": analytic.Hertz(), "kogut": analytic.KogutEtsion(critical=0.05),
    "jackson": analytic.JacksonGreen(critical=0.05, yield_strain=0.004, poisson=0.3),
    "half-space": analytic.PowerLawGraded(0.5, reduced_c0=1.0, poisson=0.3),
    "coated": analytic.Coated(reduced_thickness=0.5, ratio=2.0, poisson=0.3),
    "jkr": analytic.JohnsonKendallRoberts(pull_off=0.05),
}  # fmt: skip


def over_thickness(tau, ratio):
    """4 k a R of a spot whose layer has this thickness over its radius and conductivity over the body's."""
    return float(layered_resistivity(1.0, tau, ratio, 1.0, math.inf)) * ratio


def by_integral(radius, film=FILM):
    """Resistance of a spot, by the integral as it is written; radii in m."""
    t, k = film.layer.thickness, film.layer.conductivity
    under, other = film.conductivities
    ratio = (k - under) / (k + under)

    def added(x):
        e = ratio * math.exp(-2 * x * t / radius)
        return math.sin(x) * j1(x) / x**2 * 2 * e / (1 - e)

    far = 40 * radius / t
    ends = np.linspace(0, far, math.ceil(far / 3) + 1)
    integral = math.fsum(quad(added, a, b, epsabs=1e-15, epsrel=1e-13)[0] for a, b in pairwise(ends))
    return (1 / (4 * k) + integral / (math.pi * k)) / radius + 1 / (4 * other * radius)


@pytest.mark.parametrize(("tau", "ratio", "value"), [
    (0.2, 0.01, 0.210775270308718), (1, 0.01, 0.625912159623815), (5, 0.01, 0.913660335740708),
    (1, 4, 1.53632754862376), (0.5, 0.5, 0.743641085102813),
])  # fmt: skip
def test_check_values(tau, ratio, value):
    assert over_thickness(tau, ratio) == pytest.approx(value, rel=1e-13)
    thin = ratio + 4 * tau / math.pi
    assert abs(thin / value - 1) > 0.15, "a thin film in series is something else"


@pytest.mark.parametrize("ratio", [1e-3, 30.0])
def test_against_mpmath(ratio):
    """With few images and many, by the integral over the flux."""
    tau, big = 0.7, (ratio - 1) / (ratio + 1)

    def added(x):
        e = big * mpmath.exp(-2 * x * tau)
        return mpmath.sin(x) * mpmath.besselj(1, x) / x**2 * 2 * e / (1 - e)

    with mpmath.workdps(20):
        integral = mpmath.quad(added, [0, 1e-3, 0.1, *(mpmath.pi * k for k in range(1, 14))])
    assert over_thickness(tau, ratio) == pytest.approx(float(1 + 4 / mpmath.pi * integral), rel=1e-12)


def test_limits():
    for ratio in (1e-3, 0.5, 1.0, 7.0, 300.0):
        assert over_thickness(1e-12, ratio) == pytest.approx(ratio, rel=1e-8)  # the body under it alone
        assert over_thickness(1e12, ratio) == pytest.approx(1.0, rel=1e-9)  # the layer alone
    ratio, tau = 1e-12, 1e-7  # a film: t/(pi k a^2) in series
    assert over_thickness(tau, ratio) == pytest.approx(ratio + 4 * tau / math.pi, rel=1e-3)


def scene_of(law=LAWS["hertz"], **changes):
    asked = {
        "separations": H, "law": law, "joint": FILM, "quantities": ["load", "conductance_si"], "seed": 3,
        "n_asperities": 400, "n_surfaces": 2, "negative": "clip",
    }  # fmt: skip
    return scene_by(SURFACE, **asked | changes)


GOOD = mcgw.Joint(conductivities=(200.0, 16.0), layer=analytic.Layer(LAYER.thickness, 2000.0))


@pytest.mark.parametrize(
    ("law", "film"), [*((law, FILM) for law in LAWS.values()), (analytic.Hertz(), GOOD)], ids=[*LAWS, "good"]
)
def test_one_surface_is_the_sum_of_its_spots(law, film):
    for sampler in ("cells", "tail"):
        scene = scene_of(law, sampler=sampler, n_asperities=40, joint=film)
        e = mcgw.simulate(scene)
        s = mcgw.heights(scene, 1)
        for k, h in enumerate(H):
            radii = UNIT * term(scene, "conductance", h, s[s > h])
            expected = math.fsum(1 / by_integral(a, film) for a in radii)
            assert e["conductance_si"][1, k] == pytest.approx(expected, rel=1e-10), sampler


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_many_have_the_mean_and_spread_of_theory(law):
    scene = scene_of(law, n_surfaces=3000)
    assert max(scores(mcgw.simulate(scene))) < 5
    mean, std = (get("conductance_si", H) for get in (scene.theory.mean, scene.theory.std))
    thin = analytic.Film(
        conductivities=FILM.conductivities, film_resistance=LAYER.thickness / LAYER.conductivity
    )
    wrong = scene_of(law, joint=thin).theory.mean("conductance_si", H)
    assert (np.abs(wrong - mean) / std * math.sqrt(3000) > 20).all()


@pytest.mark.parametrize(("thickness", "conductivity"), [(0.02, 2000.0), (0.1, 1.3), (10.0, 1.3)])
def test_mean_by_quadrature(thickness, conductivity):
    """A film besides, and layers of all kinds."""
    layer = analytic.Layer(thickness * UNIT, conductivity)
    film = mcgw.Joint(conductivities=(200.0, 16.0), layer=layer, film_resistance=1e-9)
    scene = scene_of(joint=film, separations=1.0, n_asperities=1)
    layered = layer.conductivity, *film.conductivities

    def one(y):
        a = UNIT * y
        conducts = 1 / (
            float(layered_resistivity(a, layer.thickness, *layered)) / (4 * a) + 1e-9 / (math.pi * a * a)
        )
        return 2 * y * conducts * math.exp(-((1 + y * y) ** 2) / 2) / math.sqrt(2 * math.pi)

    mean = math.fsum(
        quad(one, a, b, epsabs=0, epsrel=1e-12)[0] for a, b in ((1e-9, 0.1), (0.1, 0.5), (0.5, 3))
    )
    assert float(scene.theory.mean("conductance_si", 1.0)) == pytest.approx(mean, rel=1e-9)


def test_radii_of_their_own():
    scene = mcgw.scene_from("""
        surface = { nominal_area = "1 mm^2", E_star = "78.6 GPa" }
        summits = { heights = [1e-6, 2e-6, 4e-6], radii = [1e-5, 2e-5, 1e-5] }
        ensemble = { seed = 1 }
        [contact]
        separations = [0.0]
        quantities = ["conductance_si"]
        [joint]
        conductivities = [200, 16]
        layer = { thickness = "10 um", conductivity = 1.3 }
    """)
    film = mcgw.Joint(conductivities=(200.0, 16.0), layer=analytic.Layer(1e-5, 1.3))
    assert scene.joint == film
    a = math.sqrt(1e-5 * (4 - 7 / 3) * 1e-6)
    found = float(mcgw.simulate(scene)["conductance_si"][0, 0])
    assert found == pytest.approx(1 / by_integral(a, film), rel=1e-11)
    assert mcgw.scene_from(mcgw.scene_text(scene)) == scene
