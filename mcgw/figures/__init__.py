"""Figures: numbers first, then drawn alike.

``panels``     curves, points and panels, residuals below them, and the files of a figure
``compared``   scenes on the same surfaces: one beside its references, or the paper's preset swept over gamma
``catalogue``  the figures of `mcgw figures`, a row each; their numbers are from ``ratios``
``studies``    comparison, convergence, error against time
``style``      one colour for each meaning, in every figure alike; and figures as files
``plotting``   what ``.plot()`` of each result draws
"""
