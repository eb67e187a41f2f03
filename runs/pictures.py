"""Pictures of README, LAWS.md and the site: ``python runs/pictures.py`` writes them to runs/pictures."""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

import mcgw
from mcgw.figures.catalogue import figures_of
from mcgw.figures.compared import Compared
from mcgw.figures.panels import draw
from mcgw.figures.style import CATEGORIES, MONTE_CARLO, STYLE, THEORY, save_figure
from mcgw.sampling.cells import mesh_of

HERE = Path(__file__).parent
FOLDER = HERE / "pictures"
CELLS, PHYSICS, ANSWERS = THEORY, CATEGORIES[2], MONTE_CARLO  # as dark, middle and light in grey


def from_the_catalogue():
    """Equal separation against equal load, from `mcgw figures`."""
    scene = mcgw.load_scene(HERE / "demo.toml").replace(n_surfaces=200)
    data = dict(figures_of(Compared(scene, swept=True), ["equal-load"]))["equal-load"]
    save_figure(draw(replace(data, panels=data.panels[:2])), FOLDER / "equal-load.png", dpi=110)


def how_it_works():
    """Heights into cells, cells into moments, moments times response."""
    scene = mcgw.load_scene(HERE / "demo.toml").replace(separations=(1.0, 2.0), n_asperities=300)
    edges = mesh_of(scene, split=False).edges
    with mpl.rc_context(STYLE | {"axes.grid": False}):
        figure = Figure(figsize=(9.2, 3.0), layout="constrained")
        left, middle, right = figure.subplots(1, 3, width_ratios=[1.25, 1.9, 1.1])
        _draw_cells(left, scene, edges)
        _draw_product(middle)
        _draw_answer(right, scene)
        save_figure(figure, FOLDER / "how-it-works.png", dpi=110)


def _draw_cells(axis, scene, edges):
    s = np.linspace(-2.5, 3.6, 200)
    axis.plot(s, np.exp(-s * s / 2) / np.sqrt(2 * np.pi), color="0.3")
    for k, (a, b) in enumerate(pairwise(edges)):
        x = np.linspace(a, b, 20)
        axis.fill_between(
            x, np.exp(-x * x / 2) / np.sqrt(2 * np.pi), color=CELLS, alpha=0.55 if k % 2 else 0.25, lw=0
        )
    heights = mcgw.heights(scene, 0, untouched=True)[::2]
    axis.plot(heights, np.full(heights.size, -0.03), "|", color=ANSWERS, ms=7)
    axis.axvline(1.0, color="0.2", lw=1)
    axis.text(1.1, 0.36, "plane at d/σ", fontsize=9)
    axis.set(xlabel="summit height s = z/σ", yticks=[], ylim=(-0.06, 0.45), xlim=(-2.5, 3.6))
    axis.spines["left"].set_visible(False)
    axis.set_title("1  sum what touches, cell by cell", loc="left", fontsize=9)


def _draw_product(axis):
    rng = np.random.default_rng(4)
    blocks = (
        (0.0, 3.2, 4, rng.random((9, 6)), CELLS, "moments", "surfaces × sums"),
        (4.6, 2.2, 3.2, np.tril(rng.random((6, 5)) + 0.3), PHYSICS, "response", "sums × separations"),
        (8.4, 2.2, 4, rng.random((9, 5)), ANSWERS, "loads, areas, …", "surfaces × separations"),
    )
    for x, width, height, values, color, name, shape in blocks:
        rows, columns = values.shape
        for i, j in np.ndindex(rows, columns):
            cell = (x + j * width / columns, 4 - (i + 1) * height / rows)
            axis.add_patch(
                Rectangle(
                    cell,
                    width / columns,
                    height / rows,
                    fc=color,
                    ec="w",
                    alpha=0.15 + 0.8 * min(values[i, j], 1),
                )
                if values[i, j]
                else Rectangle(cell, width / columns, height / rows, fc="0.96", ec="w")
            )
        axis.text(x + width / 2, 4.3, name, ha="center", fontweight="bold", color=color, fontsize=9)
        axis.text(x + width / 2, -0.5, shape, ha="center", fontsize=7.5)
    axis.text(3.9, 2, "×", ha="center", va="center", fontsize=18)
    axis.text(7.6, 2, "=", ha="center", va="center", fontsize=18)
    axis.set(xlim=(-0.3, 10.9), ylim=(-0.9, 4.8))
    axis.axis("off")
    axis.set_title("2  randomness × physics", loc="left", fontsize=9)


def _draw_answer(axis, scene):
    full = scene.replace(separations=tuple(np.linspace(0, 3, 31)), n_surfaces=12, n_asperities=300)
    ensemble = mcgw.simulate(full)
    axis.plot(
        ensemble.separations, ensemble.load.T / ensemble.mean("load")[0], color=ANSWERS, lw=0.7, alpha=0.7
    )
    axis.plot(ensemble.separations, ensemble.mean("load") / ensemble.mean("load")[0], color="k", lw=1.6)
    axis.set(xlabel="separation d/σ", ylabel="load", yticks=[], yscale="log", ylim=(1e-4, 2))
    axis.minorticks_off()
    axis.set_yticks([])
    axis.set_title("3  every surface, its own curve", loc="left", fontsize=9)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    from_the_catalogue()
    how_it_works()
    print(FOLDER)
