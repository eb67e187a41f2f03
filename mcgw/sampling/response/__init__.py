"""Physics as a sparse matrix on the moments of the cells; without randomness."""
