"""
Is the load of specimens Gaussian?
==================================

With many contacts, yes. With few, most specimens carry less than the mean, and a few carry much more.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import SAMPLE, line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
h = [1.0, 3.5]
scene = mcgw.Scene(
    surface, separations=h, contact=mcgw.Contact(quantities=["load", "contacts"]), n_surfaces=20000, seed=1
)
e = mcgw.simulate(scene)
x = np.linspace(-3, 5, 200)
fig, axes = plt.subplots(1, 2, sharex=True, sharey=True, figsize=(8, 3.6))
for k, ax in enumerate(axes):
    t = (e["load"][:, k] - e.mean("load")[k]) / e.std("load")[k]
    ax.hist(t, np.linspace(-3, 5, 81), density=True, color=SAMPLE, label="simulated surfaces")
    ax.plot(x, np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi), **line("Gaussian"))
    skewness = float(scene.theory.cumulants("load", h[k]).skewness)
    ax.set_title(f"d = {h[k]:g} σ: {e.mean('contacts')[k]:.0f} contacts, skewness {skewness:.2f}")
    ax.set_xlabel("(load − mean) / standard deviation")
axes[0].set_ylabel("probability density")
axes[0].legend()
