"""Figures: numbers first, then drawn alike.

``data``       points, curves and panels, with the sums and errors behind them
``compared``   scenes on the same surfaces: one beside its references, or the paper's preset swept over gamma
``catalogue``  the figures of `mcgw figures`, a row each; their numbers are from ``ratios``
``style``      one colour for each meaning, in every figure alike; and figures as files
``panels``     panels, residuals below them, and the files of a figure
``plotting``   what ``.plot()`` of each result draws
"""
