import numpy as np
import pytest

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
