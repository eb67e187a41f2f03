"""F*_n for any grading: closed forms, and quadrature of the definition at 40 digits."""

import math
from dataclasses import replace

import mpmath as mp
import numpy as np
import pytest
from oracles.reference import F, error, graded, integral, pchip, phi

import analytic
from analytic import Clipped, Custom, Exponential, Table

TOLERANCE = 1e-13  # promised for every grading that is resolved; below: where the data do not allow it
H = (-40.0, -9.0, -2.5, -0.5, 0.0, 0.3, 1.7, 4.0, 11.0, 35.0)


def worst(grading, truth, n, h=H):
    values = analytic.fn_scaled(n, h, grading)  # fn itself is subnormal for exp(-3s) at h = 35
    return max(error(v, truth(x) / (phi(x) if x >= 0 else 1)) for v, x in zip(values, h, strict=True))


@pytest.mark.parametrize(("n", "decay"), [(0, 3.0), (0.5, -3.0), (1.5, 1.0), (1.5, 3.0), (6, -3.0)])
def test_pure_exponential(n, decay):
    grading = Custom(lambda s: np.exp(-decay * s))
    closed = mp.exp(mp.mpf(decay) ** 2 / 2)
    assert worst(grading, lambda h: closed * F(n, mp.mpf(h) + decay), n) < TOLERANCE


@pytest.mark.parametrize("n", [0, 1.5])
def test_steep_growth_on_both_sides(n):
    """A closed form above 0; below, the whole integral by quadrature."""
    above = {h: mp.exp(mp.mpf(4.5)) * F(n, mp.mpf(h) - 3) for h in H[4:]}
    truth = above | {h: graded(n, h, lambda s: mp.exp(3 * abs(s)), breaks=[0]) for h in (-9.0, -0.5)}
    assert worst(Custom(lambda s: np.exp(3 * np.abs(s))), truth.get, n, sorted(truth)) < TOLERANCE


@pytest.mark.parametrize(("b", "c"), [(4.0, 1.0), (400.0, 0.62), (0.5, -2.0)])
@pytest.mark.parametrize("n", [0, 1.5])
def test_gaussian_bump(n, b, c):
    def closed(h):
        root, h = mp.sqrt(1 + mp.mpf(b)), mp.mpf(h)
        inside = F(n, root * (h - b * mp.mpf(c) / (1 + mp.mpf(b))))
        return mp.exp(-b * mp.mpf(c) ** 2 / (2 * (1 + mp.mpf(b)))) * root ** (-n - 1) * inside

    bump = Custom(lambda s: np.exp(-b * (s - c) ** 2 / 2))
    assert worst(bump, closed, n, [-3.0, 0.0, 0.5, 0.62, 1.0]) < TOLERANCE


@pytest.mark.parametrize(("n", "declared"), [(0, False), (0.5, True), (1.5, False), (1.5, True)])
def test_jump_and_kink(n, declared):
    grading = Custom(
        lambda s: np.where(s > 1.1, 2.0, 1.0) + np.abs(s - 0.4), breaks=(0.4, 1.1) if declared else ()
    )
    jump, kink = mp.mpf(1.1), mp.mpf(0.4)
    both = (-0.5, 0.3, 4.0) if declared else (-9.0, 0.3)
    truth = {
        h: graded(n, h, lambda s: (2 if s > jump else 1) + abs(s - kink), breaks=[kink, jump]) for h in both
    }
    assert worst(grading, truth.get, n, both) < TOLERANCE


@pytest.mark.parametrize(
    ("centre", "n", "h"),  # last: inside the ramp, a small part of the integral, known to few digits of s
    [(1.7, 1.5, -2.5), (1.7, 1.5, 1.69999), (-0.4, 1.5, -2.5), (-0.4, 1.5, -0.41), (1.7, 0, 1.7 - 3e-7)],
)
def test_ramp_of_a_millionth_of_sigma(centre, n, h):
    steps = (-600, -200, -80, -40, -20, -10, -2, -1, 0, 1, 2, 4, 8, 16, 32, 64, 128, 256, 600)
    cuts = [mp.mpf(centre) + k * mp.mpf(10) ** -7 for k in steps]
    truth = graded(n, h, lambda s: 2 + mp.tanh(10**6 * (s - mp.mpf(centre))), breaks=cuts)
    grading = Custom(lambda s: 2 + np.tanh(1e6 * (s - centre)))
    assert error(analytic.fn(n, h, grading), truth) < TOLERANCE


@pytest.mark.parametrize(("width", "sign"), [(1.0, 1), (0.1, -1), (0.01, 1), (0.01, -1)])
def test_modulus_that_fades_into_rounding_noise(width, sign):
    """1 +- tanh(s/w) has lost its relative digits where it is small: no reason to give up."""
    w = mp.mpf(width)
    cuts = [k * w for k in (-20, -10, -5, -2, -1, 1, 2, 5, 10, 20)]
    grading = Custom(lambda s: 1 + sign * np.tanh(s / width))
    for h in (-3.0, -width):
        truth = graded(1.5, h, lambda s: 1 + sign * mp.tanh(s / w), breaks=cuts)
        assert error(analytic.fn(1.5, h, grading), truth) < TOLERANCE


def test_waves():
    grading = Custom(lambda s: 2 + np.sin(20 * s))
    for h in (-4.0, 0.0, 3.3):
        x, w = np.polynomial.legendre.leggauss(40)
        edges = np.linspace(0, math.sqrt(13 - h), 200)
        v = edges[:-1, None] + np.diff(edges)[:, None] * (1 + x) / 2
        terms = 2 * v**4 * (2 + np.sin(20 * (h + v * v))) * np.exp(-((h + v * v) ** 2) / 2)
        truth = float(np.sum(np.diff(edges)[:, None] / 2 * w * terms)) / math.sqrt(2 * math.pi)
        assert float(analytic.fn(1.5, h, grading)) == pytest.approx(truth, rel=TOLERANCE)


@pytest.mark.parametrize("n", [0, 1.5])
def test_table(n):
    truth = pchip(S, RATIO)
    h = (-1.0, 0.1, 2.9)
    values = analytic.fn(n, h, Table(S, RATIO))
    for x, value in zip(h, values, strict=True):
        assert error(value, graded(n, x, truth, breaks=S)) < TOLERANCE


KNOTS = (-1.0, 0.3, 0.30001, 0.30003, 0.3001, 2.0)
MODULI = (0.5, 0.6, 2.0, 0.8, 1.7, 1.9)
UNDER = {
    "gaussian": (analytic.Gaussian(), lambda s: np.exp(-s * s / 2) / math.sqrt(2 * math.pi), 13.0),
    "exponential": (analytic.ExponentialHeights(), lambda s: np.exp(-1 - s), 60.0),
}


@pytest.mark.parametrize("law", UNDER)
@pytest.mark.parametrize("h", [-0.9, 0.29999, 0.30002, 1.0])
def test_knots_nearer_than_the_points_of_a_rule(h, law):
    """Means, variances and covariances of a load against literal sums piece by piece."""
    heights, density, top = UNDER[law]
    table, upper = Table(KNOTS, MODULI), h + 0.5
    x, w = np.polynomial.legendre.leggauss(40)

    def literal(f, low):
        marks = [low, *(k for k in (*KNOTS, *np.arange(0.5, top, 0.5), top) if k > low)]
        v = np.sqrt(np.array(marks) - low)  # s = low + v^2
        v, dv = v[:-1, None] + np.diff(v)[:, None] * (1 + x) / 2, np.diff(v)[:, None] / 2 * w
        s = low + v * v
        return float(np.sum(2 * v * dv * density(s) * f(s)))

    def load(s, h):
        return np.maximum(s - h, 0) ** 1.5 * table(s)

    first, second = literal(lambda s: load(s, h), h), literal(lambda s: load(s, h) ** 2, h)
    assert float(analytic.fn(1.5, h, table, heights=heights)) == pytest.approx(first, rel=1e-13)
    unit = analytic.Surface(1.0, 1.0, 1.0, 1.0, 0.75)
    model = analytic.Model(unit, grading=table, heights=heights, n_asperities=1.0)
    assert float(model.std("load", h)) ** 2 == pytest.approx(second - first**2, rel=1e-12)
    both = replace(model, count="poisson").covariance(["load"], [h, upper])[0, 0, 0, 1]
    assert both == pytest.approx(literal(lambda s: load(s, h) * load(s, upper), upper), rel=1e-12)


@pytest.mark.parametrize(("gamma", "n"), [(1.5, 0), (1.5, 1.5), (3.0, 0.5), (-0.2, 0), (-0.2, 1.5)])
def test_clipped_exponential(n, gamma):
    law = Clipped.of(Exponential(gamma))
    assert (law.smooth, law.breaks) == (True, (Exponential(gamma).zero,))
    g = mp.mpf(gamma)
    zero = -mp.log(g / (g - 1))
    low, high = (None, zero) if gamma < 0 else (zero, None)
    for h in (-8.0, -0.3, 0.9):
        if gamma < 0 and h >= zero:
            continue
        f = lambda s, h=h: (s - mp.mpf(h)) ** n * (g - (g - 1) * mp.exp(-s))  # noqa: E731
        truth = integral(f, h, low=low if low is not None and low > h else None, high=high)
        # The zero is where float arithmetic puts it; the modulus vanishes there, so it does not count.
        assert error(analytic.fn(n, h, law), truth) < TOLERANCE


def test_clipped_custom_finds_its_own_zero():
    law = Clipped.of(Custom(lambda s: s - 0.3))
    assert not law.smooth
    assert not Clipped(Exponential(2.0)).smooth  # its zero not given
    for h in (-2.0, 0.0, 0.5):
        truth = graded(1.5, h, lambda s: max(s - mp.mpf(0.3), mp.mpf(0)), breaks=[mp.mpf(0.3)])
        assert error(analytic.fn(1.5, h, law), truth) < TOLERANCE


def test_zero_of_the_exponential_grading():
    # theory.md, section 1
    assert [round(Exponential(g).zero, 4) for g in (1.2, 1.5, 2, 3)] == [-1.7918, -1.0986, -0.6931, -0.4055]
    assert all(math.isnan(Exponential(g).zero) for g in (0, 0.5, 1))


def test_bad_functions_are_named_and_numbers_will_do():
    with pytest.raises(ValueError, match="not finite at s = 1"):
        analytic.fn(1.5, 0.0, Custom(lambda s: np.where(s > 1, np.nan, 1.0)))
    with pytest.raises(ValueError, match=r"gave shape \(3,\)"):
        analytic.fn(1.5, 0.0, Custom(lambda _: np.ones(3)))
    doubled = float(analytic.fn(1.5, 0.3, Custom(lambda _: 2.0)))
    assert doubled == pytest.approx(2 * float(analytic.fn(1.5, 0.3)), rel=1e-15)


@pytest.mark.parametrize("gamma", [math.inf, math.nan])
def test_gamma_must_be_finite(gamma):
    with pytest.raises(ValueError, match=r"gamma = .*finite"):
        Exponential(gamma)


# Measured gradings: interpolation and the CSV files they come from


S = (-2.0, -0.7, 0.1, 0.4, 1.5, 3.0)
RATIO = (0.3, 0.6, 0.6, 1.4, 1.1, 2.0)


def csv(tmp_path, text, encoding="utf-8"):
    path = tmp_path / "grading.csv"
    path.write_text(text, encoding=encoding)
    return path


@pytest.mark.parametrize(
    ("s", "ratio"), [(S, RATIO), ((0, 1), (1, 3)), ((0, 1, 2), (5, 1, 1.5)), (S, RATIO[::-1])]
)
def test_interpolant_against_its_definition(s, ratio):
    heights = np.concatenate([np.linspace(-4, 5, 91), s])
    truth = pchip(s, ratio)
    literal = [float(truth(x)) for x in heights]
    # Cubics of order 1 in doubles: some 10 roundings.
    np.testing.assert_allclose(Table(s, ratio)(heights), literal, rtol=1e-14)


def test_clamped_outside_and_monotone_inside():
    table = Table((0.0, 1.0, 1.1, 4.0), (0.2, 0.3, 1.9, 2.0))
    assert table(np.array([-9.0, 9.0])).tolist() == [0.2, 2.0]
    assert np.all(np.diff(table(np.linspace(0, 4, 401))) > 0)
    assert table.breaks == (0.0, 1.0, 1.1, 4.0)
    assert table.smooth


@pytest.mark.parametrize(("s", "ratio", "message"), [
    ((0,), (1,), "two or more points, as many s as ratio, not 1 and 1"),
    ((0, 1), (1, 2, 3), "not 2 and 3"),
    ((0, math.nan), (1, 2), "must be finite"),
    ((0, 1), (1, math.inf), "must be finite"),
    ((0, 0), (1, 2), "must increase"),
    ((1, 0), (1, 2), "must increase"),
])  # fmt: skip
def test_points_that_make_no_curve(s, ratio, message):
    with pytest.raises(ValueError, match=message):
        Table(s, ratio)


@pytest.mark.parametrize(
    "text",
    [
        "s,ratio\n0,0.5\n2,1.5\n",
        "s,E_star\n0,1e9\n2,3e9\n",
        "z,ratio\n0,0.5\n4e-6,1.5\n",
        "z,E_star\n0,1e9\n4e-6,3e9\n",
        "s , ratio\r\n 2, 1.5\r\n\r\n0,0.5\r\n",  # spaces, empty lines, another order
    ],
)
def test_every_header(tmp_path, text):
    encoding = "utf-8-sig" if "z" in text else "utf-8"
    table = Table.from_csv(csv(tmp_path, text, encoding), sigma=2e-6, E_star=2e9)
    assert table.s == pytest.approx((0, 2), rel=1e-15)
    assert table.ratio == pytest.approx((0.5, 1.5), rel=1e-15)


@pytest.mark.parametrize(("text", "message"), [
    ("height,ratio\n0,1\n", "the first line must be s or z, a comma, and ratio or E_star"),
    ("ratio,s\n0,1\n", "the first line must be"),
    ("s\n0\n", "the first line must be"),
    ("s,ratio,note\n0,1,2\n", "the first line must be"),
    ("0,0.5\n2,1.5\n", "the first line must be"),
    ("", "the first line must be"),
    ("s,ratio\n0,0.5\n1\n", "every line below the header must be two numbers"),
    ("s,ratio\n0,0.5\n1,2,3\n", "two numbers"),
    ("s,ratio\n0,0.5\n1,stiff\n", "two numbers"),
    ("s,ratio\n0,1\n1,nan\n", "must be finite"),
])  # fmt: skip
def test_every_mistake_in_a_file_is_named(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        Table.from_csv(csv(tmp_path, text), sigma=2e-6, E_star=2e9)


def test_what_is_no_file_of_a_table_is_told(tmp_path):
    for path, told in (
        (tmp_path / "none.csv", "none.csv: no such file"),
        (tmp_path, "is not a regular file"),
    ):
        with pytest.raises(ValueError, match=told):
            Table.from_csv(path, sigma=2e-6, E_star=2e9)
