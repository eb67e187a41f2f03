"""Ensembles of more separations than tables and figures show beside theory."""

import numpy as np
import pytest
from oracles.inside import verdict

import mcgw
from mcgw.ensemble.ensemble import MOST_SHOWN, shown

WHOLE = np.linspace(1.5, 0.0, 2 * MOST_SHOWN + 1)  # falling: every other one is shown


@pytest.fixture(scope="module", params=["sums", "statistics"])
def whole(request):
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    scene = mcgw.Scene(surface, separations=WHOLE, n_surfaces=40, seed=3)
    return mcgw.simulate(scene, keep=request.param)


def test_up_to_a_limit_all_are_shown_and_then_the_first_the_last_and_some_between_in_their_order(whole):
    few = whole.sel(separation=WHOLE[:MOST_SHOWN])
    assert shown(few) is few
    some = shown(whole.sel(separation=WHOLE[: MOST_SHOWN + 1]))
    assert len(some.separations) == MOST_SHOWN
    some = shown(whole)
    assert some.separations[[0, -1]].tolist() == [1.5, 0.0]
    assert np.all(np.diff(some.separations) < 0)
    assert set(some.separations) <= set(WHOLE)
    assert some.surfaces_of is whole.scene


def test_a_comparison_shows_some_and_its_verdict_is_on_all(whole):
    found = mcgw.compare(whole)
    assert found.of_many == f"at {MOST_SHOWN} of {len(WHOLE)} separations"
    assert found.of_many in str(found)
    for name, table in found.tables().items():
        h, mean = (table.only(column).columns[0].values for column in ("separation", "mean"))
        assert len(h) == MOST_SHOWN
        index = [WHOLE.tolist().index(x) for x in h]
        np.testing.assert_array_equal(mean, whole.mean(name)[index])
    assert found.verdict == verdict(whole)
