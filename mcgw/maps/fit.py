"""From a measured map to the parameters of a Greenwood-Williamson surface, with their uncertainty."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, stdtrit

from analytic import SpectralMoments
from mcgw.formats.sheet import Sheet, Shown
from mcgw.machine.late import plotted
from mcgw.maps.form import Form, smooth, without_form
from mcgw.maps.hidden import Visible, unhidden, visible
from mcgw.maps.levels import form_left
from mcgw.maps.leverage import Alone, alone_of
from mcgw.maps.summit_sums import SUMS, SummitSums, summit_sums_of
from mcgw.maps.topography import Topography
from mcgw.maps.waves import Waves, waves_of

__all__ = ["METHODS", "Estimate", "Fit", "fit_map", "mean_squares"]

METHODS = {
    "moments": "spectral moments (Nayak, McCool)",
    "summits": "summits counted",
    "caps": "summits counted, hidden ones added",
}
# Of caps placed at random 12 and 20 pixels apart, so many were lost as if a summit had to be 0.7 to 1.2
# pixels from a valley, and 0.2 to 0.45 cutoffs: the correction is good to a quarter of itself.
_BLUR, _UNSURE = 0.3, 0.25
_FLAT = 0.5  # of the median curvature
_MOST_CAUTIONS = 4  # in a short look


@dataclass(frozen=True)
class Estimate:
    """The three parameters by one method, each with its standard error.

    Parameters
    ----------
    eta, radius, sigma : (float, float)
        Value and standard error: 1/m^2, m, m.
    """

    eta: tuple[float, float]
    radius: tuple[float, float]
    sigma: tuple[float, float]

    @property
    def overlap(self) -> float:
        """``eta R sigma``."""
        return self.eta[0] * self.radius[0] * self.sigma[0]


@dataclass(frozen=True, repr=False)
class Fit(Shown):
    """What a map tells.

    Parameters
    ----------
    estimates : dict of str to Estimate
        By the methods of `METHODS`; without ``caps`` if no field of independent caps looks like this.
    moments : SpectralMoments
        m0, m2 and m4, averages over both axes.
    alpha, skewness : (float, float)
        Value and standard error: m0 m4/m2^2, and the skewness of the map's heights.
    summits : ndarray
        Heights of the summits about their mean, m.
    mean_summit : float
        Their mean above the mean plane, m.
    area : float
        What was looked at, m^2.
    visible : Visible or None
        What a map shows of a field of independent caps like this one.
    mean_squares : dict of str to float
        Of slopes and second derivatives, by the names of `mcgw.maps.summit_sums.SUMS`.
    form : {"none", "plane", "quadratic"}
        What was taken off.
    waves : Waves
        Errors that follow from how few waves the map holds.
    alone : Alone or None
        The sub-area that carries the map alone, if one does.
    cautions : tuple of str, optional
        Why not to trust it: one line each, found by `mcgw.fit`.
    """

    estimates: dict[str, Estimate]
    moments: SpectralMoments
    alpha: tuple[float, float]
    skewness: tuple[float, float]
    summits: NDArray[np.float64]
    mean_summit: float
    area: float
    visible: Visible | None
    mean_squares: dict[str, float]
    form: Form
    waves: Waves
    alone: Alone | None
    cautions: tuple[str, ...] = ()

    def plot(self, ax: Any = None) -> Any:
        """Draw the summit heights beside a Gaussian distribution of their spread; returns the axes."""
        return plotted(self, ax)

    def sheet(self) -> Sheet:
        """Estimates by all methods, with standard errors, and the first of the cautions."""
        rows = [
            [METHODS[name], *(f"{value:.4g} +- {error:.1g}" for value, error in (e.eta, e.radius, e.sigma))]
            for name, e in self.estimates.items()
        ]
        facts = [("spectrum", f"alpha = {self.alpha[0]:.3g}, skewness {self.skewness[0]:.2f}")]
        facts += [("caution", line) for line in self.cautions[:_MOST_CAUTIONS]]
        more = len(self.cautions) - _MOST_CAUTIONS
        facts += [("", f"and {more} more in .cautions")] if more > 0 else []
        head = ["", "eta (1/m^2)", "R (m)", "sigma (m)"]
        return Sheet(f"Fit of {self.summits.size} summits on {self.area:.4g} m^2", facts, head, rows)


def fit_map(topography: Topography, *, cutoff: float | None, form: Form = "plane", across: int = 4) -> Fit:
    """Estimate eta, R and sigma of a map.

    Standard errors are those of a jackknife over the sub-areas, or those that follow from the number of
    waves on the map, if larger: sub-areas share its long waves.

    Parameters
    ----------
    topography : Topography
        Without missing points.
    cutoff : float or None
        Shortest wavelength that counts, m (ISO 16610-61); None: as measured.
    form : {"none", "plane", "quadratic"}, optional
        What is taken off first.
    across : int, optional
        Sub-areas along each axis.

    Returns
    -------
    Fit
        By all methods; `mcgw.maps.cautions.cautions` says why not to trust it.

    Raises
    ------
    ValueError
        If points are missing, the map is flat, has too few summits or is too small, or an estimate of
        sigma is more than the map's peak to valley.
    """
    if topography.missing:
        raise ValueError(f"the map lacks {topography.missing} points (nan): crop it, or fill them in first")
    if not np.ptp(topography.heights) > 0:
        raise ValueError("the map is flat: there is no roughness to fit")
    plain = without_form(topography, form)
    used = plain if cutoff is None else smooth(plain, cutoff)
    counted = _without_summit_form(summit_sums_of(used, across=across), form)
    if counted.heights.size < 4 * counted.parts:
        form_too = ", or --form quadratic" if form_left(topography, form) else ""
        raise ValueError(
            f"{counted.heights.size} summits are too few for {counted.parts} sub-areas; "
            f"give a larger map, a shorter cutoff, or fewer sub-areas{form_too}"
        )
    estimates = {"moments": _estimate(counted, _by_moments), "summits": _estimate(counted, _by_summits)}
    blur = math.hypot(max(used.pixel), _BLUR * (cutoff or 0.0))
    caps = _caps(counted, blur)
    peak_to_valley = float(np.ptp(used.heights))
    if caps is not None and caps.sigma[0] > peak_to_valley:
        caps = None  # so many would have to hide that those seen no longer tell
    if caps is not None:
        estimates["caps"] = caps
    waves = waves_of(used)
    estimates = {name: _with_waves(e, waves) for name, e in estimates.items()}
    _check_sigma(estimates, peak_to_valley)
    return Fit(
        estimates,
        _moments(counted),
        _at_least(_jackknife(counted, lambda t: np.array([_moments(t).alpha]))[0], waves.alpha),
        _jackknife(counted, lambda t: np.array([_skewness(t)]))[0],
        counted.heights - counted.heights.mean(),
        float(counted.heights.mean()) - mean_squares(counted)["z"],
        counted.area,
        None if caps is None else visible(caps.overlap, blur / math.sqrt(2 * caps.radius[0] * caps.sigma[0])),
        mean_squares(counted),
        form,
        waves,
        alone_of(counted),
    )


def _at_least(estimate: tuple[float, float], relative: float) -> tuple[float, float]:
    """An estimate with no smaller a relative error."""
    value, error = estimate
    return value, max(error, relative * value)


def _with_waves(estimate: Estimate, waves: Waves) -> Estimate:
    """The parameters with errors no smaller than the few waves on a map allow."""
    return Estimate(
        _at_least(estimate.eta, waves.eta),
        _at_least(estimate.radius, waves.radius),
        _at_least(estimate.sigma, waves.sigma),
    )


def _check_sigma(estimates: dict[str, Estimate], peak_to_valley: float) -> None:
    """No standard deviation is more than the range."""
    for name, estimate in estimates.items():
        if not estimate.sigma[0] <= peak_to_valley:
            raise ValueError(
                f"sigma of {METHODS[name]} is {estimate.sigma[0]:.4g} m, more than the peak to valley of "
                f"the map, {peak_to_valley:.4g} m; look at the map, and crop what does not belong to it"
            )


def _without_summit_form(counted: SummitSums, form: Form) -> SummitSums:
    """Summit heights about their own plane: deep valleys tilt that of the whole map."""
    if form == "none":
        return counted
    x, y = 2 * counted.places - 1
    columns = [np.ones_like(x), x, y, *((x * x, x * y, y * y) if form == "quadratic" else ())]
    basis = np.column_stack(columns)
    found = np.linalg.lstsq(basis, counted.heights, rcond=None)[0]
    return replace(counted, heights=counted.heights - basis[:, 1:] @ found[1:])


def _jackknife(
    counted: SummitSums, statistic: Callable[[SummitSums], NDArray[np.float64]]
) -> list[tuple[float, float]]:
    """Values, and errors by leaving out one sub-area after the other.

    They are standard errors widened as Student's t asks for so few sub-areas: two of them hold 95 %.
    """
    values = statistic(counted)
    without = np.array([statistic(counted.without(part)) for part in range(counted.parts)])
    n = counted.parts
    errors = np.sqrt((n - 1) / n * ((without - without.mean(axis=0)) ** 2).sum(axis=0))
    errors *= stdtrit(n - 1, ndtr(2.0)) / 2
    return list(zip(values.tolist(), errors.tolist(), strict=True))


def _estimate(counted: SummitSums, statistic: Callable[[SummitSums], NDArray[np.float64]]) -> Estimate:
    return Estimate(*_jackknife(counted, statistic))


def mean_squares(counted: SummitSums) -> dict[str, float]:
    """Means over the map, by the names of `mcgw.maps.summit_sums.SUMS`."""
    sums = counted.sums.sum(axis=1)
    return dict(zip(SUMS[1:], (sums[1:] / sums[0]).tolist(), strict=True))


def _moments(counted: SummitSums) -> SpectralMoments:
    m = mean_squares(counted)
    return SpectralMoments(m["z2"] - m["z"] ** 2, (m["slope_x"] + m["slope_y"]) / 2, m["bend"])


def _skewness(counted: SummitSums) -> float:
    z, z2, z3 = (mean_squares(counted)[key] for key in ("z", "z2", "z3"))
    return float((z3 - 3 * z * z2 + 2 * z**3) / (z2 - z * z) ** 1.5)


def _by_moments(counted: SummitSums) -> NDArray[np.float64]:
    m = _moments(counted)
    return np.array([m.eta, m.radius, m.sigma])


def _by_summits(counted: SummitSums) -> NDArray[np.float64]:
    n = counted.heights.size
    return np.array([n / counted.area, 1 / counted.curvatures.mean(), counted.heights.std(ddof=1)])


def _by_caps(counted: SummitSums, blur: float) -> NDArray[np.float64]:
    """All caps have one radius, so the median tells it: a few summits next to a valley do not."""
    median = np.median(counted.curvatures)
    caps = counted.heights[counted.curvatures > _FLAT * median]  # the others are ripples in the valleys
    found = unhidden(caps.size / counted.area, float(1 / median), float(caps.std(ddof=1)), blur)
    return np.full(3, np.nan) if found is None else np.array([found[0], 1 / median, found[1]])


def _caps(counted: SummitSums, blur: float) -> Estimate | None:
    """With what the corrections may be wrong by in the standard errors."""
    estimate = _estimate(counted, lambda t: _by_caps(t, blur))
    sharp = _by_caps(counted, 0.0)
    values = np.array([estimate.eta, estimate.radius, estimate.sigma])
    if not (np.all(np.isfinite(values)) and np.all(np.isfinite(sharp))):
        return None
    systematic = _UNSURE * np.abs(values[:, 0] - sharp)
    systematic[1] = abs(1 / float(counted.curvatures.mean()) - values[1, 0])
    errors = np.hypot(values[:, 1], systematic)
    return Estimate(*((float(v), float(e)) for v, e in zip(values[:, 0], errors, strict=True)))
