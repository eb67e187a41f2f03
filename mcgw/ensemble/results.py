"""The numbers of an ensemble, wherever they lie, and their statistics over the surfaces.

And results as named arrays with axes, units and words, for files, xarray and pandas, and as tables.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic import Quantity
from analytic.arrays import Array, Ints
from mcgw.formats.table import SEPARATION, Column, Table, optional

Tables = dict[str, NDArray[Any]]  # numbers of surfaces by name, a row each

CHUNK_ROWS = 256  # surfaces of a chunk of a file; fewer, by powers of two, where a chunk would be too large
_ROWS = 8192  # surfaces at a time, for ensembles larger than the memory
GROUP = "drawn"  # the one group of a file: what its statistics are made of
AXES = {  # of tables, in their order: unit and long name
    "point": ("1", "number of the point"),
    "surface": ("1", "number of the surface"),
    "separation": ("1", "mean-plane separation d/sigma"),
}
_WORDS = {
    "mean": "mean of the {}",
    "std": "standard deviation of the {} over surfaces",
}


@dataclass(frozen=True, eq=False)
class Rows:
    """A table of values of surfaces that is read when it is asked for, by slices of its rows.

    Parameters
    ----------
    of : Held
        Where it lies.
    name : str
        Its name.
    """

    of: "Held"
    name: str

    def __len__(self) -> int:
        """Return the number of surfaces."""
        return self.of.rows()

    def __getitem__(self, rows: slice) -> Array:
        """Return some of the rows."""
        return self.of.read(self.name, rows.start or 0, rows.stop)


class Held(ABC):
    """Stored results of surfaces: mean and deviation of each quantity, and perhaps more."""

    no_more = ""  # why there is no more, and what to do about it

    @abstractmethod
    def rows(self) -> int:
        """Return the number of surfaces there are."""

    @abstractmethod
    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""

    def read(self, name: str, start: int, stop: int | None) -> Array:  # noqa: ARG002
        """Rows `start` to `stop` (None: to the end) of a table."""
        raise ValueError(f"{name}: {self.no_more}")

    def table(self, name: str) -> "Array | Rows":
        """Return a whole table, or what reads it when it is asked for."""
        return Rows(self, name)

    def covariance(self, name: str, other: str) -> Array:  # noqa: ARG002
        """Between all numbers of two tables (divisor M - 1), shape (separations, separations)."""
        raise ValueError(f"{name}: {self.no_more}")


class Results(Held):
    """Values of every surface, of which statistics are made when they are asked for."""

    @abstractmethod
    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a table."""

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Shifted by the first row, so that nothing cancels."""
        m = self.rows()
        few = [self.read(name, 0, m).astype(np.float64)] if m <= _ROWS else None  # read once
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


@dataclass(frozen=True)
class MemoryResults(Results):
    """Numbers in memory, by name."""

    arrays: dict[str, Array]

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of an array."""
        return self.arrays[name][start:stop]

    def table(self, name: str) -> Array:
        """Return an array."""
        return self.arrays[name]

    def rows(self) -> int:
        """Length of the arrays."""
        return len(next(iter(self.arrays.values())))


@dataclass(frozen=True)
class Selected(Held):
    """Results of surfaces at some of the separations.

    Parameters
    ----------
    whole : Held
        At all separations.
    which : ndarray of int
        Numbers of the separations.
    """

    whole: Held
    which: Ints

    def rows(self) -> int:
        """Return the number of surfaces there are."""
        return self.whole.rows()

    def mean_and_std(self, name: str) -> tuple[Array, Array]:
        """Mean and standard deviation (divisor M - 1)."""
        mean, std = self.whole.mean_and_std(name)
        return mean[self.which], std[self.which]

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a table."""
        return self.whole.read(name, start, stop)[:, self.which]

    def covariance(self, name: str, other: str) -> Array:
        """Between all numbers of two tables (divisor M - 1)."""
        return self.whole.covariance(name, other)[np.ix_(self.which, self.which)]


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

    @property
    def about(self) -> dict[str, str]:
        """Its attributes, as netCDF has them."""
        return {**({"units": self.units} if self.units else {}), "long_name": self.long_name}


@dataclass(frozen=True)
class Labelled:
    """Tables and the coordinates of their axes, by name, and what is said of all of them.

    And what statistics of surfaces that are not kept are made of, for the one group of a file.
    """

    variables: Mapping[str, Variable]
    coordinates: Mapping[str, Variable]
    attributes: Mapping[str, Any] = field(default_factory=dict)
    drawn: Tables = field(default_factory=dict)

    def in_file(self, attributes: Mapping[str, Any]) -> "Labelled":
        """Return what a file holds, with its attributes."""
        coordinates = dict(self.coordinates)
        for name, one in coordinates.items():
            if one.values.dtype.kind not in "iuf":  # texts by their numbers, and these in words
                words = ", ".join(f"{k} {value}" for k, value in enumerate(one.values))
                numbers, told = np.arange(len(one.values)), f"{one.long_name}: {words}"
                coordinates[name] = replace(one, values=numbers, long_name=told)
        others = [name for name, one in coordinates.items() if one.dims != (name,)]
        named = {"coordinates": " ".join(others)} if others else {}  # by which xarray knows them
        scales = {name: one for name, one in coordinates.items() if name not in others}
        made_of = {f"{GROUP}/{name}": Variable((), values, "", "") for name, values in self.drawn.items()}
        return Labelled({**self.variables, **made_of}, {**scales, **coordinates}, {**attributes, **named})

    def to_xarray(self, about: Mapping[str, Any]) -> Any:
        """Return an `xarray.Dataset` with these attributes.

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        xarray = optional("xarray", "to_xarray")
        both = (
            {name: (one.dims, one.values[:], one.about) for name, one in some.items()}
            for some in (self.variables, self.coordinates)
        )
        return xarray.Dataset(*both, dict(about))

    def to_dataframe(self) -> Any:
        """Return a `pandas.DataFrame` of the tables with the axes of the first: a row for each place there.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        pandas = optional("pandas", "to_dataframe")
        dims = next(iter(self.variables.values())).dims
        places = [self.coordinates[dim].values for dim in dims]
        if len(places) == 1:
            index = pandas.Index(places[0], name=dims[0])
        else:
            index = pandas.MultiIndex.from_product(places, names=dims)
        columns = {name: one.values[:].ravel() for name, one in self.variables.items() if one.dims == dims}
        return pandas.DataFrame(columns, index=index)


def axis(name: str, values: Any) -> Variable:
    """Return the coordinate of an axis of this name."""
    return Variable((name,), np.asarray(values), *AXES[name])


def statistics_of(
    result: Any, names: Iterable[str], kinds: Sequence[str], lead: tuple[str, ...] = ()
) -> dict[str, Variable]:
    """Return what a result tells over its surfaces of some quantities, with axes before those of one."""
    found: dict[str, Variable] = {}
    scene = result.scenes[0] if lead else result.scene
    for name in names:
        q = scene.quantity(name)
        for kind in kinds:
            words = _WORDS[kind].format(q.long_name)
            found[f"{name}_{kind}"] = Variable(
                (*lead, "separation"), getattr(result, kind)(name), q.unit, words
            )
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
