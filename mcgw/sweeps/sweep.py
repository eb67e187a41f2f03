"""A sweep: many scenes that share their surfaces where possible.

Differences and ratios of its points are over the same surfaces (`mcgw.ensemble.paired`).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic.arrays import Array, Ints
from mcgw.ensemble.dataset import Dataset
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.paired import Difference, Paired, Slopes, difference_of, ratio_of
from mcgw.ensemble.pooled import PointResults, Pooled, tables_of
from mcgw.ensemble.results import STATISTICS, Labelled, Variable, axis, statistics_of
from mcgw.formats.table import SEPARATION, Column, Table, evenly
from mcgw.sampling.expected import name_of
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text
from mcgw.sweeps.axes import Axes, label

Place = tuple[int, Ints, Array]  # of a point: number of its group, which computed scenes of it, their weights
At = Mapping[str, Any] | Sequence[int] | int
_SHOWN = 7  # points displayed


@dataclass(frozen=True, repr=False)
class Sweep(Dataset):
    """Means and standard deviations over the surfaces of every point, their differences and slopes.

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
    """

    axes: Axes
    scenes: Sequence[Scene]
    places: tuple[Place, ...]
    groups: tuple[Pooled, ...]

    @property
    def _points(self) -> Sequence[Scene]:
        """The same as `scenes`."""
        return self.scenes

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis; along the one of zipped axes."""
        return self.axes.shape

    def _held(self, point: int) -> PointResults:
        """Mean and deviation of a point."""
        group, scenes, weights = self.places[point]
        return PointResults(self.groups[group], scenes, weights)

    def _at(self, which: Ints) -> "Sweep":
        """Return the same surfaces at some of the separations, by their numbers."""
        separations = tuple(self.separations[which].tolist())
        scenes = tuple(scene.replace(separations=separations) for scene in self.scenes)
        return replace(self, scenes=scenes, groups=tuple(one.at(which) for one in self.groups))

    def scene(self, at: At) -> Scene:
        """Return the scene of a point, given by the values of its keys or by its index along each axis.

        Raises
        ------
        ValueError
            If there is no such point.
        """
        return self.scenes[self.axes.place(at)]

    def ensemble(self, at: At) -> Ensemble:
        """Mean and standard deviation of a point, as an ensemble of its scene.

        Raises
        ------
        ValueError
            If there is no such point.
        """
        i = self.axes.place(at)
        return Ensemble(self.scenes[i], name_of(self.scenes[i]), self._held(i))

    def difference(self, quantity: str, one: At, other: At) -> Difference:
        """Difference of a mean between two points, first minus second, over the same surfaces.

        Parameters
        ----------
        quantity : str
            Its name.
        one, other : dict, tuple of int or int
            Points, by values of the keys as ``{"grading.gamma": 2.0}``, or by indices.

        Returns
        -------
        Difference
            With the standard error over the surfaces: fluctuations that both points share cancel.

        Raises
        ------
        KeyError
            If there is no such quantity.
        ValueError
            If there is no such point, or the two have different surfaces: drawn from the same seed, these are
            correlated, and it is not known how strongly.
        """
        name, per_area = self._stored(quantity)
        x, y = (1 / self.scene(at).surface.nominal_area if per_area else 1.0 for at in (one, other))
        return difference_of(name, *self._pair(one, other), x, y)

    def ratio(self, quantity: str, one: At, other: At) -> Paired:
        """Ratio of a mean between two points, first over second, over the same surfaces.

        Eqs. (12) and (15) of the paper by Monte Carlo; arguments and errors as of `difference`.

        Returns
        -------
        Paired
            With its standard error over the surfaces, and `interval`.
        """
        return ratio_of(self._stored(quantity)[0], *self._pair(one, other), self.separations)

    def slopes(self, quantity: str, along: str) -> Slopes:
        """Change of a mean with a key between neighbouring points, over the same surfaces, and by theory.

        Parameters
        ----------
        quantity : str
            Its name.
        along : str
            An axis whose values are numbers.

        Returns
        -------
        Slopes
            Between neighbours along that axis, with standard errors over the surfaces.

        Raises
        ------
        KeyError
            If there is no such quantity.
        ValueError
            If there is no such axis, or neighbours have different surfaces.
        """
        axis, x = self.axes.numbers(along)
        step = np.diff(x).reshape(-1, *[1] * (len(self.shape) - axis))
        shape = tuple(n - (i == axis) for i, n in enumerate(self.shape))
        pairs = [(tuple(p + (np.arange(len(p)) == axis)), p) for p in map(np.array, np.ndindex(shape))]
        errors = np.array([self.difference(quantity, after, tuple(p)).stderr for after, p in pairs])
        return Slopes(
            quantity=quantity,
            key=along,
            axis=axis,
            at=(x[1:] + x[:-1]) / 2,
            value=np.diff(self.mean(quantity), axis=axis) / step,
            stderr=errors.reshape(*shape, -1) / np.abs(step),
            theory=np.diff(self.theory(quantity), axis=axis) / step,
        )

    def labelled(self) -> Labelled:
        """Return means and deviations with a dimension for each axis."""
        coordinates = {
            name: Variable(
                ("point",) if self.axes.zipped else (name,),
                np.array([label(value) for value in self.axes.values[key]]),
                "",
                key,
            )
            for key, name in self.axes.names.items()
        }
        if self.axes.zipped:
            coordinates["point"] = axis("point", np.arange(self.axes.size))
        variables = statistics_of(self, self.axes.dims)
        # Of each point its group, one or two scenes of it (-1: none), and their weights.
        points = [(group, *scenes, -1)[:3] for group, scenes, _ in self.places]
        weights = [(*weights, 0.0)[:2] for *_, weights in self.places]
        drawn = {**tables_of(self.groups), "points": np.array(points), "weights": np.array(weights)}
        axes = {"separation": axis("separation", self.separations), **coordinates}
        return Labelled(variables, axes, drawn=drawn)

    def _about(self) -> dict[str, Any]:
        """Return the title and the first scene as TOML."""
        return {"title": self.scenes[0].title, "first_scene": scene_text(self.scenes[0])}

    def sheet(self) -> Table:
        """Display the axes, and means of some points at the lowest separation."""
        facts = [(key, self.axes.summary(key)) for key in self.axes.keys]
        surfaces = sum(group.n for group in self.groups)
        same = f"the same for all {self.axes.size} scenes"
        groups = (
            same if len(self.groups) == 1 else f"in {len(self.groups)} groups of scenes with the same ones"
        )
        facts.append(("surfaces", f"{surfaces}, {groups}"))
        k = int(np.argmin(self.separations))
        shown = evenly(self.axes.size, _SHOWN)
        where = [self.axes.values_text(i) for i in shown]
        columns = [Column("point", where, f"mean +- stderr at d/sigma = {self.separations[k]:g}")]
        for name in self.quantities:
            mean, error = (get(name)[..., k].ravel()[shown] for get in (self.mean, self.stderr))
            columns.append(Column(name, mean, form=".5g"))
            columns.append(Column("stderr", error, form=".2g", between=" +- "))
        return Table(tuple(columns), f"Sweep of {self.axes.size} scenes", facts)

    def table(self) -> Table:
        """Return a row for each point and separation: the keys, means and standard deviations.

        Ratios are those of `ratios`, with the ends of their 95 % intervals.
        """
        h, size = self.separations, self.axes.size
        at = [self.axes.at(i) for i in range(size)]
        columns = [Column(key, [label(values[key]) for values in at for _ in h]) for key in self.axes.keys]
        columns.append(Column("separation", np.tile(h, size), SEPARATION, form="g"))
        ratios = self.ratios()
        for name in self.quantities:
            unit = self.scenes[0].quantity(name).unit
            for kind in STATISTICS:
                columns.append(Column(f"{name}_{kind}", getattr(self, kind)(name).ravel(), unit=unit))
            found = np.array([(one.ratio, *one.interval()) for one in ratios.get(name, ())])
            for k, kind in enumerate(("ratio", "ratio_low", "ratio_high") if len(found) else ()):
                columns.append(Column(f"{name}_{kind}", found[:, k].ravel(), unit="1"))
        return Table(tuple(columns))

    def ratios(self) -> dict[str, list[Paired]]:
        """Ratios of the means of every point to those of the first, of each quantity that changes.

        Empty unless all points share their surfaces.
        """
        if self.axes.size == 1 or len({group for group, *_ in self.places}) > 1:
            return {}
        found, (first, *others) = {}, map(self._held, range(self.axes.size))
        for name in self.quantities:
            pairs = [ratio_of(name, point, first, self.separations) for point in (first, *others)]
            if any((pair.ratio != 1).any() for pair in pairs[1:]):
                found[name] = pairs
        return found

    def _pair(self, *both: At) -> tuple[PointResults, PointResults]:
        """Return what is known of two points, which must share their surfaces."""
        one, other = (self._held(self.axes.place(at)) for at in both)
        if one.pooled is not other.pooled:
            where = " and ".join(self.axes.text(self.axes.place(at)) for at in both)
            raise ValueError(
                f"sweep: {where} have different surfaces, so there are no pairs, but the same seed "
                "correlates them: give the ensemble of each its own seed"
            )
        return one, other
