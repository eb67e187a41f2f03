"""Published figures of asperities and their sums: Gaussian integrals, yield, stiffness, graded surfaces."""

import math

import numpy as np
from from_print_summits import own_radii, surface_of

import analytic
import mcgw

TABOR = 2.8  # hardness over yield strength, as Kogut and Etsion take it
ALPHA = 10.0
SURFACES, STEP = 100, 1.5  # drawn, and ratio of the loads that give an exponent
STIFFER, SOFTER = analytic.Exponential(2.0), analytic.Exponential(0.2)


def mean_pressure_exponential():
    """Ours is P/A over E* √(σ/R) for exponential heights, at h = 1; it does not depend on h."""
    model = analytic.Model(surface_of(ALPHA), heights=analytic.ExponentialHeights())
    unit = math.sqrt(model.surface.sigma / model.surface.radius)
    return float(model.mean("pressure", 1.0) / model.mean("area_fraction", 1.0) / unit)


def table_of_greenwood_tripp(h):
    """F_{5/2}(h)."""
    return float(analytic.fn(2.5, h))


def at_contact_of_mean_planes():
    """Ours is F_{5/2}(0); printed with five digits."""
    return table_of_greenwood_tripp(0.0)


def at_one_sigma():
    """Ours is F_{5/2}(1); printed with five digits."""
    return table_of_greenwood_tripp(1.0)


def at_three_sigma():
    """Ours is F_{5/2}(3); two digits of it are printed."""
    return table_of_greenwood_tripp(3.0)


def engine_fit_at_contact():
    """Ours is F_{5/2}(0): the fit of mixed lubrication is too low where surfaces carry most."""
    return table_of_greenwood_tripp(0.0)


def engine_fit_between():
    """Ours is F_{5/2}(2): where rings run, the fit does best."""
    return table_of_greenwood_tripp(2.0)


def engine_fit_at_the_end():
    """Ours is F_{5/2}(3.5): near its end the fit means nothing."""
    return table_of_greenwood_tripp(3.5)


def _kogut_etsion_pressure(piece, x):
    """Mean pressure of a contact over the yield strength, by the fits of load and area; nu = 0.3."""
    law = analytic.KogutEtsion(critical=1.0)
    y, e = np.array(math.sqrt(x)), np.array(1.0)
    over_hertz = float(law.load(piece, y, e) / law.radius(piece, y, e) ** 2)
    return over_hertz * 2 / 3 * law.yield_factor * TABOR


def pressure_beyond_yield():
    """Ours is 1.03 over 0.93 of the fits of load and area times the pressure at yield: digits of a fit."""
    return _kogut_etsion_pressure(1, 1.0)


def pressure_beyond_six():
    """Ours is the same of the second pair of fits, led back to x = 1."""
    return _kogut_etsion_pressure(2, 6.0) / 6.0**0.117


def pressure_fully_plastic():
    """Ours is the second pair of fits at its end, x = 110: it meets the hardness, the load then jumps."""
    return _kogut_etsion_pressure(2, 110.0)


def yield_by_jackson_green():
    """Ours is the constant C of their law at nu = 0.3."""
    return analytic.JacksonGreen(critical=1.0, yield_strain=0.004).yield_factor


def yield_by_kogut_etsion():
    """Ours is K of their law at nu = 0.3, times 2.8: two fits by others to the same stresses agree."""
    return analytic.KogutEtsion(critical=1.0).yield_factor * TABOR


def range_of_the_stiffness():
    """Ours is P/(K √m0), random curvature, α = 10, p/(E* g) = 0.01, no interaction."""
    model = own_radii(ALPHA)
    pressure = 0.01 * math.sqrt(2)
    return pressure / float(model.mean("stiffness", model.separation_at("pressure", pressure)))


def _exponent(asperities, load):
    """Of the mean stiffness of finite surfaces of one radius about a load per asperity, by Monte Carlo."""
    made = surface_of(ALPHA)
    surface = mcgw.Surface(made.sigma, made.radius, made.eta, asperities / made.eta, made.E_star)
    scene = mcgw.Scene(surface, separations=0.0, n_surfaces=SURFACES, seed=1)
    unit = 4 / 3 * math.sqrt(made.radius) * made.sigma**1.5 * asperities
    found = mcgw.solve(scene, load=[unit * load, unit * STEP * load])
    low, high = (float(np.mean(one.surfaces["stiffness"])) for one in found)
    return math.log(high / low) / math.log(STEP)


def lightest_load():
    """Ours is Hertz's 1/3, one asperity of 100 in contact: a sphere has no roughness of its own."""
    return _exponent(100, 1e-6)


def finite_size():
    """Whether the exponent at one load per asperity rises to 1 with their number."""
    sizes = (100, 10_000, 1_000_000)
    seen = [_exponent(n, 1e-4) for n in sizes]
    text = ", ".join(f"{x:.2f} on {n}" for x, n in zip(seen, sizes, strict=True))
    return seen[0] < 0.5 < seen[1] < 0.85 < seen[2], f"exponent {text} asperities at one pressure"


def stiffer_tips_carry():
    """Ours is F*_{3/2}(4)/F_{3/2}(4), γ = 2: e^{-s} is not yet nothing."""
    return float(analytic.fn(1.5, 4.0, STIFFER) / analytic.fn(1.5, 4.0))


def softer_tips_carry():
    """Ours is the same for γ = 0.2, where the same e^{-s} weighs more."""
    return float(analytic.fn(1.5, 4.0, SOFTER) / analytic.fn(1.5, 4.0))


def index_of_zircaloy():
    """Ours is 0.86 times the load-weighted modulus at d/σ = 4; 2 times 0.86 is 1.72, not 1.8 (errata, 13)."""
    return 0.86 * float(analytic.mean_modulus(4.0, STIFFER))


def spots_conduct():
    """Ours is the conductance of the spots at equal separation, d/σ = 4: γ does not enter (errata, 15)."""
    graded = analytic.Model(surface_of(ALPHA), grading=STIFFER)
    plain = analytic.Model(surface_of(ALPHA))
    return float(graded.mean("conductance", 4.0) / plain.mean("conductance", 4.0))


FIGURES = {
    "mean pressure, exponential heights": mean_pressure_exponential,
    "F_5/2 at h = 0": at_contact_of_mean_planes,
    "F_5/2 at h = 1": at_one_sigma,
    "F_5/2 at h = 3": at_three_sigma,
    "fit of F_5/2 at h = 0": engine_fit_at_contact,
    "fit of F_5/2 at h = 2": engine_fit_between,
    "fit of F_5/2 at h = 3.5": engine_fit_at_the_end,
    "pressure beyond yield": pressure_beyond_yield,
    "pressure beyond 6": pressure_beyond_six,
    "pressure at 110": pressure_fully_plastic,
    "first yield, Jackson and Green": yield_by_jackson_green,
    "first yield, Kogut and Etsion": yield_by_kogut_etsion,
    "range of the stiffness": range_of_the_stiffness,
    "exponent at the lightest load": lightest_load,
    "load of stiffer tips": stiffer_tips_carry,
    "load of softer tips": softer_tips_carry,
    "plasticity index of Zircaloy": index_of_zircaloy,
    "conductance of stiffer tips": spots_conduct,
}
CLAIMS = {"finite size": finite_size}
