"""A fitted map as one picture: before and after, the summits, their laws, and moments against cutoff."""

import textwrap
from contextlib import suppress
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure

from analytic import Gaussian, Nayak
from analytic.arrays import Marks
from mcgw.figures.style import (
    HOMOGENEOUS,
    MARKED,
    MISSING,
    SAMPLE,
    STYLE,
    THEORY,
    look,
    prefixed,
    save_figure,
)
from mcgw.maps.estimates import moments_of
from mcgw.maps.fit import Fit
from mcgw.maps.form import smooth
from mcgw.maps.preparation import Prepared
from mcgw.maps.summit_sums import summit_sums_of
from mcgw.maps.topography import Topography
from mcgw.maps.waves import Uncertain

_SIZE, _DPI = (11.0, 6.8), 160
_POINTS = 700  # points of a map along each side: more do not show
_MOST_MARKS = 3000
_CUTOFFS = 8
_WIDTH, _LINES = 42, 27  # of the text, in characters and lines
_TIMES = 12.0  # from the shortest cutoff to the longest


def save_fit_picture(fit: Fit, raw: Topography, ready: Prepared, path: Path) -> None:
    """Draw the picture of a fit.

    Parameters
    ----------
    fit : Fit
        Fit of the map.
    raw : Topography
        The map as it was read.
    ready : Prepared
        The prepared map.
    path : Path
        Ending in .png, .svg or .pdf.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with mpl.rc_context(STYLE | {"axes.axisbelow": True}):
        figure = Figure(figsize=_SIZE, layout="constrained")
        axes = figure.subplots(2, 3, width_ratios=(1, 1, 1.05))
        _draw_map(figure, axes[0, 0], raw, None)
        missing = f", {raw.missing} points missing" if raw.missing else ""
        axes[0, 0].set_title(f"a  as read{missing}", loc="left")
        _draw_map(figure, axes[0, 1], ready.used, ready.seen)
        _draw_summits(axes[0, 1], fit, ready)
        _draw_moments(axes[0, 2], ready)
        _draw_heights(axes[1, 0], fit)
        _draw_curvatures(axes[1, 1], fit)
        _write(axes[1, 2], fit)
        save_figure(figure, path, dpi=_DPI)


def _draw_map(figure: Figure, axis: Any, topography: Topography, seen: Marks | None) -> None:
    """Heights in grey; points that do not count are orange."""
    every = tuple(slice(None, None, max(n // _POINTS, 1)) for n in topography.heights.shape)
    z = topography.heights[every]
    z = np.where(np.isfinite(z) if seen is None else seen[every], z, np.nan)
    unit, factor = _unit(float(np.nanstd(z)))
    lateral, times = _unit(max(topography.size))
    low, high = np.nanpercentile(z, (0.5, 99.5)) * factor
    grey = mpl.colormaps["gray"].with_extremes(bad=MISSING)
    extent = (0, times * topography.size[0], 0, times * topography.size[1])
    image = axis.imshow(
        factor * z, cmap=grey, origin="lower", extent=extent, vmin=low, vmax=high, interpolation="nearest"
    )
    axis.grid(visible=False)
    axis.set(xlabel=f"x ({lateral})", ylabel=f"y ({lateral})")
    figure.colorbar(image, ax=axis, label=f"height ({unit})", shrink=0.8)


def _unit(length: float) -> tuple[str, float]:
    """A unit in which a length is 1 to 1000, and its number per metre."""
    size, prefix = prefixed(length)
    return f"{prefix}m", 1 / size


def _draw_summits(axis: Any, fit: Fit, ready: Prepared) -> None:
    """Where the summits are, some of them if there are many."""
    used, times = ready.used, _unit(max(ready.used.size))[1]
    some = slice(None, None, max(fit.summits.size // _MOST_MARKS, 1))
    # the filter took a margin off the map on which they are placed
    margins = ((whole - part) / 2 for whole, part in zip(ready.levelled.size, used.size, strict=True))
    listed = (fit.listed.x, fit.listed.y)
    x, y = (times * (place[some] - margin) for place, margin in zip(listed, margins, strict=True))
    marks = max(0.4, min(3.0, 90 / np.sqrt(x.size)))
    axis.plot(x, y, "o", ms=marks, color=MARKED, mew=0)
    shown = "" if x.size == fit.summits.size else f", {x.size} shown"
    axis.set_title(f"b  as analysed: {fit.summits.size} summits{shown}", loc="left")


def _draw_moments(axis: Any, ready: Prepared) -> None:
    """m0, m2, m4 over those at the cutoff that was chosen, against cutoff."""
    first = ready.asked.cutoff or 2 * max(ready.used.pixel)
    last = min(_TIMES * first, min(ready.levelled.size) / 4)
    cutoffs, rows = np.geomspace(first, max(last, 1.01 * first), _CUTOFFS), []
    for cutoff in cutoffs:
        try:
            m = moments_of(summit_sums_of(smooth(ready.levelled, float(cutoff)), across=1))
        except ValueError:  # the filter leaves nothing of the map
            break
        rows.append((m.m0, m.m2, m.m4))
    unit, times = _unit(float(cutoffs[len(rows) // 2]))
    for values, name in zip(np.array(rows).T, ("$m_0$", "$m_2$", "$m_4$"), strict=True):
        x, y = times * cutoffs[: len(rows)], values / values[0]
        axis.plot(x, y, **look(name), ms=4, mfc="white", label=name)
    axis.set(xscale="log", yscale="log", xlabel=f"cutoff ({unit})", ylabel="over those at the first cutoff")
    ticks = times * cutoffs[: len(rows) : 2]
    axis.set_xticks(ticks, [f"{t:.3g}" for t in ticks])
    axis.set_xticks([], minor=True)
    axis.set_title("c  moments against cutoff", loc="left")
    axis.legend()


def _draw_heights(axis: Any, fit: Fit) -> None:
    """Draw summit heights and the laws that they may follow."""
    sigma = float(fit.summits.std())
    z = np.linspace(-4.5, 4.5, 241)
    axis.hist(fit.summits / sigma, bins="auto", density=True, color=SAMPLE, label="summits")
    for (label, density), (color, dash) in zip(
        height_laws(fit), ((HOMOGENEOUS, "--"), (THEORY, "-")), strict=False
    ):
        axis.plot(z, density(z), dash, color=color, label=label)
    axis.set(xlabel="summit height, about its mean, over its std", ylabel="density")
    axis.set_title("d  summit heights", loc="left")
    axis.margins(y=0.5)
    axis.legend()


def height_laws(fit: Fit) -> list[tuple[str, Any]]:
    """Densities of summit heights, mean 0 and standard deviation 1, that are drawn."""
    laws: list[tuple[str, Any]] = [("Gaussian", Gaussian().pdf)]
    with suppress(ValueError):  # no isotropic surface has such an alpha
        laws.append((f"Nayak, α = {fit.alpha.value:.3g}", Nayak(fit.alpha.value).pdf))
    return laws


def _draw_curvatures(axis: Any, fit: Fit) -> None:
    """Draw summit curvatures over their mean, and Nayak's law (1971), which does not depend on alpha."""
    k = fit.curvatures / fit.curvatures.mean()
    k = k[(k > 0) & (k < 3)]
    axis.hist(k, bins="auto", density=True, color=SAMPLE, label="summits")
    axis.set_ylim(top=max(axis.get_ylim()[1], 1.5))
    x = np.linspace(0.01, 3, 200)
    mean = 8 / np.sqrt(3 * np.pi)
    t = mean * x
    density = np.sqrt(3) / (2 * np.sqrt(np.pi)) * (t**2 - 2 + 2 * np.exp(-(t**2) / 2)) * np.exp(-(t**2) / 4)
    axis.plot(x, mean * density, color=THEORY, label="Gaussian surface")
    axis.set(xlabel="mean curvature over its mean", ylabel="density", xlim=(0, 3))
    axis.set_title("e  summit curvatures", loc="left")
    axis.legend()


def _write(axis: Any, fit: Fit) -> None:
    """Write the results and the steps of preparation."""
    lines = [f"{'':9}{'eta (1/m²)':>12}{'R (m)':>11}{'sigma (m)':>11}"]
    for name, e in fit.estimates.items():
        mark = "*" if name == fit.best else " "
        lines.append(f"{name:8}{mark}{e.eta.value:12.3g}{e.radius.value:11.3g}{e.sigma.value:11.3g}")
        lines.append(f"{'   95 %':9}{_arms(e.eta):>12}{_arms(e.radius):>11}{_arms(e.sigma):>11}")
    lines += ["* best here", "", f"alpha = {fit.alpha.value:.3g} ({_arms(fit.alpha)})", ""]
    for text in (*fit.notes, *fit.cautions):
        lines += textwrap.wrap(text, _WIDTH, subsequent_indent="  ")
    shown = lines if len(lines) <= _LINES else [*lines[: _LINES - 1], "..."]
    axis.axis("off")
    axis.set_title("f  estimates", loc="left")
    axis.text(0, 1, "\n".join(shown), va="top", family="monospace", fontsize=6.6, transform=axis.transAxes)


def _arms(x: Uncertain) -> str:
    """Both ends of an interval over the value."""
    return f"{100 * (x.low / x.value - 1):+.0f} {100 * (x.high / x.value - 1):+.0f} %"
