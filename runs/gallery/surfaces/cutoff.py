"""
Which cutoff should I use for my map?
=====================================

R and η of a self-affine surface depend on the shortest wave that you include; σ hardly does.
"""

import tempfile

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

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
labels = {"sigma": "σ of the summits", "radius": "radius R", "eta": "density η"}
for k, (name, label) in enumerate(labels.items()):
    values = np.array([getattr(surface, name) for surface in scenes])
    ax.loglog(cutoffs, values / values[0], marker="o", markersize=4, **line(label, k))
ax.set(xlabel="cutoff, shortest wave that counts (µm)", ylabel="over the value at 3 µm")
ax.set_xticks(cutoffs, labels=[str(c) for c in cutoffs])
ax.set_yticks([0.1, 0.2, 0.5, 1, 2, 5], labels=["0.1", "0.2", "0.5", "1", "2", "5"])
ax.minorticks_off()
ax.legend()
