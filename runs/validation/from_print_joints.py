"""Published figures of thermal joints with gas in the gap: approximations of its integral, handbook data.

Handbooks name a finish, a pressure and a resistance. What they leave out: the finish is the rms height of
each surface, both are flat, their slope is 0.124 (σ/µm)^0.743 (Antonetti; recalled), α = 10. Spots are fully
plastic, which metals at these loads nearly are. A figure within a factor of two is what to expect.
"""

import math
from dataclasses import dataclass

import numpy as np
from from_print_conductance import ALPHA, SOFT
from scipy.special import erfcinv

import analytic
from analytic.joint import gap_integral
from analytic.laws import crowding_factor

AIR = {"conductivity": 0.026, "jump": 0.37e-6}
HOT_AIR = {"conductivity": 0.035, "jump": 0.55e-6}  # 150 °C
HELIUM = {"conductivity": 0.152, "jump": 2.0e-6}
HYDROGEN = {"conductivity": 0.182, "jump": 2.2e-6}


@dataclass(frozen=True)
class Metal:
    """Conductivity (W/(m K)), hardness of a small indent (Pa), composite modulus (Pa); recalled."""

    conductivity: float
    hardness: float
    modulus: float = 1e11


ALUMINIUM, COPPER, STEEL = Metal(180.0, 1.3e9, 39e9), Metal(390.0, 1.1e9, 66e9), Metal(25.0, 3.5e9, 110e9)


def joint(metal, roughness, pressure, gas):
    """h_j, W/(m² K), of two surfaces of one metal, each of this rms height (m)."""
    rms = math.sqrt(2) * roughness
    slope = math.sqrt(2) * 0.124 * (roughness * 1e6) ** 0.743
    m2 = math.pi / 2 * slope**2  # of a mean absolute slope
    moments = analytic.SpectralMoments(rms**2, m2, ALPHA * m2**2 / rms**2)
    surface = moments.surface(1.0, metal.modulus)
    law = analytic.ChangEtsionBogy(critical=SOFT)
    model = analytic.Model(surface, law=law)
    share = pressure / metal.hardness
    h = model.separation_at("area_fraction", share)
    spots = model.mean("conductance", h) / (2 / metal.conductivity)
    gap = analytic.Joint(gas, rms=rms).gap(surface, analytic.Gaussian())
    return float(spots / crowding_factor(share) + gap(h))


def gap_between():
    """Ours is the integral itself, at Y = 3, M = 0.1."""
    return float(gap_integral(np.array(3.0), 0.1))


def gap_rarefied():
    """Ours is the integral itself, at Y = 2, M = 2."""
    return float(gap_integral(np.array(2.0), 2.0))


def gap_close():
    """Ours is the integral itself, at Y = 2, M = 0.01, the far corner of the fit."""
    return float(gap_integral(np.array(2.0), 0.01))


def distance():
    """Ours is where the share of a Gaussian surface above the plane is P/H = 1e-3."""
    return math.sqrt(2) * float(erfcinv(2e-3))


def square():
    """Ours is what a joint of a square keeps at infinite load, from the stiffness of its body."""
    surface = analytic.Surface(sigma=1e-6, radius=1e-5, eta=1e10, nominal_area=1.0, E_star=1.0)
    compliance = analytic.Interaction("body").compliance(surface, 1.0)
    return compliance / 2  # the mean temperature of each body, E* being 1


def aluminium_air():
    """Ours is as the module says, σ = 10 µm each: the gap of the model is wider than that of the table."""
    return joint(ALUMINIUM, 10e-6, 1e5, AIR)


def aluminium_helium():
    """Ours is the same joint: helium less air gives a mean gap of 21 µm in print, of 51 µm here."""
    return joint(ALUMINIUM, 10e-6, 1e5, HELIUM)


def aluminium_hydrogen():
    """Ours is the same joint: hydrogen less air gives 15 µm in print."""
    return joint(ALUMINIUM, 10e-6, 1e5, HYDROGEN)


def ground_aluminium():
    """Ours is at 1.8 MPa, and flat: ground bars that are not touch in part of their area."""
    return joint(ALUMINIUM, 2.54e-6, 1.8e6, HOT_AIR)


def fine_aluminium():
    """Ours is at 1.8 MPa, and flat: ground bars that are not touch in part of their area."""
    return joint(ALUMINIUM, 0.25e-6, 1.8e6, HOT_AIR)


def ground_steel():
    """Ours is at 1.4 MPa; the air alone gives half of it."""
    return joint(STEEL, 2.54e-6, 1.4e6, HOT_AIR)


def ground_copper():
    """Ours is at 5 MPa, and flat: ground bars that are not touch in part of their area."""
    return joint(COPPER, 1.27e-6, 5e6, AIR)


FIGURES = {
    "gap integral, Y = 3, M = 0.1": gap_between,
    "gap integral, Y = 2, M = 2": gap_rarefied,
    "gap integral, Y = 2, M = 0.01": gap_close,
    "distance of the mean planes at P/H = 0.001": distance,
    "square under uniform flux": square,
    "aluminium, 10 µm, 0.1 MPa, air": aluminium_air,
    "aluminium, 10 µm, 0.1 MPa, helium": aluminium_helium,
    "aluminium, 10 µm, 0.1 MPa, hydrogen": aluminium_hydrogen,
    "aluminium, ground, 2.54 µm, air": ground_aluminium,
    "aluminium, ground, 0.25 µm, air": fine_aluminium,
    "stainless steel 416, ground, 2.54 µm, air": ground_steel,
    "copper, ground, 1.27 µm, air": ground_copper,
}
CLAIMS = {}
