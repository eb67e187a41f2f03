"""Weights of a wave of a profile in the moments of a filtered surface, by quadrature of their definition."""

import mpmath


def by_quadrature(x, order):
    """m0, m2 or m4 of a wave k = 1 of a profile, with a = x^2: derivatives under an integral."""
    with mpmath.workdps(25):
        a = mpmath.mpf(x) ** 2

        def under(r):  # cos(r) r exp(-r^2/(4a))/(2a), differentiated so often by a
            first = r * r / (4 * a * a) - 1 / a
            factor = (1, first, first**2 - r * r / (2 * a**3) + 1 / a**2)[order]
            return mpmath.cos(r) * mpmath.exp(-r * r / (4 * a)) * r / (2 * a) * factor

        whole = mpmath.quad(under, mpmath.linspace(0, 18 * mpmath.sqrt(a), 5))
        return float((1, mpmath.mpf(-1) / 2, mpmath.mpf(3) / 8)[order] * whole)
