"""Errata of the paper, each with a proof by numbers: ``python runs/errata.py``.

The right-hand sides are integrals by ``scipy.integrate.quad`` of the definition, which knows nothing
of the code that is tested; the page ``runs/ERRATA.md`` says what is wrong in words.
"""

import numpy as np
from scipy.integrate import quad

import analytic


def integral(n, h, gamma):
    """F*_n(h) of Eq. (7) by adaptive quadrature in v = sqrt(s - h)."""

    def integrand(v):
        s = h + v * v
        return 2 * v ** (2 * n + 1) * (gamma - (gamma - 1) * np.exp(-s)) * np.exp(-s * s / 2)

    return quad(integrand, 0, 6, epsabs=0, epsrel=1e-12, limit=200)[0] / np.sqrt(2 * np.pi)


def eq_8(h, gamma, lower, sign):
    """Eq. (8) for n = 3/2 from t = lower; the sign of the square is +1 as printed, -1 corrected."""

    def integrand(x):  # x = -ln t
        return (x - h) ** 1.5 * (gamma - (gamma - 1) * np.exp(-x)) * np.exp(sign * x * x / 2)

    return quad(integrand, h, -np.log(lower), epsabs=0, limit=200)[0] / np.sqrt(2 * np.pi)


def eq_9(h, gamma, points, shift):
    """Eq. (9) for n = 3/2; shift is exp(-h/2) as printed, exp(-h) corrected; nodes with s < h are lost."""
    x, w = np.polynomial.legendre.leggauss(points)
    t = shift * (1 + x) / 2
    good = -np.log(t) > h
    s = -np.log(t[good])
    terms = (s - h) ** 1.5 * np.exp(-s * s / 2) * (gamma - (gamma - 1) * t[good]) / t[good]
    return terms @ w[good] * shift / 2 / np.sqrt(2 * np.pi), 1 - good.mean()


def proofs():
    """Yield for each erratum: the equation, what is printed, what holds, and where."""
    h, gamma = 1.0, 1.5
    e = analytic.Exponential
    yield (
        "3",
        "no closed form",
        "there is one",
        f"F_1(1) = phi(1) - F_0(1): {float(analytic.fn(1, 1.0)):.15f}",
    )
    for lower in (1e-4, 1e-8):
        yield (
            "8",
            f"{eq_8(h, gamma, lower, +1):.3g}",
            f"{eq_8(h, gamma, lower, -1):.9f}",
            f"from t = {lower:g}",
        )
    for at in (0.5, 4.0):
        lost = eq_9(at, gamma, 64, np.exp(-at / 2))[1]
        yield "9", f"{lost:.0%} of the nodes give NaN", "none does", f"h = {at:g}"
    at = -2.0
    wrong = eq_9(at, gamma, 64, np.exp(-at / 2))[0] / integral(1.5, at, gamma) - 1
    right = eq_9(at, gamma, 64, np.exp(-at))[0] / integral(1.5, at, gamma) - 1
    yield "9", f"{wrong:+.2%} off", f"{right:+.1e} off", "h = -2"
    by_load = float(analytic.mean_modulus(0.0, e(2.0)))
    yield "13", "psi ratio 1.000 (s = d)", f"{by_load:.3f} by load", "h = 0, gamma = 2"
    step = 1e-4
    slope = (integral(1.5, h - step, gamma) - integral(1.5, h + step, gamma)) / (2 * step)
    half = integral(0.5, h, gamma)
    yield (
        "14",
        f"-8/3 F* = {-8 / 3 * half:.6f}",
        f"+4 F* = {4 * half:.6f}",
        f"-8/3 dF*/dh = {8 / 3 * slope:.6f}",
    )
    yield "14", f"stray 1/sqrt(2 pi) = {1 / np.sqrt(2 * np.pi):.5f}", "1", "line 1, printed over true"
    for g in (0.2, 2.0):
        paper = integral(0.5, h, g) / integral(0.5, h, 1.0)
        yield (
            "15",
            f"C ratio {paper:.3f}",
            "1: spots conduct by size",
            f"equal separation h = 1, gamma = {g:g}",
        )
        load = float(analytic.ratio_at_equal_load("conductance", 2.0, e(g)))
        paper = integral(0.5, 2.0, g) / integral(0.5, 2.0, 1.0)
        yield "15", f"C ratio {paper:.3f}", f"{load:.3f}", f"equal load, h = 2, gamma = {g:g}"
    ratio = integral(1.5, 0.0, 1.0) / integral(1.5, 0.0, 0.5)
    yield "12", "no effect above gamma = 0.5", f"ratio {ratio:.3f}", "h = 0, gamma = 0.5"
    low = -2.0
    pushes = analytic.fn(1.5, low, analytic.Clipped(e(2.0)))
    pulls = float(1 - integral(1.5, low, 2.0) / pushes)
    yield "4", "gamma > 1 at any s", f"{pulls:.1%} pulls", "load at h = -2, gamma = 2"


def main():
    """Print the table."""
    print(f"{'Eq.':>4}  {'the paper':32} {'true':26} where")
    for equation, printed, true, where in proofs():
        print(f"{equation:>4}  {printed:32} {true:26} {where}")


if __name__ == "__main__":
    main()
