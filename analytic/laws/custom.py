"""Your own contact law: formulas of its pieces, and the series by which a file stores them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.polynomial import Chebyshev

from analytic.arrays import Array, hold
from analytic.laws.elastic_plastic import ElasticPlastic

_MOST_TERMS = 256
_NOTHING = 1e-16  # of the largest value
_ALLOWED = 1e-13
Formula = Callable[[Any], Any]
_PROBE = 1e-30j  # slopes are taken by a step into the complex plane


@dataclass(frozen=True)
class RootSeries:
    """``u^2`` times a Chebyshev series, in the root u of a penetration.

    Parameters
    ----------
    low, high : float
        Between which the series was made. If `low` is ``-high``, around first touch, its variable is u, else
        log(u), which sees wide pieces evenly.
    coefficients : sequence of float
        Of T_0, T_1, ... in that variable, stretched to -1..1.
    """

    low: float
    high: float
    coefficients: tuple[float, ...]

    def __call__(self, u: Any) -> Any:
        """Its values, for real and complex u, also slightly outside."""
        around_0 = self.low < 0
        ends = [self.low, self.high] if around_0 else np.log([self.low, self.high])
        return u * u * Chebyshev(self.coefficients, domain=ends)(u if around_0 else np.log(u))

    @property
    def between(self) -> Array:
        """Roots all over its range, of which none is 0."""
        if self.low < 0:
            return np.linspace(self.low, self.high, 300)
        return np.geomspace(self.low, self.high, 300)

    def agrees(self, other: "RootSeries") -> bool:
        """Whether another series has the same values, to 1e-13 of the largest."""
        u = self.between
        mine, theirs = self(u) / u**2, other(u) / u**2
        near = np.allclose([self.low, self.high], [other.low, other.high], rtol=_ALLOWED)
        return bool(near and np.all(np.abs(mine - theirs) <= _ALLOWED * np.abs(mine).max()))


def resolved_in_root(formula: Formula, low: float, high: float) -> RootSeries:
    """Return the series that stands for a formula, to 1e-13 of the largest value of ``formula/u^2``.

    If 256 terms are not enough that is a ValueError.
    """

    def over_square(t: Any) -> Any:
        u = t if low < 0 else np.exp(t)
        return formula(u) / (u * u)

    ends = [low, high] if low < 0 else np.log([low, high])
    for terms in (16, 32, 64, 128, _MOST_TERMS):
        with np.errstate(all="ignore"):  # a piece may be too wide for any
            c = Chebyshev.interpolate(over_square, terms - 1, domain=ends).coef
            c[np.abs(c) <= _NOTHING * np.abs(c).max()] = 0  # so that what is even or odd stays it
            found = RootSeries(low, high, tuple(np.trim_zeros(c, "b").tolist()) or (0.0,))
            u = found.between
            off = np.abs(found(u) - formula(u)) / u**2
        if np.all(off <= _ALLOWED * np.abs(c).max()):
            return found
    first = "; where it begins, write u**3 for (u*u)**1.5: it is also evaluated at -u" if low < 0 else ""
    raise ValueError(
        f"a series of {_MOST_TERMS} terms is not accurate enough between x = {low * abs(low):g} and "
        f"{high * high:g}: give the penetration of each jump and kink in limits{first}"
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

    name: ClassVar[str] = "custom"

    load_of: tuple[Formula, ...]
    area_of: tuple[Formula, ...]
    edges: tuple[float, ...] = ()
    checked: bool = True

    def __init__(
        self,
        load: Sequence[Formula],
        area: Sequence[Formula],
        limits: Sequence[float],
        critical: float,
        checked: bool = True,
    ) -> None:
        edges = tuple(map(float, limits))
        hold(self, load_of=tuple(load), area_of=tuple(area), edges=edges, critical=float(critical))
        hold(self, checked=checked)
        super().__post_init__()
        rising = [0.0, *self.edges]
        if not (np.all(np.isfinite(rising)) and np.all(np.diff(rising) > 0)):
            raise ValueError(f"limits = {list(self.edges)}: give numbers > 0 that increase")
        for name, formulas in self._formulas().items():
            if len(formulas) != len(rising):
                raise ValueError(
                    f"{name}: give {len(rising)} formulas, one more than limits, not {len(formulas)}"
                )
            for piece, formula in enumerate(formulas):
                self._check(f"{name}[{piece}]", formula, piece)

    def _formulas(self) -> dict[str, tuple[Formula, ...]]:
        return {"load": self.load_of, "area": self.area_of}

    @property
    def is_data(self) -> bool:
        """Whether the law consists of series, which can be stored in a file."""
        return all(isinstance(formula, RootSeries) for formula in (*self.load_of, *self.area_of))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return the load of a contact, in the shape of `y` and `e`."""
        e = np.asarray(e, dtype=np.float64)
        at_yield = self._root_of_critical**3 / np.square(np.where(e > 0, e, np.inf))
        return at_yield * self.load_of[piece](self._u(y, e))

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Return the radius of a contact; its square is the area over pi R sigma."""
        u = self._u(y, e)
        u = np.where(u == 0, 1.0, u)  # where the factor y is 0
        return y * np.sqrt(self.area_of[piece](u) / (u * u))

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
            Exact to 1e-13 of the largest load or area per penetration in each piece; slopes to some 1e-12.

        Raises
        ------
        ValueError
            If a formula is no smooth function on its piece.
        """
        assert self.critical is not None
        x_max = deepest / self.critical
        kept = [x for x in self.edges if x < x_max]
        ends = np.sqrt([*kept, x_max]).tolist()
        starts = [-ends[0], *ends[:-1]]
        series: dict[str, list[Formula]] = {"load": [], "area": []}
        for name, formulas in self._formulas().items():
            for piece, (low, high) in enumerate(zip(starts, ends, strict=True)):
                try:
                    series[name].append(resolved_in_root(formulas[piece], low, high))
                except ValueError as error:
                    raise ValueError(f"{name}[{piece}]: {error}") from None
        return CustomLaw(series["load"], series["area"], kept, self.critical, self.checked)

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

    def _u(self, y: Any, e: Array) -> Any:
        """``sqrt(delta/delta_c)``; 1 where there is no stiffness."""
        return np.where(np.asarray(e) > 0, y * e / self._root_of_critical, 1.0)

    def _check(self, name: str, formula: Formula, piece: int) -> None:
        """Try a formula where its piece begins, and that of the first piece on both sides of first touch."""
        start = self.edges[piece - 1] if piece else min(self.edges, default=1.0)
        u = np.sqrt(start) * (np.array([1.1]) if piece else np.array([-0.5, 0.5]))
        with np.errstate(all="ignore"):
            try:
                good = all(np.all(np.isfinite(formula(v))) for v in (u, u + _PROBE * np.abs(u)))
            except TypeError:
                good = False
        if not good:
            also = ", also negative ones," if piece == 0 else ""
            raise ValueError(f"{name}: it must give finite numbers for arrays{also} of real and complex u")
