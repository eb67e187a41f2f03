"""Located balances of random maps, shapes and loads: each is one by plain loops, too."""

import sys
from pathlib import Path

import pytest
from oracles.located_by_hand import residual

FOLDER = Path(__file__).parents[2] / "runs" / "validation"
sys.path.insert(0, str(FOLDER))
from random_balances import case  # noqa: E402

sys.path.remove(str(FOLDER))


@pytest.mark.slow
def test_random_balances_are_those_of_plain_loops():
    """40 small maps, two shapes of summits, two loads each; not looked at where summits were left out."""
    whole = 0
    for number in range(40):
        words, located, loads = case(number, most_points=96)
        for share, load in loads:
            balance = located.at_load(load)
            assert balance.load == pytest.approx(load, rel=1e-10)
            if not balance.merged:
                assert residual(located, balance) < 1e-10, f"{number}: {words}, {share:.2g}"
                whole += 1
    assert whole >= 72
