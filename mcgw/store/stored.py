"""The sums of an ensemble where they lie: in its file, or in the shards of a run in progress."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from mcgw.ensemble.results import Results
from mcgw.errors import StoreError
from mcgw.store.layout import where
from mcgw.store.shards import RAGGED, Shard

__all__ = ["FileResults", "ShardResults"]


@dataclass(frozen=True)
class FileResults(Results):
    """The datasets of an ensemble file, opened for each reading."""

    path: Path

    def read(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        try:
            with h5py.File(self.path, "r") as file:
                return np.asarray(file[where(name)][start:stop])
        except OSError:
            raise StoreError(f"{self.path}: cannot be read; is it damaged? See mcgw show --verify") from None

    def rows(self) -> int:
        """Number of surfaces."""
        with h5py.File(self.path, "r") as file:
            return int(file["surface"].shape[0])


@dataclass(frozen=True)
class ShardResults(Results):
    """The blocks that a run had committed when it was looked at."""

    shards: tuple[Shard, ...]

    def read(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows `start` to `stop` of what is there; of the ragged table all."""
        rows, parts, first = self.rows() if stop is None else stop, [], 0
        for shard in self.shards:
            low, high = max(start - first, 0), min(rows - first, shard.span.n)
            if name == RAGGED:
                parts.append(self._arrays(shard)[name])
            elif low < high:
                parts.append(self._arrays(shard)[name][low:high])
            first += shard.span.n
        return np.concatenate(parts)[slice(start, stop) if name == RAGGED else slice(None)]

    def rows(self) -> int:
        """Number of surfaces."""
        return sum(shard.span.n for shard in self.shards)

    @staticmethod
    def _arrays(shard: Shard) -> dict[str, NDArray[Any]]:
        if not shard.path.exists():
            raise StoreError(f"{shard.path}: is gone; its run has ended, open the file again")
        return shard.arrays()
