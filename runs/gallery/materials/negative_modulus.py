"""
Where does the exponential grading turn negative?
=================================================

For γ > 1 deep below the mean plane, for γ < 0 above it; from 0 to 1 nowhere. A scene whose contacts reach the
shaded heights needs ``negative = "clip"`` or ``"allow"``.
"""

import matplotlib.pyplot as plt
import numpy as np

stiffer, softer = np.linspace(1.02, 4, 150), np.linspace(-2, -0.02, 100)
fig, ax = plt.subplots()
ax.fill_between(stiffer, -4, np.log((stiffer - 1) / stiffer), alpha=0.4, label="negative below this height")
ax.fill_between(softer, np.log(1 - 1 / softer), 4, alpha=0.4, label="negative above this height")
ax.axvspan(0, 1, color="0.93", zorder=0)
ax.set(xlabel="grading factor γ", ylabel="summit height s = z/σ", ylim=(-4, 4), xlim=(-2, 4))
ax.legend(loc="upper right")
