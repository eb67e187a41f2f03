"""Figures of `mcgw figures`: numbers first, then drawn alike.

``data``        points, curves and panels, with the sums and errors behind them
``samples``     the surfaces, drawn when first asked for
``paper``       Figures 1 to 6 of the paper
``equal_load``  what changes at equal load
``finite``      fluctuations of finite surfaces, and the law of their load
``summits``     how the area grows with the load, which summits carry it, where their modulus turns negative
``further``     all that the paper lacks
``of_scene``    the same of anybody's scene, ``beside`` its references (``scene_paper``, ``scene_further``)
``style``       one colour for each meaning, in every figure alike
``drawing``     panels, residuals below them, and the files of a figure
"""
