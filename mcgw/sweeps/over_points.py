"""Statistics over the surfaces of every point of a sweep, arranged along its axes.

What a sweep holds of one of its points, as the numbers of an ensemble.

The cautions of all points of a sweep, each said once: of how many points.
"""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analytic import PER_AREA
from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import CONFIDENCE
from mcgw.ensemble.pooled import Pooled
from mcgw.ensemble.results import Held
from mcgw.sampling.samplers import name_of
from mcgw.scene.cautions import cautions
from mcgw.scene.scene import Scene
from mcgw.sweeps.axes import Axes, Point
from mcgw.sweeps.groups import Place

At = Mapping[str, Any] | Sequence[int] | int
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


@dataclass(frozen=True, repr=False)
class OverPoints:
    """Means and standard deviations over the surfaces of every point.

    Parameters
    ----------
    axes : Axes
        The keys and their values.
    scenes : sequence of Scene
        Of all points, the last axis fastest.
    places : tuple of Place
        Where the statistics of each point are.
    groups : tuple of Pooled
        What is kept of each group of points that share their surfaces.
    statistics : tuple of str
        Statistics that `to_xarray` returns.
    """

    axes: Axes
    scenes: Sequence[Scene]
    places: tuple[Place, ...]
    groups: tuple[Pooled, ...]
    statistics: tuple[str, ...]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis; along the one of zipped axes."""
        return self.axes.shape

    @property
    def separations(self) -> Array:
        """Reduced separations d/sigma, shape (separations,)."""
        return np.array(self.scenes[0].separations)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities held for each point."""
        return tuple(self.scenes[0].shapes)

    def mean(self, quantity: str) -> Array:
        """Mean over the surfaces in SI units, shape (axes ..., separations)."""
        return self._of_all(quantity, lambda pooled, *some: pooled.mean(*some))

    def std(self, quantity: str) -> Array:
        """Standard deviation over the surfaces (divisor M - 1), nan for one surface."""
        return self._of_all(quantity, lambda pooled, *some: np.sqrt(pooled.variance(*some)))

    def stderr(self, quantity: str) -> Array:
        """Standard error of the mean, nan for one surface."""
        m = np.array([self.groups[place.group].n for place in self.places]).reshape(self.shape)
        std = self.std(quantity)
        return np.asarray(std / np.sqrt(m.reshape(self.shape + (1,) * (std.ndim - m.ndim))))

    def interval(self, quantity: str, level: float = CONFIDENCE) -> tuple[Array, Array]:
        """Confidence interval of the mean of each point, as `mcgw.Ensemble.interval`.

        Raises
        ------
        KeyError, ValueError
            As there.
        """
        low, high = zip(
            *(self.ensemble(p).interval(quantity, level) for p in self.axes.points()), strict=True
        )
        return self._arranged(low), self._arranged(high)

    def theory(self, quantity: str) -> Array:
        """Exact mean of each point (`Scene.theory`), shape (axes ..., separations)."""
        name, per_area = self._held(quantity)
        found = [np.asarray(scene.theory.mean(name, self.separations)) for scene in self.scenes]
        if per_area:
            found = [x / scene.surface.nominal_area for x, scene in zip(found, self.scenes, strict=True)]
        return np.stack(found).reshape(*self.shape, -1)

    def scene(self, at: At) -> Scene:
        """The scene of a point, given by the values of its keys or by its index along each axis.

        Raises
        ------
        ValueError
            If there is no such point.
        """
        return self.scenes[self._number(self.axes.place(at))]

    def ensemble(self, at: At) -> Ensemble:
        """Mean and standard deviation of a point, as an ensemble of its scene.

        Raises
        ------
        ValueError
            If there is no such point.
        """
        i = self._number(self.axes.place(at))
        if i not in self._ensembles:
            scene, place = self.scenes[i], self.places[i]
            self._ensembles[i] = Ensemble(
                scene, name_of(scene), PointResults(self.groups[place.group], place)
            )
        return self._ensembles[i]

    @cached_property
    def _ensembles(self) -> dict[int, Ensemble]:
        """Ensembles of some points."""
        return {}

    def _of_all(self, quantity: str, get: Any) -> Array:
        """One array over all points, per area if requested."""
        name, per_area = self._held(quantity)
        found = [get(self.groups[place.group], name, *place.of(name)) for place in self.places]
        if per_area:
            found = [x / scene.surface.nominal_area for x, scene in zip(found, self.scenes, strict=True)]
        return self._arranged(found)

    def _arranged(self, found: Iterable[Array]) -> Array:
        """Data of all points in the shape of the axes."""
        each = np.stack(list(found))
        return each.reshape(*self.shape, *each.shape[1:])

    def _held(self, quantity: str) -> tuple[str, bool]:
        """The stored quantity, and whether the requested one is per nominal area."""
        name = PER_AREA[quantity].of if quantity in PER_AREA else quantity
        if name not in self.quantities:
            raise KeyError(f"{quantity!r} is not in this sweep; it has {', '.join(self.quantities)}")
        return name, quantity in PER_AREA

    def _number(self, point: Point) -> int:
        return int(np.ravel_multi_index(point, self.shape))


@dataclass(frozen=True)
class PointResults(Held):
    """Mean and deviation of a point, a weighted mean of what is pooled.

    Parameters
    ----------
    pooled : Pooled
        Statistics of its group.
    place : Place
        Its place in the group.
    """

    pooled: Pooled
    place: Place

    no_more = (
        "a sweep only keeps mean and standard deviation of a point; simulate(sweep.scene(point)) draws "
        "surfaces of that scene"
    )

    def rows(self) -> int:
        """Number of surfaces."""
        return self.pooled.n

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        some = self.place.of(name)
        return self.pooled.mean(name, *some), np.sqrt(self.pooled.variance(name, *some))

    def total_number(self, name: str) -> Array:
        """The mean times the number of surfaces, as a whole number."""
        return np.rint(self.pooled.mean(name, *self.place.of(name)) * self.pooled.n)


def sweep_cautions(sweep: OverPoints) -> list[str]:
    """Cautions about all scenes, one line each, the most common first.

    Cautions that differ in their numbers alone are one, with those of the first point that has it.
    """
    points = list(sweep.axes.points())
    found: dict[str, list[tuple[int, str]]] = {}
    for i in range(len(points)):
        for line in cautions(sweep.scenes[i]):
            found.setdefault(_NUMBER.sub("#", line), []).append((i, line))
    lines = []
    for some in sorted(found.values(), key=len, reverse=True):
        first, line = some[0]
        alike = len({text for _, text in some}) == 1
        where = "" if alike else f" (numbers of {sweep.axes.text(points[first])})"
        lines.append(f"{len({i for i, _ in some})} of {len(points)} points: {line}{where}")
    return lines
