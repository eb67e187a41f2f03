"""From a scene to the sums of its surfaces: an ensemble is a matrix, a question is a matrix.

``cells``      the heights that touch, cut where a law of contact has a root (`spacing` says where else)
``moments``    sums over the uniforms of a cell (`philox`, `kernels`), or from their Gaussian limit
               (`crowds`): all that a surface keeps, as many of each cell as its `Layout` says
``response``   physics as a sparse matrix: series on the cells and on a `tree` over them, found in a `walk`,
               put together to rows that follow from each other
``counted``    how many asperities fall into each cell, exactly; a block of surfaces = response @ moments, and
               the few asperities outside the cells; `samplers` has the names of what is made so
``direct``     all heights, or those that are given, in plain loops: the witness
``asperities`` the heights that were summed

The whole idea in a dozen lines. The load of each surface is its row of moments times a matrix that was made
without any surface; it is that of its very asperities, added up one by one:

>>> import mcgw, numpy as np
>>> from analytic import Exponential
>>> from mcgw.sampling.samplers import cells_of
>>> surface = mcgw.Surface("1.37 um", "13 um", "300/mm^2", "1 cm^2", "78.6 GPa")
>>> asked = {"separations": (0.0, 1.0), "grading": Exponential(2.0), "n_surfaces": 3, "seed": 1}
>>> scene = mcgw.Scene(surface=surface, **asked)
>>> sampler = cells_of(scene)
>>> moments, _, _ = sampler.drawn(0, 3, sampler.response.layout)
>>> load = moments.T @ sampler.response.matrix()[scene.quantities.index("load")].T
>>> s = mcgw.heights(scene, 2)
>>> delta = surface.sigma * np.maximum(s[:, None] - scene.separations, 0)
>>> E = surface.E_star * scene.grading(s)
>>> hertz = 4 / 3 * E[:, None] * np.sqrt(surface.radius) * delta**1.5
>>> bool(np.all(np.abs(load[2] / hertz.sum(axis=0) - 1) < 1e-13))
True
"""
