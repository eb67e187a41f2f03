"""A study of speed and accuracy by hand, for tables and figures."""

from oracles.inside import Ladder, Point, Rung, Tradeoff, Way


def made_up(scene):
    """A study by hand, for tables and figures."""
    points = (
        Point("tail", "mean", 10, 0.2, 0.02, 0.0, 1e-3, 16),
        Point("tail", "mean", 100, 0.06, 0.006, 0.0, 4e-3, 16),
        Point("theory", "mean", 0, 0.0, 0.0, 0.0, 5e-4, 16),
    )  # fmt: skip
    ways = (
        Way("theory", "mean", 1e-13, 5e-4, 0.0), Way("tail", "mean", 0.0, 1e-3, 3e-5),
        Way("cells", "values", 1e-14, 1e-3, 1e-6), Way("exact law", "quantile", 1e-6, 0.01, 0.0),
    )  # fmt: skip
    ladder = Ladder((Rung("formula", 0, 1e-3, 0.0, 0.03), Rung("surfaces", 10, 0.1, 0.02, 0.03)), "")
    return Tradeoff(scene, 2.5, points, ways, ladder, 12.4)
