"""
How far can I push before it slips?
===================================

Small spots slip first; the tangential load reaches μP within tenths of a micrometre (bands: 95 %).
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
push = np.linspace(0, 1.2e-6, 61)
friction = 0.3
sideways = mcgw.Tangential(friction, 0.3, push)
scene = mcgw.Scene(surface, separations=[0.0, 1.0], tangential=sideways, n_surfaces=500, seed=1)
e = mcgw.simulate(scene)
tangential = e.values("tangential_load")
fig, ax = plt.subplots()
for k, h in enumerate(e.separations):
    share = tangential[:, k] / (friction * e["load"][:, k, None])
    look = line(f"d/σ = {h:g}")
    said = {"label": f"d/σ = {h:g}: P = {e.mean('load')[k]:.0f} N"}
    ax.plot(push * 1e6, share.mean(axis=0), **look | said)
    low, high = np.quantile(share, [0.025, 0.975], axis=0)
    ax.fill_between(push * 1e6, low, high, alpha=0.25, color=look["color"], linewidth=0)
ax.set(xlabel="tangential displacement (µm)", ylabel="tangential load / μP", ylim=(0, 1.05))
ax.legend()
