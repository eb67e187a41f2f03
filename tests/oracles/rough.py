"""Gaussian maps for tests, periodic; and a map fitted in one call, without what speaks against the fit."""

from mcgw.maps import Spectrum, gaussian_map
from oracles.inside import Preparation, fit_prepared, prepared

SPECTRUM = Spectrum(rms=1e-6, long=40e-6, short=5e-6)


def rough(rng, columns=64, rows=None, pixel=(1e-6, 1e-6)):
    """One of as many points, by a generator; square if the rows are left out."""
    return gaussian_map(SPECTRUM, (rows or columns, columns), pixel, rng)


def fit_map(topography, *, cutoff, **steps):
    return fit_prepared(prepared(topography, Preparation(cutoff, **steps)))
