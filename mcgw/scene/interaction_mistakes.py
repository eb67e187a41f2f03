"""Mistakes in scenes with asperity interaction."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from mcgw.scene.fields import Fields


def interaction_mistakes(scene: Fields) -> Iterator[str]:
    """One line for each mistake."""
    yield from list(_independent(scene)) or _balance(scene)


def _independent(scene: Fields) -> Iterator[str]:
    """Mistakes that do not depend on where the balance is."""
    if "load" not in scene.quantities:
        yield 'interaction: separations depend on the load; add "load" to contact.quantities'


def _balance(scene: Fields) -> Iterator[str]:
    """Mistake: separations at which the plane sinks faster than it is pressed."""
    theory: Any = scene.theory
    h = np.unique(scene.separations)
    try:
        rate = 1 + theory.compliance * theory.alone.slope("load", h)
    except ValueError as error:
        yield str(error)
        return
    if np.any(rate <= 0):
        yield (
            f"interaction: at d/sigma = {h[rate <= 0].max():g} the mean plane sinks faster than it is "
            "pressed, so the nominal separation is not unique; give larger separations"
        )
