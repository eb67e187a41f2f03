"""Ensembles in memory: drawing, statistics, regrading, answers at given loads."""
