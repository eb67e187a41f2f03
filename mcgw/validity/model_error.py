"""Error of a model against elasticity at some separations: in numbers, in words, and as cautions."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from analytic.arrays import Array, Marks
from mcgw.formats.table import SEPARATION, Column, Shown, Table
from mcgw.validity.error_table import COLUMNS

_AT_LOAD = {"area": "area", "stiffness": "stiffness", "separation": "gap"}  # columns at a given load
_UNIFORM = "; measured for a uniform modulus"
_COLUMNS = {"area": "area", "stiffness": "stiffness", "separation": "gap/sigma", "load": "load at d"}


@dataclass(frozen=True, repr=False)
class Validity(Shown):
    """Expected errors of a model against elasticity: periodic cells of a homogeneous half-space.

    The errors of "area", "stiffness" and "separation" are those at the load that the model has at each
    separation; that of "load" is the one at the same separation, taken for the mean gap of a periodic cell.

    Parameters
    ----------
    separations : ndarray
        Reduced separations d/sigma, rising.
    loads : ndarray
        Pressure over E* g of Gaussian surfaces, g being the rms slope, or over E* sqrt(sigma/R) of separate
        caps: of Hertz's law without a grading at each separation; nan where the model was not measured.
    error : dict of str to ndarray
        Largest deviation of 95 % of surfaces, over the right value, or over sigma for "separation":
        ``|bias|`` plus 2.1 standard deviations, for surfaces with as many contacts as one of the scene, and
        as many long waves (except for areas), including that of the bias itself. nan where nothing was
        measured.
    bias : dict of str to ndarray
        Mean over maps of model/elasticity - 1, or of the difference over sigma.
    graded : bool
        Whether the scene has a grading, which these errors do not cover: they come from the geometry alone.
    axis : str
        Name of the loads, such as "p/(E* g)".
    where : str
        Where the errors were measured, in words.
    unknown : str
        Why numbers are missing at some or all separations; empty if there is one at each.
    listed : bool
        Whether the model had the summits of each map; specimens scatter in addition.
    """

    separations: Array
    loads: Array
    error: dict[str, Array]
    bias: dict[str, Array]
    graded: bool = False
    axis: str = ""
    where: str = ""
    unknown: str = ""
    listed: bool = False

    @property
    def measured(self) -> Marks:
        """Whether anything was measured, at each separation."""
        return self.known(*COLUMNS)

    def known(self, *names: str) -> Marks:
        """Whether one of some columns was measured, at each separation."""
        return np.asarray(np.any([np.isfinite(self.error[name]) for name in names], axis=0))

    def worst(self, *names: str) -> float:
        """Largest expected error of some columns over the separations; nan if none was measured."""
        values = np.concatenate([self.error[name] for name in names])
        return float(np.nanmax(values)) if np.isfinite(values).any() else np.nan

    @property
    def verdict(self) -> str:
        """One sentence: the error of the model, where, and where it was not measured."""
        if not self.measured.any():
            return f"Model error: {self.unknown}"
        where = span(self.separations, ~self.measured)
        unknown = f"; at d/sigma = {where} {self.unknown}" if where else ""
        return f"Against an elastic half-space: {self.brief}{unknown}"

    @property
    def brief(self) -> str:
        """The error of the model alone, or why it is unknown."""
        told, before = [], np.ones(len(self.separations), dtype=np.bool_)
        for names, at in ((("area", "stiffness"), "a load"), (("load",), "a mean gap")):
            known = self.known(*names)
            where = "" if np.array_equal(known, before) else f" for d/sigma = {span(self.separations, known)}"
            which = " and ".join(name for name in names if self.known(name).any())
            if which:
                told.append(f"{which} within {percent(self.worst(*names))} at {at}{where}")
                before = known
        return f"{', '.join(told)} (95 % of surfaces{_UNIFORM * self.graded})" if told else self.unknown

    @property
    def details(self) -> str:
        """The error of each quantity, and where it was measured; empty if nothing was."""
        if not self.measured.any():
            return ""
        told = []
        for name, word in _AT_LOAD.items():
            if math.isnan(worst := self.worst(name)):
                told.append(f"{word} not measured")
            else:
                told.append(f"{word} {f'{rounded_up(worst):g} sigma' if word == 'gap' else percent(worst)}")
        return f"{', '.join(told)} (95 %); by {self.where}"

    @property
    def lines(self) -> list[str]:
        """The verdict, and the error of each quantity."""
        return [*filter(None, (self.verdict, self.details))]

    def sheet(self) -> Table:
        """Return the verdict, and errors at some separations: mean over maps, and ends of 95 % of them."""
        where = [("measured", self.where)] if self.where else []
        return self.table().under("Against elasticity", [("verdict", self.brief), *where])

    def table(self) -> Table:
        """At some separations the bias of each quantity, and how far 95 % are from it; else empty."""
        if not self.measured.any():
            return Table(())
        h = range(len(self.separations))
        told = [Column(name, [self._cell(name, k) for k in h], words) for name, words in _COLUMNS.items()]
        separation = Column("separation", self.separations, SEPARATION, form="g")
        return Table((separation, Column("pressure", self.loads, unit="1", form=".2g"), *told)).rows()

    def _cell(self, name: str, k: int) -> str:
        bias, error = float(self.bias[name][k]), float(self.error[name][k])
        if math.isnan(error):
            return "not measured"
        off = error - abs(bias)
        return (
            f"{bias:+z.2f} ± {off:.2f}" if name == "separation" else f"{100 * bias:+z.0f} ± {100 * off:.0f} %"
        )


def percent(x: float) -> str:
    """Return a share in per cent, rounded up so that the statement holds."""
    return f"{100 * rounded_up(x):.0f} %"


def rounded_up(x: float) -> float:
    """Round up to two decimals."""
    return math.ceil(100 * x - 1e-9) / 100


def span(h: Array, where: Marks) -> str:
    """Ranges of separations that are marked, in words."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], where, [False]])))
    pairs = [(h[first], h[last - 1]) for first, last in edges.reshape(-1, 2)]
    return " and ".join(" to ".join(dict.fromkeys(f"{end:.3g}" for end in pair)) for pair in pairs)


_OFF = 0.1  # error of area, stiffness or load above which there is a caution
_QUANTITIES = ("area", "stiffness", "load")


def off_elasticity(v: Validity, why: str) -> Iterator[str]:
    """Errors above 10 % by their size, and loads above those that were measured."""
    for loose, told, because in ((False, "model error", f": {why}"), (True, "scatter between surfaces", "")):
        off, sizes = np.zeros(len(v.separations), dtype=np.bool_), {}
        for name, error in v.error.items():
            scatters = error > 2 * np.abs(v.bias[name])  # mostly scatter, not bias
            where = (error > _OFF) & (scatters == loose) & (name in _QUANTITIES)
            if where.any():
                k = int(np.argmax(np.where(where, error, -np.inf)))
                size, sign = percent(float(error[k])), "large" if v.bias[name][k] > 0 else "small"
                sizes[name] = f"{name} ± {size}" if loose else f"{name} up to {size} too {sign}"
                off |= where
        at_load = ", ".join(size for name, size in sizes.items() if name != "load")
        largest = [f"{at_load} at that load"] * bool(at_load)
        largest += [f"{sizes['load']} at that mean gap"] if "load" in sizes else []
        if off.any():
            yield f"d/sigma = {span(v.separations, off)}: {told}: {'; '.join(largest)}{because}"
    heavier = np.arange(len(v.separations)) < np.argmax(v.measured)
    if heavier.any():
        yield (
            f"d/sigma = {span(v.separations, heavier)}: loads heavier than measured ({v.axis} up to "
            f"{v.loads[heavier].max():.2g}); the error is not known"
        )
