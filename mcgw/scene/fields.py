"""Quantities derived from the values of a scene, and the range of heights that matters."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from operator import attrgetter
from typing import Any, Literal

import numpy as np

import analytic
from analytic import HeightLaw, MeasuredRadii, RandomCurvature, SpectralMoments, Surface
from analytic.joint import Gap, above_surface
from analytic.laws import Branch, ContactLaw, Film, Hertz
from mcgw.scene.contact import Contact, Joint
from mcgw.scene.ensemble import Sampling
from mcgw.scene.measured import Fitted, Uncertainty, moments_of

_BEYOND = 1e-16  # share of heights above those checked for negative moduli


class LeftOut(int):
    """An integer that was not given: it equals the same number, but is found anew when the scene changes."""


def _of(path: str) -> Any:
    """Return a value of a part."""
    return property(attrgetter(path))


class Flat:
    """Values of the parts of a scene and of its model, which others read as its own."""

    alone: analytic.Model = _of("theory.alone")  # without interaction and gas
    ways: Branch = _of("theory.ways")  # of loading or unloading
    law: ContactLaw = _of("contact.law")
    quantities: tuple[str, ...] = _of("contact.quantities")
    unload_from: float | None = _of("contact.unload_from")
    hardness: float | None = _of("contact.hardness")
    poisson: float | None = _of("contact.poisson")
    film: Film | None = _of("joint.film")
    gas: analytic.Joint | None = _of("joint.filling")
    n_surfaces: int = _of("ensemble.n_surfaces")
    n_asperities: int = _of("ensemble.n_asperities")
    count: Literal["fixed", "poisson"] = _of("ensemble.count")
    seed: int = _of("ensemble.seed")
    sampler: str = _of("ensemble.sampler")
    keep: str = _of("ensemble.keep")
    rel_err: float | Mapping[str, float | list[float]] | None = _of("ensemble.rel_err")
    max_seconds: float | None = _of("ensemble.max_seconds")
    accuracy: float = _of("ensemble.accuracy")


@dataclass(frozen=True, init=False, repr=False)
class Fields(Flat):
    """The parts of a scene, complete and checked, with what follows from them."""

    surface: Surface
    separations: tuple[float, ...]
    title: str
    grading: analytic.Grading
    negative: str
    heights: HeightLaw
    summits: RandomCurvature | MeasuredRadii | None
    contact: Contact
    interaction: analytic.Interaction | None
    joint: Joint
    ensemble: Sampling
    fitted: Fitted | None

    @property
    def uncertainty(self) -> Uncertainty | None:
        """Standard errors of the parameters of the surface; None if they are known."""
        return getattr(self.surface, "uncertainty", None)

    @cached_property
    def touching(self) -> float:
        """Expected number of asperities of a surface above the lowest separation."""
        return self.n_asperities * float(self.heights.sf(np.array(self.lowest)))

    @property
    def modulus(self) -> analytic.Grading:
        """The grading as used: clipped if the scene says so."""
        return analytic.Clipped(self.grading) if self.negative == "clip" else self.grading

    @cached_property
    def theory(self) -> analytic.Model:
        """The exact model of this scene: modulus, heights, contact law, history, asperities, joint."""
        return analytic.Model(
            self.surface,
            grading=self.modulus,
            heights=self.heights,
            curvature=self.summits,
            law=self.law,
            unload_from=self.unload_from,
            film=self.film,
            n_asperities=float(self.n_asperities),
            count=self.count,
            interaction=self.interaction,
            filled=self.filled,
        )

    @property
    def moments(self) -> SpectralMoments | None:
        """Spectral moments of its surface, if they are known."""
        return moments_of(self.surface, self.heights, self.fitted)

    @cached_property
    def filled(self) -> Gap | None:
        """Conduction by gas in the gap of the joint; None without one."""
        return None if self.gas is None else self.gas.gap(self.surface, self.heights, self.moments)

    @cached_property
    def rise(self) -> float | None:
        """Height of the mean plane of the summits above that of the surface, over sigma; None if unknown."""
        rms = None if self.gas is None else self.gas.rms
        found = above_surface(self.surface, self.heights, self.moments, rms)
        return None if found is None else found[1]

    @property
    def gap(self) -> str:
        """The name of its gap: between the mean planes of the surfaces, or to that of the summits."""
        return "gap_to_summits" if self.rise is None else "mean_gap"

    def quantity(self, name: str) -> analytic.Quantity:
        """Return a quantity with its unit in this scene, which conducts heat or current."""
        q = analytic.quantity_of(name)
        return replace(q, unit=q.unit.split(" or ")[-1 if self.thermal else 0]) if " or " in q.unit else q

    @property
    def thermal(self) -> bool:
        """Whether heat is conducted."""
        return self.film is not None and self.film.thermal

    @property
    def from_mean_plane(self) -> bool:
        """Whether nominal separations are measured from the mean of the deformed plane, as gaps are."""
        return self.interaction is not None and self.interaction.reference == "mean-plane"

    def series(self, quantity: str) -> float:
        """Return what the half-space adds to the inverse of a sum over spots, in units of that sum."""
        if self.interaction is None:
            return 0.0
        rho = 1.0 if self.film is None else self.film.rho
        return self.interaction.series(quantity, self.surface, float(self.n_asperities), rho)

    @property
    def as_measured(self) -> bool:
        """Whether its one surface has the measured heights as they are, and nothing is drawn."""
        return isinstance(self.heights, analytic.MeasuredHeights) and not self.heights.resampled

    @property
    def hertzian(self) -> bool:
        """Whether every sum is over powers of the penetration, as in Hertz's law."""
        return type(self.law) is Hertz and self.film is None

    @property
    def reduced_law(self) -> ContactLaw:
        """The contact law in reduced units."""
        return self.law.on(self.surface)

    @property
    def softer(self) -> tuple[float, float] | None:
        """Hardness, Pa, and Poisson's ratio that tell whether contacts of an elastic law yield, if known."""
        if self.hardness is None:
            return None
        poisson = getattr(self.law, "poisson", self.poisson)
        return self.hardness, 0.3 if poisson is None else poisson

    @property
    def all_separations(self) -> tuple[float, ...]:
        """Every separation once, increasing."""
        return tuple(sorted(set(self.separations)))

    @property
    def tables(self) -> tuple[str, ...]:
        """Names of the tables of an ensemble, which have a number for each surface and separation."""
        separations = {} if self.interaction is None else analytic.SEPARATIONS
        more = separations if self.joint.gas is None else separations | analytic.JOINT
        back = self.unload_from is not None
        return (*self.quantities, *(name for name, q in more.items() if back or not q.unloading))

    @property
    def of_joint(self) -> tuple[str, ...]:
        """Conductances of a joint other than those of its spots."""
        return tuple(name for name in self.tables if name in analytic.JOINT)

    @property
    def answers(self) -> tuple[str, ...]:
        """Its answers: sums and conductances of the joint."""
        return (*self.quantities, *self.of_joint)

    @property
    def width(self) -> int:
        """Count of numbers of one surface in all tables."""
        return len(self.tables) * len(self.separations)

    @property
    def lowest(self) -> float:
        """Lowest separation that asperities ever feel: those below it never touch."""
        lowest = min(self.separations)
        return lowest if self.unload_from is None else min(lowest, self.unload_from)

    @cached_property
    def highest(self) -> float:
        """Height that hardly any asperity exceeds, above every separation."""
        rare = float(self.heights.isf(np.array(_BEYOND)))
        return min(max(rare, max(self.separations) + 1), self.heights.support[1])

    @cached_property
    def least(self) -> float:
        """Height that hardly any asperity is below."""
        return float(self.heights.ppf(np.array(_BEYOND)))

    def negative_above(self, h: float) -> float | None:
        """First height that touches at `h` where the grading is negative, clipped or not; or None."""
        bottom, end = self.heights.support
        high = min(max(self.highest, h + 1), end)
        start = max(h, self.least - 1, bottom)
        return analytic.first_negative(self.grading, start, high) if start < high else None
