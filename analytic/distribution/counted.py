"""The law of a number of contacts."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any


@dataclass(frozen=True)
class Counted:
    """The exact law of a number of asperities: that of `scipy.stats`, binomial or Poisson, and its `atom`.

    Parameters
    ----------
    share : float
        Probability that an asperity counts.
    number : float
        Asperities on a surface, or their mean number.
    poisson : bool
        Whether their number is a Poisson variable.
    """

    share: float
    number: float
    poisson: bool
    error: float = 1e-14

    @cached_property
    def _law(self) -> Any:
        from scipy.stats import binom, poisson  # takes long to import

        if self.poisson:
            return poisson(self.number * self.share)
        return binom(round(self.number), self.share)

    @property
    def atom(self) -> float:
        """Probability that there is none."""
        return float(self._law.pmf(0))

    def __getattr__(self, name: str) -> Any:
        """Whatever a frozen law of `scipy.stats` has: cdf, sf, pmf, ppf, isf, interval, rvs, mean, std."""
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._law, name)
