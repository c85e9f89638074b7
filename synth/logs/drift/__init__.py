"""The watch on drift: what of a position's numbers has moved away from what they were, and since when."""
