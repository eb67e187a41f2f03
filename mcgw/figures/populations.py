"""How contacts, and surfaces, of one population differ: moduli, who carries the load, scatter."""

from itertools import pairwise

import numpy as np

import analytic
from analytic import Exponential, Grading, mean_modulus
from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import ENOUGH, SCENE, Compared, of_gamma
from mcgw.figures.data import GAMMA, SEPARATION, Estimate, FigureData, Panel, Points, Series, ratio_of_sums
from mcgw.figures.ratios import over_gamma
from mcgw.figures.style import power_of_ten
from mcgw.scene.scene import Scene

_SPREADING = ("load", "area", "stiffness")
_PSI = r"$\psi/\psi_\mathrm{hom}$"
_POWERS = {"number": 0.0, "area": 1.0, "load": 1.5}
_LINE = np.linspace(0.2, 2, 73)
_GAMMAS = np.array([0.2, 0.4, 0.6, 0.8, 1.2, 1.4, 1.6, 1.8, 2.0])
_AT = np.arange(5.0)
_TITLES = {
    "number": "b  mean over the contacts",
    "area": "c  weighted by area",
    "load": "d  weighted by load",
}


def mean_moduli(f: Compared) -> FigureData:
    """Show the mean modulus of the contacts, which the plasticity index goes as."""
    title = "Plasticity index over that of the homogeneous surface"
    if f.swept:
        return FigureData(title, f.listed_caption, _over_gamma(f))
    plain = f.hertz and f.scene.curvature is None  # else area and load of a contact are not powers
    series = []
    for weight in _POWERS if plain else ("number",):
        line, at = (_exact(f, weight, f.scene.modulus, h) for h in (f.line, f.h))
        label = "contacts" if weight == "number" else weight
        series.append(Series(label, f.line, line, _points(f, weight, at)))
    panel = Panel("", SEPARATION, _PSI, tuple(series), level=1.0)
    said = (
        f"Mean over the contacts, each weighted alike (contacts){', by its area, or by its load' * plain}. "
    )
    return FigureData(title, said + f.listed_caption, (panel,))


def _over_gamma(f: Compared) -> tuple[Panel, ...]:
    just = tuple(Series(f"d/σ = {h:g}", _LINE, _LINE - (_LINE - 1) * np.exp(-h)) for h in _AT)
    panels = [Panel("a  as in the paper: just touching, s = d/σ", GAMMA, _PSI, just, level=1.0)]
    for weight, title in _TITLES.items():

        def exact(gamma: str | float, h: Array, weight: str = weight) -> Array:
            return _exact(f, weight, Exponential(float(gamma)), h)

        found = [_drawn(f, weight, Exponential(float(g)), _AT) for g in _GAMMAS]
        mean, stderr = np.array(found).transpose(1, 0, 2)
        series = over_gamma(_LINE, _GAMMAS, _AT, exact, (mean, stderr))
        panels.append(Panel(title, GAMMA, _PSI, series, level=1.0))
    return tuple(panels)


def _exact(f: Compared, weight: str, modulus: Grading, h: Array) -> Array:
    asked = {"weight": weight, "heights": f.scene.heights}
    return mean_modulus(h, modulus, **asked)  # type: ignore[arg-type]


def _points(f: Compared, weight: str, exact: Array) -> Points | None:
    """Points from the listed heights, where there are enough."""
    if len(f.listed) < 2:
        return None
    known = f.enough(f.scene.replace(n_surfaces=len(f.listed)))
    if not known.any():
        return None
    return Points(f.h[known], *_drawn(f, weight, f.scene.modulus, f.h[known]), exact[known])


def _drawn(f: Compared, weight: str, modulus: Grading, h: Array) -> Estimate:
    """Mean of E*(s)/E* over the contacts of the listed surfaces."""
    above, below = np.zeros((2, len(f.listed), len(h)))
    for i, s in enumerate(f.listed):
        for k, separation in enumerate(h):
            touching = s[s > separation]
            e = modulus(touching)
            weights = (touching - separation) ** _POWERS[weight] * (e if weight == "load" else 1.0)
            above[i, k], below[i, k] = np.sum(weights * e), np.sum(weights)
    return ratio_of_sums(above, below)


def carriers(f: Compared) -> FigureData:
    """Show modulus and share of the load, by height."""
    h, s = 1.0, np.linspace(0, 4, 161)
    edges = np.arange(1.0, 4.01, 0.25)
    centre = (edges[1:] + edges[:-1]) / 2
    moduli, shares = [], []
    for gamma in (2.0, 1.0, 0.2):
        e, label = Exponential(gamma), of_gamma(gamma)
        moduli.append(Series(label, s, e(s)))
        mean, stderr = _shares(f.listed, h, e, edges)
        exact = [float(analytic.fn_between(1.5, h, a, b, e)) for a, b in pairwise(edges)]
        points = Points(centre, mean / 0.25, stderr / 0.25, np.array(exact) / 0.25)
        above = np.maximum(s - h, 0.0)
        density = above**1.5 * e(s) * np.exp(-s * s / 2) / np.sqrt(2 * np.pi) / analytic.fn(1.5, h, e)
        shares.append(Series(label, s, density, points))
    return FigureData(
        "Which summits carry the load, at d/σ = 1",
        f"Shares in bins of 0.25 σ. {f.listed_caption}",
        (
            Panel("a  modulus", "summit height s = z/σ", "E*(s)/E*", tuple(moduli)),
            Panel("b  share of the load", "summit height s = z/σ", "share per σ", tuple(shares)),
        ),
        columns=1,
    )


def _shares(listed: tuple[Array, ...], h: float, e: Grading, edges: Array) -> Estimate:
    """Share of the load in each bin of height."""
    rows, totals = [], []
    for s in listed:
        s = s[s > h]
        loads = (s - h) ** 1.5 * e(s)
        rows.append(np.histogram(s, edges, weights=loads)[0])
        totals.append(loads.sum())
    return ratio_of_sums(np.array(rows), np.array(totals)[:, None])


def negative_modulus(_: Compared) -> FigureData:
    """Show the heights where the exponential grading is below zero."""
    end = 4.0
    above, below = np.linspace(1.02, end, 150), np.linspace(-2, -0.02, 100)
    low, high = -np.log(above / (above - 1)), np.log(1 + 1 / np.abs(below))
    series = (
        Series("negative below this height", above, low, band=(np.full_like(low, -end), low)),
        Series("negative above this height", below, high, band=(high, np.full_like(high, end))),
    )
    return FigureData(
        "Where the modulus turns negative (shaded)",
        "Exponential grading. A scene whose contacts reach the shaded heights needs "
        'negative = "clip" or "allow". γ from 0 to 1 is safe at every height; γ > 1 from d/σ = 0 up. Theory.',
        (Panel("", GAMMA, "summit height s = z/σ", series, ylim=(-end, end)),),
    )


def fluctuations(f: Compared) -> FigureData:
    """Show the standard deviation over the mean: of a sweep from a hundred asperities to a million."""
    if not f.swept:
        series = tuple(_spreads(name, f.scene, name, f.line, f.drawn(SCENE), ENOUGH) for name in _SPREADING)
        panel = Panel("", SEPARATION, "std / mean", series, ("linear", "log"), level=1.0)
        size = f"{f.scene.surface.nominal_area * 1e6:g} mm²"
        return FigureData(f"Scatter of surfaces of {size}", f.caption, (panel,))
    scene = f.scene.replace(keep="sums", separations=np.linspace(0, 4, 9), quantities=_SPREADING)
    sizes = {n: min(2000, 400_000_000 // n) for n in (100, 10_000, 1_000_000)}
    drawn = {n: simulate(scene.replace(n_asperities=n, n_surfaces=m)) for n, m in sizes.items()}
    line, panels = np.linspace(0, 4, 41), []
    for key, name in zip("abc", scene.quantities, strict=True):
        series = tuple(
            _spreads(f"N = {power_of_ten(n)}", scene.replace(n_asperities=n), name, line, drawn.get(n), 400)
            for n in (100, 1000, 10_000, 100_000, 1_000_000)
        )
        room = float(series[-1].theory.min()) / 2, 50 * float(series[0].theory.max())  # for the legend
        panels.append(Panel(f"{key}  {name}", SEPARATION, "std / mean", series, ("linear", "log"), 1.0, room))
    return FigureData(
        "Scatter of finite surfaces",
        f"N asperities per surface; 2000 surfaces (400 for N = 10⁶), seed {scene.seed}. Markers with 95 % "
        "intervals, for 400 contacts or more.",
        tuple(panels),
    )


def _spreads(
    label: str, scene: Scene, name: str, line: Array, drawn: Ensemble | None, fewest: float
) -> Series:
    """A line of theory; points where surfaces are drawn and have enough contacts together."""

    def exact(h: Array) -> Array:
        return np.asarray(scene.theory.std(name, h) / np.abs(scene.theory.mean(name, h)))

    if drawn is None:
        return Series(label, line, exact(line))
    h = drawn.separations
    known = scene.theory.mean("contacts", h) * drawn.n_surfaces >= fewest
    return Series(label, line, exact(line), spread(drawn.values(name)[:, known], h[known], exact(h)[known]))


def spread(x: Array, h: Array, exact: Array) -> Points | None:
    """Take std over mean of surfaces at each separation, and its standard error by its influence function."""
    if not h.size:
        return None
    mean, std = x.mean(axis=0), x.std(axis=0, ddof=1)
    z = (x - mean) / std
    influence = std / mean * ((z**2 - 1) / 2 - z * std / mean)
    return Points(h, std / np.abs(mean), influence.std(axis=0) / np.sqrt(len(x)), exact)


def distribution(f: Compared) -> FigureData:
    """Show the law of the load at light contact: exact, Gaussian, drawn."""
    panels = tuple(_load_panel(f, key, contacts) for key, contacts in (("a", 5.0), ("b", 50.0), ("c", 500.0)))
    return FigureData(
        "Load of one finite surface at light contact (d/σ = 2.5)",
        f"Homogeneous; 100 000 surfaces, seed {f.scene.seed}. Gaussian: of the same mean and "
        "std. Markers: share of the surfaces in bins of a quarter of the std, over their width.",
        panels,
    )


def _load_panel(f: Compared, key: str, contacts: float) -> Panel:
    h, m = 2.5, 100_000
    n = round(contacts / float(f.scene.heights.sf(np.array(h))))
    scene = f.scene.replace(keep="sums", separations=h, quantities=("load",), n_asperities=n, n_surfaces=m)
    law = scene.theory.distribution("load", h)
    mean, std = law.mean(), law.std()
    width, top = std / 4, mean + 5 * std
    edges = np.arange(max(width * round((mean - 4 * std) / width), width), top, width)
    share, p = np.histogram(simulate(scene).load[:, 0], edges)[0] / m, np.diff(law.cdf(edges))
    often = p * m >= 25  # a bin with fewer has no symmetric interval
    share, p, centre = share[often], p[often], ((edges[1:] + edges[:-1]) / 2)[often] / mean
    each = width / mean
    points = Points(centre, share / each, np.sqrt(p * (1 - p) / m) / each, p / each)
    fine = np.linspace(max(0.0, 2 * mean - top), top, 201)
    bell = np.exp(-(((fine - mean) / std) ** 2) / 2) / np.sqrt(2 * np.pi) * mean / std
    none = f"; no contact: {law.atom:.1%}" if contacts < 10 else ""
    return Panel(
        f"{key}  {contacts:g} contacts{none}",
        r"load over its mean, $P/\langle P\rangle$",
        "probability density",
        (Series("exact", centre, p / each, points), Series("Gaussian", fine / mean, bell)),
    )
