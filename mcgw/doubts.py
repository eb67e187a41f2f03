"""Where the model of independent Hertz contacts is strained: doubts about an ensemble, in words."""

import numpy as np

from mcgw.ensemble import Ensemble
from mcgw.plausible import unit_doubts

__all__ = ["doubts"]

_CROWDED = 0.05  # real over nominal area from which neighbouring asperities feel each other
_STEEP = 0.3  # contact radius over summit radius from which a paraboloid is no sphere and strain is large
_FEW = 30.0  # contacts a surface, below which single surfaces are far from Gaussian


def doubts(ensemble: Ensemble) -> list[str]:
    """What a reader should know before trusting the numbers.

    Parameters
    ----------
    ensemble : Ensemble
        To look at: its scene, not its luck.

    Returns
    -------
    list of str
        One sentence each; empty where the model has no known trouble.
    """
    scene, h = ensemble.scene, ensemble.separations
    surface, found = scene.surface, unit_doubts(scene)
    share = scene.n_asperities / surface.n_asperities
    crowded = h[scene.theory.mean("area", h) / surface.nominal_area > _CROWDED]
    if crowded.size:
        found.append(
            f"Up to d/σ = {crowded.max():.3g} more than {_CROWDED:.0%} of the nominal area touches: "
            "asperities are no longer independent, and the load at that separation is overestimated."
        )
    most = h[scene.heights.above(h) > 0.5]
    if most.size:
        found.append(
            f"Up to d/σ = {most.max():.3g} more than half of all summits touch; the model does not merge "
            "contacts."
        )
    top = float(scene.heights.from_above(np.array(1 / scene.n_asperities), -40.0))
    steepest = float(np.sqrt(max(top - h.min(), 0.0) * surface.sigma / surface.radius))
    if steepest > _STEEP:
        found.append(
            f"The highest summits (s = {top:.1f}) have contacts of {steepest:.2f} times their radius at "
            "the lowest separation, more than Hertz's parabolic contact bears; metals yield far earlier."
        )
    few = h[scene.theory.mean("contacts", h) < _FEW]
    if few.size:
        found.append(
            f"From d/σ = {few.min():.3g} fewer than {_FEW:.0f} contacts are expected on a surface: "
            "single surfaces are far from Gaussian, and intervals of few surfaces are lopsided; below ten "
            "in the whole ensemble there are none."
        )
    if abs(share - 1) > 0.01:
        found.append(
            f"A surface has {scene.n_asperities:g} asperities, not η Aₙ = {surface.n_asperities:g}: loads "
            f"belong to {share:.3g} of the nominal area."
        )
    if scene.negative != "error" and scene.negative_above(scene.lowest) is not None:
        word = "set to zero" if scene.negative == "clip" else "left negative"
        found.append(
            f"The modulus is negative at heights that touch, and {word}: a fit taken beyond its range."
        )
    found.append(
        "Every contact is elastic: with the hardness H and slope of the material at hand, check the "
        "plasticity index (analytic.plasticity_index) before using loads at small separations."
    )
    return found
