"""Why a fit may not be trusted: the map, the pixel, the shape of the heights, the crowd of summits."""

from mcgw.maps.fit import Fit
from mcgw.maps.flaws import flaws
from mcgw.maps.hidden import CROWDED, visible
from mcgw.maps.instrument import faults
from mcgw.maps.preparation import Prepared

__all__ = ["cautions"]

_PIXELS = 10.0  # a cutoff wavelength should have
_RESOLVED = 0.05  # that two ways to m4 may differ by: at about ten pixels a wavelength
_LOST = 0.1  # of the summits
_SKEW, _ALPHA, _FEW, _STREAKY = 0.3, 1.5, 100, 1.5


def cautions(fit: Fit, ready: Prepared, use: str = "auto") -> list[str]:
    """Warnings about the fit of a map, and the estimate to `use`, each in one line that says what to do."""
    return [
        *flaws(fit, ready),
        *faults(ready, _longer(ready)),
        *_of_the_pixel(fit, ready),
        *_of_the_heights(fit),
        *_of_the_summits(fit, use if use in fit.estimates else fit.best),
    ]


def _longer(ready: Prepared) -> float:
    """A cutoff that takes more of the shortest waves, in pixels."""
    return max(_PIXELS, 1.5 * (ready.asked.cutoff or 0.0) / max(ready.used.pixel))


def _of_the_pixel(fit: Fit, ready: Prepared) -> list[str]:
    pixel, cutoff = max(ready.used.pixel), ready.asked.cutoff
    if cutoff is not None and cutoff < _PIXELS * pixel:
        return [
            f"cutoff: {cutoff / pixel:.3g} pixels a wavelength; below {_PIXELS:g} the pixel sets eta and R, "
            "not the specimen; give a longer cutoff or finer pixels"
        ]
    more = fit.mean_squares["bend"] / fit.mean_squares["bend_1"] - 1
    if more > _RESOLVED:
        return [
            f"pixel: m4 by differences of fourth order is {100 * more:.2g} % above that by plain ones; it "
            f"has a say in m4, R and eta; give a cutoff of {_longer(ready):.3g} pixels or more"
        ]
    return []


def _of_the_heights(fit: Fit) -> list[str]:
    warnings = []
    skewness, error = fit.skewness
    if abs(skewness) > max(_SKEW, 3 * error):
        warnings.append(
            f"skewness: {skewness:.2f} of the heights; spectral moments tell of summits for Gaussian heights "
            "only; count them, and keep their heights (--heights table)"
        )
    if fit.alpha.value < _ALPHA:
        warnings.append(f"alpha: {fit.alpha.value:.3g} is below 1.5, which no isotropic Gaussian surface has")
    if fit.lay > _STREAKY:
        warnings.append(
            f"lay: mean square slopes across and along it have the ratio {fit.lay:.3g}; it is not isotropic"
        )
    return warnings


def _of_the_summits(fit: Fit, used: str) -> list[str]:
    warnings = []
    if fit.summits.size < _FEW:
        warnings.append(f"summits: only {fit.summits.size} were found; give a larger map or a shorter cutoff")
    overlap = fit.estimates[used].overlap
    if used == "caps" and fit.visible is not None:
        sharp = visible(overlap).share
        lost = sharp - fit.visible.share
        if lost > _LOST:
            warnings.append(
                f"blur: {100 * lost:.0f} % of caps like these are lost where a valley is nearer than a pixel "
                "or a third of a cutoff; give finer pixels, and a shorter cutoff"
            )
        hidden = f" of caps like these {100 * (1 - sharp):.0f} % hide under others,"
    else:
        hidden = " summits are as broad as they are far apart,"
    if overlap > CROWDED:
        warnings.append(f"overlap: eta R sigma = {overlap:.2g};{hidden} so asperities do not act one by one")
    return warnings
