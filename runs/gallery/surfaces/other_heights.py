"""
What if the heights are not Gaussian?
=====================================

With the same σ, loads at a given separation differ by orders of magnitude, since only the upper tail touches.
"""

import matplotlib.pyplot as plt
import numpy as np
import scipy.stats

import mcgw
from mcgw.figures.style import line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
h = np.linspace(0, 3, 31)
laws = {
    "worn: Weibull, shape 10": mcgw.Weibull(10.0),
    "Gaussian": mcgw.Gaussian(),
    "gamma, shape 4": scipy.stats.gamma(4),
    "exponential": mcgw.ExponentialHeights(),
}
fig, ax = plt.subplots()
for k, (name, law) in enumerate(laws.items()):
    pressure = mcgw.Scene(surface, separations=h, heights=law).theory.mean("pressure", h) / 1e6
    ax.semilogy(h, np.where(pressure > 0, pressure, np.nan), **line(name, k))
ax.set(xlabel="separation d/σ", ylabel="pressure (MPa)", ylim=(1e-3, None))
ax.legend()
