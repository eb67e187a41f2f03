"""
At which separation does a joint carry 1 MPa?
=============================================

Softer bodies come closer. Dots mark a pressure of 1 MPa.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

h = np.linspace(0, 4, 81)
fig, ax = plt.subplots()
for k, (name, modulus) in enumerate((("steel", "115 GPa"), ("glass", "37 GPa"), ("polymer", "2 GPa"))):
    surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", modulus)
    theory = mcgw.Scene(surface, separations=h).theory
    at = float(theory.separation_at("pressure", 1e6))
    look = step(f"{name}, {modulus}: d = {at:.2f} σ at 1 MPa", k, 3)
    ax.semilogy(h, theory.mean("pressure", h) / 1e6, **look)
    ax.plot(at, 1, "o", color=look["color"])
ax.axhline(1, color="0.5", linewidth=0.8, linestyle=":")
ax.set(xlabel="separation d/σ", ylabel="pressure (MPa)", ylim=(1e-3, 1e3))
ax.legend()
