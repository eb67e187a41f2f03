"""Scenes taken at random over all features: drawn and right, or refused when made, with what to do."""

import pytest
from random_scenes import judged


@pytest.mark.parametrize("seed", range(20))
def test_drawn_and_right_or_refused(seed):
    assert not judged(seed)["wrong"]


@pytest.mark.slow
@pytest.mark.parametrize("tens", range(2, 20))
def test_many(tens):
    assert not [told for told in map(judged, range(10 * tens, 10 * tens + 10)) if told["wrong"]]
