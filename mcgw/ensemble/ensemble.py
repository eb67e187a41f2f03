"""An ensemble: the sums of every surface, and their statistics over surfaces."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from analytic import PER_AREA
from analytic.arrays import Array
from mcgw.ensemble.intervals import CONFIDENCE, interval_of
from mcgw.ensemble.labelled import Labelled, axes_of, sheet_of, statistics_of, values_of
from mcgw.ensemble.results import Held
from mcgw.formats.sheet import Sheet, Shown, brief
from mcgw.machine.terminal import plotted, quantity_and_axes
from mcgw.scene.scene import Scene
from mcgw.scene.scene_file import scene_text

_SAME = 1e-9  # d/sigma
STATISTICS = ("mean", "std")  # of each quantity, kept in place of values, besides covariances


@dataclass(frozen=True, repr=False)
class Ensemble(Shown):
    """The sums of every surface at every separation.

    The quantities are those of the scene, such as "load" (N); "pressure" (P/A_n, Pa) and "area_fraction"
    (A/A_n, 1) follow from them.

    Parameters
    ----------
    scene : Scene
        The scene that was simulated.
    sampler : str
        The sampler that drew it.
    sums : Held
        The values of every surface, or their statistics.
    drawn_for : Scene, optional
        The scene for which the surfaces were drawn, if it is another one, as for some of its separations.

    Examples
    --------
    >>> import mcgw
    >>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
    >>> e = mcgw.simulate(mcgw.Scene(surface, separations=[0, 1, 2], n_surfaces=100, seed=1))
    >>> e["load"].shape, e.mean("pressure").shape
    ((100, 3), (3,))
    >>> e  # doctest: +ELLIPSIS
    Ensemble of 100 surfaces of 300 asperities
      grading     Homogeneous()
      heights     Gaussian()
      drawn       by cells, seed 1
      elasticity  ...
      mean +- stderr, d/sigma =                    0                    1                    2
      load (N)                         78.623 +- 0.9        13.997 +- 0.3       1.2636 +- 0.08
      area (m^2)                 6.7268e-09 +- 6e-11  1.4176e-09 +- 3e-11  1.4864e-10 +- 7e-12
      stiffness (N/m)            8.2104e+07 +- 6e+05  2.0904e+07 +- 3e+05  2.5762e+06 +- 1e+05
      contacts (1)                     150.17 +- 0.9         47.49 +- 0.7          6.99 +- 0.3
    """

    scene: Scene
    sampler: str
    sums: Held
    drawn_for: Scene | None = None

    @property
    def surfaces_of(self) -> Scene:
        """The scene whose seed reproduces the surfaces."""
        return self.drawn_for or self.scene

    @property
    def n_surfaces(self) -> int:
        """Number of surfaces drawn so far; smaller than the scene's while a run is in progress."""
        return self.sums.rows()

    @property
    def separations(self) -> Array:
        """Reduced separations d/sigma, shape (separations,)."""
        return np.array(self.scene.separations)

    def values(self, quantity: str) -> Array:
        """Return all values of a quantity in SI units, shape (surfaces, separations).

        Raises
        ------
        KeyError
            If the ensemble does not hold this quantity.
        """
        name, area = self._held(quantity)
        values = self.sums.read(name, 0, self.n_surfaces)
        return values / area if name != quantity else values

    def __getitem__(self, quantity: str) -> Array:
        """The same as `values`."""
        return self.values(quantity)

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
        """Stiffness of the contact spots, N/m, shape (surfaces, separations): -dP/dd where nothing yields.

        With asperity interaction, in series with the half-space: ``1/K = 1/K_asp + compliance``.
        """
        return self.values("stiffness")

    @property
    def contacts(self) -> Array:
        """Number of contacts, shape (surfaces, separations)."""
        return self.values("contacts")

    @property
    def conductance(self) -> Array:
        """Contact conductance times resistivity, m, shape (surfaces, separations).

        With asperity interaction it is in series with the half-space, as `stiffness` is.
        """
        return self.values("conductance")

    @property
    def pressure(self) -> Array:
        """Load per nominal area P/A_n, Pa, shape (surfaces, separations)."""
        return self.values("pressure")

    @property
    def area_fraction(self) -> Array:
        """Real area per nominal area A/A_n, shape (surfaces, separations)."""
        return self.values("area_fraction")

    def mean(self, quantity: str, separation: ArrayLike | None = None) -> Array:
        """Return the mean over the surfaces.

        Parameters
        ----------
        quantity : str
            Its name.
        separation : array_like, optional
            Some of the separations of the ensemble, d/sigma. Default: all.

        Returns
        -------
        ndarray
            In the shape of the separations.

        Raises
        ------
        KeyError
            If the ensemble does not hold this quantity.
        ValueError
            If it has no such separation.
        """
        name, area = self._held(quantity)
        return self._at(np.asarray(self.sums.mean_and_std(name)[0] / area), quantity, separation)

    def std(self, quantity: str, separation: ArrayLike | None = None) -> Array:
        """Return the standard deviation over the surfaces (divisor M - 1), nan for one; as `mean`."""
        name, area = self._held(quantity)
        return self._at(np.asarray(self.sums.mean_and_std(name)[1] / area), quantity, separation)

    def stderr(self, quantity: str, separation: ArrayLike | None = None) -> Array:
        """Return the standard error of the mean, nan for one surface; as `mean`."""
        return np.asarray(self.std(quantity, separation) / np.sqrt(self.n_surfaces))

    def _at(self, values: Array, quantity: str, separation: ArrayLike | None) -> Array:
        """Values at some separations."""
        if separation is None:
            return values
        asked = np.asarray(separation, dtype=np.float64)
        apart = np.abs(asked[..., None] - self.separations)
        if np.any(lacking := apart.min(axis=-1, initial=np.inf) > _SAME):
            first, have = float(asked[lacking].flat[0]), ", ".join(f"{h:g}" for h in self.separations)
            raise ValueError(
                f"separation = {first:g}: the ensemble has {brief(have)}; "
                f"scene.theory.mean({quantity!r}, {first:g}) is exact at any"
            )
        return np.asarray(values[apart.argmin(axis=-1)])

    def covariance(self, quantity: str, other: str | None = None) -> Array:
        """Return the covariance over the surfaces (divisor M - 1) of two quantities, or of one with itself.

        Shape (separations, separations of the other); nan for one surface.
        """
        (name, area), (second, by) = self._held(quantity), self._held(other or quantity)
        found = self.sums.covariance(name, second)
        return np.asarray(found / area / by)

    def quantile(self, quantity: str, share: float) -> Array:
        """Return the quantile over the surfaces, as `numpy.quantile`, shape (separations,).

        The exact one, of a surface that is not yet drawn, is ``scene.theory.distribution(quantity, h).ppf``.

        Raises
        ------
        KeyError
            If the ensemble does not hold this quantity.
        ValueError
            If `share` is not from 0 to 1, or values are not kept.
        """
        if not 0 <= share <= 1:
            raise ValueError(f"share = {share!r}: give a fraction of the surfaces, 0 to 1")
        return np.asarray(np.quantile(self.values(quantity), share, axis=0))

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
            Lower and upper ends, shape (separations,); nan where the whole ensemble has fewer than ten
            effective contacts (`mcgw.ensemble.intervals.Spread`).

        Raises
        ------
        KeyError
            If the ensemble does not hold this quantity.
        """
        name, area = self._held(quantity)
        low, high = interval_of(self.scene, self.sampler, self.sums, name, level)
        return low / area, high / area

    def to_xarray(self) -> Any:
        """Return all values as an `xarray.Dataset` with dimensions (surface, separation), as in the file.

        With ``keep = "statistics"``: ``load_mean``, ``load_std`` and so on, dimension (separation).

        Raises
        ------
        ImportError
            If xarray is not installed.
        """
        scene = self.scene
        about = {"title": scene.title, "scene": scene_text(scene), "sampler": self.sampler}
        return self.labelled().to_xarray(about)

    def to_dataframe(self) -> Any:
        """Return all values as a `pandas.DataFrame`: rows (surface, separation), a column for each quantity.

        With ``keep = "statistics"``: a row for each separation, a column for each mean and deviation.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        over = () if self.scene.keep == "statistics" else ("surface",)
        return self.labelled().to_dataframe((*over, "separation"))

    def labelled(self) -> Labelled:
        """Return all data with axes, units and descriptions, for the file, xarray and pandas alike."""
        if self.scene.keep != "statistics":
            return values_of(self.scene, {name: self.values(name) for name in self.scene.shapes})
        return Labelled(statistics_of(self, self.scene.shapes, STATISTICS), axes_of(self.scene))

    def plot(self, quantity: str | None = None, ax: Any = None) -> Any:
        """Draw the mean of a quantity with its confidence interval, and the spread of single surfaces.

        Parameters
        ----------
        quantity : str, optional
            Default: the first quantity of the scene.
        ax : matplotlib Axes, optional
            Axes to draw on, also as the first argument; default: new ones.

        Returns
        -------
        matplotlib.axes.Axes
            With labels.
        """
        quantity, ax = quantity_and_axes(quantity, ax)
        return plotted(self, ax, quantity=quantity or self.scene.quantities[0])

    def sheet(self) -> Sheet:
        """Return how the ensemble was drawn, and means at the lowest, a middle and the highest separation."""
        return sheet_of(self)

    def _held(self, quantity: str) -> tuple[str, float]:
        """The stored quantity, and the area to divide by, or 1."""
        q = PER_AREA.get(quantity)
        name, area = (q.of, self.scene.surface.nominal_area) if q else (quantity, 1.0)
        if name not in self.scene.shapes:
            have = ", ".join(self.scene.shapes)
            raise KeyError(f"{quantity!r} is not in this ensemble; it has {have}")
        return name, area
