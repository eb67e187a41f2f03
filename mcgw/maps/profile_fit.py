"""From profiles of one isotropic surface to its summits, with their uncertainty.

A peak of a profile is not a summit of the surface: that usually lies beside the line. But both share their
moments: for an isotropic surface, m0, m2 and m4 of any profile are those of the surface (Nayak 1971), and if
heights are Gaussian they determine density, curvature and heights of its summits.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.special import stdtrit

from analytic import SpectralMoments
from analytic.arrays import Array
from mcgw.formats.table import Column, Shown, Table
from mcgw.machine.terminal import plotted
from mcgw.maps.estimates import Estimate, Roughness, roughness_of
from mcgw.maps.profile import (
    PROFILE_ORDERS,
    SMOOTH,
    Profile,
    smooth_profile,
    waves_of_profile,
    without_profile_form,
)
from mcgw.maps.steps import Form
from mcgw.maps.waves import Uncertain, log_derivatives, uncertain


@dataclass(frozen=True, repr=False)
class ProfileFit(Shown):
    """Surface parameters from profiles, if the surface is isotropic and its heights are Gaussian.

    Parameters
    ----------
    moments : SpectralMoments
        Moments of the surface, filtered as `mcgw.fit` filters a map.
    numbers : dict of str to Uncertain
        m0, m2, m4, alpha, eta, radius and sigma; errors are widened so that the value plus or minus two of
        them is a 95 % interval.
    roughness : Roughness
        Roughness of the filtered profiles without their form.
    peaks : (float, float)
        Peaks per length of these filtered profiles, 1/m: counted, and from their own moments,
        sqrt(m4/m2)/(2 pi).
    lengths : tuple of float
        Lengths of the profiles, m.
    form : {"none", "plane", "quadratic"}
        What was taken off.
    covariance : ndarray
        Of the logarithms of m0, m2 and m4, by their waves, shape (3, 3), to a factor.
    cautions : tuple of str, optional
        Why not to trust it.
    """

    moments: SpectralMoments
    numbers: dict[str, Uncertain]
    roughness: Roughness
    peaks: tuple[float, float]
    lengths: tuple[float, ...]
    form: Form
    covariance: Array
    cautions: tuple[str, ...] = ()

    @property
    def area(self) -> float:
        """Square of the mean length, m^2, since a profile has no area."""
        return (sum(self.lengths) / len(self.lengths)) ** 2

    @property
    def estimates(self) -> dict[str, Estimate]:
        """The only estimate, ``moments``, under the same name as in the fit of a map."""
        return {"moments": Estimate(*(self.numbers[name] for name in ("eta", "radius", "sigma")))}

    def plot(self, ax: Any = None) -> Any:
        """Draw the distributions of all heights and, derived from it, of the summits; returns the axes."""
        return plotted(self, ax)

    def sheet(self) -> Table:
        """Each number with its 95 % interval, and the first of the cautions."""
        counted, expected = self.peaks
        facts = [
            ("profiles", self.roughness.text("P")),
            ("peaks", f"{counted:.4g} per metre; {expected:.4g} expected from the moments"),
            ("summits", f"{self.moments.mean_height:.3g} m above the mean plane; sigma is about that height"),
            ("model", "isotropic surface, Gaussian heights (Nayak, McCool), after the areal filter"),
        ]
        facts += [("caution", line) for line in self.cautions[:1]]
        title = f"Fit of {len(self.lengths)} profile(s), {sum(self.lengths):.4g} m together"
        return self.table().under(title, facts)

    def table(self) -> Table:
        """Return a row for each number, with its 95 % interval."""
        units = {"m0": "m^2", "m4": "1/m^2", "eta": "1/m^2", "radius": "m", "sigma": "m"}
        value, _, low, high = zip(*self.numbers.values(), strict=True)
        return Table(
            (
                Column("name", list(self.numbers), " "),
                Column("unit", [units.get(name, "1") for name in self.numbers]),
                Column("value", value, form=".4g"),
                Column("low_95", low, "95 %", form=".3g"),
                Column("high_95", high, form=".3g", between=" to "),
            )
        )


def fit_profiles(profiles: Sequence[Profile], *, cutoff: float | None, form: Form = "plane") -> ProfileFit:
    """Estimate moments and summits of the surface that profiles were taken from.

    Longer profiles count more. Standard errors follow from the power of the waves seen, as for maps
    (`mcgw.maps.waves`), with the profiles independent of each other; or from what stretches of them differ,
    if that is more.

    Parameters
    ----------
    profiles : sequence of Profile
        Profiles of one surface, in any direction, far enough apart not to share waves.
    cutoff : float or None
        Shortest wavelength that counts, m, of the areal filter of ISO 16610-61; None: as measured.
    form : {"none", "plane", "quadratic"}, optional
        What is taken off first: nothing but the mean, a line, or a parabola.

    Returns
    -------
    ProfileFit
        See `mcgw.maps.fit_cautions` for reasons for caution.

    Raises
    ------
    ValueError
        If there is no profile, or they are flat, or too short for the cutoff.
    """
    if form not in PROFILE_ORDERS:
        raise ValueError(f"form = {form!r}: a profile has plane (a line), quadratic (a parabola) or none")
    if not profiles:
        raise ValueError("give at least one profile")
    plain = [without_profile_form(p, form) for p in profiles]
    if not any(
        np.ptp(p.heights) > 1e-12 * np.abs(q.heights).max() for p, q in zip(plain, profiles, strict=True)
    ):
        raise ValueError("the profile is flat, without roughness")
    filtered = plain if cutoff is None else [smooth_profile(p, cutoff) for p in plain]
    pieces = math.ceil(16 / len(profiles))
    shortest = min(p.heights.size for p in profiles)
    if shortest < 4 * pieces:
        raise ValueError(f"{shortest} points: too few for {pieces} stretches; give a longer profile")
    seen = [waves_of_profile(p, cutoff=cutoff, terms=PROFILE_ORDERS[form] + 1, pieces=pieces) for p in plain]
    shares = np.array([p.length for p in plain]) / sum(p.length for p in plain)
    stretches, waves = (
        np.concatenate([share * part for share, part in zip(shares, each, strict=True)], axis=1)
        for each in zip(*seen, strict=True)
    )
    values = stretches.sum(axis=1) / pieces
    moments, waves = _checked(values), waves / values[:, None]
    stretches *= len(plain) / values[:, None]
    return ProfileFit(
        moments,
        {
            name: uncertain(value := getattr(moments, name), value * _error(by @ stretches, by @ waves))
            for name, by in log_derivatives(moments).items()
        },
        roughness_of(np.concatenate([p.heights for p in filtered])),
        _peaks(filtered),
        tuple(p.length for p in profiles),
        form,
        waves @ waves.T,
    )


def _checked(values: Array) -> SpectralMoments:
    """Check that a surface can have these moments."""
    if not np.all(values > 0):
        raise ValueError(
            f"m0, m2, m4 = {', '.join(f'{v:.3g}' for v in values)}: not all are > 0; the profile is too "
            "short for this cutoff, or the surface is not isotropic; give a longer one"
        )
    moments = SpectralMoments(*values.tolist())
    if moments.alpha < 0.9:  # below it summit heights have no variance
        raise ValueError(
            f"m0 m4/m2^2 = {moments.alpha:.3g}, impossible for an isotropic surface (1.5 or more): the "
            "surface has a lay, or the profile is too short"
        )
    return moments


def _error(stretches: Array, waves: Array) -> float:
    """Of the logarithm of a number, from what stretches and waves have in it, widened by Student's t.

    Two of them hold 95 %.
    """
    squares = waves**2
    by_waves = math.sqrt(float(squares.sum()) / (1 + 1 / SMOOTH))
    freedom = max(float(squares.sum() ** 2 / (squares**2).sum()) / 2, 2.0)  # neighbours share power
    by_stretches = float(stretches.std(ddof=1)) / math.sqrt(stretches.size)
    return max(by_waves * _widened(freedom), by_stretches * _widened(stretches.size - 1))


def _widened(freedom: float) -> float:
    return float(stdtrit(freedom, 0.975)) / 2


def _peaks(profiles: list[Profile]) -> tuple[float, float]:
    """Peaks per length of filtered profiles, counted and by Rice's formula."""
    counted, slopes, bends, points, length = 0, 0.0, 0.0, 0, 0.0
    for p in profiles:
        z, h = p.heights, p.spacing
        counted += int(np.count_nonzero((z[1:-1] > z[:-2]) & (z[1:-1] >= z[2:])))
        slopes += float(np.sum((np.diff(z)[:-1] / h) ** 2))
        bends += float(np.sum((np.diff(z, 2) / h**2) ** 2))
        points, length = points + z.size - 2, length + (z.size - 2) * h
    return counted / length, math.sqrt(bends / slopes) / (2 * math.pi)
