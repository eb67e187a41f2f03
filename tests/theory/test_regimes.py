"""Heights where a contact law changes its piece: against closed forms and the literal comparison."""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

from analytic import Clipped, ContactLaw, Custom, Exponential, Homogeneous, Table
from analytic.laws import Branch, piece_of


class Yielding(ContactLaw):
    """Pieces of Hertz that begin at multiples of a penetration, softer asperities deeper."""

    def __init__(self, *limits):
        self.penetrations = np.array(limits)

    def limits(self, e):
        return self.penetrations.reshape(-1, *[1] * np.ndim(e)) / np.asarray(e) ** 2


def listed(regimes, k=0):
    here = regimes.separation == k
    return list(zip(regimes.low[here], regimes.high[here], regimes.piece[here], strict=True))


def test_soft_tips_yield_between_two_heights_or_nowhere():
    """gamma = 0: e = exp(-s), and s - dc exp(2 s) is highest, -(1 + log(2 dc))/2, at s = -log(2 dc)/2."""
    dc = 0.05
    highest = -(1 + math.log(2 * dc)) / 2
    assert highest == pytest.approx(0.65129, abs=1e-5)
    h = np.array([0.6, highest - 1e-14, highest + 1e-14])
    regimes = Branch(Yielding(dc)).regimes(Exponential(0.0), h, -1.0, 13.0)

    def gap(s, level):
        return s - level - dc * math.exp(2 * s)

    top = -math.log(2 * dc) / 2
    (_, one, _), (_, two, _), _ = listed(regimes)
    assert one == pytest.approx(brentq(gap, h[0], top, (h[0],), xtol=1e-15), abs=4e-15)
    assert two == pytest.approx(brentq(gap, top, 13, (h[0],), xtol=1e-15), abs=4e-15)
    assert [piece for *_, piece in listed(regimes)] == [0, 1, 0]
    (_, one, _), (_, two, _), _ = listed(regimes, 1)
    assert two - one == pytest.approx(2 * math.sqrt(1e-14), rel=0.05)  # the curvature there is -2
    assert [piece for *_, piece in listed(regimes, 2)] == [0]


def bumpy(s):
    return 1 + 0.3 * np.sin(3 * s)


GRADINGS = {
    "no tips": Exponential(0.0),
    "clipped": Clipped(Exponential(3.0)),
    "table": Table([-1.0, 0.0, 0.7, 1.5], [0.4, 1.0, 0.3, 2.0]),
    "jump at a break": Custom(lambda s: np.where(s >= 1, 0.4, 1.0), breaks=(1.0,)),
    "untold jump": Custom(lambda s: np.where(s > 1.1, 0.4, 1.0)),
    "untold kink": Custom(lambda s: 0.3 + np.abs(s - 0.7)),
    "waves": Custom(bumpy),
}


@pytest.mark.parametrize("name", GRADINGS)
def test_regimes_are_what_the_literal_comparison_says(name):
    """On random heights, and on the last floating-point numbers on either side of every end."""
    grading, law = GRADINGS[name], Yielding(0.05, 0.3)
    h = np.array([-1.3, 0.0, 0.05, 0.6, 1.0, 1.0 + 1e-9, 2.5])
    low, high = -0.6, 6.0
    regimes = Branch(law).regimes(grading, h, low, high)
    rng = np.random.default_rng(20240603)
    for k in range(h.size):
        rows = listed(regimes, k)
        assert rows[0][0] == max(h[k], low)
        assert rows[-1][1] == high
        for (_, end, _), (start, *_) in pairwise(rows):
            assert end == start
        for a, b, piece in rows:
            s = rng.uniform(a, b, 2000)
            margin = 20 * np.spacing(max(abs(a), abs(b), abs(h[k])))  # ends that near another are that one
            s = np.append(s[(s > a + margin) & (s < b - margin)], [a + margin, b - margin])
            if b - a > 3 * margin:
                assert np.all(piece_of(law, s - h[k], grading(s)) == piece)


JUMPS = {  # moduli, and where they are elastic again: where dc/e^2 = 1.875, or 3.33 on 1/500 of a height
    "at a break": (Custom(lambda s: np.where(s >= 1, 0.4, 1.0), breaks=(1.0,)), (1.0, 2.075)),
    "behind a break": (Custom(lambda s: np.where(s > 1, 0.4, 1.0), breaks=(1.0,)), (1.0, 2.075)),
    "narrow": (
        Custom(lambda s: np.where((s >= 1.001) & (s < 1.003), 0.3, 1.0), breaks=(1.001, 1.003)),
        (1.001, 1.003),
    ),
}


@pytest.mark.parametrize("name", JUMPS)
def test_a_jump_of_the_modulus_ends_a_regime(name):
    """Yielded up to the jump and elastic above, until s - h is large enough, or a jump back."""
    grading, again = JUMPS[name]
    regimes = Branch(Yielding(0.3)).regimes(grading, [0.2], -1.0, 13.0)
    assert [piece for *_, piece in listed(regimes)] == [0, 1, 0, 1]
    np.testing.assert_allclose([low for low, *_ in listed(regimes)], [0.2, 0.5, *again], rtol=1e-15)


def test_ends_that_cannot_be_told_apart_are_one():
    """Separations a limit apart: h + 0.05 is the next of them but for its rounding."""
    for step in (0.05, 0.07, 0.013, 0.3):
        h = np.arange(21) * step
        regimes = Branch(Yielding(step, step * (1 + 1e-16))).regimes(Homogeneous(), h, -1.0, 13.0)
        assert set(regimes.low[regimes.low <= h[-1]]) <= set(h)
    tiny = Branch(Yielding(1e-17)).regimes(Homogeneous(), [1.0], -1.0, 13.0)
    assert listed(tiny) == [(1.0, 13.0, 1)]
    near = Branch(Yielding(0.05, 0.05 + 1e-15)).regimes(Homogeneous(), [0.0], -1.0, 13.0)
    assert [piece for *_, piece in listed(near)] == [0, 1, 2]
