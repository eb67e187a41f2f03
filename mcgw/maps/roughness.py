"""Parameters of roughness as drawings name them, of what is left of a map or profile."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Roughness", "roughness_of"]


@dataclass(frozen=True, slots=True)
class Roughness:
    """Of heights about their mean (ISO 25178-2 for maps, ISO 21920-2 for profiles).

    Parameters
    ----------
    a : float
        Arithmetic mean deviation, Sa or Pa, m.
    q : float
        Root mean square deviation, Sq or Pq, m.
    sk, ku : float
        Skewness and kurtosis, Ssk and Sku or Psk and Pku.
    """

    a: float
    q: float
    sk: float
    ku: float

    def text(self, kind: str) -> str:
        """Named as of a map ("S") or a profile ("P")."""
        return f"{kind}a = {self.a:.4g} m, {kind}q = {self.q:.4g} m, {kind}sk = {self.sk:.2f}"


def roughness_of(heights: NDArray[np.float64]) -> Roughness:
    """Of an array of any shape without missing points, m."""
    z = (heights - heights.mean()).ravel()  # the one copy of a large map
    q = math.sqrt(float(z @ z) / z.size)
    powers = (float(np.einsum(f"i{',i' * (k - 1)}", *k * (z,))) / z.size for k in (3, 4))
    sk, ku = (power / q**k if q > 0 else 0.0 for k, power in zip((3, 4), powers, strict=True))
    return Roughness(float(np.abs(z, out=z).mean()), q, sk, ku)
