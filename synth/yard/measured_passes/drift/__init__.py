"""The watch on drift: what of a position's numbers has moved away from what its tables were made for, and since when."""
