"""Hertz: the elastic contact of two spheres."""

from dataclasses import dataclass
from typing import ClassVar

from analytic.laws.law import ContactLaw

__all__ = ["Hertz"]


@dataclass(frozen=True)
class Hertz(ContactLaw):
    """Hertz's contact: load ``e delta^(3/2)``, area ``delta``, stiffness ``e delta^(1/2)``.

    Valid for frictionless elastic spheres whose radius of contact is small against R. Nothing is known
    to be wrong with it; metals seldom stay elastic (see the laws that yield).

    Notes
    -----
    Source: H. Hertz, J. reine angew. Math. 92 (1882) 156.

    Examples
    --------
    >>> import numpy as np
    >>> float(Hertz().load(0, np.sqrt(4.0), np.array(1.0)))
    8.0
    """

    name: ClassVar[str] = "hertz"
