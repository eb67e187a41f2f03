"""The numbers of an ensemble, wherever they lie, and their statistics over the surfaces.

And results as named arrays with axes, units and words, for files, xarray and pandas, and as tables.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Quantity
from analytic.arrays import Array, Ints
from mcgw.formats.table import SEPARATION, Column, Table

Tables = dict[str, NDArray[Any]]  # numbers of surfaces by name, a row each

CHUNK_ROWS = 256  # surfaces of a chunk of a file; fewer, by powers of two, where a chunk would be too large
_ROWS = 8192  # surfaces at a time, for ensembles larger than the memory
GROUP = "drawn"  # the one group of a file: what its statistics are made of
AXES = {  # of tables, in their order: unit and long name
    "point": ("1", "number of the point"),
    "surface": ("1", "number of the surface"),
    "separation": ("1", "mean-plane separation d/sigma"),
}
STATISTICS = {  # of each quantity, kept in place of values, and what they are
    "mean": "mean of the {}",
    "std": "standard deviation of the {} over surfaces",
}


@dataclass(frozen=True, eq=False)
class Rows:
    """A table of values of surfaces that is read when it is asked for, by slices of its rows."""

    n: int  # number of surfaces
    read: Callable[[slice], Array]  # the rows of a slice
    together: int = 1  # that are best read at once

    def __len__(self) -> int:
        return self.n

    def __getitem__(self, rows: slice) -> Array:
        return self.read(rows)


class Held(ABC):
    """Stored results of surfaces: mean and deviation of each quantity, and perhaps more."""

    no_more = ""  # why there is no more, and what to do about it

    @abstractmethod
    def rows(self) -> int:
        """Return the number of surfaces there are."""

    @abstractmethod
    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""

    @abstractmethod
    def at(self, which: Ints) -> "Held":
        """Return the same at some of the separations, by their numbers."""

    def read(self, name: str, start: int, stop: int | None) -> Array:  # noqa: ARG002
        """Rows `start` to `stop` (None: to the end) of a table."""
        raise ValueError(f"{name}: {self.no_more}")

    def covariance(self, name: str, other: str) -> Array:  # noqa: ARG002
        """Between all numbers of two tables (divisor M - 1), shape (separations, separations)."""
        raise ValueError(f"{name}: {self.no_more}")


@dataclass(frozen=True)
class Results(Held):
    """Values of every surface, of which statistics are made when they are asked for."""

    tables: Mapping[str, Any]  # arrays, or `Rows`, of shape (surfaces, separations)

    def rows(self) -> int:
        """Return the number of surfaces there are."""
        return len(next(iter(self.tables.values())))

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a table."""
        return np.asarray(self.tables[name][start:stop])

    def changed(self, change: Callable[[str, Array], Array]) -> "Results":
        """Return what a function makes of each table and its name, whenever that is read."""

        def of(name: str, table: Any) -> Rows:
            return Rows(len(table), lambda rows: change(name, table[rows]))

        return Results({name: of(name, table) for name, table in self.tables.items()})

    def at(self, which: Ints) -> "Results":
        """Return the same at some of the separations, by their numbers."""
        return self.changed(lambda _, rows: np.take(rows, which, axis=1))

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Shifted by the first row, so that nothing cancels."""
        m = self.rows()
        few = list(self._chunks(name)) if m <= _ROWS else None  # read once
        shift = next(iter(few or self._chunks(name)))[0]
        mean = sum((chunk - shift).sum(axis=0) for chunk in few or self._chunks(name)) / m + shift
        squares = sum(((chunk - mean) ** 2).sum(axis=0) for chunk in few or self._chunks(name))
        return np.asarray(mean), np.sqrt(squares / (m - 1)) if m > 1 else np.full(np.shape(mean), np.nan)

    def covariance(self, name: str, other: str) -> Array:
        """From the deviations, some surfaces at a time."""
        m, (a, b) = self.rows(), (self.mean_and_std(each)[0] for each in (name, other))
        if m == 1:
            return np.full((a.size, b.size), np.nan)
        pairs = zip(self._chunks(name), self._chunks(other), strict=True)
        return np.asarray(sum((x - a).T @ (y - b) for x, y in pairs) / (m - 1))

    def _chunks(self, name: str) -> Iterator[Array]:
        m = self.rows()
        for start in range(0, m, _ROWS):
            yield self.read(name, start, min(start + _ROWS, m)).astype(np.float64)


def joined(parts: Sequence[Mapping[str, NDArray[Any]]]) -> Tables:
    """Return the tables of several blocks of surfaces, one below the other."""
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


@dataclass(frozen=True)
class Variable:
    """An array, or one that is yet to be read, with the names of its axes, its unit and what it is."""

    dims: tuple[str, ...]
    values: Any  # an array, or `Rows` of one
    units: str
    long_name: str


@dataclass(frozen=True)
class Labelled:
    """Tables and the coordinates of their axes, by name, and what is said of all of them.

    And what statistics of surfaces that are not kept are made of, for the one group of a file.
    """

    variables: Mapping[str, Variable]
    coordinates: Mapping[str, Variable]
    attributes: Mapping[str, Any] = field(default_factory=dict)
    drawn: Tables = field(default_factory=dict)

    def numbered(self) -> "Labelled":
        """Return it for a file: texts by their numbers, and names of coordinates that are no axes."""
        coordinates = dict(self.coordinates)
        for name, one in coordinates.items():
            if one.values.dtype.kind not in "iuf":  # texts by their numbers, and these in words
                words = ", ".join(f"{k} {value}" for k, value in enumerate(one.values))
                numbers, told = np.arange(len(one.values)), f"{one.long_name}: {words}"
                coordinates[name] = replace(one, values=numbers, long_name=told)
        others = [name for name, one in coordinates.items() if one.dims != (name,)]
        named = {"coordinates": " ".join(others)} if others else {}  # by which xarray knows them
        scales = {name: one for name, one in coordinates.items() if name not in others}
        return Labelled(self.variables, {**scales, **coordinates}, named, self.drawn)


def axis(name: str, values: Any) -> Variable:
    """Return the coordinate of an axis of this name."""
    return Variable((name,), np.asarray(values), *AXES[name])


def statistics_of(result: Any, lead: tuple[str, ...] = ()) -> dict[str, Variable]:
    """Return what a result tells over its surfaces, with axes before that of the separations."""
    found, scene = dict[str, Variable](), result.scenes[0] if lead else result.scene
    for q in map(scene.quantity, result.quantities):
        for kind, words in STATISTICS.items():
            values, dims = getattr(result, kind)(q.name), (*lead, "separation")
            found[f"{q.name}_{kind}"] = Variable(dims, values, q.unit, words.format(q.long_name))
    return found


def heading(q: Quantity) -> str:
    """Long name and unit of a quantity, over its table."""
    return q.long_name if q.unit == "1" else f"{q.long_name} ({q.unit})"


def statistics_table(ensemble: Any, name: str) -> Table:
    """Mean, std and stderr of a quantity at every separation."""
    q = ensemble.scene.quantity(name)
    unit = q.unit
    found = [("mean", ensemble.mean(name), ".6g"), ("std", ensemble.std(name), ".3g")]
    found.append(("stderr", ensemble.stderr(name), ".3g"))
    columns = [Column(kind, values, unit=unit, form=form) for kind, values, form in found]
    columns[0] = replace(columns[0], error=found[2][1])
    separation = Column("separation", ensemble.separations, SEPARATION, form="g")
    return Table((separation, *columns), heading(q))
