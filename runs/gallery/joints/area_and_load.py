"""
Is the real area proportional to the load?
==========================================

Nearly, and so is friction: over five decades of pressure A/P falls by a factor of 1.5 to 2.5 (γ = 2, 0.5).
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
pressure = np.geomspace(1e3, 1e8, 41)
fig, ax = plt.subplots()
for gamma in (0.5, 1.0, 2.0):
    theory = mcgw.Scene(surface, separations=0.0, grading=mcgw.Exponential(gamma)).theory
    h = theory.separation_at("pressure", pressure)
    area = theory.mean("area_fraction", h)
    ax.semilogx(pressure / 1e6, area / pressure * 1e9, **line(f"γ = {gamma:g}"))
ax.set(xlabel="pressure (MPa)", ylabel="real area fraction / pressure (1/GPa)", ylim=(0, None))
ax.legend(title="E*(s)/E* = γ − (γ − 1) exp(−s)")
