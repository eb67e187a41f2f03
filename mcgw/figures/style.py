"""What all figures share: their look, titles and labels."""

import math
from typing import Any

from cycler import cycler

from analytic import Exponential, Grading, Hertz, Homogeneous, PiecewiseSeries
from mcgw.machine.terminal import one_line
from mcgw.scene.law_text import law_text
from mcgw.scene.scene import Scene

__all__ = ["STYLE", "contact_label", "grading_label", "power_of_ten", "shown_title"]

# One style for all figures: colours of Okabe and Ito, told apart by colour-blind readers and in grey.
STYLE: Any = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titley": 1.0,  # told, for it is looked for by measuring all ticks, at each drawing
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9"]),
    "axes.grid": True,
    "grid.color": "0.9",
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "savefig.dpi": 160,
    "svg.fonttype": "none",
}


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def power_of_ten(x: float, _: Any = None) -> str:
    """Label of a tick of a logarithmic axis as plain text: to read formulas takes a quarter of a second."""
    power = round(math.log10(x))
    return f"10{str(power).translate(_RAISED)}" if math.isclose(x, 10.0**power) else f"{x:g}"


def shown_title(scene: Scene, otherwise: str) -> str:
    """Title of a scene as one line of plain text: no escape sequences, no mathematics between dollars."""
    return one_line(scene.title).replace("$", r"\$") or otherwise


def grading_label(grading: Grading) -> str:
    """A few words for a caption."""
    match grading:
        case Homogeneous():
            return "homogeneous"
        case Exponential():
            return f"exponential grading, γ = {grading.gamma:g}"
        case PiecewiseSeries(name=name) if name:
            return f"grading {one_line(name).replace('$', '')}"
    return f"{type(grading).__name__.lower()} grading"


def contact_label(scene: Scene) -> str:
    """Grading and contact law for a caption; Hertz's law is not named."""
    law = "" if type(scene.law) is Hertz else f", {one_line(law_text(scene.law))}"
    return f"{grading_label(scene.grading)}{law}"
