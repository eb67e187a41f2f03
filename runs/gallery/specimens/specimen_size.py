"""
How large must a specimen be?
=============================

Scatter decreases with the number of contacts: at 1 MPa this surface needs about 50 mm² for a scatter of 10 %.
"""

import matplotlib.pyplot as plt
import numpy as np

import mcgw
from mcgw.figures.style import step

areas = np.geomspace(1, 1000, 7)  # mm^2
fig, ax = plt.subplots()
for k, pressure in enumerate(("0.1 MPa", "1 MPa", "10 MPa")):
    simulated, exact = [], []
    for area in areas:
        surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", f"{area} mm^2", "78.6 GPa")
        scene = mcgw.Scene(
            surface, separations=0.0, contact=mcgw.Contact(quantities=["load"]), n_surfaces=400, seed=1
        )
        h = float(scene.theory.separation_at("pressure", 1e6 * float(pressure.split()[0])))
        e = mcgw.simulate(scene, separations=h)
        simulated.append(100 * e.std("load")[0] / e.mean("load")[0])
        exact.append(100 * scene.theory.std("load", h) / scene.theory.mean("load", h))
    look = step(f"at a mean pressure of {pressure}", k, 3)
    ax.loglog(areas, exact, **look)
    ax.loglog(areas, simulated, "o", color=look["color"], markersize=4)
ax.axhline(10, color="0.5", linewidth=0.8, linestyle=":")
ax.set(xlabel="nominal area of the specimen (mm²)", ylabel="scatter of the load (%)")
ax.legend(title="lines: theory, dots: simulated")
