"""What is said of a sweep before it is finished, and of laws that are lists of numbers."""

import re

import numpy as np
import pytest
from oracles.inside import law_text
from oracles.said import call

import mcgw

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "0.1 mm^2", "78.6 GPa")
SCENE = mcgw.Scene(SURFACE, separations=[0.0, 1.0], n_surfaces=100, seed=1)


def test_a_sweep_half_done_says_how_far_it_is(tmp_path):
    path, over = tmp_path / "s.h5", {"grading.gamma": [0.5, 1.5], "ensemble.count": ["fixed", "poisson"]}
    assert (
        mcgw.sweep(SCENE, over, path=path, shard="1/2") == 100
    )  # one group of two, by the law of the number
    assert call("show", path).stdout == (
        f"{path}: a sweep of 4 points over grading.gamma, ensemble.count, not finished: 100 of 200 surfaces "
        "are drawn; run mcgw sweep again to resume\n"
    )
    assert mcgw.scene_from(call("show", "--scene", path).stdout).surface == SURFACE
    for option in ("--verify", "--digest"):
        done = call("show", path, option)
        assert done.returncode == 2
        assert "is an unfinished sweep; finish it with mcgw sweep" in done.stderr
    with pytest.raises(mcgw.StoreError, match="is an unfinished sweep; mcgw show prints its progress"):
        mcgw.open_ensemble(path)
    assert mcgw.sweep(SCENE, over, path=path).shape == (2, 2)  # nothing of it was removed


@pytest.mark.parametrize("points", [2, 5, 400])
def test_no_text_of_a_law_ends_in_half_a_number(points):
    heights = mcgw.HeightTable.of(np.random.default_rng(1).normal(size=points))
    text = law_text(heights)
    assert len(text) < 200
    known = {form(x) for x in (*heights.s, *heights.share) for form in ("{:.4g}".format, "{:.6g}".format)}
    numbers = re.findall(r"-?\d+\.\d+(?:e-?\d+)?", text)
    assert numbers
    assert set(numbers) <= known
