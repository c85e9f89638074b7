"""What the studies of aimed braking share: the hump, an aim that is tried on drawn cuts, and its figures."""
