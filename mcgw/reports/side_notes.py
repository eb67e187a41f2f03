"""What is said beside the numbers of a model: how far elasticity is, what a stop rule gives."""

from typing import TYPE_CHECKING

import numpy as np

from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.intervals import CONFIDENCE, TOO_FEW, spread_of
from mcgw.scene.samplers import promise_of
from mcgw.scene.scene import Scene
from mcgw.scene.stop_rule import wanted
from mcgw.scene.validity import Validity

if TYPE_CHECKING:
    from mcgw.ensemble.forecast import Forecast


def against_elasticity(found: Validity) -> list[str]:
    """The verdict, and where it was measured, a line each."""
    return [found.verdict, *([f"  {found.details}"] if found.details else [])]


def elasticity_words(found: Validity) -> list[str]:
    """The same in paragraphs of a page; the second one tells of a table over the separations."""
    if not found.measured.any():
        return [f"{found.verdict}."]
    details = f"{found.details}."
    return [
        f"{details[0].upper()}{details[1:]}",
        "Model over elasticity, less 1: mean over the maps ± what holds 95 % of surfaces with so many "
        "contacts and long waves. Area, stiffness and gap are those at the load of that separation; the load "
        "is that at the separation itself, taken for the mean gap of a periodic cell. Pressure: "
        f"{found.axis}.",
    ]


def before(forecast: "Forecast", seconds_each: float) -> str:
    """One line: how many surfaces, how long, and what that will not reach."""
    line = f"about {forecast.surfaces:.2g} surfaces, {forecast.surfaces * seconds_each:.2g} s"
    return f"{line}; {forecast.shortfall}" if forecast.shortfall else line


def after(ensemble: Ensemble, scene: Scene) -> list[str]:
    """One line for each separation without a contact and each mean known less well than the scene asked."""
    m, n = ensemble.n_surfaces, ensemble.scene.n_asperities
    silent = np.all([ensemble.mean(name) == 0 for name in ensemble.scene.quantities], axis=0)
    limit = upper_contacts(m)
    lines = [
        f"d/sigma = {h:g}: no contact in {m} surfaces, mean below {limit:.3g} contacts a surface, "
        f"{limit / n:.3g} an asperity ({CONFIDENCE:.0%} confidence)"
        for h in np.unique(ensemble.separations[silent])
    ]
    if not promise_of(ensemble.sampler).real_surfaces:
        return lines
    asked = wanted(scene) or dict.fromkeys(scene.quantities, np.ones(len(scene.separations)))
    for name, most in asked.items():
        reach = spread_of(ensemble.scene, name).reach(m)
        for h, w, rel_err in zip(ensemble.separations[~silent], reach[~silent], most[~silent], strict=True):
            if rel_err < np.inf and not w <= rel_err * (1 + 1e-9):
                known = TOO_FEW if np.isnan(w) else f"is known to {w:.2g} of itself, not to {rel_err:g}"
                lines.append(f"{name} at d/sigma = {h:g}{': ' if np.isnan(w) else ' '}{known}")
    return lines


def upper_contacts(n: int) -> float:
    """Upper limit (95 %) of the mean number of contacts a surface, if `n` surfaces had none: 3.0/n.

    Exact for a Poisson number of contacts, ``exp(-n limit) = 0.05``; for a fixed number of asperities it
    is the safe side by a share 1.5/(n N).
    """
    return float(-np.log(1 - CONFIDENCE) / n)
