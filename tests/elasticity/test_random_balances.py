"""Located balances of random maps, shapes and loads: each is one by plain loops, too."""

import sys
from pathlib import Path

import pytest
from oracles.located_by_hand import residual

from mcgw.elasticity.located import balanced

FOLDER = Path(__file__).parents[2] / "runs" / "validation"
sys.path.insert(0, str(FOLDER))
from random_balances import case  # noqa: E402

sys.path.remove(str(FOLDER))


@pytest.mark.slow
def test_random_balances_are_those_of_plain_loops():
    """40 small maps, paraboloids and the surface around summits, two loads each."""
    whole = 0
    for number in range(40):
        words, loads = case(number, most_points=96)
        for share, (spots, places, grid, start, load) in loads:
            found = balanced(spots, places, grid, start, load)
            assert spots.loads(found.penetrations).sum() == pytest.approx(load, rel=1e-10)
            assert residual(spots, places, grid, start, found) < 1e-10, f"{number}: {words}, {share:.2g}"
            whole += found.share == 1
    assert whole >= 76
