"""What values may be off by, their means may be off by too: intervals and the stop rule know it."""

import numpy as np
import pytest

import mcgw

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
ASKED = {"separations": [0.0, 1.0], "grading": mcgw.Exponential(2.0), "n_asperities": 3000, "seed": 1}


def test_an_interval_holds_all_that_values_may_be_off_by():
    """As long as that of the last digits, and twice the accuracy besides; numbers of contacts are exact."""
    exact, coarse = (
        mcgw.simulate(mcgw.Scene(SURFACE, n_surfaces=400, accuracy=a, **ASKED)) for a in (1e-13, 1e-2)
    )
    for name in ("load", "pressure", "area_fraction"):
        (low, high), (lower, higher) = exact.interval(name), coarse.interval(name)
        drawn = (high - low) / exact.mean(name)
        np.testing.assert_allclose((higher - lower) / coarse.mean(name), drawn + 2e-2, rtol=1e-9)
    widths = [np.diff(e.interval("contacts"), axis=0) for e in (exact, coarse)]  # of other draws
    np.testing.assert_allclose(widths[1], widths[0], rtol=0.2)


@pytest.mark.parametrize("rel_err", [1e-2, 5e-3, {"load": 1e-2}, {"load": [2e-2, 9e-3]}])
def test_no_mean_is_asked_for_closer_than_its_values_are_known(rel_err):
    with pytest.raises(mcgw.SceneError, match=r"rel_err.*: values and their means only have accuracy = 0.01"):
        mcgw.Scene(SURFACE, accuracy=1e-2, rel_err=rel_err, **ASKED)


def test_what_is_left_of_rel_err_is_for_the_draw():
    """So many surfaces as the difference alone takes where values are exact; contacts are, always."""

    def surfaces(accuracy, rel_err):
        return mcgw.simulate(mcgw.Scene(SURFACE, accuracy=accuracy, rel_err=rel_err, **ASKED)).n_surfaces

    least = surfaces(1e-13, {"load": 5e-3})
    assert surfaces(1e-2, {"load": 1.5e-2}) == least > surfaces(1e-13, {"load": 1.5e-2})
    assert surfaces(1e-2, {"contacts": 5e-3}) == surfaces(1e-13, {"contacts": 5e-3})
