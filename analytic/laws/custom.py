"""Your own contact law: formulas of its pieces, and the series by which a file stores them."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.arrays import Array, hold
from analytic.gradings import Custom
from analytic.laws.elastic_plastic import ElasticPlastic
from analytic.laws.law import NEXT_TO_0, STEP
from analytic.piecewise import PiecewiseSeries
from analytic.resolution import resolved

Formula = Callable[[Any], Any]
Formulas = Sequence[Formula]


class RootSeries(PiecewiseSeries):
    """Series of a formula over ``u^2``: in u around first touch, of a later piece in log(u)."""


def _resolved_in_root(name: str, formula: Formula, low: float, high: float) -> RootSeries:
    """Return the series that stand for a formula, of the first piece from ``low < 0`` on, to 1e-13."""

    def over_square(t: Array) -> Array:
        u = np.where(np.abs(t) < NEXT_TO_0, NEXT_TO_0, t) if low < 0 else np.exp(t)
        return np.asarray(formula(u) / (u * u))

    with suppress(ValueError):
        found = resolved(Custom(over_square), *((low, high) if low < 0 else np.log([low, high]).tolist()))
        if not found.kinks:
            return RootSeries(found.edges, found.coefficients)
    first = "; where it begins, write u**3 for (u*u)**1.5: it is also evaluated at -u" if low < 0 else ""
    raise ValueError(
        f"{name}: it is not smooth between x = {low * abs(low):g} and {high * high:g}: give the "
        f"penetration of each jump and kink in limits{first}"
    )


@dataclass(frozen=True)
class CustomLaw(ElasticPlastic):
    """A law made of formulas, one for each piece, in ``u = sqrt(delta/delta_c)``.

    In u a contact is analytic where it begins: Hertz's load is u^3, his area u^2. Formulas take arrays,
    real and complex, so they must not take absolute values, or compare; those of the first piece also
    take -u, and next to u = 0 they are power series that begin with u^2 or higher. Unloading is not known,
    and asking for it is an error.

    Parameters
    ----------
    load : sequence of callable
        Load of each piece over ``(4/3) E*(s) sqrt(R) (delta_c)^1.5``, Hertz's at delta_c.
    area : sequence of callable
        Area of each piece over ``pi R delta_c``.
    limits : sequence of float
        ``x = delta/delta_c`` at which each piece from the second on begins, increasing.
    critical : float
        delta_c/sigma of an asperity of modulus E*; where the modulus is e E*, it is critical/e^2.
    checked : bool, optional
        Whether a scene refuses the law if its load or area is above 1000 or below 0.001 of Hertz's at every
        penetration that occurs, as a load in newtons is.

    Raises
    ------
    ValueError
        If there are not as many formulas as pieces, limits do not increase, or a formula gives no finite
        numbers.

    Examples
    --------
    Elastic, then a constant mean pressure:

    >>> law = CustomLaw(
    ...     load=(lambda u: u**3, lambda u: u**2),
    ...     area=(lambda u: u**2, lambda u: u**2),
    ...     limits=(1.0,),
    ...     critical=0.05,
    ... )
    >>> float(law.load(1, np.sqrt(0.1), 1.0).round(12))
    0.022360679775
    """

    name = "custom"

    load_of: tuple[Formula, ...]
    area_of: tuple[Formula, ...]
    edges: tuple[float, ...] = ()
    checked: bool = True

    def __init__(
        self, load: Formulas, area: Formulas, limits: Sequence[float], critical: float, checked: bool = True
    ) -> None:
        edges = tuple(map(float, limits))
        hold(self, load_of=tuple(load), area_of=tuple(area), edges=edges, critical=float(critical))
        is_data = all(isinstance(formula, RootSeries) for formula in (*load, *area))
        hold(self, checked=checked, is_data=is_data)
        super().__post_init__()
        rising = [0.0, *edges]
        if not (np.all(np.isfinite(rising)) and np.all(np.diff(rising) > 0)):
            raise ValueError(f"limits = {list(edges)}: give numbers > 0 that increase")
        for name, formulas in (("load", self.load_of), ("area", self.area_of)):
            if len(formulas) != len(rising):
                raise ValueError(
                    f"{name}: give {len(rising)} formulas, one more than limits, not {len(formulas)}"
                )
            for piece, formula in enumerate(formulas):
                self._check(name, formula, piece)

    def _value(self, what: str, piece: int, u: Any, e: Array) -> Any:
        formula = getattr(self, f"{what}_of")[piece]
        return u * u * formula(np.log(u) if piece else u) if isinstance(formula, RootSeries) else formula(u)

    def as_data(self, deepest: float) -> "CustomLaw":
        """Return the law as plain numbers: `RootSeries` in place of formulas, up to a penetration.

        Parameters
        ----------
        deepest : float
            Greatest penetration that is needed, of an asperity of modulus E*; pieces that begin there or
            beyond are left out.

        Returns
        -------
        CustomLaw
            Exact to 1e-13 of the largest load or area per penetration in each piece; slopes to some 1e-11.

        Raises
        ------
        ValueError
            If a formula is no smooth function on its piece.
        """
        assert self.critical is not None
        kept = [x for x in self.edges if x * self.critical < deepest]
        ends = np.sqrt([*kept, deepest / self.critical]).tolist()
        pairs = list(zip([-ends[0], *ends[:-1]], ends, strict=True))
        load, area = (
            [_resolved_in_root(f"{name}[{k}]", formulas[k], *pair) for k, pair in enumerate(pairs)]
            for name, formulas in (("load", self.load_of), ("area", self.area_of))
        )
        return CustomLaw(load, area, kept, self.critical, self.checked)

    def given(self) -> dict[str, Any]:
        """Return the number of pieces, and the critical penetration."""
        return {"pieces": len(self.load_of), "critical": self.critical}

    def agrees(self, other: object) -> bool:
        """Return whether another law is the same but for the last digits of its series."""
        if not (isinstance(other, CustomLaw) and self.is_data and other.is_data):
            return False
        alike = self.edges == other.edges and self.critical == other.critical
        pairs = zip((*self.load_of, *self.area_of), (*other.load_of, *other.area_of), strict=True)
        return alike and all(mine.agrees(theirs) for mine, theirs in pairs)  # type: ignore[attr-defined]

    def _check(self, name: str, formula: Formula, piece: int) -> None:
        """Try a formula where its piece begins, and that of the first piece on both sides of first touch."""
        if isinstance(formula, RootSeries):
            first, last = formula.edges[0], formula.edges[-1]
            if piece == 0 and first != -last:
                raise ValueError(f"{name}: the first piece reaches from {first:g} to {last:g}, not around 0")
            return
        start = self.edges[piece - 1] if piece else min(self.edges, default=1.0)
        u = np.sqrt(start) * (np.array([1.1]) if piece else np.array([-0.5, 0.5]))
        with np.errstate(all="ignore"), suppress(TypeError):
            if all(np.all(np.isfinite(formula(v))) for v in (u, u + 1j * STEP * np.abs(u))):
                return
        also = ", also negative ones," if piece == 0 else ""
        name += f"[{piece}]"
        raise ValueError(f"{name}: it must give finite numbers for arrays{also} of real and complex u")
