"""The stochastic dynamic programme: from a problem to switching lines, polynomials and a predicted table."""
