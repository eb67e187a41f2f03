"""Published figures of thermal contact conductance, in the terms of their authors.

All are of the form h_c σ/(k m) = c (P/H)^n with σ the roughness of the surface, m its mean absolute
slope, k = 2 k1 k2/(k1 + k2), and H a hardness: for elastic contact H_e = E* m/√2 in its place. A spot of
radius a conducts 2 k a, so that h_c = k C ρ/(2 A_n) of the conductance C ρ here, over the factor by
which spots crowd each other.
"""

import math

import numpy as np
from from_print_summits import own_radii, surface_of
from scipy.optimize import brentq
from scipy.stats import truncnorm

import analytic
from analytic.laws import crowding_factor

SLOPE = math.sqrt(2 / math.pi)  # mean absolute slope of profiles with m2 = 1
LIGHT = 1e-3  # P/H, in the middle of the measurements
ALPHA = 10.0
SOFT = 1e-6  # critical penetration over sigma, small enough for fully plastic contact
LOWEST, HIGHEST = -1.0, 8.0  # separations over sigma that are looked at


def truncated(separation, share):
    """h_c σ/(k m) of Cooper, Mikic and Yovanovich, whose spots are cut out of a Gaussian surface.

    Their number is that of the places where the surface passes a plane, (m/σ)²/16 exp(-Y²)/erfc(Y/√2).
    The real area is `share` times what lies above the plane: 1 where it is plastic, 1/2 elastic (Mikic).
    """
    above = float(analytic.fn(0, separation))
    number = math.exp(-(separation**2)) / (32 * above)
    radius = math.sqrt(share * above / (math.pi * number))
    return 2 * number * radius / float(crowding_factor(share * above))


def by_truncation(pressure, share):
    """That at a pressure over the hardness, which is the share of real area."""

    def excess(y):
        return math.log(share * float(analytic.fn(0, y)) / pressure)

    return truncated(brentq(excess, LOWEST, HIGHEST), share)


def conducted(model, h):
    """h_c σ/(k m) of a model of a Gaussian surface with m0 = m2 = 1."""
    plain = model.mean("conductance", h) / (2 * SLOPE)
    return plain / crowding_factor(model.mean("area_fraction", h))


def elastic(model, pressure):
    """That at a pressure over H_e."""
    return float(conducted(model, model.separation_at("pressure", pressure * SLOPE / math.sqrt(2))))


def plastic(model, pressure):
    """That of fully plastic asperities at a pressure over the hardness: the share of real area."""
    return float(conducted(model, model.separation_at("area_fraction", pressure)))


def one_radius(**changes):
    """Greenwood and Williamson's surface of these spectral moments."""
    return analytic.Model(surface_of(ALPHA), **changes)


def exponent(function, model):
    """Slope of ln function(model, pressure) in ln pressure."""
    step = 1.01
    low, high = function(model, LIGHT / step), function(model, LIGHT * step)
    return math.log(high / low) / math.log(step**2)


def mikic_by_mikic():
    """Ours is his model without the fit: the truncation model at half its area. His coefficient is right."""
    return by_truncation(LIGHT, 0.5) / LIGHT**0.94


def mikic_by_summits():
    """Ours is random curvature, α = 10: a model of summits gives what half the truncated area gives."""
    return elastic(own_radii(ALPHA), LIGHT) / LIGHT**0.94


def mikic_by_broad_spectrum():
    """Ours is random curvature, α = 100: his truncated surface knows no bandwidth, ours conducts better."""
    return elastic(own_radii(100.0), LIGHT) / LIGHT**0.94


def mikic_by_one_radius():
    """Ours is Greenwood and Williamson's surface with McCool's parameters, α = 10: the same again."""
    return elastic(one_radius(), LIGHT) / LIGHT**0.94


def mikic_exponent():
    """Ours is the local slope for random curvature, α = 10."""
    return exponent(elastic, own_radii(ALPHA))


def simplified_by_summits():
    """Ours is h_c σ/k over (P/E*)^0.94, random curvature, α = 10, at a slope of 0.1: m^0.06 is left out."""
    slope = 0.1
    pressure = LIGHT * slope / math.sqrt(2)  # over E*
    return slope * elastic(own_radii(ALPHA), LIGHT) / pressure**0.94


def plastic_by_truncation():
    """Ours is their truncation model without the fit."""
    return by_truncation(LIGHT, 1.0) / LIGHT**0.95


def plastic_of_1969():
    """Ours is the same model: the first fit, which Yovanovich replaced, lies below its own model there."""
    return by_truncation(LIGHT, 1.0) / LIGHT**0.985


def plastic_by_summits():
    """Ours is one radius, α = 10, fully plastic by Chang, Etsion and Bogy: more, smaller spots."""
    law = analytic.ChangEtsionBogy(critical=SOFT)
    return plastic(one_radius(law=law), LIGHT) / LIGHT**0.95


def measured_exponent():
    """Ours is the local slope of one radius, fully plastic: their groups leave out the slope m."""
    return exponent(plastic, one_radius(law=analytic.ChangEtsionBogy(critical=SOFT)))


def fit_holds():
    """Whether Mikic's fit is within 5 % of random curvature over four decades of pressure."""
    pressures = (1e-5, 1e-4, 1e-3, 1e-2)
    off = [100 * (elastic(own_radii(ALPHA), p) / (1.55 * p**0.94) - 1) for p in pressures]
    text = ", ".join(f"{d:+.1f} % at {p:.0e}" for d, p in zip(off, pressures, strict=True))
    return max(map(abs, off)) < 5, f"own radii, α = 10: {text} of H_e"


def truncation_conducts():
    """Whether heights that end at 3 sigma conduct better at light load than Gaussian ones."""
    cut = one_radius(heights=analytic.ScipyHeights(truncnorm(-3, 3)))
    ratios = {p: elastic(cut, p) / elastic(one_radius(), p) for p in (1e-6, 1e-5, 1e-4, 1e-3)}
    text = ", ".join(f"{ratio:.2f} at {p:.0e}" for p, ratio in ratios.items())
    values = np.array(list(ratios.values()))
    return bool(np.all(np.diff(values) < 0) and values[0] > 1.1), f"conductance {text} of H_e, α = 10"


FIGURES = {
    "elastic coefficient, Mikic's own model": mikic_by_mikic,
    "elastic coefficient, own radii": mikic_by_summits,
    "elastic coefficient, broad spectrum": mikic_by_broad_spectrum,
    "elastic coefficient, one radius": mikic_by_one_radius,
    "elastic exponent": mikic_exponent,
    "elastic coefficient without m": simplified_by_summits,
    "plastic coefficient, truncation model": plastic_by_truncation,
    "plastic coefficient of 1969": plastic_of_1969,
    "plastic coefficient, one radius": plastic_by_summits,
    "measured exponent, aluminium": measured_exponent,
    "measured exponent, stainless steel": measured_exponent,
}
CLAIMS = {"elastic fit": fit_holds, "truncated heights": truncation_conducts}
