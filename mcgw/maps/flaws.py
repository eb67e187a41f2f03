"""What does not belong to the roughness of a map, or makes one map too little: each with what would do."""

from mcgw.maps.edges import bad_edges
from mcgw.maps.fit import Fit
from mcgw.maps.levels import form_left, step_of
from mcgw.maps.preparation import Prepared
from mcgw.maps.spikes import spikes_of
from mcgw.maps.topography import STEEPEST, Topography

__all__ = ["flaws"]

_WIDEST = 1e-2  # m
_FEW_WAVES = 50  # sigma known to a tenth


def flaws(fit: Fit, ready: Prepared) -> list[str]:
    """Warnings about what lies on a map, each in one line that says what to do."""
    level = ready.levelled
    return [
        *_units(level),
        *_edges(level),
        *_spikes(level),
        *_alone(fit, level),
        *(_step(level) or _form(fit, level) or _waves(fit)),
    ]


def _units(topography: Topography) -> list[str]:
    lines = []
    if topography.steepness > STEEPEST:
        lines.append(
            f"slope: {topography.steepness:.3g} is usual on this map; are heights or pixel in another unit?"
        )
    if max(topography.pixel) > _WIDEST:
        lines.append(f"pixel: {max(topography.pixel):g} m; was um or mm meant?")
    return lines


def _edges(topography: Topography) -> list[str]:
    number = bad_edges(topography.heights)
    if not number:
        return []
    points = "outermost points" if number == 1 else f"outermost {number} points"
    return [f"edge: the {points} of the map jump unlike all others; leave them off by --trim {number}"]


def _spikes(topography: Topography) -> list[str]:
    spikes = spikes_of(topography)
    if spikes is None:
        return []
    places = "1 place stands" if spikes.number == 1 else f"{spikes.number} places stand"
    kind = "high" if spikes.height > 0 else "deep"
    return [
        f"spikes: {places} out of the map, the largest at x = {spikes.x:.4g} m, y = {spikes.y:.4g} m, "
        f"{abs(spikes.height):.3g} m {kind} and narrower than five pixels; one alone can set R, eta and "
        "sigma: take them out by --spikes remove, or crop the map"
    ]


def _alone(fit: Fit, topography: Topography) -> list[str]:
    alone = fit.alone
    if alone is None:
        return []
    place = (
        f"{axis} = {size * n / alone.across:.4g} to {size * (n + 1) / alone.across:.4g} m"
        for axis, size, n in zip("xy", topography.size, (alone.column, alone.row), strict=True)
    )
    return [
        f"sub-area: without the one at {', '.join(place)} {alone.moment} is {alone.left:.2g} of itself; the "
        "errors stated say little where one sub-area counts alone: look there, and crop it"
    ]


def _step(topography: Topography) -> list[str]:
    step = step_of(topography)
    if step is None:
        return []
    return [
        f"step: two levels {step.height:.3g} m apart meet near {step.axis} = {step.place:.3g} m; keep the "
        "larger terrace by --step crop"
    ]


def _form(fit: Fit, topography: Topography) -> list[str]:
    left = form_left(topography, fit.form)
    if left is None:
        return []
    kind = "a tilt or a curved form" if fit.form == "none" else "a curved form"
    return [
        f"form: {kind} of {left.height:.3g} m from peak to valley was left and holds "
        f"{100 * left.share:.0f} % of the variance; give --form {left.form}"
    ]


def _waves(fit: Fit) -> list[str]:
    number = fit.waves.independent
    if number >= _FEW_WAVES:
        return []
    return [
        f"waves: the longest are so few that m0 is known as from {number:.2g} heights: sigma may be another "
        f"one elsewhere, by {100 * fit.waves.sigma.error:.2g} % or more; give a longer map"
    ]
