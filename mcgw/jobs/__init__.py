"""Ensembles in files: distribute blocks to engines, and merge them."""
