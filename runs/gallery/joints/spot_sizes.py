"""
How large are the spots?
========================

A hundred times the pressure makes fifty times as many spots, but not much larger ones.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "10 cm^2", "78.6 GPa")
scene = mcgw.Scene(surface, separations=0.0, n_surfaces=1, seed=1)
s = mcgw.heights(scene, 0)
edges = np.linspace(0, 8, 41)
fig, ax = plt.subplots()
for k, pressure in enumerate((1e7, 1e6, 1e5)):
    h = float(scene.theory.separation_at("pressure", pressure))
    radius = 1e6 * np.sqrt(surface.radius * surface.sigma * (s[s > h] - h))
    label = f"{pressure / 1e6:g} MPa: {len(radius)} spots, mean {radius.mean():.1f} µm"
    ax.hist(radius, edges, histtype="step", linewidth=1.4, **step(label, k, 3))
ax.set(xlabel="radius of a spot (µm)", ylabel="number of spots on 10 cm²", yscale="log", ylim=(1, 2e4))
ax.legend()
