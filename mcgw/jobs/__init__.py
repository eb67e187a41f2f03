"""Ensembles in files: who draws which block, on what, and what makes the file of them."""
