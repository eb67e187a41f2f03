"""Ensembles in memory: drawing, statistics, answers at given loads."""
