"""Trains over the hump, cut after cut: what rolls where, what the positions make of it, and what it came to."""
