"""What is asked: surface, grading, contact and ensemble, checked before anything is computed."""

import dataclasses
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from analytic import (
    QUANTITIES,
    Clipped,
    Custom,
    Exponential,
    Grading,
    HeightLaw,
    MeasuredHeights,
    Model,
    PiecewiseSeries,
    Surface,
    Table,
    first_negative,
)
from mcgw.formats.sheet import Sheet, Shown, brief
from mcgw.scene.law_text import law_text
from mcgw.scene.reading import LeftOut, read_values
from mcgw.scene.samplers import promise_of
from mcgw.scene.section import SceneError, nearest
from mcgw.scene.surface import SURFACE_UNITS, surface_of

__all__ = ["LeftOut", "Scene", "SceneError"]

_LEAST = 1e-100  # next to it, powers of a distance are beyond double precision
MOST_ASPERITIES = 2**53  # counts are exact in double precision up to here
_SURFACES, _MOST_SURFACES = 1000, 10**9  # where n_surfaces is left out; where rel_err is to decide
_BEYOND = 1e-16  # share of the heights that lie above what is checked for negative moduli


@dataclass(frozen=True, repr=False)
class Scene(Shown):
    """Everything that determines an ensemble.

    Parameters
    ----------
    surface : Surface
        Parameters in SI units: `mcgw.Surface`.
    separations : array_like
        Reduced separations d/sigma, in any order, repeated or not: an array, a list, or one number.
    title : str, optional
        For people.
    grading : Grading or callable, optional
        E*(s)/E*, or any function of an array of heights s, as ``lambda s: 1 + 0.3*np.tanh(s)``; its kinks
        and jumps are searched for, or told by `mcgw.Custom`. Default: homogeneous.
    negative : {"error", "clip", "allow"}, optional
        What to do where the grading makes the modulus of a contacting asperity negative.
    heights : HeightLaw or frozen law of scipy.stats, optional
        Law of the reduced heights: of a law of scipy the mean and the scale drop out. Default: Gaussian.
    quantities : sequence of str, optional
        Which sums to compute: names of `analytic.QUANTITIES`. Default: load, area, stiffness, contacts.
    n_surfaces : int, optional
        Number of surfaces M, default: 1000; with `rel_err` the most that may be drawn, default: 1e9.
    n_asperities : int, optional
        Asperities on each (their mean number if `count` is "poisson"). Default: eta A_n, rounded, of
        whatever surface the scene has, so that N follows if the surface is replaced.
    count : {"fixed", "poisson"}, optional
        Law of their number.
    seed : int, optional
        0 to 2^64 - 1. Default: drawn, and recorded.
    sampler : {"auto", "direct", "tail", "cells", "aggregate", "stratified"}, optional
        How surfaces are drawn; "auto" takes the cheapest exact way.
    keep : {"sums", "moments"}, optional
        Whether the file also keeps the moments, from which `mcgw.regrade` starts.
    rel_err : float or str, optional
        Draw so many surfaces that the 95 % interval of every mean reaches no farther than this share of
        it, 0 to 0.1 or as "1 %": as many as the exact law of a finite surface says.
    max_seconds : float or str, optional
        Stop after the block that is being drawn then; s, or as "2 h".

    Raises
    ------
    SceneError
        With one line for each mistake, as for a scene file.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
    >>> mcgw.Scene(surface, separations=[0, 2, 4], grading=mcgw.Exponential(2.0), seed=1)
    Scene
      surface      sigma = 1.37e-06 m, radius = 1.3e-05 m, eta = 3e+08 1/m^2
                   nominal_area = 0.0001 m^2, E_star = 7.86e+10 Pa
      grading      Exponential(gamma=2.0)
      heights      Gaussian()
      separations  3 from 0 to 4 (d/sigma)
      quantities   load, area, stiffness, contacts
      ensemble     1000 surfaces of 30000 asperities (fixed), seed 1, sampler auto
    """

    surface: Surface
    separations: tuple[float, ...]
    title: str
    grading: Grading
    negative: Literal["error", "clip", "allow"]
    heights: HeightLaw
    quantities: tuple[str, ...]
    n_surfaces: int
    n_asperities: int
    count: Literal["fixed", "poisson"]
    seed: int
    sampler: str
    keep: Literal["sums", "moments"]
    rel_err: float | None
    max_seconds: float | None

    def __init__(
        self,
        surface: Surface,
        *,
        separations: ArrayLike,
        title: str = "",
        grading: Grading | Callable[[Any], Any] | None = None,
        negative: Literal["error", "clip", "allow"] = "error",
        heights: Any = None,
        quantities: Sequence[str] | None = None,
        n_surfaces: int | None = None,
        n_asperities: int | None = None,
        count: Literal["fixed", "poisson"] = "fixed",
        seed: int | None = None,
        sampler: str = "auto",
        keep: Literal["sums", "moments"] = "sums",
        rel_err: float | str | None = None,
        max_seconds: float | str | None = None,
    ) -> None:
        given = {key: value for key, value in locals().items() if key != "self"}
        values, problems = read_values(given)
        if problems:
            raise SceneError(problems)
        for key, value in values.items():
            object.__setattr__(self, key, value)
        self._check()

    def _check(self) -> None:
        """Give what was left out its value, and refuse values that do not go together."""
        self._fill("n_asperities", round(min(self.surface.n_asperities, 2.0**62)))
        self._fill("n_surfaces", _SURFACES if self.rel_err is None else _MOST_SURFACES)
        object.__setattr__(self, "separations", tuple(h + 0.0 for h in self.separations))  # -0.0 is 0.0
        problems = [*self._wrong_values(), *self._wrong_scales(), *self._wrong_measured()]
        problems = (
            problems
            or self._wrong_function()
            or self._wrong_range()
            or self._wrong_modulus()
            or self._wrong_grading()
        )
        if problems:
            raise SceneError(problems)

    def _fill(self, key: str, value: int) -> None:
        """Give what was left out, now or in the scene that this one was made of, its value."""
        if isinstance(getattr(self, key), LeftOut):
            object.__setattr__(self, key, LeftOut(value))

    @property
    def left_out(self) -> tuple[str, ...]:
        """Which of the numbers that depend on something else nobody gave: n_asperities, seed."""
        return tuple(key for key in ("n_asperities", "seed") if isinstance(getattr(self, key), LeftOut))

    def replace(self, **changes: Any) -> "Scene":
        """The scene with other values; what was left out follows.

        Parameters
        ----------
        **changes
            Fields of the scene or of its surface, each as `Scene` and `mcgw.Surface` take it; None leaves
            a field out.

        Returns
        -------
        Scene
            Checked anew.

        Raises
        ------
        TypeError
            If there is no such field.
        SceneError
            If a value is wrong.

        Examples
        --------
        >>> import mcgw
        >>> surface = mcgw.Surface("1 um", "10 um", "300/mm^2", "1 cm^2", "80 GPa")
        >>> scene = mcgw.Scene(surface, separations=1.0)
        >>> scene.n_asperities, scene.replace(nominal_area="10 cm^2").n_asperities
        (30000, 300000)
        """
        fields = (*(each.name for each in dataclasses.fields(self)), *SURFACE_UNITS)
        for key in changes:
            if key not in fields:
                meant = nearest(key, fields).rstrip() or f"it has {', '.join(fields)}"
                raise TypeError(f"a scene has no {key!r}; {meant}")
        of_surface = {key: changes.pop(key) for key in SURFACE_UNITS if key in changes}
        if of_surface:
            surface = changes.get("surface", self.surface)
            changes["surface"] = surface_of(
                {key: of_surface.get(key, getattr(surface, key)) for key in SURFACE_UNITS}
            )
        return dataclasses.replace(self, **changes)

    def sheet(self) -> Sheet:
        """What is shown of it."""
        x = {key: f"{key} = {getattr(self.surface, key):g} {unit}" for key, unit in SURFACE_UNITS.items()}
        h, among = self.separations, f"{len(self.separations)} from " if len(self.separations) > 1 else ""
        ends = " to ".join(f"{end:g}" for end in sorted({min(h), max(h)}))
        stop = "" if self.rel_err is None else f" until rel_err = {self.rel_err:g}, at most"
        facts = [
            ("surface", ", ".join((x["sigma"], x["radius"], x["eta"]))),
            ("", f"{x['nominal_area']}, {x['E_star']}"),
            ("grading", law_text(self.grading) + ("" if self.negative == "error" else f", {self.negative}")),
            ("heights", law_text(self.heights)),
            ("separations", f"{among}{ends} (d/sigma)"),
            ("quantities", ", ".join(self.quantities)),
            (
                "ensemble",
                f"{stop} {self.n_surfaces} surfaces of {self.n_asperities} asperities ({self.count}), "
                f"seed {self.seed}, sampler {self.sampler}".strip(),
            ),
        ]
        return Sheet(f"Scene: {self.title}" if self.title else "Scene", facts)

    @property
    def modulus(self) -> Grading:
        """The grading as used: clipped if the scene says so."""
        return Clipped.of(self.grading) if self.negative == "clip" else self.grading

    @property
    def theory(self) -> Model:
        """The exact model of this very scene: its modulus, height law, number of asperities and count."""
        return Model(
            self.surface,
            grading=self.modulus,
            heights=self.heights,
            n_asperities=float(self.n_asperities),
            count=self.count,
        )

    @property
    def lowest(self) -> float:
        """The lowest separation: what lies below it never touches."""
        return min(self.separations)

    @property
    def touching(self) -> float:
        """Asperities of a surface that are expected above the lowest separation."""
        return self.n_asperities * float(self.heights.above(np.array(self.lowest)))

    def negative_above(self, h: float) -> float | None:
        """First height that touches at `h` where the grading is negative, clipped or not; or None."""
        bottom, end = self.heights.support
        high = min(max(self._highest(), h + 1), end)
        start = max(h, float(self.heights.from_below(np.array(_BEYOND), math.inf)) - 1, bottom)
        return first_negative(self.grading, start, high) if start < high else None

    def _wrong_values(self) -> list[str]:
        problems = []
        if not self.separations:
            problems.append("contact.separations = []: give at least one separation d/sigma")
        tiny = [h for h in self.separations if 0 < abs(h) < _LEAST]
        if tiny:
            problems.append(
                f"contact.separations: {tiny[0]:g} is too close to 0; give 0, or at least {_LEAST:g}"
            )
        if not self.quantities:
            problems.append(f"contact.quantities = []: give one or more of {', '.join(QUANTITIES)}")
        problems += [
            f"contact.quantities: {name!r} is not one of {', '.join(QUANTITIES)}"
            for name in self.quantities
            if name not in QUANTITIES
        ]
        if len(set(self.quantities)) < len(self.quantities):
            problems.append(f"contact.quantities = {list(self.quantities)}: name each quantity once")
        if not 1 <= self.n_asperities <= MOST_ASPERITIES:
            problems.append(
                f"ensemble.n_asperities = {self.n_asperities}: must lie between 1 and 2^53; "
                "change it, or surface.eta and surface.nominal_area"
            )
        if self.rel_err is not None and self.rel_err > 0.1:
            problems.append(
                f"ensemble.rel_err = {self.rel_err}: give a number > 0 and at most 0.1, beyond which so few "
                "contacts would do that an interval means nothing"
            )
        if not promise_of(self.sampler).real_surfaces and self.rel_err is not None:
            problems.append(
                'ensemble.rel_err: sampler = "stratified" has no variance to stop by; take another'
            )
        if self.seed >= 2**64:
            problems.append(f"ensemble.seed = {self.seed}: give a whole number from 0 to 2^64 - 1")
        if self.keep == "moments" and not promise_of(self.sampler).keeps_moments:
            problems.append(f'ensemble.keep = "moments": sampler = "{self.sampler}" has none; take "cells"')
        return problems

    def _wrong_scales(self) -> list[str]:
        """Products of parameters that leave the range of double precision."""
        problems = []
        for name in self.quantities:
            if name not in QUANTITIES:
                continue
            with np.errstate(all="ignore"):
                try:
                    one = QUANTITIES[name].scale(self.surface)
                except OverflowError:
                    one = math.inf
                ends = (one * 1e-12, one * float(self.n_asperities) * 1e4)
            if not (np.finfo(float).tiny < ends[0] and ends[1] < np.finfo(float).max):
                problems.append(
                    f"surface: the {name} of an asperity would be {one:.3g} {QUANTITIES[name].unit}, "
                    "beyond double precision; check sigma, radius and E_star"
                )
        return problems

    def _wrong_grading(self) -> list[str]:
        """Sums that the grading makes larger than double precision holds."""
        ends = np.array(sorted({self.lowest, self._highest(), *self.separations}))
        with np.errstate(all="ignore"):
            try:
                steepest = float(np.max(np.abs(self.modulus(ends))))
            except ValueError:
                return []  # `_wrong_modulus` says why
            stiff = [QUANTITIES[name] for name in self.quantities if QUANTITIES[name].modulus]
            sums = [q.scale(self.surface) * steepest * float(self.n_asperities) * 1e4 for q in stiff]
        if all(value < np.finfo(float).max for value in sums):
            return []
        key = (
            f"grading.gamma = {self.grading.gamma:g}" if isinstance(self.grading, Exponential) else "grading"
        )
        return [f"{key}: E*(s)/E* reaches {steepest:.3g}, and sums leave double precision; give a modest one"]

    def _wrong_function(self) -> list[str]:
        """A Python function that does not take arrays."""
        if not isinstance(self.grading, Custom):
            return []
        try:
            with np.errstate(all="ignore"):
                self.grading.function(np.array([self.lowest, self._highest()]))
        except Exception as error:  # of any kind: it is the user's own code
            reason = brief(f"{type(error).__name__}: {error}")
            return [
                f"grading: the function fails on an array of heights ({reason}); write it with numpy, or "
                "give np.vectorize of it"
            ]
        return []

    def _wrong_range(self) -> list[str]:
        """Heights that touch and that the series of a grading do not reach."""
        if not isinstance(self.grading, PiecewiseSeries):
            return []
        lowest = max(self.lowest, float(self.heights.from_below(np.array(_BEYOND), math.inf)))
        first, last = self.grading.edges[0], self.grading.edges[-1]
        if self.lowest >= self._highest() or (first <= lowest and self._highest() <= last):
            return []
        return [
            f"grading.edges: the series reach from s = {first:.6g} to {last:.6g}, but heights from "
            f"{lowest:.6g} to {self._highest():.6g} count; give the grading itself, or other separations"
        ]

    def _highest(self) -> float:
        """Height that hardly an asperity exceeds, above every separation."""
        top = float(self.heights.from_above(np.array(_BEYOND), -math.inf))
        return min(max(top, max(self.separations) + 1), self.heights.support[1])

    def _wrong_measured(self) -> list[str]:
        """Measured heights are one surface, added up and not drawn."""
        if not isinstance(self.heights, MeasuredHeights):
            return []
        problems = []
        number = len(self.heights.heights)
        if self.n_asperities != number:
            problems.append(
                f"ensemble.n_asperities = {self.n_asperities}: {number} heights are measured; give that "
                "number, or heights.resample = true"
            )
        for key, value, wanted in (
            ("n_surfaces", self.n_surfaces, (1,)),
            ("count", self.count, ("fixed",)),
            ("sampler", self.sampler, ("direct",)),
        ):
            if value not in wanted:
                problems.append(
                    f"ensemble.{key} = {value!r}: measured heights as they are need {wanted[0]!r}; "
                    "or say resample = true under [heights]"
                )
        return problems

    def _wrong_modulus(self) -> list[str]:
        """Negative moduli among the heights that touch."""
        if self.negative != "error":
            return []
        try:
            where = self.negative_above(self.lowest)
        except ValueError as error:
            return [str(error)]
        if where is None:
            return []
        if isinstance(self.grading, Exponential):
            key = f"grading.gamma = {self.grading.gamma:g}"
            where = self.grading.zero if self.grading.gamma < 0 else where
        elif isinstance(self.grading, Table):
            key = "grading.table"
        else:
            key = "grading"
        return [
            f"{key}: E*(s) is negative from s = {where:.4g}, which touches at h = {self.lowest:g}; raise the "
            'separations, or say negative = "clip" or "allow" under [grading]'
        ]
