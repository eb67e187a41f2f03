"""
How finite is your surface?
===========================

The exact distribution of the load of a specimen (a) becomes Gaussian as more summits touch (b).
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import SAMPLE, line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "100 mm^2", "78.6 GPa")
scene = mcgw.Scene(
    surface, separations=3.0, contact=mcgw.Contact(quantities=["load"]), n_surfaces=40_000, seed=1
)
law = scene.theory.distribution("load", 3.0)
fig, (a, b) = plt.subplots(1, 2, figsize=(8, 3.8), layout="constrained")

x = np.linspace(*law.ppf([1e-9, 1 - 1e-9]), 300)
a.hist(mcgw.simulate(scene)["load"][:, 0], 60, density=True, color=SAMPLE, label="40 000 surfaces")
a.plot(x, law.pdf(x), **line("theory") | {"label": "exact law"})
a.axvspan(*law.interval(0.9), color="0.9", zorder=0, label="90 % of the specimens")
a.set(xlabel="load (N)", ylabel="density (1/N)", yscale="log", ylim=(1e-8 * law.pdf(law.mean()), None))

t = np.linspace(-5, 7, 241)
for number, style in ([3000, ("0.6", ":")], [30_000, ("0.4", "-.")], [1_000_000, ("0.0", "-")]):
    model = scene.replace(n_asperities=number).theory
    law, contacts = model.distribution("load", 3.0), float(model.mean("contacts", 3.0))
    with np.errstate(divide="ignore"):
        density = law.std() * law.pdf(law.mean() + t * law.std())
    density = np.where(density > 0, density, np.nan)
    b.plot(t, density, color=style[0], linestyle=style[1], label=f"{contacts:.0f} contacts")
b.plot(t, np.exp(-(t**2) / 2) / np.sqrt(2 * np.pi), **line("Gaussian"))
b.set(xlabel="(load − mean) / standard deviation", ylabel="density", yscale="log", ylim=(1e-8, 2))
for ax, name in zip((a, b), "ab", strict=True):
    ax.set_title(f"({name})", loc="left")
    ax.legend(fontsize="small")
