"""Runs of `hump simulate` side by side, on the same trains."""
