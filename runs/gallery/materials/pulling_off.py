"""
Does a rough surface stick?
===========================

A soft, smooth one does: below zero the plane has to be pulled off. Roughness reduces adhesion.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

law = mcgw.JohnsonKendallRoberts(work=0.05)  # J/m^2
d = np.linspace(-0.2, 1.2, 71)  # um
fig, ax = plt.subplots()
for k, sigma in enumerate((0.1, 0.2, 0.5)):
    surface = mcgw.Surface(f"{sigma} um", "50 um", "1000/mm^2", "1 mm^2", "10 MPa")
    contact = mcgw.Contact(law, quantities=["load"], unload_from="loop")
    scene = mcgw.Scene(surface, separations=d / sigma, contact=contact, n_surfaces=50, seed=1)
    e = mcgw.simulate(scene)
    pressure = e.mean("load_unloading") / surface.nominal_area / 1e3
    ax.plot(d, pressure, **step(f"σ = {sigma:g} µm", k, 3))
ax.axhline(0, color="0.5", linewidth=0.8, linestyle=":")
ax.set(xlabel="separation d (µm)", ylabel="pressure on unloading (kPa)", ylim=(-12, 15))
ax.legend()
