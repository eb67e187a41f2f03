"""Measured gradings: interpolation and the CSV files they come from."""

import math

import numpy as np
import pytest
from reference import pchip

from analytic import Table

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


@pytest.mark.parametrize(
    ("s", "ratio", "message"),
    [
        ((0,), (1,), "two or more points, as many s as ratio, not 1 and 1"),
        ((0, 1), (1, 2, 3), "not 2 and 3"),
        ((0, math.nan), (1, 2), "must be finite"),
        ((0, 1), (1, math.inf), "must be finite"),
        ((0, 0), (1, 2), "must increase"),
        ((1, 0), (1, 2), "must increase"),
    ],
)
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
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_every_header(tmp_path, text, encoding):
    table = Table.from_csv(csv(tmp_path, text, encoding), sigma=2e-6, E_star=2e9)
    assert table.s == pytest.approx((0, 2), rel=1e-15)
    assert table.ratio == pytest.approx((0.5, 1.5), rel=1e-15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("height,ratio\n0,1\n", "the first line must be s or z, a comma, then ratio or E_star"),
        ("ratio,s\n0,1\n", "the first line must be"),
        ("s\n0\n", "the first line must be"),
        ("s,ratio,note\n0,1,2\n", "the first line must be"),
        ("0,0.5\n2,1.5\n", "the first line must be"),
        ("", "the first line must be"),
        ("s,ratio\n0,0.5\n1\n", "every line below the header must be two numbers"),
        ("s,ratio\n0,0.5\n1,2,3\n", "two numbers"),
        ("s,ratio\n0,0.5\n1,stiff\n", "two numbers"),
        ("s,ratio\n", "two or more points"),
        ("s,ratio\n0,1\n0,2\n", "must increase"),
        ("s,ratio\n0,1\n1,nan\n", "must be finite"),
    ],
)
def test_every_mistake_is_named(tmp_path, text, message):
    with pytest.raises(ValueError, match=message):
        Table.from_csv(csv(tmp_path, text), sigma=2e-6, E_star=2e9)
