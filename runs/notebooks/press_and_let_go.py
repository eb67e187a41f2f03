# ---
# jupyter:
#   jupytext:
#     formats: ipynb,py:percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Loading and unloading
#
# Bead-blasted aluminium yields under any load. How does this change the contact, how many asperities yield,
# and how much work is lost?

# %%
import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import MONTE_CARLO, STYLE, line

plt.rcParams.update(STYLE)

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
metal = mcgw.KogutEtsion(hardness=1.2e9, poisson=0.33)
h = np.linspace(0.5, 4.0, 71)
asked = ["load", "area", "contacts", "yielded"]
contact = mcgw.Contact(metal, quantities=asked, unload_from="loop")
scene = mcgw.Scene(surface, separations=h, contact=contact, n_surfaces=200, seed=1)
e = mcgw.simulate(scene)
e

# %% [markdown]
# ## The loop

# %%
fig, ax = plt.subplots()
ax.plot(h, e.mean("load"), **line("loading"))
ax.plot(h, e.mean("load_unloading"), **line("unloading"))
ax.set(xlabel="separation d/σ", ylabel="load (N)")
ax.legend()

# %% [markdown]
# The area between the lines is the work lost. It differs between surfaces:

# %%
step = surface.sigma * (h[1] - h[0])
lost = np.sum(e.values("load") - e.values("load_unloading"), axis=1) * step
spent = np.sum(e.values("load"), axis=1) * step
share = lost / spent
print(
    f"work spent: {spent.mean():.2e} J; {share.mean():.1%} of it stays, specimens differ by {share.std():.2%}"
)

# %% [markdown]
# ## How many yield
#
# Nearly all contacts, at every separation. Theory gives the number without drawing surfaces, from the pieces
# of the law.

# %%
yielded = e.mean("yielded") / e.mean("contacts")
by_theory = 1 - scene.theory.share(0, h)
fig, ax = plt.subplots()
ax.plot(h, by_theory, **line("theory"))
ax.plot(h[::5], yielded[::5], "o", markersize=4, color=MONTE_CARLO, label="simulated")
ax.set(xlabel="separation d/σ", ylabel="share of the contacts that yielded", ylim=(0.98, 1.0))
ax.legend()

# %% [markdown]
# ## What if it were harder?
#
# The same summits with other hardnesses, so differences have no sampling noise:

# %%
metal = mcgw.KogutEtsion(hardness=1e9, poisson=0.33)
contact = mcgw.Contact(metal, quantities=["load"])
base = mcgw.Scene(surface, separations=[1.0, 2.0, 3.0], contact=contact, n_surfaces=100, seed=1)
hardness = [1e9, 4e9, 16e9, 64e9]
sweep = mcgw.sweep(base, {"contact.law.hardness": hardness})
for k in range(1, len(hardness)):
    ratio = sweep.ratio("load", k, 0).ratio
    print(f"{hardness[k] / 1e9:3.0f} GPa: load over that at 1 GPa", *(f"{x:.2f}" for x in ratio))

# %% [markdown]
# Test means and covariances, loading and unloading, against theory:

# %%
mcgw.compare(e)
