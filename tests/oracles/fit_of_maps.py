"""A map fitted in one call, without what speaks against the fit."""

from oracles.inside import Preparation, fit_prepared, prepared


def fit_map(topography, *, cutoff, **steps):
    return fit_prepared(prepared(topography, Preparation(cutoff, **steps)))
