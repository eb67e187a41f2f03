"""
Do different summit radii matter?
=================================

Yes: high summits of a Gaussian surface are sharper than the one radius of the classical model.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

h = np.linspace(0, 3.5, 29)
fig, ax = plt.subplots()
for k, alpha in enumerate((2, 5, 20)):
    surface = mcgw.SpectralSurface(1e-12, 1e-3, alpha * 1e6, "1 mm^2", "100 GPa")
    own = mcgw.Scene(surface, separations=h)
    mean = mcgw.Scene(surface, separations=h, summits="mean")
    ratio = mean.theory.mean("load", h) / own.theory.mean("load", h)
    ax.plot(h, ratio, **step(f"α = {alpha}", k, 3))
ax.axhline(1, color="0.5", linewidth=0.8, linestyle=":")
ax.set(xlabel="separation from the mean summit, d/σ", ylabel="load with one radius / with own radii")
ax.legend()
