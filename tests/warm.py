"""Compile the loops that tests share, once for all workers, in two processes side by side.

Two workers that start with nothing compile the same loops twice. What is kept is the product's own cache, in
its usual place; a session that finds it passes here in two seconds.
"""

import subprocess
import sys

import numpy as np

import mcgw
from mcgw.maps.topography import Topography
from mcgw.sampling.block import Layout
from mcgw.sampling.cells import mesh_of
from mcgw.sampling.counts import counts_of
from mcgw.sampling.drawing import OneByOne
from mcgw.sampling.samplers import sampler_of

SURFACE = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 mm^2", "78.6 GPa")
SPECTRAL = mcgw.SpectralSurface(m0=1e-12, m2=1e-2, m4=4e8, nominal_area=1e-6, E_star=1e11)
ASKED = {"separations": [0.0, 0.5, 2.0], "n_asperities": 3000, "n_surfaces": 20, "seed": 1}
SCENE = mcgw.Scene(SURFACE, grading=mcgw.Exponential(2.0), **ASKED)


def responses():
    """The physics of cells alone."""
    sampler_of(SCENE.replace(keep="moments"))
    sampler_of(SCENE.replace(law=mcgw.KogutEtsion(critical=0.1), unload_from=0.0))


def draws():
    """Moments of every length, without any physics."""
    mesh = mesh_of(SCENE)
    lengths = (np.resize(kinds, mesh.size) for kinds in ([10, 12, 16], [0, 0, 0, 4, 6, 11]))
    OneByOne().moments(1, 0, counts_of(SCENE, mesh, 0, 20), Layout(*lengths))


def scenes(*changes):
    for change in changes:
        mcgw.simulate(SCENE.replace(**change))


def nominal():
    interaction = mcgw.Interaction("mean-plane", at="nominal")
    scenes({"interaction": interaction, "n_asperities": 300})


def hertz():
    scenes({"keep": "moments"}, {"sampler": "stratified"}, {"sampler": "direct"}, {"count": "poisson"})


def others():
    scenes({"accuracy": 1e-3, "n_asperities": 10**5}, {"sampler": "aggregate", "n_asperities": 10**6})
    mcgw.simulate(mcgw.Scene(SPECTRAL, **ASKED))


def maps():
    heights = np.random.default_rng(1).normal(size=(64, 64)) * 1e-6
    mcgw.fit(Topography(heights, (1e-6, 1e-6)), cutoff="8 um")


# The first of the one are not in the other: what both need last is there by then.
HALVES = ((responses, maps, nominal, hertz), (draws, others))


def warm():
    """Both halves at once, in processes of their own."""
    halves = [subprocess.Popen([sys.executable, __file__, str(i)]) for i in range(len(HALVES))]
    return [half.wait() for half in halves]


if __name__ == "__main__":
    for part in HALVES[int(sys.argv[1])]:
        part()
