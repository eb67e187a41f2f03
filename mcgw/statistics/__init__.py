"""Where Monte Carlo meets theory: comparison, convergence, error against time."""
