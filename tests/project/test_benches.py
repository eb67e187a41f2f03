"""Benches (`runs/bench`): all can be imported, and the script that they are measured against is right."""

import importlib
import sys
from pathlib import Path

import numpy as np
import pytest

import analytic

FOLDER = Path(__file__).parents[2] / "runs" / "bench"
NAMES = sorted(path.stem for path in FOLDER.glob("*.py"))


@pytest.fixture(scope="module")
def benches():
    """Every file of the folder, imported as `history.py` imports them."""
    before = set(sys.modules)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(FOLDER))
        yield {name: importlib.import_module(name) for name in NAMES}
    for name in set(NAMES) - before:
        del sys.modules[name]


def test_every_bench_with_ratios_is_in_the_history(benches):
    found = {name for name, module in benches.items() if hasattr(module, "ratios")}
    assert found == set(benches["history"].BENCHES)


def test_the_script_answers_the_same_question(benches):
    """Means of 4000 surfaces against theory: 5 standard errors (false alarm 1e-5), and gamma = 2, not 1."""
    h, asperities, surfaces = (0.0, 1.0, 2.0), 100, 4000
    drawn = benches["scenes"].numpy_script(asperities, h, surfaces) / asperities
    mean, error = drawn.mean(axis=0), drawn.std(axis=0) / np.sqrt(surfaces)

    def off(grading):
        graded = [analytic.fn(n, h, grading) for n in (1.5, 0.5)]
        expected = [graded[0], analytic.fn(1, h), graded[1], analytic.fn(0, h)]
        return np.abs((mean - np.stack(expected, axis=1)) / error).max()

    assert off(benches["scenes"].S1.grading) < 5
    assert off(None) > 20
