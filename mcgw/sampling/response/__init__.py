"""Physics as a sparse matrix on the moments of the cells; it knows no randomness."""
