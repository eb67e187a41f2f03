"""Gradings and height laws of Python: the series that files hold, looked at and refused as any others."""

import re

import numpy as np
import pytest
import scipy.stats
from oracles.begun_runs import SIZE, digest, halted, in_small_blocks
from oracles.inside import storable

import analytic
import mcgw
from mcgw.cli import main
from mcgw.errors import StoreError

H = (2.0, 0.5, 3.0)


def bent(s):
    """A kink that nobody tells of."""
    return 1 + 0.3 * np.abs(s - 0.777)


SCENES = {
    "lambda": {"grading": lambda s: 1 + 0.3 * np.tanh(s)},
    "kink": {"grading": bent},
}


@pytest.fixture(autouse=True)
def _small_blocks(monkeypatch):
    in_small_blocks(monkeypatch)


@pytest.fixture
def make(make_scene):
    def of(name="lambda", **changes):
        values = {
            "separations": H,
            "n_surfaces": 60,
            "sampler": "cells",
            "grading": analytic.Homogeneous(),
        }
        return make_scene(**(values | SCENES[name] | changes))

    return of


# --- another machine, another function ------------------------------------------------------------------


def test_other_last_digits_go_on_and_another_function_does_not(make, tmp_path):
    """As where another processor evaluates the function: the run keeps the series that it began with."""
    path = tmp_path / "e.h5"
    mcgw.run(make("lambda"), tmp_path / "whole.h5")
    halted(make("lambda"), path, SIZE)

    def elsewhere(s):
        return (1 + 0.3 * np.tanh(s)) * (1 + 4e-16 * np.sign(np.sin(1e3 * s)))

    assert storable(make("lambda", grading=elsewhere)).grading != storable(make("lambda")).grading
    with pytest.raises(StoreError, match=r"holds a different run: grading\.coefficients is "):
        mcgw.run(make("lambda", grading=lambda s: 1 + (0.3 + 1e-11) * np.tanh(s)), path)
    mcgw.run(make("lambda", grading=elsewhere), path)
    assert digest(path) == digest(tmp_path / "whole.h5")
    mcgw.run(make("lambda", grading=elsewhere, n_surfaces=70), path)
    with pytest.raises(StoreError, match="holds a different ensemble: grading"):
        mcgw.run(make("lambda", grading=np.cosh, n_surfaces=80), path)


# --- looked at ------------------------------------------------------------------------------------------


def test_laws_of_python_are_shown_by_name(make, tmp_path, capsys):
    mcgw.run(make("kink", heights=scipy.stats.lognorm(0.3), quantities=("load",)), tmp_path / "k.h5")
    assert main(["show", str(tmp_path / "k.h5")]) == 0
    shown = capsys.readouterr().out
    assert re.search(r"grading +PiecewiseSeries\('bent', \d+ pieces from s = 0.5 to ", shown)
    assert "scipy.stats.lognorm(s=0.3)" in shown


# --- what is refused ------------------------------------------------------------------------------------


def test_noise_is_one_line(make):
    with pytest.raises(mcgw.SceneError, match=r"^grading: not resolved by .* pieces near s = [^\n]*$"):
        make("lambda", grading=lambda s: 1 + 1e-3 * np.modf(np.sin(1e9 * s) * 1e5)[0])


def test_series_are_not_taken_where_they_do_not_reach(make):
    known = storable(make("lambda"))
    assert known.replace(separations=(1.0, 3.0)).grading == known.grading
    with pytest.raises(
        mcgw.SceneError, match=r"^grading\.edges: the series reach from s = 0\.5 .*give the grading"
    ):
        known.replace(separations=(-1.0, 3.0))
    with pytest.raises(mcgw.SceneError, match=r"^grading\.edges: "):
        known.replace(heights=scipy.stats.lognorm(0.9))


# --- distributions of scipy -----------------------------------------------------------------------------


def test_a_distribution_is_its_shapes(make):
    plain = make("lambda", heights=scipy.stats.lognorm(s=0.3))
    for given in (scipy.stats.lognorm(0.3, 2.0, 5.0), analytic.ScipyHeights(scipy.stats.lognorm(0.3))):
        scene = make("lambda", heights=given)
        assert scene.heights == plain.heights
        assert hash(scene.heights) == hash(plain.heights)
        assert mcgw.scene_from(mcgw.scene_text(scene)) == storable(scene)
        assert 'law = "scipy"\nname = "lognorm"' in mcgw.scene_text(scene)
