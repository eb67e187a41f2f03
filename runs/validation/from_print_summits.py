"""Published figures of Gaussian surfaces: their summits, and the real area at light load."""

import math

import numpy as np
from scipy.optimize import brentq

import analytic

HIGHEST = 12.0  # no summit to speak of lies as many sqrt(m0) above the mean plane
ALPHAS = np.array([2.0, 5.0, 10.0, 20.0, 50.0, 100.0])


def surface_of(alpha):
    """Parameters by McCool of a Gaussian surface with m0 = m2 = 1, E* = 1 and unit area."""
    return analytic.SpectralMoments(1.0, 1.0, alpha).surface(1.0, 1.0)


def own_radii(alpha):
    """The same surface with Nayak's heights, each summit having its own radius."""
    return analytic.Model(
        surface_of(alpha), heights=analytic.Nayak(alpha), curvature=analytic.RandomCurvature(alpha)
    )


def kappa(model, h):
    """Real area over load: A/A_n times E* g over the pressure, g = sqrt(2 m2) the slope of the surface."""
    return math.sqrt(2) * model.mean("area_fraction", h) / model.mean("pressure", h)


def kappa_at_pressure(alpha, pressure):
    """That at a given pressure over E* g."""
    model = own_radii(alpha)
    return float(kappa(model, model.separation_at("pressure", pressure * math.sqrt(2))))


def kappa_at_area(alpha, share):
    """That at a given share of real area."""
    model = own_radii(alpha)
    return float(kappa(model, model.separation_at("area_fraction", share)))


def _moments_of_heights(alpha):
    """Mean and variance of Nayak's density of summit heights over sqrt(m0), by quadrature."""
    law = analytic.Nayak(alpha)
    x, w = np.polynomial.legendre.leggauss(400)
    height = HIGHEST * x
    weight = HIGHEST * w * law.pdf((height - law.mean) / law.std) / law.std
    mean = weight @ height
    return mean, weight @ (height - mean) ** 2


def mean_height():
    """Ours is the mean of the density of summit heights, by quadrature at α = 5."""
    return float(_moments_of_heights(5.0)[0] * math.sqrt(5.0))


def spread_of_heights():
    """Ours is α times what the variance of that density, by quadrature at α = 5, lacks of m0."""
    return float(5.0 * (1 - _moments_of_heights(5.0)[1]))


def distance_of_planes():
    """Ours is η R times the mean height of the summits, from m0, m2, m4."""
    moments = analytic.SpectralMoments(1.0, 1.0, 5.0)
    return moments.eta * moments.radius * moments.mean_height


def variance_lost():
    """Ours is (η R)² (m0 - σ²), from m0, m2, m4; printed with four digits."""
    moments = analytic.SpectralMoments(1.0, 1.0, 5.0)
    return (moments.eta * moments.radius) ** 2 * (moments.m0 - moments.sigma**2)


def bandwidth_of_product():
    """Ours is α over (η R √m0)²: one product of the three parameters fixes the whole Gaussian surface."""
    moments = analytic.SpectralMoments(1.0, 1.0, 5.0)
    return moments.alpha / (moments.eta * moments.radius) ** 2


def limit_of_kappa():
    """Ours is random curvature at α = 2, seven separations up to 36 √m0 led on in 1/x² to infinity."""
    law = analytic.Nayak(2.0)
    x = np.array([12.0, 15.0, 18.0, 21.0, 25.0, 30.0, 36.0])
    seen = kappa(own_radii(2.0), (x - law.mean) / law.std)
    others = [np.delete(x**-2, k) for k in range(x.size)]
    weights = [np.prod(o / (o - t)) for o, t in zip(others, x**-2, strict=True)]
    return float(np.dot(weights, seen))


def limit_against_persson():
    """Ours is the same limit: asperity models and Persson differ by the factor π/2 at vanishing load."""
    return limit_of_kappa()


def kappa_of_simulations():
    """Ours is random curvature, α = 10, p/(E* g) = 0.01: no interaction, and no spots that merge."""
    return kappa_at_pressure(10.0, 0.01)


def kappa_of_the_challenge():
    """Ours is random curvature, α = 33, p/(E* g) = 0.01: a broad spectrum is where asperities mislead."""
    return kappa_at_pressure(33.0, 0.01)


def falls_with_alpha():
    """Whether kappa at 1 % of real area falls in proportion to ln alpha, and its values."""
    seen = np.array([kappa_at_area(alpha, 0.01) for alpha in ALPHAS])
    slope, _ = np.polyfit(np.log(ALPHAS), seen, 1)
    straight = np.corrcoef(np.log(ALPHAS), seen)[0, 1]
    values = ", ".join(f"{k:.2f}" for k in seen)
    text = (
        f"in form: κ = {values} at α = {', '.join(f'{a:g}' for a in ALPHAS)} and A/A_n = 1 %, {slope:.2f} "
        f"for each unit of ln α (correlation {straight:.3f}); boundary elements fall less steeply"
    )
    return bool(straight < -0.98), text


def _share_where_linear(alpha):
    """Share of real area at which kappa is 10 % below its limit."""
    law, model = analytic.Nayak(alpha), own_radii(alpha)

    def short(x):
        return float(kappa(model, (x - law.mean) / law.std)) - 0.9 * math.sqrt(2 * math.pi)

    x = brentq(short, 1.0, 25.0, xtol=1e-2)
    return float(model.mean("area_fraction", (x - law.mean) / law.std))


def needs_vanishing_area():
    """Whether the share of real area below which kappa is within 10 % of its limit falls to nothing."""
    shares = [_share_where_linear(alpha) for alpha in (2.0, 10.0, 100.0)]
    text = "within 10 % of the limit below A/A_n = {:.0e}, {:.0e} and {:.0e} at α = 2, 10, 100"
    return shares[1] < 1e-4 and shares[2] < 1e-9, text.format(*shares)


FIGURES = {
    "mean height of the summits": mean_height,
    "spread of the summit heights": spread_of_heights,
    "distance of the mean planes": distance_of_planes,
    "variance of summits and of surface": variance_lost,
    "bandwidth from η R σ": bandwidth_of_product,
    "area over load, vanishing load": limit_of_kappa,
    "area over load, Persson": limit_against_persson,
    "area over load, simulations": kappa_of_simulations,
    "area over load, challenge": kappa_of_the_challenge,
}
CLAIMS = {"broad spectra": falls_with_alpha, "linear range": needs_vanishing_area}
