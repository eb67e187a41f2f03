"""How finite surfaces differ from each other."""

import numpy as np

from analytic.arrays import Array
from mcgw.ensemble.ensemble import Ensemble
from mcgw.ensemble.simulation import simulate
from mcgw.figures.compared import ENOUGH, SCENE, Compared
from mcgw.figures.data import SEPARATION, FigureData, Panel, Points, Series
from mcgw.figures.style import power_of_ten
from mcgw.scene.scene import Scene

_SPREADING = ("load", "area", "stiffness")


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
