"""The study `convergence`: grids refined."""
