"""Contact laws typed in, independent of those of `analytic.laws`, and what tests of models share."""

from dataclasses import dataclass

import numpy as np

from analytic import ContactLaw, Exponential, Homogeneous, Surface, quantity_of
from analytic.laws import CustomLaw

SURFACE = Surface(sigma=1e-6, radius=1e-5, eta=1e9, nominal_area=1e-6, E_star=1e9)
GRADINGS = {
    "uniform": Homogeneous(), "no tips": Exponential(0.0), "soft tips": Exponential(0.2),
    "stiff tips": Exponential(2.0),
}  # fmt: skip


def kogut_etsion(critical=0.05):
    """Kogut and Etsion (2002) with nu = 0.3: K = 0.577."""
    return CustomLaw(
        load=(
            lambda u: u**3,
            lambda u: 1.03 * u**2.85,
            lambda u: 1.40 * u**2.526,
            lambda u: 3 / 0.577 * u**2,
        ),
        area=(lambda u: u**2, lambda u: 0.93 * u**2.272, lambda u: 0.94 * u**2.292, lambda u: 2 * u**2),
        limits=(1.0, 6.0, 110.0),
        critical=critical,
    )


def chang_etsion_bogy(critical):
    """Chang, Etsion and Bogy (1987): the load jumps by a half at yield, the area is continuous."""
    return CustomLaw(
        load=(lambda u: u**3, lambda u: 1.5 * (2 * u * u - 1)),
        area=(lambda u: u**2, lambda u: 2 * u * u - 1),
        limits=(1.0,),
        critical=critical,
    )


OWN = kogut_etsion()


X, W = np.polynomial.legendre.leggauss(30)


def over_pieces(f, edges):
    """Integral of f(s) by Gauss's rule on each of the pieces between the edges, all of them at once."""
    a, b = (np.array(x)[:, None] for x in (edges[:-1], edges[1:]))
    return float(np.sum((b - a) / 2 * W * f(a + (b - a) * (1 + X) / 2)))


def reduced(model, quantity, h):
    """Mean of one asperity over the scale."""
    return np.asarray(model.mean(quantity, h)) / model.number / quantity_of(quantity).scale(SURFACE)


def differences(model, quantity, h, step=4e-3):
    """-d mean/dh by differences of the eighth order: the mean is smooth, jumps are smeared over heights."""
    k, weights = step * np.array([1, 2, 3, 4]), np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280]) / step
    return float((model.mean(quantity, h - k) - model.mean(quantity, h + k)) @ weights)


@dataclass(frozen=True)
class HalfSpace(ContactLaw):
    """A half-space whose modulus grows with the depth to the power k, over its own factor."""

    k: float = 0.25

    name = "by hand: graded half-space"
    root = False

    def load(self, piece, y, e):  # noqa: ARG002
        return e * y ** (3 + self.k)

    def radius(self, piece, y, e):  # noqa: ARG002
        return y + 0 * e


@dataclass(frozen=True)
class Film(ContactLaw):
    """Hertz's contact whose "radius" is its conductance behind a film: y^2/(y + b)."""

    b: float = 0.1

    name = "by hand: film"

    def radius(self, piece, y, e):  # noqa: ARG002
        return y * y / (y + self.b) + 0 * e
