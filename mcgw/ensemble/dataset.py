"""What is held of the surfaces of one scene or of several: statistics over them, and other forms of them."""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from analytic import PER_AREA
from analytic.arrays import Array, Ints
from mcgw.ensemble.intervals import CONFIDENCE, interval_of
from mcgw.ensemble.results import Held, Labelled, Variable
from mcgw.formats.table import Drawn, optional
from mcgw.machine.terminal import brief
from mcgw.scene.scene import Scene

_SAME = 1e-9  # d/sigma


class Dataset(Drawn):
    """Quantities of surfaces at the separations of their scenes, SI, and statistics over the surfaces.

    What is an array has first the shape of the points, which a single scene does not have. The quantities
    are those of the scenes, such as "load" (N); "pressure" (P/A_n, Pa) and "area_fraction" (A/A_n, 1) follow
    from them.
    """

    @property
    @abstractmethod
    def _points(self) -> Sequence[Scene]:
        """Scenes, the last axis fastest."""

    @property
    @abstractmethod
    def shape(self) -> tuple[int, ...]:
        """Number of points along each axis; nothing of a single scene."""

    @abstractmethod
    def _held(self, point: int) -> Held:
        """Return what is held of the surfaces of a point."""

    @abstractmethod
    def _at(self, which: Ints) -> Self:
        """Return the same surfaces at some of the separations, by their numbers."""

    @abstractmethod
    def labelled(self) -> Labelled:
        """Return all data with axes, units and descriptions, for the file, xarray and pandas alike."""

    @abstractmethod
    def _about(self) -> dict[str, Any]:
        """Return what is said of all data, for xarray."""

    def to_xarray(self) -> Any:
        """Return all data as an `xarray.Dataset`.

        Values of every surface have the dimensions (surface, separation), as in the file; what is a
        statistic, ``load_mean``, ``load_std`` and so on, those of the points and (separation).

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        xarray, found = optional("xarray", "to_xarray"), self.labelled()

        def told(one: Variable) -> tuple[Any, ...]:
            units = {"units": one.units} if one.units else {}
            return one.dims, one.values[:], {**units, "long_name": one.long_name}

        both = ({name: told(x) for name, x in some.items()} for some in (found.variables, found.coordinates))
        return xarray.Dataset(*both, self._about())

    def to_dataframe(self) -> Any:
        """Return all data as a `pandas.DataFrame`: a row for each place along the dimensions of `to_xarray`.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        pandas, found = optional("pandas", "to_dataframe"), self.labelled()
        dims = next(iter(found.variables.values())).dims
        places = [found.coordinates[dim].values for dim in dims]
        if len(places) == 1:
            index = pandas.Index(places[0], name=dims[0])
        else:
            index = pandas.MultiIndex.from_product(places, names=dims)
        columns = {name: one.values[:].ravel() for name, one in found.variables.items() if one.dims == dims}
        return pandas.DataFrame(columns, index=index)

    @property
    def separations(self) -> Array:
        """Reduced separations d/sigma, shape (separations,)."""
        return np.array(self._points[0].separations)

    @property
    def quantities(self) -> tuple[str, ...]:
        """Quantities that are held."""
        return self._points[0].tables

    def mean(self, quantity: str) -> Array:
        """Return the mean over the surfaces in SI units, shape (points ..., separations).

        Raises
        ------
        KeyError
            If this quantity is not held.
        """
        return self._of_each(quantity, lambda _, held, name: held.mean_and_std(name)[0])

    def std(self, quantity: str) -> Array:
        """Return the standard deviation over the surfaces (divisor M - 1), nan for one; as `mean`."""
        return self._of_each(quantity, lambda _, held, name: held.mean_and_std(name)[1])

    def stderr(self, quantity: str) -> Array:
        """Return the standard error of the mean, nan for one surface; as `mean`."""
        return self._of_each(
            quantity, lambda _, held, name: held.mean_and_std(name)[1] / np.sqrt(held.rows())
        )

    def covariance(self, quantity: str, other: str | None = None) -> Array:
        """Return the covariance over the surfaces (divisor M - 1) of two quantities, or of one with itself.

        Shape (points ..., separations, separations of the other); nan for one surface.

        Raises
        ------
        KeyError
            If this quantity is not held.
        ValueError
            If this is not kept, as of a sweep.
        """
        second, per_area = self._stored(other or quantity)
        found = self._of_each(quantity, lambda _, held, name: held.covariance(name, second))
        return self._per_area(found) if per_area else found

    def quantile(self, quantity: str, share: float) -> Array:
        """Return the quantile over the surfaces, as `numpy.quantile`, shape (points ..., separations).

        The exact one, of a surface that is not yet drawn, is ``scene.theory.distribution(quantity, h).ppf``.

        Raises
        ------
        KeyError
            If this quantity is not held.
        ValueError
            If `share` is not from 0 to 1, or values are not kept.
        """
        if not 0 <= share <= 1:
            raise ValueError(f"share = {share!r}: give a fraction of the surfaces, 0 to 1")
        return self._of_each(
            quantity, lambda _, held, name: np.quantile(held.read(name, 0, None), share, axis=0)
        )

    def interval(self, quantity: str, level: float = CONFIDENCE) -> tuple[Array, Array]:
        """Return the confidence interval of the mean, from the exact spread and skewness of the scene.

        It holds for any number of surfaces, even one. For `contacts` it is exact (Clopper-Pearson, or Garwood
        for a Poisson number of asperities). Measured heights used as they are do not fluctuate: both ends
        equal the value.

        Parameters
        ----------
        quantity : str
            Its name.
        level : float, optional
            Probability that the interval covers the mean of all surfaces.

        Returns
        -------
        (ndarray, ndarray)
            Lower and upper ends, each as `mean`; nan where the surfaces together have fewer than ten
            effective contacts (`mcgw.ensemble.intervals.Spread`).

        Raises
        ------
        KeyError
            If this quantity is not held.
        """
        ends = self._of_each(
            quantity, lambda i, held, x: np.stack(interval_of(self._points[i], held, x, level), -1)
        )
        return ends[..., 0], ends[..., 1]

    def theory(self, quantity: str) -> Array:
        """Return the exact mean (`Scene.theory`), shape (points ..., separations)."""
        h = self.separations
        return self._of_each(quantity, lambda i, _, name: self._points[i].theory.mean(name, h))

    def sel(self, *, separation: ArrayLike) -> Self:
        """Return the same surfaces at some of the separations.

        Parameters
        ----------
        separation : array_like
            One or several of `separations`, d/sigma.

        Raises
        ------
        ValueError
            If there is no such separation.

        Examples
        --------
        >>> import mcgw
        >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
        >>> e = mcgw.simulate(mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=100, seed=1))
        >>> f"{e.sel(separation=1.0).mean('load')[0] / e.mean('load')[1]:.12g}"
        '1'
        """
        wanted = np.atleast_1d(np.asarray(separation, dtype=np.float64)).ravel()
        apart = np.abs(wanted[:, None] - self.separations)
        if np.any(lacking := apart.min(axis=-1, initial=np.inf) > _SAME):
            have = ", ".join(f"{h:g}" for h in self.separations)
            raise ValueError(
                f"separation = {wanted[lacking][0]:g}: there are {brief(have)}; scene.theory has the exact "
                "mean at any"
            )
        return self._at(apart.argmin(axis=-1))

    def _of_each(self, quantity: str, get: Callable[[int, Held, str], Any]) -> Array:
        """One array over all points, in the shape of the axes, per area if requested."""
        name, per_area = self._stored(quantity)
        found = np.stack([get(i, self._held(i), name) for i in range(len(self._points))])
        found = found.reshape(*self.shape, *found.shape[1:])
        return self._per_area(found) if per_area else found

    def _per_area(self, values: Array) -> Array:
        areas = np.array([scene.surface.nominal_area for scene in self._points])
        return np.asarray(values / areas.reshape(*self.shape, *[1] * (values.ndim - len(self.shape))))

    def _stored(self, quantity: str) -> tuple[str, bool]:
        """Return the stored quantity, and whether the requested one is per nominal area."""
        name = PER_AREA[quantity].of if quantity in PER_AREA else quantity
        if name not in self.quantities:
            kind, have = type(self).__name__.lower(), ", ".join(self.quantities)
            raise KeyError(f"{quantity!r} is not in this {kind}; it has {have}")
        return name, quantity in PER_AREA
