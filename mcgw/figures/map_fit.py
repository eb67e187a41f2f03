"""A fitted map as one figure: before and after, the summits, their laws, and moments against cutoff."""

import textwrap
from contextlib import suppress
from functools import partial
from typing import Any

import matplotlib as mpl
import numpy as np

from analytic import Gaussian, Nayak
from analytic.arrays import Marks
from mcgw.figures.panels import FigureData, Panel, words
from mcgw.figures.style import HOMOGENEOUS, MARKED, MISSING, SAMPLE, THEORY, look, prefixed
from mcgw.maps.fit import Fit
from mcgw.maps.form import smooth
from mcgw.maps.preparation import Prepared
from mcgw.maps.summit_sums import summit_sums_of
from mcgw.maps.topography import Topography
from mcgw.maps.waves import Uncertain

_POINTS = 700  # points of a map along each side: more do not show
_MOST_MARKS = 3000
_WIDTH, _LINES = 42, 27  # of the text, in characters and lines
_BARS: Any = {"bins": "auto", "density": True, "color": SAMPLE, "label": "summits"}


def fit_figure(fit: Fit, raw: Topography, ready: Prepared) -> FigureData:
    """Show the fit of a map, as it was read and as it was prepared."""
    missing = f", {raw.missing} points missing" if raw.missing else ""
    panels = (
        Panel(f"a  as read{missing}", paint=partial(_draw_map, raw, None)),
        Panel(paint=partial(_draw_summits, fit, ready)),
        Panel("c  moments against cutoff", paint=partial(_draw_moments, ready)),
        Panel("d  summit heights", paint=partial(draw_heights, fit)),
        Panel("e  summit curvatures", paint=partial(_draw_curvatures, fit)),
        Panel("f  estimates", paint=partial(_draw_listing, fit)),
    )
    return FigureData("", "", panels)


def _draw_map(topography: Topography, seen: Marks | None, axis: Any) -> None:
    """Heights in grey; points that do not count have a colour."""
    every = tuple(slice(None, None, max(n // _POINTS, 1)) for n in topography.heights.shape)
    z = topography.heights[every]
    z = np.where(np.isfinite(z) if seen is None else seen[every], z, np.nan)
    unit, prefix = prefixed(float(np.nanstd(z)))
    lateral, of_sides = prefixed(max(topography.size))
    low, high = np.nanpercentile(z, (0.5, 99.5)) / unit
    image = axis.imshow(
        z / unit, vmin=low, vmax=high, origin="lower", interpolation="nearest",
        cmap=mpl.colormaps["gray"].with_extremes(bad=MISSING),
        extent=(0, topography.size[0] / lateral, 0, topography.size[1] / lateral),
    )  # fmt: skip
    axis.grid(visible=False)
    axis.figure.colorbar(image, ax=axis, label=f"height ({prefix}m)", shrink=0.8)
    axis.set(xlabel=f"x ({of_sides}m)", ylabel=f"y ({of_sides}m)")


def _draw_summits(fit: Fit, ready: Prepared, axis: Any) -> None:
    """Draw the map with its summits, some of them if there are many."""
    used, (unit, _) = ready.used, prefixed(max(ready.used.size))
    some = slice(None, None, max(fit.summits.size // _MOST_MARKS, 1))
    # the filter took a margin off the map on which they are placed
    margins = ((whole - part) / 2 for whole, part in zip(ready.levelled.size, used.size, strict=True))
    listed = (fit.listed.x, fit.listed.y)
    x, y = ((place[some] - margin) / unit for place, margin in zip(listed, margins, strict=True))
    shown = "" if x.size == fit.summits.size else f", {x.size} shown"
    _draw_map(used, ready.seen, axis)
    axis.set_title(f"b  as analysed: {fit.summits.size} summits{shown}")
    size = max(0.4, min(3.0, 90 / np.sqrt(x.size)))
    axis.plot(x, y, "o", ms=size, color=MARKED, mew=0)


def _draw_moments(ready: Prepared, axis: Any) -> None:
    """m0, m2, m4 over those at the cutoff that was chosen, against cutoff."""
    first = ready.asked.cutoff or 2 * max(ready.used.pixel)
    last = min(12.0 * first, min(ready.levelled.size) / 4)  # from the shortest cutoff to the longest
    cutoffs, rows = np.geomspace(first, max(last, 1.01 * first), 8), []
    with suppress(ValueError):  # the filter leaves nothing of the map
        for cutoff in cutoffs:
            m = summit_sums_of(smooth(ready.levelled, float(cutoff)), across=1).moments
            rows.append((m.m0, m.m2, m.m4))
    unit, prefix = prefixed(float(cutoffs[len(rows) // 2]))
    axis.set_yscale("log")
    for values, name in zip(np.array(rows).T, ("$m_0$", "$m_2$", "$m_4$"), strict=True):
        over = values / values[0]
        axis.plot(cutoffs[: len(rows)] / unit, over, **look(name), ms=4, mfc="white", label=name)
    label = "over those at the first cutoff"
    axis.set(xlabel=f"cutoff ({prefix}m)", ylabel=label)


def draw_heights(fit: Fit, axis: Any) -> None:
    """Summit heights and the laws that they may follow."""
    z, alpha = np.linspace(-4.5, 4.5, 241), fit.numbers["alpha"].value
    axis.hist(fit.summits / fit.summits.std(), **_BARS)
    axis.plot(z, Gaussian().pdf(z), color=HOMOGENEOUS, ls="--", label="Gaussian")
    with suppress(ValueError):  # no isotropic surface has such an alpha
        axis.plot(z, Nayak(alpha).pdf(z), color=THEORY, label=f"Nayak, α = {alpha:.3g}")
    label = "summit height, about its mean, over its std"
    title = f"{fit.summits.size} summits, sigma = {fit.summits.std():.4g} m"
    axis.set(title=title, xlabel=label, ylabel="density")


def _draw_curvatures(fit: Fit, axis: Any) -> None:
    """Summit curvatures over their mean, and Nayak's law (1971), which does not depend on alpha."""
    k = fit.curvatures / fit.curvatures.mean()
    x, mean = np.linspace(0.01, 3, 200), 8 / np.sqrt(3 * np.pi)
    t = mean * x
    density = np.sqrt(3) / (2 * np.sqrt(np.pi)) * (t**2 - 2 + 2 * np.exp(-(t**2) / 2)) * np.exp(-(t**2) / 4)
    axis.hist(k[(k > 0) & (k < 3)], **_BARS)
    axis.plot(x, mean * density, color=THEORY, label="Gaussian surface")
    axis.set(xlabel="mean curvature over its mean", ylabel="density", xlim=(0, 3))


def _draw_listing(fit: Fit, axis: Any) -> None:
    """Write the results and the steps of preparation."""
    lines = [f"{'':9}{'eta (1/m²)':>12}{'R (m)':>11}{'sigma (m)':>11}"]
    for name, e in fit.estimates.items():
        mark = "*" if name == fit.best else " "
        lines.append(f"{name:8}{mark}{e.eta.value:12.3g}{e.radius.value:11.3g}{e.sigma.value:11.3g}")
        lines.append(f"{'   95 %':9}{_arms(e.eta):>12}{_arms(e.radius):>11}{_arms(e.sigma):>11}")
    alpha = fit.numbers["alpha"]
    lines += ["* best here", "", f"alpha = {alpha.value:.3g} ({_arms(alpha)})", ""]
    for text in (*fit.notes, *fit.cautions):
        lines += textwrap.wrap(text, _WIDTH, subsequent_indent="  ")
    shown = lines if len(lines) <= _LINES else [*lines[: _LINES - 1], "..."]
    words("\n".join(shown), axis, (0, 1), va="top", ha="left", family="monospace", fontsize=6.6)


def _arms(x: Uncertain) -> str:
    """Both ends of an interval over the value."""
    return f"{100 * (x.low / x.value - 1):+.0f} {100 * (x.high / x.value - 1):+.0f} %"
