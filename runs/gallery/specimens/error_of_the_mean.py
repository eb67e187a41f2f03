"""
How many surfaces do I need?
============================

The theory predicts the error of a mean (lines; dots are simulated): large separations need more surfaces.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
h = np.array([0.0, 2.0, 3.5])
numbers = np.array([10, 30, 100, 300])
scene = mcgw.Scene(surface, separations=h, contact=mcgw.Contact(quantities=["load"]))
truth, std = scene.theory.mean("load", h), scene.theory.std("load", h)
runs = [mcgw.simulate(scene, n_surfaces=300, seed=seed)["load"] for seed in range(30)]
fig, ax = plt.subplots()
for k in range(3):
    off = [np.sqrt(np.mean([(x[:m, k].mean() / truth[k] - 1) ** 2 for x in runs])) for m in numbers]
    look = line(f"d/σ = {h[k]:g}")
    ax.loglog(numbers, 100 * std[k] / truth[k] / np.sqrt(numbers), **look)
    ax.loglog(numbers, 100 * np.array(off), "o", color=look["color"], markersize=4)
ax.set(xlabel="number of surfaces", ylabel="error of the mean load (%)")
ax.legend(title="lines: theory, dots: simulated")
