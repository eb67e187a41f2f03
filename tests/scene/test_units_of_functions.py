"""Gradings and laws of one's own that are no ratios: refused with what would do, unless it is meant so."""

import re

import numpy as np
import pytest
from oracles.scenes import scene_by

import analytic
import mcgw

_SURFACE = mcgw.Surface("2 um", "10 um", "1000/mm^2", "1 mm^2", "72 GPa")
_NO_RATIO = r"grading: E\*\(s\)/E\* is \S+( to \S+)? at all heights that touch; "
_CUSTOM = r"; if it is meant so, give mcgw\.Custom\(function, checked=False\)"
_LIMITS = {"limits": (1.0,), "critical": 0.05}
_AREA = (lambda u: u**2, lambda u: 0.93 * u**2.272)
_LOAD = (lambda u: u**3, lambda u: 1.03 * u**2.85)
_NEWTON = 4 / 3 * 72e9 * 1e-5**0.5 * 1e-7**1.5
_METRES = np.pi * 1e-5 * 1e-7


def _young(s):
    """E*(s), Pa."""
    return 80e9 * (1 + 0.1 * s)


_GRADINGS = {
    "Pa": (_young, r"divide by E_star = 7\.2e\+10 Pa"),
    "MPa": (lambda s: _young(s) / 1e6, "divide by E_star = 72000 MPa"),
    "GPa": (lambda s: _young(s) / 1e9, "divide by E_star = 72 GPa"),
    "z in metres": (
        lambda z: 1 + 0.1 * z / 1e-6,
        "it is asked for s = z/sigma: multiply s by sigma = 2e-06 m",
    ),
    "z in metres, falling": (lambda z: np.exp(-z / 1e-5), "it is asked for s = z/sigma: multiply s by"),
    "inverse": (lambda s: 1 / _young(s), "give a ratio, which is near 1"),
    "huge": (lambda s: 1e30 + s, "give a ratio, which is near 1"),
    "none": (lambda s: 0 * s, "give a ratio, which is near 1"),
}


def _scene(**given):
    return scene_by(_SURFACE, separations=[0.0, 1.0], n_surfaces=3, seed=1, **given)


def _refused(match, **given):
    with pytest.raises(mcgw.SceneError, match=match) as error:
        _scene(**given)
    assert len(error.value.problems) == 1


@pytest.mark.parametrize("name", _GRADINGS)
@pytest.mark.parametrize("negative", ["error", "clip", "allow"])
def test_a_function_is_no_ratio(name, negative):
    function, advice = _GRADINGS[name]
    _refused(f"{_NO_RATIO}{advice}.*{_CUSTOM}$", grading=function, negative=negative)
    _refused(f"{_NO_RATIO}{advice}", grading=mcgw.Custom(function, (0.5,)), negative=negative)


@pytest.mark.parametrize("factor", [1e9, 1.0, 1e-20])
def test_series_and_tables_are_no_ratios(factor):
    """A table of pascals or gigapascals, and series of a file; with a way out that the file can say."""
    advice = {1e9: r"divide by E_star = 7\.2e\+10 Pa", 1.0: "divide by E_star = 72 GPa"}.get(
        factor, "give a ratio"
    )
    _refused(f"{_NO_RATIO}{advice}", grading=mcgw.Table([-1.0, 6.0], [80 * factor, 90 * factor]))
    series = analytic.PiecewiseSeries([-50.0, 50.0], [[80 * factor]])
    _refused(f"{_NO_RATIO}{advice}.*; if it is meant so, give checked = false$", grading=series)
    text = mcgw.scene_text(_scene()) + (
        f'\n[grading]\nlaw = "series"\nedges = [-50.0, 50.0]\ncoefficients = [[{80 * factor}]]\n'
    )
    text = re.sub(r"\[grading\]\nlaw = \"homogeneous\"\nnegative = \"error\"\n", "", text)
    with pytest.raises(mcgw.SceneError, match=_NO_RATIO):
        mcgw.scene_from(text)
    assert not mcgw.scene_from(f"{text}checked = false\n").grading.checked


@pytest.mark.parametrize(
    "function",
    [
        lambda s: 1 + 0.1 * s,
        lambda s: np.exp(3 * s),
        lambda s: 900.0 + 0 * s,
        lambda s: 0.002 + 0 * s,
        lambda s: np.where(s > 1, 1e6, 1.0),
        lambda s: s - 0.9,
        lambda s: 72.0 * np.exp(-s),
    ],
)
def test_ratios_are_taken(function):
    assert _scene(grading=function, negative="clip").grading.function is function


@pytest.mark.parametrize(
    ("load", "area", "line"),
    [
        ((lambda u: _NEWTON * u**3, lambda u: _NEWTON * 1.03 * u**2.85), _AREA,
         r"its load is \S+ to \S+ of Hertz's at all penetrations that occur; divide it by \(4/3\) E\*\(s\) "
         r"sqrt\(R\) delta_c\^1\.5 = 0\.0096 N at E\*"),
        ((lambda u: 1e6 * u**3, lambda u: 1e6 * u**2.85), _AREA, r"its load is \S+ to \S+ of Hertz's"),
        (_LOAD, (lambda u: _METRES * u**2, lambda u: _METRES * 0.93 * u**2.272),
         r"its area is \S+ to \S+ of Hertz's .* divide it by pi R delta_c = 3\.142e-12 m\^2 at E\*"),
    ],
    ids=["newtons", "far", "square metres"],
)  # fmt: skip
def test_a_law_in_other_units(load, area, line):
    law = mcgw.CustomLaw(load, area, **_LIMITS)
    way_out = "; if it is meant so, give checked=False$"
    _refused(rf"contact\.law = CustomLaw: {line}.*{way_out}", law=law)
    meant = _scene(law=mcgw.CustomLaw(load, area, **_LIMITS, checked=False))
    again = mcgw.scene_from(mcgw.scene_text(meant))
    assert not again.law.checked
    assert mcgw.scene_from(mcgw.scene_text(again)) == again
    text = mcgw.scene_text(meant).replace("checked = false\n", "")
    with pytest.raises(mcgw.SceneError, match="of Hertz's at all penetrations"):
        mcgw.scene_from(text)


def test_a_law_that_is_right_on_a_graded_surface():
    """The critical penetration of a stiff asperity is smaller, its ratio to Hertz's the same or less."""
    for grading in (analytic.Exponential(2.0), lambda s: 1 + 0.3 * np.tanh(s)):
        assert _scene(law=mcgw.CustomLaw(_LOAD, _AREA, **_LIMITS), grading=grading).law.checked


@pytest.mark.parametrize("steep", [2.0, 4.0, 8.0, 12.0])
def test_a_law_of_ones_own_under_a_grading_too_steep_for_it(steep):
    line = r"contact\.law = CustomLaw: E\*\(s\)/E\* reaches \S+ at s = \S+, where no series of the law is"
    grading = mcgw.Custom(lambda s: np.exp(steep * s), checked=False)
    _refused(line, law=mcgw.CustomLaw(_LOAD, _AREA, **_LIMITS), grading=grading)


def test_nothing_that_touches_is_looked_at():
    heights = analytic.HeightTable.of(np.linspace(0.0, 1.0, 50))
    assert mcgw.Scene(_SURFACE, separations=[9.0], heights=heights, grading=_young).grading.function is _young
