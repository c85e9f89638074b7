"""Each subject as a few functions for Python programs and notebooks, from a problem to a validated table first."""
