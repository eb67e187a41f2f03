"""Ensembles in memory: drawn, summed up, extended to other gradings and to given loads."""
