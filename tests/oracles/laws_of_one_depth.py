"""Contact laws typed anew, of one depth d (over sigma) and one modulus e (over E*): load and area.

Loads are over that of Hertz at d = 1 and e = 1, areas over the area there. Constants are those of `critical`
depth, yield `strain` or pull-off `stretch` at e = 1; `ratio` is R/sigma, or the moduli of coating and body.
"""

from math import atan, cos, exp, gamma, log, log1p, pi, sin, sqrt

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq


def kogut_etsion(d, e=1.0, critical=0.05, k=0.577):
    """Numbers or arrays; `k` is 0.454 + 0.41 nu."""
    dc = critical / e**2
    x, pc = np.maximum(d, 0) / dc, e * dc**1.5
    pieces = [x < 1, x < 6, x < 110]
    load = np.select(pieces, [x**1.5, 1.03 * x**1.425, 1.40 * x**1.263], 3 / k * x)
    return pc * load, dc * np.select(pieces, [x, 0.93 * x**1.136, 0.94 * x**1.146], 2 * x)


def unloaded_kogut_etsion(d, deepest, critical):
    """Load on the way back from the deepest, by Etsion, Kligerman and Kadin (2005)."""
    x = deepest / critical
    left = deepest * (1 - x**-0.28) * (1 - x**-0.69)
    return kogut_etsion(deepest, 1, critical)[0] * ((d - left) / (deepest - left)) ** (1.5 * x**-0.0331)


def chang_etsion_bogy(d, e=1.0, critical=0.5):
    dc = critical / e**2
    return (e * d**1.5, d) if d < dc else (1.5 * e * sqrt(dc) * (2 * d - dc), 2 * d - dc)


def zhao_maietta_chang(d, e=1.0, critical=0.05):
    """Fully plastic beyond 54 times the depth of yield, at a mean pressure of 0.4 H at yield."""
    dc = critical / e**2
    t, hardness = (d - dc) / (53 * dc), 1 / 0.4 * e * sqrt(dc)
    if t < 0:
        return e * d**1.5, d
    area = d * (1 + min(t, 1) ** 2 * (3 - 2 * min(t, 1)))
    return area * hardness * min(1 - 0.6 * log(54 * dc / d) / log(54), 1), area


def yields_at(strain, nu=0.3, ratio=1000.0):
    """Critical depth of Jackson and Green at e = 1."""
    return (pi * 1.295 * exp(0.736 * nu) * strain / 2) ** 2 * ratio


def jackson_green(d, e=1.0, strain=0.004, nu=0.3, ratio=1000.0):
    ey, c = strain / e, 1.295 * exp(0.736 * nu)
    dc = yields_at(ey, nu, ratio)
    x = d / dc
    if x < 1.9:
        return e * d**1.5, d
    a2 = d * (x / 1.9) ** (0.14 * exp(23 * ey))
    hardness = 2.84 * (1 - exp(-0.82 * sqrt(a2 / ratio) ** -0.7))  # a/R = sqrt(a2 sigma/R)
    force = exp(-(x ** (5 / 12)) / 4) * x**1.5 + 4 * hardness / c * (1 - exp(-(x ** (5 / 9)) / 25)) * x
    return e * dc**1.5 * force, a2


def coated(d, e=1.0, thickness=0.5, ratio=3.0, nu=0.3):
    def stiffness(y):
        x = thickness / y
        mixed = (1 - 2 * nu) * x * log1p(x**-2) - x / (1 + x * x)
        return y * (1 + (ratio - 1) * (2 / pi * atan(x) + mixed / (2 * pi * (1 - nu))))

    return 1.5 * e * quad(lambda y: 2 * y * stiffness(y), 0, sqrt(d), epsabs=0, epsrel=1e-12)[0], d


def power_law_graded(d, e=1.0, k=0.5, depth=2.0, nu=0.3):
    b = sqrt((1 + k) * (1 - k * nu / (1 - nu)))
    c = 2 ** (1 + k) * gamma((3 + k + b) / 2) * gamma((3 + k - b) / 2) / (pi * gamma(2 + k))
    h = 2 * (1 + k) * cos(k * pi / 2) * gamma(1 + k / 2)
    h /= sqrt(pi) * c * b * sin(b * pi / 2) * gamma((1 + k) / 2)
    a = sqrt((1 + k) * d)
    return 3 * h / depth**k * e * a ** (3 + k) / ((1 + k) ** 2 * (3 + k)), a * a


def johnson_kendall_roberts(d, e=1.0, stretch=0.3):
    third = stretch / e ** (2 / 3) / 3
    z = brentq(lambda z: third * (z**4 - 4 * z) - d, 4 ** (1 / 3), 20, xtol=1e-15, rtol=1e-15)
    return e * third**1.5 * (z**6 - 6 * z**3), third * z**4
