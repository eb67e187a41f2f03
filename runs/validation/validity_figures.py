"""Pictures of the README: the map of validity, and contact of one map by all models."""

import math
from collections.abc import Iterator
from pathlib import Path

import matplotlib as mpl
import numpy as np
from charted import VALID
from deviations import Condensed, number
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import TwoSlopeNorm
from matplotlib.figure import Figure
from models import INTERACTIONS, MODELS, Model, summits_of
from numpy.typing import NDArray
from solve_table import Row

from mcgw.figures.style import HOMOGENEOUS, STYLE, look, save_figure

Lines = list[Condensed]

NORM, COLOURS = TwoSlopeNorm(0, -60, 60), mpl.colormaps["RdBu"]
LABEL = {"none": "no interaction", "summits": "interaction (summits)", "contacts": "interaction (contacts)"}
DASHES = {"none": "--", "summits": ":", "contacts": "-"}


def chart(lines: Lines, quantity: str, panels: list[tuple[str, str]], path: Path) -> None:
    """Error over alpha and load as colour, one panel for a model; where it is within 10 %, outlined."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(3.6 * len(panels) + 0.6, 3.3), layout="constrained")
        axes = figure.subplots(1, len(panels), sharey=True)
        for ax, (model, interaction) in zip(axes, panels, strict=True):
            of_panel = [x for x in lines if (x.model, x.interaction) == (model, interaction)]
            _panel(ax, [x for x in of_panel if x.map == "gaussian"], quantity)
            title = model if quantity == "area" else f"{model}, {LABEL[interaction]}"
            ax.set(title=title, xlabel="p/(E* g)")
        axes[0].set(ylabel="Nayak's α")
        bar = figure.colorbar(ScalarMappable(NORM, COLOURS), ax=axes, extend="both")
        bar.set_label(f"{quantity}: model less BEM (%)")
        save_figure(figure, path)


def _panel(ax: Axes, lines: Lines, quantity: str) -> None:
    alphas, loads = (sorted({getattr(line, key) for line in lines}) for key in ("x", "p"))
    found = {(line.x, line.p): 100 * line.mean[quantity] for line in lines}
    error = np.array([[found.get((a, p), math.nan) for p in loads] for a in alphas])
    ax.pcolormesh(np.arange(len(loads) + 1), np.arange(len(alphas) + 1), error, norm=NORM, cmap=COLOURS)
    for (row, column), value in np.ndenumerate(error):
        if math.isfinite(value):
            shade = "white" if abs(value) > 38 else "black"
            ax.text(
                column + 0.5,
                row + 0.5,
                f"{value:+.0f}".replace("-", "−"),
                ha="center",
                va="center",
                color=shade,
            )
    for ends in edges(np.abs(error) <= 100 * VALID):
        ax.plot(*ends, color="black", lw=2, solid_capstyle="projecting", clip_on=False)
    middle = (np.arange(len(loads)) + 0.5, np.arange(len(alphas)) + 0.5)
    ax.set_xticks(middle[0], [f"{p:.0e}".replace("e-0", "e−") for p in loads], fontsize=8)
    ax.set_yticks(middle[1], [f"{a:g}" for a in alphas])
    ax.grid(visible=False)
    ax.spines[:].set_visible(False)
    ax.tick_params(length=0)


def edges(inside: NDArray[np.bool_]) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """Ends (x, y) of all edges between a cell inside and one that is not, or the rim."""
    padded = np.pad(inside, 1)
    for row, column in np.argwhere(padded[1:-1, 1:] != padded[1:-1, :-1]).tolist():
        yield (column, column), (row, row + 1)
    for row, column in np.argwhere(padded[1:, 1:-1] != padded[:-1, 1:-1]).tolist():
        yield (column, column + 1), (row, row)


def one_map(rows: list[Row], path: Path) -> None:
    """Area and mean gap of one map over the load, by all models and by boundary elements."""
    row, unit = rows[0], math.sqrt(number(rows[0], "m0"))
    p, area, gap = (np.array([number(one, key) for one in rows]) for key in ("p", "area", "gap"))
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=(7.4, 5.8), layout="constrained")
        (areas, gaps), (missed, legend) = figure.subplots(2, 2, sharex=True)
        areas.plot(p, area / p, "o", color=HOMOGENEOUS, ms=4.5, label="boundary elements")
        gaps.plot(p, gap / unit, "o", color=HOMOGENEOUS, ms=4.5)
        for name in MODELS:
            colour = look(name)["color"]
            summits = summits_of(name, *(number(row, key) for key in ("m0", "m2", "m4")))
            x = [summits.separation(one) for one in p.tolist()]
            areas.plot(p, np.array([summits.at(one).area for one in x]) / p, color=colour, label=name)
            for interaction in INTERACTIONS:
                h = np.array([Model(summits, interaction).gap(one) for one in x])
                gaps.plot(p, h / unit, DASHES[interaction], color=colour)
                label = LABEL[interaction] if name == MODELS[-1] else None
                missed.plot(p, (h - gap) / unit, DASHES[interaction], color=colour, label=label)
        areas.set(ylabel="(A/Aₙ) E* g/p", title="Real area at the load", ylim=(0, None))
        gaps.set(ylabel="mean gap over rms height", title="Mean gap at the load")
        missed.set(ylabel="over rms height", title="Gap: model less boundary elements")
        for ax in (areas, gaps, missed):
            ax.set(xscale="log", xlabel="p/(E* g)")
            ax.tick_params(labelbottom=True)
        handles = [x for ax in (areas, missed) for x in ax.get_legend_handles_labels()[0]]
        legend.axis("off")
        legend.legend(handles=handles, loc="center", fontsize=9)
        save_figure(figure, path)
