"""Monte Carlo against theory: comparison, convergence, error against time."""
