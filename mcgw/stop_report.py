"""What a stop rule promises before a run, and what it has to say after one."""

import numpy as np

from mcgw.ensemble import Ensemble
from mcgw.forecast import Forecast
from mcgw.stopping import CONFIDENCE, upper_contacts

__all__ = ["after", "before"]


def before(forecast: Forecast, seconds_each: float) -> str:
    """One line: how many surfaces, how long, and what that will not reach."""
    line = f"about {forecast.surfaces:.2g} surfaces, {forecast.surfaces * seconds_each:.2g} s"
    if forecast.out_of_reach:
        name, h = forecast.out_of_reach[-1]
        line += (
            f"; {len(forecast.out_of_reach)} means need more surfaces than max_surfaces allows, "
            f"such as {name} at d/sigma = {h:g}: {max(forecast.needed[name]):.2g}"
        )
    return line


def after(ensemble: Ensemble, rel_err: float) -> list[str]:
    """One line for each separation without a contact and each mean known less well than asked."""
    m, n = ensemble.n_surfaces, ensemble.scene.n_asperities
    low = {name: ensemble.mean(name) for name in ensemble.scene.quantities}
    silent = np.all([mean == 0 for mean in low.values()], axis=0)
    limit = upper_contacts(m)
    lines = [
        f"d/sigma = {h:g}: no contact in {m} surfaces, mean below {limit:.3g} contacts a surface, "
        f"{limit / n:.3g} an asperity ({CONFIDENCE:.0%} confidence)"
        for h in np.unique(ensemble.separations[silent])
    ]
    for name, mean in low.items():
        with np.errstate(divide="ignore", invalid="ignore"):
            width = (ensemble.interval(name, CONFIDENCE)[1] - mean) / np.abs(mean)
        for h, w in zip(ensemble.separations[~silent], width[~silent], strict=True):
            if not w <= rel_err * (1 + 1e-9):  # the interval is summed in another order than the rule's
                lines.append(f"{name} at d/sigma = {h:g} is known to {w:.2g} of itself, not to {rel_err:g}")
    return lines
