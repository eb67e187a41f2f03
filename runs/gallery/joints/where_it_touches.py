"""
Where do the bodies touch?
==========================

On a few spots among many summits: here 0.1 mm² at 100 MPa. The lighter a spot, the more load.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw

surface = mcgw.Surface("1.37 um", "13 um", "3000/mm^2", "0.1 mm^2", "78.6 GPa")
scene = mcgw.Scene(surface, separations=-5.0, n_surfaces=1, seed=1)
s = mcgw.heights(scene, 0)
x, y = 316 * np.random.default_rng(1).random((2, len(s)))  # µm: summits stand anywhere
h = float(scene.theory.separation_at("pressure", 1e8))
delta = surface.sigma * np.maximum(s - h, 0)
load = 4 / 3 * surface.E_star * np.sqrt(surface.radius) * delta**1.5
radius = 1e6 * np.sqrt(surface.radius * delta)  # µm
shades = plt.colormaps["plasma"](load / load.max())
fig, ax = plt.subplots()
ax.plot(x, y, "o", ms=1, zorder=0, color="0.75")
for k in np.flatnonzero(delta):
    ax.add_patch(plt.Circle((x[k], y[k]), radius[k], color=shades[k], zorder=3))
title = f"{np.count_nonzero(delta)} spots of {len(s)} summits at d/σ = {h:.2f}"
ax.set(xlabel="x (µm)", ylabel="y (µm)", aspect="equal", title=title)
