"""Why a fit of profiles may not be trusted, each in one line that says what to do."""

from collections.abc import Sequence

from mcgw.maps.profile import Profile
from mcgw.maps.profile_fit import ProfileFit

__all__ = ["profile_cautions"]

_PIXELS = 10.0  # points a cutoff wavelength should have
_SKEW, _PEAKS, _ALPHA, _UNSURE = 0.3, 1.2, 1.5, 0.2


def profile_cautions(fit: ProfileFit, profiles: Sequence[Profile], cutoff: float | None) -> list[str]:
    """Warnings about the fit of these profiles."""
    return [*_of_the_points(profiles, cutoff), *_of_the_heights(fit), *_of_the_waves(fit)]


def _of_the_points(profiles: Sequence[Profile], cutoff: float | None) -> list[str]:
    lines = []
    filled, points = sum(p.filled for p in profiles), sum(p.heights.size for p in profiles)
    if filled:
        lines.append(f"missing: {filled} of {points} heights lie on straight lines between their neighbours")
    spacing = max(p.spacing for p in profiles)
    if any(p.resampled for p in profiles):
        lines.append("x: the points were not evenly spaced; heights between them were interpolated")
    if cutoff is None:
        lines.append(
            "cutoff: none, so that noise and the tip set m4, R and eta; give ten points "
            f"({10 * spacing:.2g} m) or more, and no less than the radius of the tip"
        )
    elif cutoff < _PIXELS * spacing:
        lines.append(
            f"cutoff: {cutoff / spacing:.3g} points a wavelength; below {_PIXELS:g} the spacing sets eta and "
            "R, not the specimen; give a longer cutoff"
        )
    return lines


def _of_the_heights(fit: ProfileFit) -> list[str]:
    lines = []
    if abs(fit.roughness.sk) > max(_SKEW, 6 * fit.errors["m0"]):
        lines.append(
            f"skewness: {fit.roughness.sk:.2f} of the heights; moments tell of summits for Gaussian heights "
            "only; measure a map, and count them"
        )
    counted, expected = fit.peaks
    if not 1 / _PEAKS < counted / expected < _PEAKS:
        lines.append(
            f"peaks: {counted:.3g} a metre are counted, and {expected:.3g} follow from the profile's own "
            "moments; it is not Gaussian, or noise makes peaks: measure a map"
        )
    if fit.moments.alpha < _ALPHA:
        lines.append(
            f"alpha: {fit.moments.alpha:.3g} is below 1.5, which no isotropic Gaussian surface has; a turned "
            "or ground surface needs a map"
        )
    return lines


def _of_the_waves(fit: ProfileFit) -> list[str]:
    if fit.errors["sigma"] < _UNSURE:
        return []
    return [
        f"waves: sigma is known to {100 * fit.errors['sigma']:.2g} % only, since the longest are few; give "
        "longer profiles, or more of them"
    ]
