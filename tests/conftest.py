import io
from pathlib import Path

import numpy as np
import pytest
from interacting_by_hand import QUANTITIES, SEPARATIONS, interaction
from matplotlib.figure import Figure

import analytic
from mcgw.scene.scene import Scene

SURFACE = analytic.Surface(sigma=1.37e-6, radius=13e-6, eta=3.0e8, nominal_area=1e-4, E_star=78.6e9)


@pytest.fixture
def make_scene():
    """Scenes of one surface, whatever else is asked."""

    def make(**changes):
        values = {
            "surface": SURFACE,
            "separations": tuple(np.linspace(0, 4, 9)),
            "grading": analytic.Exponential(2.0),
            "n_asperities": 3000,
            "n_surfaces": 200,
            "seed": 1,
        }
        return Scene(**(values | changes))

    return make


@pytest.fixture
def pressed(make_scene):
    """The same whose asperities press each other down, by an interaction of some strength."""

    def make(strength, at="nominal", **changes):
        values = {"separations": SEPARATIONS, "quantities": QUANTITIES, "n_surfaces": 4}
        scene = make_scene(**(values | changes))
        return scene.replace(interaction=interaction(strength, scene.surface, scene.n_asperities, at))

    return make


@pytest.fixture
def blank_figures(monkeypatch):
    """Figures are made and their files written, but nothing is drawn in them, which takes a second each."""

    def blank(self, target, **_):
        if isinstance(target, Path):
            target.touch()
        else:
            target.write(b"" if isinstance(target, io.BytesIO) else "<svg></svg>")

    monkeypatch.setattr(Figure, "savefig", blank)
