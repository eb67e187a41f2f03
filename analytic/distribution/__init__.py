"""The exact law of a finite surface: of any sum over its asperities, without a draw.

A sum S over N independent asperities has the transform ``(1 + q)^N``, or ``exp(N q)`` where their
number is a Poisson variable, with ``q(z) = E exp(-z X) - 1`` of what one adds. Lattices give the law of S.
"""

from analytic.distribution.distribution import Law
from analytic.distribution.of_model import distribution_of, separation_law_of

__all__ = ["Law", "distribution_of", "separation_law_of"]
