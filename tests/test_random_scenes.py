"""Scenes taken at random over all features: drawn and right, or refused when made, with what to do."""

import pytest
from random_scenes import judged

ONCE_SLOW = (
    10250,
    10543,
)  # bins of summits of any radius; a balance whose grading was searched for each bound


@pytest.mark.parametrize("seed", range(20))
def test_drawn_and_right_or_refused(seed):
    assert not judged(seed)["wrong"]


@pytest.mark.slow
@pytest.mark.parametrize("seeds", [ONCE_SLOW, *(range(10 * tens, 10 * tens + 10) for tens in range(2, 20))])
def test_many(seeds):
    assert not [told for told in map(judged, seeds) if told["wrong"]]
