"""The watch on all positions of a yard: what to repair first, and what it costs over the hump."""
