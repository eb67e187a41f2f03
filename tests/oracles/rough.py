"""Gaussian maps for tests, periodic."""

from mcgw.maps import Spectrum, gaussian_map

SPECTRUM = Spectrum(rms=1e-6, long=40e-6, short=5e-6)


def rough(rng, columns=64, rows=None, pixel=(1e-6, 1e-6)):
    """One of as many points, by a generator; square if the rows are left out."""
    return gaussian_map(SPECTRUM, (rows or columns, columns), pixel, rng)
