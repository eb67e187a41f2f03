"""
Which cutoff do I take for my map?
==================================

There is no answer without one: R and η of a self-affine surface depend on the shortest wave that counts,
while σ hardly does.
"""

import tempfile

import matplotlib.pyplot as plt
import numpy as np

import mcgw

# A Gaussian map of 512 points of 0.5 um: waves of 2 to 60 um, Hurst exponent 0.8.
q = np.fft.fftfreq(512, 0.5)[:, None], np.fft.rfftfreq(512, 0.5)[None, :]
q = np.hypot(*q)
amplitude = np.where((q > 1 / 60) & (q < 1 / 2), np.maximum(q, 1 / 60) ** -1.8, 0)
noise = np.fft.rfft2(np.random.default_rng(1).normal(size=(512, 512)))
z = np.fft.irfft2(amplitude * noise)
cutoffs = np.array([3, 4, 6, 8, 12])  # um
with tempfile.TemporaryDirectory() as folder:
    np.save(f"{folder}/map.npy", z / z.std() * 1e-6)
    fits = [mcgw.fit(f"{folder}/map.npy", cutoff=f"{c} um", pixel="0.5 um") for c in cutoffs]
scenes = [mcgw.fitted_scene(fit).surface for fit in fits]
fig, ax = plt.subplots()
for name, label in (("sigma", "σ of the summits"), ("radius", "radius R"), ("eta", "density η")):
    values = np.array([getattr(surface, name) for surface in scenes])
    ax.loglog(cutoffs, values / values[0], "o-", markersize=4, label=label)
ax.set(xlabel="cutoff, shortest wave that counts (µm)", ylabel="over the value at 3 µm")
ax.set_xticks(cutoffs, labels=[str(c) for c in cutoffs])
ax.minorticks_off()
ax.legend()
