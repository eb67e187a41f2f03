"""Contact laws: the load and the radius of one asperity's contact, piece by piece.

Everything is in reduced units. An asperity of height s under a plane at the separation h is penetrated by
``delta = s - h``; lengths normal to the plane are in sigma, contact radii in sqrt(R sigma), loads in
``(4/3) E* sqrt(R) sigma^(3/2)``, and ``e = E*(s)/E*`` is the asperity's own modulus. Formulas take
``y = sqrt(delta)``, in which a contact is analytic where it begins; y is Hertz's radius of contact.
"""

import math
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from analytic.arrays import Array, Ints, hold
from analytic.surface import Surface, check_positive

_STEP = 1e-30  # of a variable, into the complex plane
NEXT_TO_0 = 1e-60  # stands for 0: cubes of it, times a step, are still numbers


class ContactLaw:
    """Contact law of one asperity: Hertz's elastic contact, unless a subclass changes it.

    A law consists of pieces. Piece 0 begins where the asperity touches, at delta = 0; piece j begins at
    the penetration ``limits(e)[j - 1]``. `load` and `radius` of a piece are one formula each that goes on
    smoothly beyond its ends, so that those of piece 0 also take -y. For a slope, formulas are asked for
    complex y: they must not take absolute values, or compare.

    Attributes
    ----------
    name : str
        Name of the law in scene files and reports.
    elastic : bool
        Whether an asperity unloads along its loading curve.
    yields : bool
        Whether an asperity yields.
    stiff : bool
        False if on unloading the stiffness of a contact has no variance, and so is refused.
    finest : float
        How far above first touch the formulas of piece 0 are analytic, in penetration: infinite if they
        are sums of powers of y.
    of_radius : (str, float) or None
        A constant that follows the radius of a summit, and the power of the radius on one surface that it
        goes as.
    in_si : (str, str) or None
        The constant in SI units that may stand for that one, and words for the two.
    root : bool
        False if piece 0 is no analytic function of y next to y = 0, as a power that is no half-integer.
    """

    name: ClassVar[str] = "hertz"
    elastic: ClassVar[bool] = True
    yields: ClassVar[bool] = False
    root: ClassVar[bool] = True
    stiff: ClassVar[bool] = True
    of_radius: ClassVar[tuple[str, float] | None] = None
    in_si: ClassVar[tuple[str, str] | None] = None

    @property
    def finest(self) -> float:
        """How far above first touch the formulas of piece 0 are analytic."""
        return math.inf

    @property
    def is_data(self) -> bool:
        """Whether the law consists of plain numbers, which can be stored in a file."""
        return True

    def as_data(self, deepest: float) -> "ContactLaw":
        """Return the law as plain numbers, up to a given penetration of an asperity of modulus E*."""
        return self

    def agrees(self, other: "ContactLaw") -> bool:
        """Return whether another law is the same, up to rounding in a stored series."""
        return self == other

    def given(self) -> dict[str, Any]:
        """Return the constants of the law that the user gave, by name."""
        known: list[str] = [field.name for field in fields(self)] if is_dataclass(self) else []
        return {name: getattr(self, name) for name in known if getattr(self, name) is not None}

    @property
    def hertz(self) -> bool:
        """Whether this is Hertz's law, for which closed forms exist."""
        return type(self) in (ContactLaw, Hertz)

    def check_constants(self, *others: str) -> None:
        """Refuse constants that are not numbers > 0, and two that fix the same thing, or neither of these."""
        names = [pair[0] for pair in (self.in_si, self.of_radius) if pair]
        given = {name: getattr(self, name) for name in (*names, *others)}
        if self.in_si and sum(given[name] is None for name in names) != 1:
            told = ", ".join(f"{name} = {given[name]!r}" for name in names)
            raise ValueError(f"{told}: give one of them, {self.in_si[1]}")
        check_positive("", **given)
        poisson = getattr(self, "poisson", None)
        if poisson is not None:
            check_poisson(poisson)

    def on(self, surface: Surface) -> Self:
        """Return the law on this surface, in reduced units: nothing is left in Pa or m."""
        if not (self.in_si and self.of_radius) or getattr(self, self.in_si[0]) is None:
            return self
        law: Any = self
        return replace(law, **{self.in_si[0]: None, self.of_radius[0]: self.reduced_on(surface)})  # type: ignore[no-any-return]

    def reduced_on(self, surface: Surface) -> float:
        """Return the constant that follows the radius, on this surface: a length over sqrt(R sigma)."""
        length: float = getattr(self, self.in_si[0])  # type: ignore[index]
        return length / math.sqrt(surface.radius * surface.sigma)

    @property
    def reduced(self) -> Any:
        """The constant that follows the radius, or one for each summit; a ValueError if it is in SI units."""
        assert self.of_radius
        value = getattr(self, self.of_radius[0])
        if value is None:
            raise ValueError(
                f"{self}: put it on a surface first, law.on(surface), or give `{self.of_radius[0]}`"
            )
        return value

    def with_radii(self, ratios: Array) -> Self:
        """Return it in the units of summits whose radii are these multiples of the surface's.

        Parameters
        ----------
        ratios : ndarray
            One a summit: formulas then take arrays of this shape.

        Returns
        -------
        ContactLaw
            Radii of contact over sqrt(c R sigma), loads over ``(4/3) E* sqrt(c R) sigma^(3/2)``.
        """
        if not self.of_radius:
            return self
        changed, (name, power) = copy(self), self.of_radius
        hold(changed, **{name: getattr(self, name) * ratios**power})  # checks are for numbers
        return changed

    def limits(self, e: Array) -> Array:
        """Return penetrations where the next piece begins, increasing; shape ``(pieces - 1, *e.shape)``."""
        return np.empty((0, *np.shape(e)))

    def load(self, piece: int, y: Any, e: Array) -> Any:
        """Return the load of a contact, in the shape of `y` and `e`."""
        return e * (y * y * y)

    def radius(self, piece: int, y: Any, e: Array) -> Any:
        """Return the radius of a contact; its square is the area over pi R sigma."""
        return y + 0.0 * e

    def stiffness(self, piece: int, y: Array, e: Array) -> Array:
        """Return the stiffness of a spot over 2 E* sqrt(R sigma); after yield, that as unloading starts."""
        return np.asarray(e * self.radius(piece, y, e))

    def unloading(self, deepest: Any) -> "ContactLaw":
        """Return the law of contacts that are pulled back from their deepest penetration.

        Its formulas take ``y = sqrt(penetration - residual)``, so that next to lift-off no digit is lost;
        `piece` is the piece of this law that holds at the deepest penetration.

        Raises
        ------
        ValueError
            If asperities yield and their unloading is not known.
        """
        if not self.elastic:
            raise ValueError(
                f"law = {self.name!r}: no unloading is known for it; use 'kogut-etsion' or an elastic law"
            )
        return self

    def residual(self, e: Array) -> Any:
        """Return the penetration at which contact is lost on unloading."""
        return 0.0


@dataclass(frozen=True)
class Hertz(ContactLaw):
    """Hertz's contact: load ``e delta^(3/2)``, area ``delta``, stiffness ``e delta^(1/2)``.

    Valid for frictionless elastic spheres whose radius of contact is small against R. It has no known
    defect, but metals seldom stay elastic (see the elastic-plastic laws).

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


def check_poisson(poisson: float) -> None:
    """Refuse a value that is not a Poisson's ratio."""
    if not -1 < poisson <= 0.5:
        raise ValueError(f"poisson = {poisson!r}: give a Poisson's ratio, above -1 and at most 0.5")


def piece_of(law: ContactLaw, penetration: Array, e: Array) -> Ints:
    """Which piece of the law holds at these penetrations, in the shape of both."""
    piece = np.zeros(np.broadcast_shapes(np.shape(penetration), np.shape(e)), dtype=np.int64)
    with np.errstate(divide="ignore", over="ignore"):  # without a modulus nothing yields
        for limit in law.limits(e):
            piece += limit <= penetration
    return piece


def slope_in_root(formula: Callable[[Any], Any], y: Array) -> Array:
    """``d formula/d(y^2)``, at y = 0 its limit."""
    y = np.where(y == 0, NEXT_TO_0, y)
    step = _STEP * np.abs(y)
    return np.asarray(np.imag(formula(y + 1j * step)) / step / (2 * y))
