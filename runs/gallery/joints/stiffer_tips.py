"""
Do stiffer tips conduct better?
===============================

Not at equal separation, where spots are the same. At equal *load* stiffer tips (γ > 1) conduct less.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import line

surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
plain = mcgw.Scene(surface, separations=2.0).theory
load = plain.mean("load", 2.0)


def ratio(gamma, at):
    """Conductance over that of γ = 1."""
    graded = mcgw.Scene(surface, separations=2.0, grading=mcgw.Exponential(gamma)).theory
    h = graded.separation_at("load", load) if at == "load" else 2.0
    return graded.mean("conductance", h) / plain.mean("conductance", 2.0)


gammas = np.linspace(0.2, 2.5, 24)
fig, ax = plt.subplots()
ax.plot(gammas, [ratio(g, "load") for g in gammas], **line("at the load of d = 2σ, γ = 1"))
ax.plot(gammas, [ratio(g, "separation") for g in gammas], **line("at the separation d = 2σ", 1))
ax.set(xlabel="γ of E*(s)/E* = γ − (γ − 1) exp(−s)", ylabel="conductance over that of γ = 1", ylim=(0, None))
ax.legend()
