"""From the accuracy of the park position and what is measured of a cut to gaps and damaging couplings."""
