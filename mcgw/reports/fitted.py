"""Results of a fit to a map or profiles, as text."""

from collections.abc import Sequence

from mcgw.maps.estimates import METHODS, estimates_table
from mcgw.maps.fit import Fit
from mcgw.maps.preparation import Preparation
from mcgw.maps.profile_fit import ProfileFit
from mcgw.maps.summits import variation
from mcgw.maps.waves import Uncertain


def fit_words(
    fit: Fit | ProfileFit, names: Sequence[str], asked: Preparation, assumed_unit: str
) -> list[str]:
    """Return what was fitted and how, what was done to it, and the results."""
    taken = f"form removed: {asked.form}"
    if isinstance(fit, ProfileFit):
        removed = {"none": "mean", "plane": "line", "quadratic": "parabola"}[fit.form]
        taken = f"profile; removed: {removed}"
    filtered = "none" if asked.cutoff is None else f"{asked.cutoff:g} m (Gaussian, ISO 16610-61)"
    line = f"{', '.join(names)}: {taken}; cutoff: {filtered}"
    if assumed_unit:
        line += f"; lengths assumed in {assumed_unit} where the file gives no unit"
    return [line, *(profile_lines(fit) if isinstance(fit, ProfileFit) else [*fit.notes, *fit_lines(fit)])]


def fit_lines(fit: Fit) -> list[str]:
    """Moments and the estimates by each method, one per line, with standard errors."""
    m0, m2, m4, alpha = (_told(x) for x in fit.numbers.values())
    lines = [
        f"m0 = {m0} m^2, m2 = {m2}, m4 = {m4} 1/m^2, alpha = {alpha}, "
        f"skewness {fit.skewness[0]:z.2f} +- {fit.skewness[1]:.1g}",
        f"{fit.summits.size} summits on {fit.area:.4g} m^2, "
        f"on average {fit.mean_summit:.3g} m above the mean plane",
        f"of all heights (below, sigma is that of the summits): {fit.roughness.text('S')}",
        *estimates_table(fit.estimates).text().splitlines(),
    ]
    across = round(len(fit.tiles) ** 0.5)
    between = f"{len(fit.maps)} maps" if fit.maps else f"{across} x {across} sub-areas"
    varies = fit.tiles.only("eta", "radius", "sigma").columns
    lines.append(
        f"scatter of counted summits between {between} (standard deviation): "
        + ", ".join(f"{c.words or c.name} by {100 * variation(c.values):.2g} %" for c in varies)
    )
    why = f"spread of the curvatures of summits: {fit.spread_of_curvatures:.2g} (Gaussian surfaces: 0.35)"
    lines.append(f"best here: {METHODS[fit.best]}; {why}")
    if fit.visible is not None and fit.best == "caps":
        lines.append(
            f"of such independent caps the map shows {100 * fit.visible.share:.3g} %, so counts are off by "
            f"{100 * (fit.visible.share - 1):+.2g} % in eta and {100 * (fit.visible.std - 1):+.2g} % in sigma"
        )
    return lines


def profile_lines(fit: ProfileFit) -> list[str]:
    """Statistics of the profiles and of the surface, one number per line."""
    counted, expected = fit.peaks
    number = len(fit.lengths)
    return [
        f"{number} profile{'s' if number > 1 else ''}, {sum(fit.lengths):.4g} m together; filtered along the "
        f"line: {fit.roughness.text('P')} (primary profile; called Ra, Rq, Rsk if waves beyond a cutoff "
        "lambda_c were removed before)",
        f"{counted:.4g} peaks per metre of profile; {expected:.4g} expected from its moments",
        "for an isotropic surface with Gaussian heights (Nayak, McCool), after the areal filter:",
        *fit.table().text().splitlines(),
        f"summits lie {fit.moments.mean_height:.3g} m above the mean plane on average; sigma is their "
        "deviation from that mean",
    ]


def _told(x: Uncertain) -> str:
    return f"{x.value:.4g} +- {x.error:.1g}"
