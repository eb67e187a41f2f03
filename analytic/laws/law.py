"""Contact laws: the load and the radius of one asperity's contact, piece by piece.

Everything is in reduced units. An asperity of height s under a plane at the separation h is penetrated by
``delta = s - h``; lengths normal to the plane are in sigma, contact radii in sqrt(R sigma), loads in
``(4/3) E* sqrt(R) sigma^(3/2)``, and ``e = E*(s)/E*`` is the asperity's own modulus. Formulas take
``y = sqrt(delta)``, in which a contact is analytic where it begins; y is Hertz's radius of contact.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, ClassVar, Self, cast

import numpy as np

from analytic.arrays import Array, Ints
from analytic.surface import Surface, check_positive

STEP = 1e-30  # of a variable, into the complex plane
NEXT_TO_0 = 1e-60  # stands for 0: cubes of it, times a step, are still numbers


class ContactLaw:
    """Contact law of one asperity: Hertz's elastic contact, unless a subclass changes it.

    A law consists of pieces. Piece 0 begins where the asperity touches, at delta = 0; piece j begins at
    the penetration ``limits(e)[j - 1]``. `load` and `radius` of a piece are one formula each that goes on
    smoothly beyond its ends, so that those of piece 0 also take -y. For a slope, formulas are asked for
    complex y: they must not take absolute values, or compare.
    """

    name: ClassVar[str] = "hertz"  #: in scene files and reports
    elastic: ClassVar[bool] = True  #: whether an asperity unloads along its loading curve
    yields: ClassVar[bool] = False  #: whether an asperity yields
    stiff: ClassVar[bool] = True  #: whether stiffness on unloading has a variance; without one it is refused
    root: ClassVar[bool] = True  #: whether piece 0 is analytic in y next to y = 0, as half-integer powers
    is_data: bool = True  #: whether the law consists of plain numbers, which can be stored in a file
    #: constants in reduced units, each with the power of a summit's radius that it goes as on one surface
    of_radius: ClassVar[dict[str, float]] = {}
    #: the constant in SI units that may stand for all of those, and words for what to give
    in_si: ClassVar[tuple[str, str]] = "", ""

    def __post_init__(self) -> None:
        """Refuse constants out of range, and any in SI units beside reduced ones, or neither."""
        si, advice = self.in_si
        given = {name: getattr(self, name) for name in (si, *self.of_radius) if name}
        if si and any((given[name] is None) == (given[si] is None) for name in self.of_radius):
            told = ", ".join(f"{name} = {value!r}" for name, value in given.items())
            raise ValueError(f"{told}: give {advice}")
        check_positive("", **given)
        if (poisson := getattr(self, "poisson", None)) is not None:
            check_poisson(poisson)

    def given(self) -> dict[str, Any]:
        """Return the constants of the law that the user gave, by name."""
        known: list[str] = [field.name for field in fields(self)] if is_dataclass(self) else []
        return {name: getattr(self, name) for name in known if getattr(self, name) is not None}

    def on(self, surface: Surface) -> Self:
        """Return the law on this surface, in reduced units: nothing is left in Pa or m."""
        si, law = self.in_si[0], cast(Any, self)
        if (value := getattr(self, si, None)) is None:
            return self
        return replace(law, **{si: None}, **self.reduced_on(surface, value))  # type: ignore[no-any-return]

    def reduced_on(self, surface: Surface, value: float) -> dict[str, float]:
        """Return what its constant in SI units is on this surface: a length over sqrt(R sigma)."""
        return dict.fromkeys(self.of_radius, value / math.sqrt(surface.radius * surface.sigma))

    def reduced(self, name: str) -> Any:
        """Return a constant in reduced units, or one for each summit; a ValueError if it is in SI units."""
        if (value := getattr(self, name)) is None:
            raise ValueError(f"{self}: put it on a surface first, law.on(surface), or give `{name}`")
        return value

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

    def left(self, above: Array, e: Array) -> Any:
        """Return the penetration left until contact is lost, of one that is so much above the separation."""
        return above


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
    >>> float(Hertz().load(0, np.sqrt(4.0), np.array(1.0)))
    8.0
    """

    name = "hertz"


def check_poisson(poisson: float) -> None:
    """Refuse a value that is not a Poisson's ratio."""
    if not -1 < poisson <= 0.5:
        raise ValueError(f"poisson = {poisson!r}: give a Poisson's ratio, above -1 and at most 0.5")


def piece_of(law: ContactLaw, penetration: Array, e: Array) -> Ints:
    """Which piece of the law holds at these penetrations, in the shape of both."""
    first = np.zeros(np.broadcast(penetration, e).shape, dtype=np.int64)
    with np.errstate(divide="ignore", over="ignore"):  # without a modulus nothing yields
        return sum((limit <= penetration for limit in law.limits(e)), first)


def slope_in_root(formula: Callable[[Any], Any], y: Array) -> Array:
    """``d formula/d(y^2)``, at y = 0 its limit."""
    y = np.where(y == 0, NEXT_TO_0, y)
    step = STEP * np.abs(y)
    return np.asarray(np.imag(formula(y + 1j * step)) / step / (2 * y))
