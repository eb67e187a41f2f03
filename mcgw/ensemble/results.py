"""Where the numbers of an ensemble lie: in memory here, in files in `mcgw.store.stored`."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

__all__ = ["MemoryResults", "Results", "joined"]

Array = NDArray[np.float64]


class Results(Protocol):
    """Where an ensemble's numbers lie: in memory or in a file."""

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        ...

    def rows(self) -> int:
        """Number of surfaces there are."""
        ...


@dataclass(frozen=True)
class MemoryResults:
    """Numbers in memory, by name."""

    arrays: dict[str, Array]

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of an array."""
        return self.arrays[name][start:stop]

    def rows(self) -> int:
        """Length of the arrays."""
        return len(next(iter(self.arrays.values())))


def joined(parts: Sequence[Mapping[str, NDArray[Any]]]) -> dict[str, NDArray[Any]]:
    """The tables of several blocks of surfaces, one below the other."""
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}
