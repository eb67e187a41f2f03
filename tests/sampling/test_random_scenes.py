"""Scenes taken at random over all features: drawn and right, or refused when made, with what to do."""

import pytest
from oracles.random_scenes import judged

# Bins of summits of any radius; balances whose grading was searched for each bound, or slopes asked again;
# cells without end; quantiles that were searched one by one. And rounding at the turn of deep contacts.
ONCE_SLOW = (10250, 10543, 32123, 60029, 60425, 70093)
# Series to the highest heights; starts of sticking contacts; powers of small heights on a wide node; cells
# from which on contacts are elastic again; last digits next to where contacts are lost.
ONCE_WRONG = (60354, 60413, 60522, 70294, 70593)


@pytest.mark.parametrize("seed", [*range(0, 20, 2), 10189, *ONCE_WRONG])
def test_drawn_and_right_or_refused(seed):
    assert not judged(seed)["wrong"]


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [ONCE_SLOW, *(range(10 * tens, 10 * tens + 10) for tens in range(2, 20))])
def test_many(seeds):
    assert not [told for told in map(judged, seeds) if told["wrong"]]
