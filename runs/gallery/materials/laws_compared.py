"""
How much do the laws of yielding differ?
========================================

At the same load Jackson and Green's real area is a fifth to two fifths larger than Kogut and Etsion's;
both are 6 to 11 times that of Hertz's law, which knows no yielding.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
hertz = mcgw.Scene(surface, separations=0.0).theory
laws = {
    "Kogut, Etsion": mcgw.KogutEtsion(hardness=1.2e9, poisson=0.33),
    "Jackson, Green": mcgw.JacksonGreen(yield_strength=0.43e9, poisson=0.33),
}
pressure = np.geomspace(1e4, 1e7, 31)
elastic = hertz.mean("area", hertz.separation_at("pressure", pressure))
fig, ax = plt.subplots()
for k, (label, law) in enumerate(laws.items()):
    model = mcgw.Scene(surface, separations=0.0, law=law).theory
    h = np.array([model.separation_at("pressure", p) for p in pressure])
    ax.plot(pressure / 1e6, model.mean("area", h) / elastic, **step(label, k, len(laws)))
ax.set(xscale="log", xlabel="pressure (MPa)", ylabel="real area over Hertz's at this load", ylim=(0, None))
ax.legend()
