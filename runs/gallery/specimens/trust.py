"""
How accurate is the model?
==========================

Errors against boundary elements: interaction corrects the stiffness at heavy loads, but not the real area.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

surface = mcgw.SpectralSurface(1e-12, 1e-3, 5e6, "1 mm^2", "100 GPa")
h = np.linspace(0, 4, 41)
fig, ax = plt.subplots()
for interaction, dash in ((None, "-"), ("mean-plane", "--")):
    scene = mcgw.Scene(surface, separations=h, interaction=interaction)
    found = scene.validity(h)
    pressure = scene.theory.mean("pressure", found.separations) / 1e6
    if interaction is None:
        said = "area, with or without interaction"
        ax.semilogx(pressure, 100 * found.bias["area"], **line("area") | {"label": said})
    said = f"stiffness, {'with' if interaction else 'without'} interaction"
    look = line("stiffness") | {"label": said, "linestyle": dash}
    ax.semilogx(pressure, 100 * found.bias["stiffness"], **look)
ax.axhline(0, color="0.5", linewidth=0.8, linestyle=":")
ax.set(xlabel="pressure (MPa)", ylabel="mean error at the load (%)")
ax.legend()
