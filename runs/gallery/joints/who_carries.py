"""
Which summits carry the load?
=============================

Those about one standard deviation above the plane; stiffer tips shift it to the higher ones.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

h, s = 1.0, np.linspace(1, 5, 161)
surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
fig, ax = plt.subplots()
for k, gamma in enumerate((0.2, 1.0, 2.0)):
    grading = mcgw.Exponential(gamma)
    density = (s - h) ** 1.5 * grading(s) * np.exp(-s * s / 2)
    look = step(f"γ = {gamma:g}", k, 3)
    ax.plot(s, density / np.trapezoid(density, s), **look)
    scene = mcgw.Scene(surface, separations=h, grading=grading, n_surfaces=20, seed=1)
    touching = np.concatenate([mcgw.heights(scene, i) for i in range(20)])
    loads = (touching - h) ** 1.5 * grading(touching)
    share, edges = np.histogram(touching, np.arange(1, 4.01, 0.25), weights=loads / loads.sum() / 0.25)
    ax.plot((edges[1:] + edges[:-1]) / 2, share, "o", markersize=4, color=look["color"])
ax.set(
    xlabel="summit height s = z/σ",
    ylabel="fraction of the load per σ, at d/σ = 1",
    ylim=(0, None),
    xlim=(1, 4),
)
ax.set_xlim(1, 4)
ax.legend()
