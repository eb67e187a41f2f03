"""The work-precision study: bounded in time, wide in error, and its advice holds."""

import numpy as np
import pytest

import analytic
from mcgw.figures.tradeoff import save_tradeoff
from mcgw.statistics.methods import reference
from mcgw.statistics.tradeoff import tradeoff


@pytest.fixture(scope="module")
def scene():
    from conftest import SURFACE

    from mcgw.scene.scene import Scene

    return Scene(surface=SURFACE, separations=(0.0, 1.0, 2.0), grading=analytic.Exponential(2.0), seed=1)


@pytest.fixture(scope="module")
def found(scene):
    return tradeoff(scene, seconds=5)


def test_it_spans_six_decades_with_five_methods(found):
    errors = np.concatenate([p.rms for p in found.points])
    assert np.log10(errors.max() / errors[errors > 0].min()) > 6
    assert len({p.method for p in found.points}) >= 5


def test_reference_is_the_theory(scene):
    """Two different rules agree to the 1e-13 that each promises."""
    exact = analytic.load(scene.surface, scene.separations, scene.grading)
    np.testing.assert_allclose(reference(scene, (0, 1, 2)), exact, rtol=2e-13)


def test_errors_fall_as_they_should(found):
    stratified = found.of("stratified")
    # How many sizes there was time for depends on the machine. N^(-3/2) lies a factor of 4 below 1/N at a
    # ratio of 16, N^(-1/2) a factor of 4 above; an rms of two or more seeds is known better than that.
    first, last = stratified[0], stratified[-1]
    assert last.rms[0] / first.rms[0] < first.size / last.size
    paper = found.of("paper's Gauss rule, Eq. (9)")
    assert paper[-1].rms[2] < 1e-8 < paper[0].rms[2]


def test_figure(found, tmp_path):
    save_tradeoff(found, tmp_path / "x.png")
    assert (tmp_path / "x.png").read_bytes().startswith(b"\x89PNG")


def test_no_time_is_refused(scene):
    with pytest.raises(ValueError, match="seconds = 0: give a finite number > 0"):
        tradeoff(scene, seconds=0)
