"""The numbers of an ensemble, wherever they lie, and their statistics over the surfaces."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analytic.arrays import Array, Ints

Tables = dict[str, NDArray[Any]]  # numbers of surfaces by name, a row each

CHUNK_ROWS = 256  # surfaces of a chunk of a file; fewer, by powers of two, where a chunk would be too large
_ROWS = 8192  # surfaces at a time, for ensembles larger than the memory


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

    def drawn(self) -> Tables:
        """Return what the statistics of surfaces that are not kept are made of, for a file."""
        return {}

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
