"""Every number of the page on Ra and sigma, computed again."""

import math
from pathlib import Path

import numpy as np
import pytest
from oracles.inside import gaussian_transmission
from scipy.integrate import quad
from scipy.optimize import brentq

import analytic
from analytic import SpectralMoments
from mcgw.maps import Spectrum

PAGE = (Path(__file__).parents[2] / "runs" / "ROUGHNESS.md").read_text(encoding="utf-8")
TEXT = " ".join(PAGE.split())

pytestmark = pytest.mark.site
RA = quad(lambda z: 2 * z * math.exp(-z * z / 2) / math.sqrt(2 * math.pi), 0, 40)[0]  # of Rq, Gaussian


def stands(template, *values):
    """Whether the page says this, with the values as many digits as the template gives them."""
    assert template.format(*values) in TEXT, template.format(*values)


def test_ra_and_rq():
    sine = 2 / math.pi * math.sqrt(2)
    stands("Ra/Rq is {:.3f} for Gaussian heights and {:.3f} for a sine", RA, sine)


def load(sigma, d):
    return float(analytic.fn(1.5, d / sigma)) * sigma**1.5


@pytest.mark.parametrize("alpha", ["1.6", "2", "5", "10", "100"])
def test_rows_of_the_table(alpha):
    moments = SpectralMoments(1.0, 1.0, float(alpha))
    sigma = moments.sigma
    ratio = load(RA, 2 * sigma) / load(sigma, 2 * sigma)
    row = f"| {alpha} | {sigma:.3f} | {RA / sigma:.3f} | {moments.mean_height:.3f} | × {ratio:.2f} |"
    assert row in PAGE, row


def test_stiffness_at_a_load():
    """Of one load, the separation of each is found; K = 3/2 F_1/2/F_3/2 P/sigma."""
    sigma = SpectralMoments(1.0, 1.0, 10.0).sigma
    wrong = 1 - RA / sigma
    stands("an error of {:.0f} % in σ (α = 10)", 100 * wrong)
    h = brentq(lambda x: load(RA, x * RA) - load(sigma, 2.0 * sigma), 0, 4)

    def stiffness(spread, x):
        return 1.5 * float(analytic.fn(0.5, x)) * spread**0.5

    assert stiffness(RA, h) / stiffness(sigma, 2.0) == pytest.approx(1.2, abs=0.05)
    stands("one of about {:.0f} % in stiffness", 20)


def test_twice_the_length():
    """Power from the long wave on: Rq^2 ~ L^(2H)."""

    def rms(long):
        q = np.geomspace(2 * np.pi / long, 1e4, 200001)
        return math.sqrt(np.trapezoid(q * q ** (-2 - 1.6), q))

    stands("a line twice as long has {:.2f} times the Ra", rms(2.0) / rms(1.0))


def test_peaks_and_summits():
    """Peaks of a Gaussian profile: second derivatives k > 0, each weighted by k; z given k is m2/m4 k."""
    m = SpectralMoments(1.0, 1.0, 1.0)
    normal = [quad(lambda k, n=n: k**n * math.exp(-k * k / 2), 0, 40)[0] for n in (1, 2)]
    curvature = normal[1] / normal[0]
    stands("the mean radius of peaks is {:.2f} R", 1 / m.radius / curvature)
    per_length = math.sqrt(m.m4 / m.m2) / (2 * math.pi)
    stands("has {:.2f} D² summits per area", m.eta / per_length**2)
    stands("on average only {:.2f} times as high above the mean as summits", curvature / m.mean_height)


def test_a_filter_along_the_line():
    """Waves of every direction: filtered by the length that the line sees, or by their own."""
    spectrum, cutoff = Spectrum(1.0, 100.0, 2.0, 0.8), 10.0
    q = np.geomspace(2 * np.pi / 100, 2 * np.pi / 2, 3001)
    k = np.abs(q[:, None] * np.cos((np.arange(1000) + 0.5) * np.pi / 1000))
    power = q * spectrum.density(q)
    line, plane = gaussian_transmission(k, cutoff) ** 2, gaussian_transmission(q, cutoff)[:, None] ** 2
    m0, m2, m4 = (
        np.trapezoid(power * np.mean(line * k**n, axis=1), q)
        / np.trapezoid(power * np.mean(plane * k**n, axis=1), q)
        for n in (0, 2, 4)
    )
    stands("m0, m2 and m4 are {:.2f}, {:.2f} and {:.2f} times", m0, m2, m4)
    stands("R is {:.0f} % too small", 100 * (1 - 1 / math.sqrt(m4)))
