"""
How many contacts yield?
========================

That depends on the hardness, and hardly on the pressure, because new elastic spots keep forming.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
h = np.linspace(0.5, 3.5, 7)
fig, ax = plt.subplots()
for k, hardness in enumerate(("2 GPa", "10 GPa", "40 GPa")):
    law = mcgw.KogutEtsion(hardness=float(hardness[:-4]) * 1e9, poisson=0.33)
    asked = ["load", "contacts", "yielded"]
    scene = mcgw.Scene(surface, separations=h, law=law, quantities=asked, n_surfaces=100, seed=1)
    e = mcgw.simulate(scene)
    contacts = e.mean("contacts")
    share = e.mean("yielded") / contacts
    low, high = np.array(e.interval("yielded")) / contacts
    error = np.maximum([share - low, high - share], 0)
    look = step(f"hardness {hardness}", k, 3)
    ax.errorbar(e.mean("pressure") / 1e6, share, error, marker="o", markersize=4, **look)
ax.set(xscale="log", xlabel="pressure (MPa)", ylabel="share of the contacts that yielded", ylim=(-0.02, 1.05))
ax.legend()
