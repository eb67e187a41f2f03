"""Which density belongs into the interaction: all summits, or loaded spots? Tried on maps of this study."""

import numpy as np
from as_markdown import percent, signed, table
from deviations import Condensed
from models import INTERACTIONS, MODELS

ALPHAS = (2.0, 5.0, 10.0)
JUDGED = {"separation": "Gap error", "load": "load error", "stiffness": "stiffness error"}
HEAVY = 1e-3  # lighter loads are carried by few spots, which sink little


def errors(lines: list[Condensed], alpha: float, model: str, interaction: str, quantity: str) -> float:
    """Root mean square, over loads that are not light, of the mean deviations; nan if one is missing."""
    values = [
        line.mean[quantity]
        for line in lines
        if (line.x, line.model, line.interaction) == (alpha, model, interaction) and line.p >= HEAVY
    ]
    return float(np.sqrt(np.mean(np.square(values))))


def density_table(lines: list[Condensed]) -> str:
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


def verdict(lines: list[Condensed]) -> str:
    """Whether each density lowers the errors at every alpha, of every model: one line each."""
    said = []
    for density, words in (("summits", "all summits"), ("contacts", "loaded spots")):
        tells = "; ".join(f"{name}: {_raised(lines, density, q)}" for q, name in JUDGED.items())
        said.append(f"- Density of {words}. {tells}.")
    return "\n".join(said) + "\n"


def _raised(lines: list[Condensed], density: str, quantity: str) -> str:
    """Where an error is not lower than without interaction."""
    worse = [
        f"α = {alpha:g}, {model}"
        for alpha in ALPHAS
        for model in MODELS
        if not errors(lines, alpha, model, density, quantity) < errors(lines, alpha, model, "none", quantity)
    ]
    return f"not lower at {', '.join(worse)}" if worse else "lower for every model and α"
