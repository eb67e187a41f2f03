"""Random numbers, and boundary elements that cost nothing, for tests of means by levels."""

import numpy as np
import pytest

from mcgw.elasticity import elastic as public
from mcgw.elasticity.levels import LEVELS, Level, located


@pytest.fixture
def rng():
    return np.random.default_rng(20261124)


@pytest.fixture
def cheap(monkeypatch):
    """Boundary elements that are a known multiple of what located summits say."""

    def solve(pressed):
        return {name: 1.25 * value for name, value in located(pressed).items()}

    levels = (*LEVELS[:2], Level("elastic", "stand-in", solve, 1.0))
    monkeypatch.setattr(public, "LEVELS", levels)
