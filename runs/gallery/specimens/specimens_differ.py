"""
How much do two specimens differ?
=================================

Each grey line is one specimen of 1 mm² with 300 summits; the band contains 95 % of them.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import SAMPLE, line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
scene = mcgw.Scene(surface, separations=np.linspace(0, 3, 31), n_surfaces=2000, seed=1)
e = mcgw.simulate(scene)
h, pressure = e.separations, e["pressure"] / 1e6

fig, ax = plt.subplots()
ax.semilogy(h, np.where(pressure[:40] > 0, pressure[:40], np.nan).T, color="0.45", linewidth=0.5)
low, high = np.quantile(pressure, [0.025, 0.975], axis=0)
ax.fill_between(h, np.maximum(low, 1e-3), high, color=SAMPLE, alpha=0.5, label="95 % of the specimens")
ax.semilogy(h, scene.theory.mean("pressure", h) / 1e6, **line("theory") | {"label": "theory: mean of all"})
ax.set(xlabel="separation d/σ", ylabel="pressure (MPa)", ylim=(1e-2, None))
ax.legend()
