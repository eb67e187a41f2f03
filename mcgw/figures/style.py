"""What all figures share: one colour for each meaning, their look, titles and labels.

Colour never stands alone: a dash and a marker go with each. Those that one figure shows together differ for
readers with two kinds of cones and in grey (`tests/figures/test_palette.py` measures both).

And how they become files, in the formats of matplotlib.
"""

import math
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from cycler import cycler
from matplotlib.figure import Figure

from analytic import Exponential, Grading, Hertz, Homogeneous, PiecewiseSeries
from analytic.arrays import Array
from mcgw.formats.files import whole_file
from mcgw.formats.law_text import law_text
from mcgw.formats.table import RAISED
from mcgw.machine.terminal import one_line
from mcgw.scene.scene import Scene

THEORY, MONTE_CARLO = "#00598F", "#E0701A"
SEEN: Any = {"color": MONTE_CARLO, "mfc": "none", "ms": 3}  # markers of means, on what theory says
SAMPLE = "#9CCBEB"  # bars and bands of what was drawn, with lines upon them
HOMOGENEOUS = "#000000"  # and every other reference: Hertz's law, boundary elements
LEVEL, BAND = "0.55", "0.93"  # a value worth a line; where residuals may lie
MARKED, MISSING = "#E0701A", "#F0C419"  # on pictures of maps: summits; points without a height
PAPER = "0.25"  # text that is read last

# Lightness goes up and down between blue and yellow: the two that are left to those who see no red or green.
CATEGORIES = ("#1A2560", "#7B2D26", "#8A4FD3", "#D9700A", "#5FB0E8", "#E8C81A")
_CYCLE = (THEORY, MONTE_CARLO, "#5C1F1A", "#8A4FD3", "#E8C81A", "#5FB0E8")
STEPS = ("#2A0A5E", "#7A1D6D", "#C0394F", "#ED6925", "#FBB61A")  # of any quantity that rises
SEPARATIONS = ("#2D0B59", "#3C4F9E", "#1F8A8C", "#5DBB63", "#C8D431")  # d/sigma = 0 to 4
# By gamma: blue where tips are stiffer, orange where they are softer, lighter the farther from homogeneous.
GRADINGS = {
    0.0: "#FFD98A", 0.2: "#EFAE3A", 0.5: "#CC5A10", 0.8: "#7A2E0C", 1.0: HOMOGENEOUS,
    1.2: "#12306E", 1.5: "#1F63B5", 2.0: "#58A6E0", math.inf: "#B4DBF5",
}  # fmt: skip
_DASHES: tuple[Any, ...] = (
    "-", (0, (6, 2)), (0, (3, 1, 1, 1)), (0, (1.2, 1.2)), (0, (8, 2, 1, 2)), (0, (2, 1)), (0, (4, 1.2))
)  # fmt: skip
_MARKERS = ("o", "s", "^", "D", "v", "<", ">")
_TOP = len(_DASHES)

FAMILIES: tuple[tuple[str, ...], ...] = (  # what one figure may show together, in the order of the colours
    ("load", "area", "stiffness", "contacts", "conductance", "yielded"),
    ("cells", "tail", "aggregate", "direct"),
    ("own radii", "one radius", "nayak", "measured summits"),
    ("$m_0$", "$m_2$", "$m_4$"),
)
PAIRS = (
    ("loading", "unloading"), ("interacting", "independent"), ("exact", "Gaussian"), ("theory", "Monte Carlo")
)  # fmt: skip


def _of(color: str, place: int) -> dict[str, Any]:
    return {"color": color, "linestyle": _DASHES[place % _TOP], "marker": _MARKERS[place % _TOP]}


MEANINGS = {
    **{name: _of(CATEGORIES[k], k) for names in FAMILIES for k, name in enumerate(names)},
    **{name: _of(_CYCLE[k], k) for names in PAIRS for k, name in enumerate(names)},
    "load_slope": _of(CATEGORIES[2], 5),
    "conductance_si": _of(CATEGORIES[4], 6),
    "this scene": _of(THEORY, 0),
    "homogeneous": _of(HOMOGENEOUS, 1) | {"marker": "v"},
    "homogeneous, Hertz": _of(LEVEL, 3),
    "Hertz": _of(HOMOGENEOUS, 0) | {"marker": "v"},
}

# One style for all figures. Texts stay texts, so that they can be searched, copied and edited: in SVG set in
# the reader's own sans-serif, in PDF in a TrueType font that goes with the file (journals refuse Type 3).
STYLE: Any = {
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": cycler(color=list(_CYCLE)),
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.color": "0.9",
    "legend.frameon": False,
    "lines.linewidth": 1.4,
    "savefig.dpi": 160,
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
}

_LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹", "0123456789")


def prefixed(largest: float) -> tuple[float, str]:
    """Return a power of a thousand that leaves 1 to 1000 of a number, and its prefix: 2.5e6 -> (1e6, "M")."""
    power = min(max(math.floor(math.log10(largest) / 3), -5), 5) if largest > 0 else 0
    return 1000.0**power, "fpnµm kMGTP"[power + 5].strip()


def look(label: str, place: int = 0) -> dict[str, Any]:
    """Colour, dash and marker of what a label names, as options of ``plot``.

    Labels are names of `MEANINGS`, of a quantity on unloading, "γ = 0.5", "d/σ = 2" and "N = 10³"; others are
    told apart by which line of its panel each is.
    """
    if label in MEANINGS:
        return MEANINGS[label]
    if label.removesuffix("_unloading") in MEANINGS:
        return MEANINGS[label.removesuffix("_unloading")] | {"linestyle": "--"}
    if decade := re.match(r"N = 10([⁰¹²³⁴⁵⁶⁷⁸⁹]+)$", label):
        power = int(decade[1].translate(_LOWERED)) - 2
        return _of(_between(power / 4, STEPS), power)
    found = re.match(r"(γ|d/σ) = ([0-9.]+)$", label)
    if found is None:
        return _of(_CYCLE[place % len(_CYCLE)], place)
    number = float(found[2])
    return _of_gamma(number) if found[1] == "γ" else _of(_between(number / 4, SEPARATIONS), round(number))


def line(label: str, place: int = 0) -> dict[str, Any]:
    """Label, colour and dash of a line: ``ax.plot(x, y, **line("γ = 0.5"))``."""
    return {"label": label} | {key: x for key, x in look(label, place).items() if key != "marker"}


def step(label: str, k: int, n: int) -> dict[str, Any]:
    """Label, colour and dash of line k of n, along a quantity that rises from line to line."""
    return {"label": label, "color": _between(k / max(n - 1, 1), STEPS), "linestyle": _DASHES[k % _TOP]}


def _of_gamma(gamma: float) -> dict[str, Any]:
    """On the map of gradings; dash and marker of the nearest one there."""
    if gamma == 1:
        return MEANINGS["Hertz"]
    side = [g for g in GRADINGS if g != 1 and (g > 1) == (gamma > 1)]
    away = np.array([1 - min(g, 1 / g) if g else 1.0 for g in side])  # as far from 1 as its inverse is
    x = 1 - min(gamma, 1 / gamma) if gamma > 0 else 1.0
    order, nearest = np.argsort(away), int(np.argmin(np.abs(away - x)))
    color = _between(x, [GRADINGS[side[k]] for k in order], away[order])
    return _of(color, (3, 2, 1, 1)[nearest] if gamma > 1 else (5, 5, 4, 6)[nearest])


def _between(x: float, colors: Sequence[str], at: Array | None = None) -> str:
    """Colour at x along a map, whose own colours are evenly spaced from 0 to 1 or stand at these places."""
    at = np.linspace(0, 1, len(colors)) if at is None else at
    rgb = np.array([list(bytes.fromhex(color[1:])) for color in colors])
    return f"#{bytes(round(float(np.interp(x, at, channel))) for channel in rgb.T).hex().upper()}"


def power_of_ten(x: float) -> str:
    """Label of a tick of a logarithmic axis as plain text: to read formulas takes a quarter of a second."""
    power = round(math.log10(x))
    return f"10{str(power).translate(RAISED)}" if math.isclose(x, 10.0**power) else f"{x:g}"


def shown_title(scene: Scene, otherwise: str) -> str:
    """Title of a scene as one line of plain text: no escape sequences, no mathematics between dollars."""
    return one_line(scene.title).replace("$", r"\$") or otherwise


def grading_label(grading: Grading) -> str:
    """Return a few words for a caption."""
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
    law = "" if type(scene.law) is Hertz else f", {short(law_text(scene.law))}"
    return f"{grading_label(scene.grading)}{law}"


def short(law: str) -> str:
    """Write a law as one line with few digits: ``KogutEtsion(hardness=1.2e+09, poisson=0.33)``."""
    few = re.sub(r"[0-9]+\.[0-9]+(e[-+]?[0-9]+)?", lambda number: f"{float(number[0]):g}", one_line(law))
    return few.removesuffix("()").replace("$", "")


# Files have no date, so that the same figure gives the same bytes.
_UNDATED: dict[str, dict[str, Any]] = {"pdf": {"CreationDate": None}, "svg": {"Date": None}}


def save_figure(figure: Figure, path: str | Path, **options: Any) -> None:
    """Write a figure whole or not at all, in the format of the ending; options are those of ``savefig``."""
    ending = Path(path).suffix[1:].lower()
    with whole_file(Path(path)) as unfinished, mpl.rc_context({"svg.hashsalt": "mcgw"}):
        figure.savefig(unfinished, format=ending, metadata=_UNDATED.get(ending), **options)
