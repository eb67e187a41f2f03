"""Ensembles in files: distribute blocks to executors, and merge them."""
