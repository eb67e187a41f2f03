"""What crowds buy: `accuracy` with a hundred million asperities, against cells that are exact.

Run: ``python runs/bench/accuracy.py [--rounds 7]``. What they change in the laws of values is computed, not
drawn: `tests/oracles/law_of_crowds.py`.
"""

from scenes import S1, block
from timing import Job, against, parser_of, show, timed


def crowds() -> dict[str, Job]:
    """A hundred million asperities with crowds and without."""
    scene = S1.replace(sampler="auto", n_asperities=10**8)
    return {"accuracy 1e-4, N = 1e8": block(scene.replace(accuracy=1e-4)), "cells, N = 1e8": block(scene)}


def ratios(rounds: int) -> dict[str, float]:
    """Seconds a surface with crowds, to those without: lower is better."""
    return against(timed(crowds(), rounds), "cells, N = 1e8")


def main() -> None:
    """Print the times."""
    rounds = parser_of(__doc__).parse_args().rounds
    show("N = 1e8, 41 separations", timed(crowds(), rounds), "accuracy 1e-4, N = 1e8")


if __name__ == "__main__":
    main()
