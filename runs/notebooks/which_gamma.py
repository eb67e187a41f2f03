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
# # Which grading does my surface have?
#
# You measured the normal stiffness of a joint at several pressures, for example by ultrasound, and want to
# know whether the tips are stiffer than the rest. Here the data are synthetic, with γ = 1.5 and 3 % noise,
# so the answer is known.

# %%
import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import HOMOGENEOUS, STYLE, THEORY, line

plt.rcParams.update(STYLE)

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
pressure = np.geomspace(0.1e6, 30e6, 12)  # Pa


def stiffness(gamma):
    """Of the joint at these pressures, N/m, by theory."""
    theory = mcgw.Scene(surface, separations=0.0, grading=mcgw.Exponential(gamma)).theory
    return theory.mean("stiffness", theory.separation_at("pressure", pressure))


noise = 0.03
data = stiffness(1.5) * (1 + noise * np.random.default_rng(1).normal(size=len(pressure)))

# %% [markdown]
# ## Theory
#
# At a given *pressure* stiffness hardly depends on γ: stiffer tips keep the plane farther away, and the loss
# of contacts balances the higher modulus. The picture shows how small the effect is.

# %%
fig, ax = plt.subplots()
ax.semilogx(pressure / 1e6, data / stiffness(1.0), "o", color=HOMOGENEOUS, label="data")
for gamma in (0.5, 1.5, 3.0):
    ax.semilogx(pressure / 1e6, stiffness(gamma) / stiffness(1.0), **line(f"γ = {gamma:g}"))
ax.set(xlabel="pressure (MPa)", ylabel="stiffness over that of γ = 1")
ax.legend()

# %% [markdown]
# ## The likely values
#
# The sum of squares as a function of γ. Values within 3.84 of the minimum form a 95 % interval.

# %%
gammas = np.linspace(0.3, 4.0, 75)
squares = np.array([np.sum(((data / stiffness(g) - 1) / noise) ** 2) for g in gammas])
inside = gammas[squares < squares.min() + 3.84]
print(f"best: {gammas[squares.argmin()]:.2f}; 95 %: {inside.min():.2f} to {inside.max():.2f}")

fig, ax = plt.subplots()
ax.plot(gammas, squares, color=THEORY)
ax.axhspan(squares.min(), squares.min() + 3.84, color=THEORY, alpha=0.2)
ax.set(xlabel="γ", ylabel="sum of squares", ylim=(0, squares.min() + 30))

# %% [markdown]
# ## Would conductance be better?
#
# Conductance at a given pressure decreases with γ, because there are fewer spots. With the same noise it
# determines γ much better.


# %%
def conductance(gamma):
    """Times the resistivity, m."""
    theory = mcgw.Scene(surface, separations=0.0, grading=mcgw.Exponential(gamma)).theory
    return theory.mean("conductance", theory.separation_at("pressure", pressure))


data = conductance(1.5) * (1 + noise * np.random.default_rng(2).normal(size=len(pressure)))
near = np.linspace(1.4, 1.6, 81)
squares = np.array([np.sum(((data / conductance(g) - 1) / noise) ** 2) for g in near])
sharper = near[squares < squares.min() + 3.84]
print(f"best: {near[squares.argmin()]:.3f}; 95 %: {sharper.min():.3f} to {sharper.max():.3f}")
assert np.ptp(sharper) < np.ptp(inside)

# %% [markdown]
# ## And my specimen is finite
#
# One specimen of 1 cm² differs from the mean. At light loads this scatter is larger than the noise here, so
# it must be included in the sum of squares.

# %%
scene = mcgw.Scene(surface, separations=0.0, grading=mcgw.Exponential(1.5), n_surfaces=100, seed=1)
for solution in mcgw.solve(scene, pressure=[float(pressure[0]), float(pressure[-1])]):
    k = solution.surfaces["stiffness"]
    at = solution.amount / surface.nominal_area / 1e6
    print(f"{at:5.1f} MPa: specimens differ by {k.std() / k.mean():.1%}")
