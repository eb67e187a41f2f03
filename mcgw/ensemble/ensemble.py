"""An ensemble: the sums of every surface, and their statistics over surfaces."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from analytic import QUANTITIES, MeasuredHeights
from mcgw.ensemble.intervals import CONFIDENCE, count_interval, mean_interval, spread_of
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene

__all__ = ["Arrays", "Ensemble", "Sums"]

Array = NDArray[np.float64]

_ROWS = 8192  # surfaces at a time, for ensembles larger than the memory
_LOW = 2**32 - 1  # the lower half of an integer: sums of halves do not overflow


class Sums(Protocol):
    """Where an ensemble's numbers lie: in memory or in a file."""

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of a dataset."""
        ...

    def rows(self) -> int:
        """Number of surfaces there are."""
        ...


@dataclass(frozen=True)
class Arrays:
    """Numbers in memory, by name."""

    arrays: dict[str, Array]

    def read(self, name: str, start: int, stop: int | None) -> Array:
        """Rows `start` to `stop` (None: to the end) of an array."""
        return self.arrays[name][start:stop]

    def rows(self) -> int:
        """Length of the arrays."""
        return len(next(iter(self.arrays.values())))


@dataclass(frozen=True)
class Ensemble:
    """The sums of every surface at every separation.

    Parameters
    ----------
    scene : Scene
        What was asked.
    sampler : str
        What drew it.
    sums : Sums
        Its numbers.
    """

    scene: Scene
    sampler: str
    sums: Sums

    @property
    def n_surfaces(self) -> int:
        """Number of surfaces there are; less than the scene's while a run goes on."""
        return self.sums.rows()

    @property
    def separations(self) -> Array:
        """Reduced separations d/sigma, shape (separations,)."""
        return np.array(self.scene.separations)

    def values(self, quantity: str) -> Array:
        """All values of a quantity in SI units, shape (surfaces, separations).

        Raises
        ------
        KeyError
            If the ensemble does not hold this quantity.
        """
        self._check(quantity)
        return self.sums.read(quantity, 0, self.n_surfaces)

    @property
    def load(self) -> Array:
        """Load P, N, shape (surfaces, separations)."""
        return self.values("load")

    @property
    def area(self) -> Array:
        """Real area A, m^2, shape (surfaces, separations)."""
        return self.values("area")

    @property
    def stiffness(self) -> Array:
        """Stiffness -dP/dd, N/m, shape (surfaces, separations)."""
        return self.values("stiffness")

    @property
    def contacts(self) -> Array:
        """Number of contacts, shape (surfaces, separations)."""
        return self.values("contacts")

    @property
    def conductance(self) -> Array:
        """Conductance times resistivity, m, shape (surfaces, separations)."""
        return self.values("conductance")

    def mean(self, quantity: str) -> Array:
        """Mean over the surfaces, shape (separations,)."""
        return self._moments(quantity)[0]

    def std(self, quantity: str) -> Array:
        """Standard deviation over the surfaces (divisor M - 1), nan for one surface."""
        return self._moments(quantity)[1]

    def stderr(self, quantity: str) -> Array:
        """Standard error of the mean, nan for one surface."""
        return np.asarray(self.std(quantity) / np.sqrt(self.n_surfaces))

    def interval(self, quantity: str, level: float = CONFIDENCE) -> tuple[Array, Array]:
        """Confidence interval of the mean, from the exact spread and skewness of the scene's own law.

        For any number of surfaces, one too. That of `contacts` is exact (Clopper-Pearson, or Garwood for
        a Poisson number of asperities). Measured heights as they are leave nothing open: both ends are
        the value.

        Parameters
        ----------
        quantity : str
            Its name.
        level : float, optional
            Probability that the interval covers the mean of all surfaces.

        Returns
        -------
        (ndarray, ndarray)
            Lower and upper ends, shape (separations,); nan where the whole ensemble has fewer than ten
            effective contacts (`mcgw.ensemble.intervals.Spread`).

        Raises
        ------
        KeyError
            If the ensemble does not hold this quantity.
        ValueError
            If the surfaces are stratified: how far their mean is off is not known.
        """
        self._check(quantity)
        scene, m = self.scene, self.n_surfaces
        if not promise_of(self.sampler).real_surfaces:
            raise ValueError("stratified surfaces have no interval: their fluctuations are not those of any")
        if isinstance(scene.heights, MeasuredHeights):
            return self.mean(quantity), self.mean(quantity)
        if quantity == "contacts":
            ends = count_interval(
                self._contacts(), float(scene.n_asperities) * m, poisson=scene.count == "poisson", level=level
            )
            return ends[0] / m, ends[1] / m
        return mean_interval(self.mean(quantity), spread_of(scene, quantity), m, level)

    def _contacts(self) -> Array:
        """Number of contacts of all surfaces: exact but for its rounding to double precision."""
        total = [0] * len(self.scene.separations)
        for start in range(0, self.n_surfaces, _ROWS):
            rows = self.sums.read("contacts", start, min(start + _ROWS, self.n_surfaces)).astype(np.int64)
            halves = zip((rows >> 32).sum(axis=0).tolist(), (rows & _LOW).sum(axis=0).tolist(), strict=True)
            total = [so_far + (high << 32) + low for so_far, (high, low) in zip(total, halves, strict=True)]
        return np.array([float(x) for x in total])

    def _check(self, quantity: str) -> None:
        if quantity not in self.scene.quantities:
            have = ", ".join(self.scene.quantities)
            hint = "" if quantity in QUANTITIES else " and is no quantity"
            raise KeyError(f"{quantity!r} is not in this ensemble{hint}; it has {have}")

    def _chunks(self, quantity: str) -> Iterator[Array]:
        for start in range(0, self.n_surfaces, _ROWS):
            yield self.sums.read(quantity, start, min(start + _ROWS, self.n_surfaces)).astype(np.float64)

    def _moments(self, quantity: str) -> tuple[Array, Array]:
        """Mean and standard deviation; shifted by the first row, so nothing cancels."""
        self._check(quantity)
        shift = self.sums.read(quantity, 0, 1)[0].astype(np.float64)
        m = self.n_surfaces
        mean = sum((chunk - shift).sum(axis=0) for chunk in self._chunks(quantity)) / m + shift
        squares = sum(((chunk - mean) ** 2).sum(axis=0) for chunk in self._chunks(quantity))
        std = np.sqrt(squares / (m - 1)) if m > 1 else np.full(len(mean), np.nan)
        return np.asarray(mean), np.asarray(std)
