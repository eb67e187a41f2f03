"""
Is there hysteresis on unloading?
=================================

Yes, if summits yielded: they stay flattened, and the plane loses contact sooner.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
law = mcgw.KogutEtsion(hardness=1.2e9, poisson=0.33)
h = np.linspace(0.5, 3.0, 51)
scene = mcgw.Scene(
    surface, separations=h, law=law, contact=mcgw.Contact(unload_from="loop"), n_surfaces=100, seed=1
)
e = mcgw.simulate(scene)
elastic = mcgw.Scene(surface, separations=h).theory.mean("pressure", h) / 1e6
fig, ax = plt.subplots()
ax.plot(h, e.mean("load") / surface.nominal_area / 1e6, **line("loading"))
ax.plot(h, e.mean("load_unloading") / surface.nominal_area / 1e6, **line("unloading"))
ax.plot(h, elastic, linewidth=0.9, **line("Hertz") | {"label": "if nothing yielded (Hertz)"})
ax.set(xlabel="separation d/σ", ylabel="pressure (MPa)", ylim=(0, None))
ax.legend()
