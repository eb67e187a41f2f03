"""A study of speed and accuracy by hand, for tables and figures."""

from oracles.inside import Point, Rung, Tradeoff, Way, worth


def made_up(scene):
    """Of two samplers, theory and the exact law."""
    points = (
        Point("tail", "mean", 10, 0.2, 0.02, 0.0, 1e-3, 16),
        Point("tail", "mean", 1000, 0.02, 0.002, 0.0, 4e-3, 16),
        Point("theory", "mean", 0, 0.0, 0.0, 0.0, 5e-4, 16),
    )
    ways = (
        Way("theory", "mean", 1e-13, 5e-4, 0.0), Way("tail", "mean", 0.0, 1e-3, 3e-6),
        Way("cells", "values", 1e-3, 0.25, 0.01), Way("exact law", "quantile", 1e-6, 0.01, 0.0),
    )  # fmt: skip
    ladder = (
        Rung("formula", 0, 1e-3, 0.0, 0.03), Rung("surfaces", 10, 0.1, 0.04, 0.03),
        Rung("surfaces", 1000, 9.0, 0.004, 0.03),
    )  # fmt: skip
    return Tradeoff(scene, 2.0, points, ways, ladder, worth(ladder, ""), 12.4)
