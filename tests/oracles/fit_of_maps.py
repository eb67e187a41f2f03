"""A map fitted in one call, without what speaks against the fit."""

from mcgw.maps.fit import fit_prepared
from mcgw.maps.preparation import Preparation, prepared


def fit_map(topography, *, cutoff, across=4, **steps):
    return fit_prepared(prepared(topography, Preparation(cutoff, **steps)), across=across)
