"""What the laws of asperities that yield have in common: penetrations in units of the critical one."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from analytic.laws.law import ContactLaw
from analytic.laws.positive import is_positive

__all__ = ["ElasticPlastic"]

Array = NDArray[np.float64]
Formula = Callable[[int, Any, Array], Any]


@dataclass(frozen=True)
class ElasticPlastic(ContactLaw):
    """A law in ``x = delta/delta_c``: Hertz's up to the first of its `starts`, then a fit.

    An asperity of modulus E*(s) yields at ``delta_c = critical/e^2``, because its hardness does not
    depend on its height. A fit says what multiple of Hertz's load and area at the same penetration the
    contact has.

    Parameters
    ----------
    critical : float, optional
        Critical penetration over sigma of an asperity of modulus E*.
    """

    _: KW_ONLY
    critical: float | None = None

    elastic: ClassVar[bool] = False
    of_radius: ClassVar[tuple[str, float]] = ("critical", 1.0)
    starts: ClassVar[tuple[float, ...]] = (1.0,)

    def __post_init__(self) -> None:
        if self.critical is not None and not is_positive(self.critical):
            raise ValueError(f"critical = {self.critical!r}: give a critical penetration over sigma > 0")

    @property
    def edges(self) -> tuple[float, ...]:
        """Penetrations over the critical one at which pieces from 1 on begin."""
        return self.starts

    @property
    def _root_of_critical(self) -> Any:
        if self.critical is None:
            raise ValueError(f"{self}: put it on a surface first, law.on(surface), or give `critical`")
        return np.sqrt(self.critical)

    def delta_c(self, e: Array) -> Array:
        """Critical penetration, infinite where there is no stiffness; in the shape of `e`."""
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray((self._root_of_critical / np.asarray(e, dtype=np.float64)) ** 2)

    def x(self, y: Any, e: Array) -> Any:
        """``delta/delta_c``; 1 where there is no stiffness, as formulas beyond yield mean nothing there."""
        return np.where(np.asarray(e) > 0, np.square(y * e / self._root_of_critical), 1.0)

    def limits(self, e: Array) -> Array:
        """Penetrations at which the next piece begins, increasing; shape (pieces - 1, *e.shape)."""
        return np.asarray(np.multiply.outer(np.array(self.edges), self.delta_c(e)))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Load of a contact, in the shape of `y` and `e`."""
        hertz = super().load(piece, y, e)
        if piece == 0:
            return hertz
        return hertz * self._of(self.load_over_hertz, 1.5, piece, self.x(y, e), e)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Radius of a contact; its square is the area over pi R sigma."""
        hertz = super().radius(piece, y, e)
        if piece == 0:
            return hertz
        return hertz * np.sqrt(self._of(self.area_over_hertz, 1.0, piece, self.x(y, e), e))

    def _of(self, fit: Formula, power: float, piece: int, x: Any, e: Array) -> Any:
        """A fit over Hertz's, which itself goes as x to this power."""
        return fit(piece, x, np.where(np.asarray(e) > 0, e, 1.0))

    def load_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """Load beyond the start of this fit, over Hertz's at the same penetration."""
        raise NotImplementedError

    def area_over_hertz(self, fit: int, x: Any, e: Array) -> Any:
        """Area beyond the start of this fit, over Hertz's at the same penetration."""
        raise NotImplementedError
