"""
How many contacts yield?
========================

That depends on the hardness, and hardly on the pressure, because new elastic spots keep forming.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.stats import binomtest

import mcgw
from mcgw.figures.style import step

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
h, fine = np.linspace(0.5, 3.5, 7), np.linspace(0.5, 3.5, 61)
fig, ax = plt.subplots()
for k, hardness in enumerate(("2 GPa", "10 GPa", "40 GPa")):
    law = mcgw.KogutEtsion(hardness=float(hardness[:-4]) * 1e9, poisson=0.33)
    asked = ["load", "contacts", "yielded"]
    scene = mcgw.Scene(
        surface, separations=h, law=law, contact=mcgw.Contact(quantities=asked), n_surfaces=100, seed=1
    )
    e = mcgw.simulate(scene)
    yielded, contacts = (e.values(name).sum(axis=0) for name in ("yielded", "contacts"))
    share = yielded / contacts
    tests = [binomtest(int(some), int(of)) for some, of in zip(yielded, contacts, strict=True)]
    low, high = np.array([test.proportion_ci(0.95) for test in tests]).T  # exact: within 0 and 1
    look = step(f"hardness {hardness}", k, 3)
    theory = scene.theory
    ax.plot(theory.mean("pressure", fine) / 1e6, 1 - theory.share(0, fine), **look)
    bars = np.maximum([share - low, high - share], 0)
    ax.errorbar(e.mean("pressure") / 1e6, share, bars, fmt="o", markersize=4, color=look["color"])
ax.set(
    xscale="log", xlabel="pressure (MPa)", ylabel="fraction of the contacts that yielded", ylim=(-0.02, 1.05)
)
ax.legend(title="lines: theory; markers: simulated, 95 %", loc=(0.3, 0.15))
