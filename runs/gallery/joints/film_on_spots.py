"""
How much does an oxide film reduce conductance?
===============================================

By about the same fraction at every pressure: more load makes more spots, but hardly larger ones.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
pressure = np.geomspace(1e4, 1e8, 25)
resistivity = 1 / 150 + 1 / 16  # m K/W: of aluminium on stainless steel
fig, ax = plt.subplots()
for k, film in enumerate((0, -7, -6, -5)):
    joint = mcgw.Joint(resistivity=resistivity, film_resistance=10.0**film if film else None)
    scene = mcgw.Scene(surface, separations=0.0, joint=joint)
    h = scene.theory.separation_at("pressure", pressure)
    conductance = scene.theory.mean("conductance_si", h) / surface.nominal_area
    label = f"film of $10^{{{film}}}$ m² K/W" if film else "clean"
    ax.loglog(pressure / 1e6, conductance, **step(label, k, 4))
ax.set(xlabel="pressure (MPa)", ylabel="conductance (W/(m² K))")
ax.legend()
