"""Thirteen height laws through everything that judges and shows, below, at and above their support.

Means and contacts are held to an independent integral over the density (or a plain sum over measured
heights); a separation that nothing reaches has mean and variance 0, and no warning.
"""

import numpy as np
import pytest
import scipy.stats
from oracles.inside import cautions, forecast, report_html, summary

import mcgw
from analytic import QUANTITIES, Exponential, ExponentialHeights, Gaussian, MeasuredHeights
from mcgw import compare, converge

SAMPLE = np.random.default_rng(1).weibull(1.6, size=300)
LAWS = {
    "gaussian": Gaussian(), "exponential": ExponentialHeights(), "weibull 1.5": mcgw.Weibull(1.5),
    "weibull 3.6": mcgw.Weibull(3.6), "nayak": mcgw.Nayak(2.0), "table": mcgw.HeightTable.of(SAMPLE),
    "measured": MeasuredHeights(SAMPLE), "uniform": mcgw.ScipyHeights(scipy.stats.uniform()),
    "beta": mcgw.ScipyHeights(scipy.stats.beta(2, 3)), "t": mcgw.ScipyHeights(scipy.stats.t(5)),
    "lognormal": mcgw.ScipyHeights(scipy.stats.lognorm(0.3)),
    "gamma": mcgw.ScipyHeights(scipy.stats.gamma(4)), "triangle": mcgw.ScipyHeights(scipy.stats.triang(0.3)),
}  # fmt: skip
ATTRIBUTES = {
    "digest": "0", "seed": 1, "sampler": "cells", "date": "", "versions": "", "commit": "", "cpu": "",
    "scene": "", "complete": True, "wall_seconds": 1.0,
}  # fmt: skip


@pytest.fixture
def ensemble_of(make_scene):
    def make(name, separations, sampler="cells", **changes):
        own = {"sampler": sampler, "n_surfaces": 64, "n_asperities": 300}
        if name == "measured":
            own = {"sampler": "direct", "n_surfaces": 1, "n_asperities": SAMPLE.size}
        scene = make_scene(
            heights=LAWS[name], separations=separations, grading=Exponential(0.5), **(own | changes)
        )
        return mcgw.simulate(scene)

    return make


def literal(scene, quantity, h):
    """Mean of a quantity by a composite rule of its own over the law's density; or a plain sum."""
    q, law = QUANTITIES[quantity], scene.heights
    unit = scene.n_asperities * q.scale(scene.surface)
    if isinstance(law, MeasuredHeights):
        s = np.array([x for x in law.heights if x > h])
        return unit / SAMPLE.size * float(np.sum((s - h) ** q.exponent * scene.grading(s) ** q.modulus))
    high = min(law.support[1], 1e5 if law is LAWS["t"] else 60.0)
    marks = [h, high, *law.breaks, *np.arange(-1, 14, 0.25), *np.geomspace(14, 1e5, 60)]
    roots = np.sqrt(np.unique([b for b in marks if h <= b <= high]) - h)  # s = h + v^2
    x, w = np.polynomial.legendre.leggauss(20)
    half = np.diff(roots)[:, None] / 2
    v = roots[:-1, None] + half * (1 + x)
    s = np.minimum(h + v * v, np.nextafter(high, h))
    terms = 2 * v ** (2 * q.exponent + 1) * scene.grading(s) ** q.modulus * law.pdf(s)
    return unit * float(np.sum(half * w * terms))


def around(law):
    """Separations below, at and above the support, where it has an end; else far out."""
    low, high = (end if np.isfinite(end) else far for end, far in zip(law.support, (-9.0, 40.0), strict=True))
    return low - 1, low, 0.5, high, high + 1


# Where not cells: those with one end, with two and with none in each of the three samplers.
SAMPLERS = {
    "gaussian": "direct", "exponential": "tail", "weibull 1.5": "tail", "weibull 3.6": "tail",
    "uniform": "tail", "beta": "direct", "gamma": "tail", "triangle": "direct", "measured": "direct",
}  # fmt: skip


@pytest.mark.parametrize("name", LAWS)
def test_everything_takes_separations_in_and_around_the_support(name, ensemble_of):
    """All separations together, and the highest by itself."""
    h = around(LAWS[name])
    for separations in ((*h, -0.3, 1.1), h[-1:]):
        e = ensemble_of(name, separations, SAMPLERS.get(name, "cells"))
        comparison = compare(e)
        assert comparison.verdict.agrees
        assert summary(e, ATTRIBUTES)
        share = LAWS[name].sf(np.array(separations))
        np.testing.assert_allclose(
            comparison.curves["contacts"].theory, e.scene.n_asperities * share, rtol=1e-9
        )
        for quantity, curve in comparison.curves.items():
            inside = [k for k, x in enumerate(separations) if x in (-0.3, 0.5, 1.1)]
            expected = [literal(e.scene, quantity, separations[k]) for k in inside]
            np.testing.assert_allclose(curve.theory[inside], expected, rtol=1e-8)
            nothing = curve.theory == 0
            assert np.all(e.values(quantity)[:, nothing] == 0)
            assert np.all(curve.residual[nothing] == 0)
    if np.isfinite(LAWS[name].support[1]):
        assert (comparison.verdict.degrees, comparison.verdict.p) == (0, 1.0)


def test_negative_moduli_are_looked_for_as_far_as_the_law_reaches(make_scene):
    """E* is negative from s = 12 on, which exponential heights reach and Gaussian ones do not."""
    falling = Exponential(-1e-5)  # negative above ln(1 + 1e5) = 11.5
    for name, expected in (("exponential", True), ("gaussian", False), ("uniform", False)):
        scene = make_scene(heights=LAWS[name], separations=(1.0,), grading=falling, negative="clip")
        text = "\n".join(cautions(scene))
        assert ("modulus is negative" in text) == expected, name


def test_what_never_touches_is_neither_waited_for_nor_tested(make_scene):
    law = LAWS["beta"]
    scene = make_scene(heights=law, separations=around(law)[3:], n_surfaces=300, grading=None)
    assert forecast(scene.replace(rel_err=0.1)).surfaces < 300
    with pytest.raises(ValueError, match=r"no height reaches d/sigma = .*, so there is nothing to test"):
        converge(scene, seeds=2)


def test_a_figure_of_nothing_is_drawn(ensemble_of):
    """A report with its figures, where nothing at all touches: axes without a logarithm of 0."""
    page = report_html(ensemble_of("uniform", (3.0, 4.0), quantities=("load",)), ATTRIBUTES)
    assert page.count("<svg") == 2
