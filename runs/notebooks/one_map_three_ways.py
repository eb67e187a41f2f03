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
# # One map, three ways to use it
#
# A height map can go into the model as five numbers, as a spectrum, or as the list of its summits. How
# much do the three differ, and which should I trust?

# %%
import tempfile

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import STYLE, line

plt.rcParams.update(STYLE)

# A map of 384 points of 1 um: waves from 10 to 80 um, Gaussian heights of 0.4 um.
n, pixel = 384, 1.0
q = np.hypot(np.fft.fftfreq(n, pixel)[:, None], np.fft.rfftfreq(n, pixel)[None, :])
amplitude = np.where((q > 1 / 80) & (q < 1 / 10), np.maximum(q, 1e-9) ** -1.8, 0.0)
z = np.fft.irfft2(amplitude * np.fft.rfft2(np.random.default_rng(2).normal(size=(n, n))))
z *= 0.4e-6 / z.std()

# %% [markdown]
# ## What `fit` finds
#
# The cutoff is the shortest wave of the roughness. Spectral moments and counted summits give two estimates.

# %%
with tempfile.TemporaryDirectory() as folder:
    np.save(f"{folder}/map.npy", z)
    fit = mcgw.fit(f"{folder}/map.npy", cutoff="10 um", pixel="1 um")
fit

# %% [markdown]
# ## The three scenes

# %%
h = np.linspace(0.5, 3.0, 26)
names = {"gaussian": "one radius", "nayak": "own radii", "summits": "measured summits"}
scenes = {name: mcgw.fitted_scene(fit, heights=name, E_star="100 GPa") for name in names}
curves = {}
for name, scene in scenes.items():
    felt = h * scenes["gaussian"].surface.sigma / scene.surface.sigma  # the same d in m
    draws = 1 if name == "summits" else 200
    curves[name] = mcgw.simulate(scene, separations=felt, n_surfaces=draws, seed=1)

# %% [markdown]
# The list is the one measured surface; the others are ensembles, whose spread is shaded.

# %%
fig, ax = plt.subplots()
d = scenes["gaussian"].surface.sigma * h * 1e6
for name, e in curves.items():
    pressure = e["pressure"] / 1e6
    look = line(names[name])
    ax.semilogy(d, np.maximum(pressure.mean(axis=0), 1e-6), **look)
    if len(pressure) > 1:
        low, high = np.quantile(pressure, [0.025, 0.975], axis=0)
        ax.fill_between(d, np.maximum(low, 1e-6), high, alpha=0.2, color=look["color"], linewidth=0)
ax.set(xlabel="separation from the mean summit (µm)", ylabel="pressure (MPa)", ylim=(1e-2, None))
ax.legend()

# %% [markdown]
# ## Which to trust
#
# Each scene states the error of its model against boundary elements, if it was measured.

# %%
for name, scene in scenes.items():
    print(f"{names[name]}: {scene.replace(separations=[1.0, 2.0]).validity().verdict}")
