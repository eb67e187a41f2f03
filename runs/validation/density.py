"""Which density belongs into the interaction: all summits, or loaded spots? Tried on maps of this study."""

import numpy as np
from as_markdown import Sheet, percent, signed, table
from deviations import Condensed
from models import INTERACTIONS, MODELS

ALPHAS = (2.0, 5.0, 10.0)
HEAVY = 1e-3  # lighter loads are carried by few spots, which sink little


def errors(lines: list[Condensed], alpha: float, model: str, interaction: str, quantity: str) -> float:
    """Root mean square, over loads that are not light, of the mean deviations; nan if one is missing."""
    values = [
        line.mean[quantity]
        for line in lines
        if (line.x, line.model, line.interaction) == (alpha, model, interaction) and line.p >= HEAVY
    ]
    return float(np.sqrt(np.mean(np.square(values))))


def density_table(lines: list[Condensed]) -> Sheet:
    """Gap, load and stiffness with either density, and without."""
    rows = []
    for alpha in (alpha for alpha in ALPHAS if any(line.x == alpha for line in lines)):
        for model in MODELS:
            for interaction in INTERACTIONS:
                gap, load, stiffness = (
                    errors(lines, alpha, model, interaction, q) for q in ("separation", "load", "stiffness")
                )
                shown = (signed(gap)[1:], percent(load)[1:], percent(stiffness)[1:])
                rows.append([f"{alpha:g}", model, interaction, *shown])
    head = ["α", "model", "density", "gap / rms height", "load at the gap, %", "stiffness, %"]
    return table(head, rows)
