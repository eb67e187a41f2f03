"""
Does asperity interaction matter?
=================================

It changes the load at a given separation, but not the real area at a given load.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "100 GPa")
felt = np.linspace(0.5, 3, 26)  # separations that the summits feel
alone = mcgw.Scene(surface, separations=felt).theory
fig, ax = plt.subplots()
labels = {"body": "from the body far away", "mean-plane": "from the mean plane"}
for k, (reference, label) in enumerate(labels.items()):
    scene = mcgw.Scene(surface, separations=felt, interaction=reference, n_surfaces=200, seed=1)
    e = mcgw.simulate(scene)
    h = e.mean("nominal_separation")
    ax.plot(h, scene.theory.mean("load", felt) / alone.mean("load", h), **line(label, k))
ax.axhline(1, color="0.5", linewidth=0.8, linestyle=":", label="independent summits")
ax.set(xlabel="nominal separation d/σ", ylabel="load over that of independent summits")
ax.legend(title="separations")
