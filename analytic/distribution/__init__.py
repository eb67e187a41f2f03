"""The exact law of a finite surface: of any sum over its asperities, without a draw.

A sum S over N independent asperities has the transform ``(1 + q(t))^N``, or ``exp(N q(t))`` where their
number is a Poisson variable, with ``q(t) = E exp(i t X) - 1`` of what one adds. One integral over t gives
the law of S; where contacts are few another way leads there.
"""

from analytic.distribution.derived import Law, Mapped
from analytic.distribution.of_model import distribution_of, interacting_distribution, separation_law_of

__all__ = ["Law", "Mapped", "distribution_of", "interacting_distribution", "separation_law_of"]
