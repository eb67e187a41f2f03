"""From a scene to the sums of its surfaces, in one straight line.

``cells``      the heights that touch, cut where a law of contact has a root (`spacing` says where else)
``counts``     how many asperities fall into each cell, exactly (`halving`, `binomial`)
``moments``    sums over the uniforms of a cell (`philox`, `uniform_sums`), or from their Gaussian limit
               (`aggregate`): all that a surface keeps
``response``   physics as a sparse matrix: `laws` on the cells and on a `tree` over them
``samplers``   a block of surfaces = response @ moments, and the few asperities outside the cells (`extras`,
               `hertz`)
``asperities`` the very heights that were summed, if anybody asks
"""
