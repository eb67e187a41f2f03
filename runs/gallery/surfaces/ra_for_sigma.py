"""
What if I use Ra as σ?
======================

The load is then too large for narrow spectra and too small for broad ones, here by up to six times.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw

ra = np.sqrt(2 / np.pi) * 1e-6  # of Gaussian heights whose root mean square is 1 um
alphas = np.geomspace(1.6, 100, 30)
errors = []
for alpha in alphas:
    true = mcgw.SpectralSurface(1e-12, 1e-3, alpha * 1e6, "1 mm^2", "100 GPa").surface
    wrong = mcgw.Surface(ra, true.radius, true.eta, true.nominal_area, true.E_star)
    h = 2 * true.sigma / ra  # the same separation of 2 sigma, over what is taken for sigma
    load = mcgw.Scene(wrong, separations=h).theory.mean("load", h)
    errors.append(load / mcgw.Scene(true, separations=2.0).theory.mean("load", 2.0))

fig, ax = plt.subplots()
ax.loglog(alphas, errors)
ax.axhline(1, color="0.5", linewidth=0.8, linestyle=":")
ax.set(xlabel="Nayak's α = m0 m4 / m2² of the surface", ylabel="load with Ra for σ, over the true one")
ax.set_yticks([0.2, 0.5, 1, 2, 3], labels=["0.2", "0.5", "1", "2", "3"])
ax.set_xticks([2, 5, 10, 20, 50, 100], labels=["2", "5", "10", "20", "50", "100"])
ax.minorticks_off()
