"""Ranges of named inputs carried through any function to its named outputs: Monte Carlo, Sobol indices, tornado."""
